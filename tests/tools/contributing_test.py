"""What CONTRIBUTING.md tells to do is done here, word for word, in a copy; and the hook before a commit sees what it should.

S4TP_BUILD names the host's build folder.
"""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ["S4TP_BUILD"])
PAGE = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")


def recipe(name):
    """The block of the page that is headed by this file's name."""
    return re.search(rf"^```\w+ {re.escape(name)}\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL)[1]


def run(*command, code=0, **options):
    result = subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                            check=False, stdin=subprocess.DEVNULL, timeout=280, **options)
    if result.returncode != code:
        raise AssertionError(f"{' '.join(map(str, command))}\nanswered {result.returncode}, not {code}:\n{result.stdout}")
    return result.stdout


class Recipes(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="s4tp_recipe_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    # A planner's file compiles as it stands, with every warning an error; linked into the program, of which no other file
    # names it, it drives where it is asked for, bare and guarded.
    def test_planner(self):
        name, text = "half_speed", recipe("half_speed.cpp")
        self.assertIn(f"--planner {name}", PAGE)
        self.assertIn("GLOB baselines_sources CONFIGURE_DEPENDS baselines/*.cpp", (ROOT / "sim_host/CMakeLists.txt").read_text(encoding="utf-8"))
        (self.folder / "half_speed.cpp").write_text(text, encoding="utf-8")
        commands = json.loads((BUILD / "compile_commands.json").read_text(encoding="utf-8"))
        command = next(one["command"] for one in commands if one["file"].endswith("sim_host/baselines/any_ecu.cpp"))
        command = re.sub(r" -(?:include|o|c) \S+", "", command)  # without the headers read once: the file includes its own
        run("sh", "-c", f"{command} -Wall -Wextra -Wpedantic -Wshadow -Werror -c half_speed.cpp -o half_speed.o", cwd=self.folder)
        link = run("ninja", "-C", BUILD, "-t", "commands", "-s", "sim_host/s4tp_tool").splitlines()[-1]
        self.assertIn(" -o sim_host/s4tp_tool ", link)
        run("sh", "-c", link.replace(" -o sim_host/s4tp_tool ", f" {self.folder}/half_speed.o -o {self.folder}/s4tp_tool "), cwd=BUILD)
        (self.folder / "share").symlink_to(BUILD.resolve() / "share")
        run(self.folder / "s4tp_tool", "eval", "--planner", name, "--scenario", ROOT / "sim_host/scenarios/cruise", "--guard", "on", "off",
            "--episodes", "1", "--out", self.folder / "out")
        results = json.loads((self.folder / "out/results.json").read_text(encoding="utf-8"))["runs"]
        self.assertEqual([(one["planner"], one["guarded"]) for one in results], [(name, True), (name, False)])
        for one in results:  # the limit is 13.89 m/s, and the ego enters with it
            self.assertTrue(6.0 < one["mean_speed_mps"] < 8.5, one["mean_speed_mps"])

    # A scenario is driven to its end, and is the one that was asked for.
    def test_scenario(self):
        shutil.copy(ROOT / "sim_host/scenarios/cruise/network.net.xml", self.folder)
        (self.folder / "scenario.toml").write_text(recipe("scenario.toml"), encoding="utf-8")
        said = run(BUILD / "sim_host/s4tp_tool", "run", "--scenario", self.folder, "--seed", "0", "--out", self.folder / "out")
        self.assertRegex(said, r": goal after [\d.]+ s")

    # A parameter's row: the core compiles with it, knows its name and its default, and refuses what is outside its range.
    def test_parameter(self):
        shutil.copytree(ROOT / "algo", self.folder / "algo")
        table = self.folder / "algo/core/parameters.def"
        rows = table.read_text(encoding="utf-8").replace("GROUP_END(comfort)", recipe("parameters.def") + "GROUP_END(comfort)")
        table.write_text(rows, encoding="utf-8")
        (self.folder / "main.cpp").write_text("""
#include <cstdio>
#include <cstring>
#include <cstdlib>
#include "algo/core/parameter_info.hpp"
namespace s4tp {
[[noreturn]] void assertion_failed(const char*, const char*, int) { std::abort(); }
}
int main() {
  s4tp::Parameters parameters;
  int bad = -1;
  if (parameters.comfort.example_gap_m != 1.5F || validate(parameters, bad) != s4tp::Status::kOk) return 1;
  parameters.comfort.example_gap_m = 5.5F;
  if (validate(parameters, bad) == s4tp::Status::kOk) return 2;
  std::puts(s4tp::parameter_info(bad).name);
}
""", encoding="utf-8")
        core = [self.folder / f"algo/core/{name}.cpp" for name in ("parameters", "parameter_info", "crc32", "math", "status")]
        run("g++", "-std=c++17", f"-I{self.folder}", self.folder / "main.cpp", *core, "-o", self.folder / "main")
        self.assertIn("example_gap_m", run(self.folder / "main"))

    def patch(self, path, *pieces):
        """A copy of the file with each piece written before its place."""
        text = (ROOT / path).read_text(encoding="utf-8")
        for place, piece in pieces:
            self.assertEqual(text.count(place), 1, place)
            text = text.replace(place, piece + place)
        (self.folder / path).parent.mkdir(parents=True, exist_ok=True)
        (self.folder / path).write_text(text, encoding="utf-8")

    def message_goes_from_sender_to_reader(self):
        """Both as the page has them, in copies of the files they go to; the codec with the message is generated."""
        node = self.folder / "sim_host/world/nodes/slope_node.hpp"
        node.parent.mkdir(parents=True)
        node.write_text(recipe("slope_node.hpp"), encoding="utf-8")
        self.assertIn("`SlopeNode slope_node_` in `WorldNodes`", PAGE)
        self.patch("sim_host/world/nodes/world_nodes.hpp", ("  Perception perception_;", "  SlopeNode slope_node_;\n"),
                   ('#include "sim_host/world/nodes/map_node.hpp"', '#include "sim_host/world/nodes/slope_node.hpp"\n'))
        self.patch("sim_host/world/nodes/world_nodes.cpp", ("  perception_.publish(now_ms, frames);", "  slope_node_.publish(now_ms, 0.1F, frames);\n"))
        value, function, receiver = recipe("inputs.hpp").split("\n\n")
        case, body, tick = re.fullmatch(r"(    case.*?)\n\n(void.*?^}\n)\n(.*)", recipe("inputs.cpp"), re.MULTILINE | re.DOTALL).groups()
        self.patch("firmware/ecu/inputs.hpp", ("  [[nodiscard]] bool engage_switch()", f"{value}\n"),
                   ("  void accept_version(", f"{function}\n"), ("  PeriodicReceiver version_receiver_", receiver))
        self.patch("firmware/ecu/inputs.cpp", ("    case wire::kVersionWorldId:", f"{case}\n"), ("void Inputs::close_tick() {", f"{body}\n"),
                   ("  version_receiver_.tick();", tick))
        (self.folder / "drive.cpp").write_text("""
#include <cstdio>
#include <cstdlib>
#include "firmware/ecu/inputs.hpp"
#include "sim_host/world/nodes/slope_node.hpp"
namespace s4tp {
[[noreturn]] void assertion_failed(const char*, const char*, int) { std::abort(); }
}
int main() {
  s4tp::nodes::SlopeNode node;
  s4tp::ecu::Inputs inputs;
  int sent = 0;
  for (unsigned tick = 0; tick < 100; ++tick) {
    std::vector<s4tp::wire::Frame> frames;
    node.publish(10 * tick, tick < 50 ? 0.1F : 0.2F, frames);
    sent += static_cast<int>(frames.size());
    for (s4tp::wire::Frame& frame : frames) {
      if (tick >= 50) frame.data[3] ^= 1;  // damaged on its way
      inputs.accept(frame);
    }
    inputs.close_tick();
  }
  std::printf("%d sent, %u rejected, slope %.4f", sent, static_cast<unsigned>(inputs.rejected_frames()), static_cast<double>(inputs.slope_rad()));
}
""", encoding="utf-8")
        flags = ("-Wall", "-Wextra", "-Werror", f"-I{self.folder}", f"-I{ROOT}")
        run("g++", "-std=c++20", "-fsyntax-only", *flags, self.folder / "sim_host/world/nodes/world_nodes.cpp")
        sources = [self.folder / "drive.cpp", self.folder / "firmware/ecu/inputs.cpp", *self.folder.rglob("s4tp_codec.cpp"),
                   ROOT / "firmware/ecu/vehicle_clock.cpp", *(ROOT / "firmware/wire").glob("*.cpp")]
        run("g++", "-std=c++20", *flags, *sources, BUILD / "algo/libs4tp_core.a", "-o", self.folder / "drive")
        # Not taken: the first of all, as nobody trusts a counter that has not moved yet, and the five damaged ones.
        self.assertEqual(run(self.folder / "drive"), "10 sent, 6 rejected, slope 0.1000")

    # A message: the generated codec has it and packs it as the golden frames say, the load table counts it, and a version
    # raised in one place only is found; what the sender says the reader takes, and nothing damaged.
    def test_message(self):
        dbc = self.folder / "firmware/wire/s4tp.dbc"
        versions = self.folder / "algo/core/versions.hpp"
        for file in (dbc, versions, self.folder / "CMakeLists.txt", self.folder / "CHANGELOG.md"):
            file.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / file.relative_to(self.folder), file)
        lines = recipe("s4tp.dbc").splitlines(True)
        text = dbc.read_text(encoding="utf-8")
        for begin, kind in (("CM_ BO_ 8", "CM_"), ('BA_ "GenMsgCycleTime" BO_ 8', "BA_")):
            text = text.replace(begin, "".join(line for line in lines if line.startswith(kind)) + begin, 1)
        message = "".join(line for line in lines if line.startswith(("BO_", " SG_"))) + "\n"
        text = text.replace("BO_ 8 ", message + "BO_ 8 ", 1)
        text = re.sub(r'^VERSION "(\d+)"', lambda match: f'VERSION "{int(match[1]) + 1}"', text)
        dbc.write_text(text, encoding="utf-8")
        run(sys.executable, "-B", ROOT / "toolchain/dbc_codec.py", dbc, "--output", self.folder / "firmware/wire/generated")
        codec = "".join(file.read_text(encoding="utf-8") for file in self.folder.rglob("s4tp_codec.hpp"))
        self.assertRegex(codec, r"struct Example\b")
        self.assertIn("slope_rad", codec)
        run(sys.executable, "-B", ROOT / "toolchain/bus_load.py", dbc, self.folder / "load.md")
        self.assertIn("| Example | VEHICLE | 10.0 |", (self.folder / "load.md").read_text(encoding="utf-8"))
        # Packed by the generated codec as by the one of the golden frames, and read back.
        for file in ("tests/golden/make_wire_frames.py", "toolchain/dbc.py"):
            (self.folder / file).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / file, self.folder / file)
        frames = run(sys.executable, "-B", self.folder / "tests/golden/make_wire_frames.py")
        golden = re.search(r"^Example (\w+) slope_rad=1.0235$", frames, re.MULTILINE)[1]
        (self.folder / "main.cpp").write_text("""
#include <cstdio>
#include "firmware/wire/codec.hpp"
int main() {
  s4tp::wire::Example sent;
  s4tp::wire::Example got;
  s4tp::wire::Frame frame;
  sent.slope_rad = 1.0235F;
  if (!encode(sent, frame) || !decode(frame, got) || got.slope_rad != sent.slope_rad || frame.id != 96) return 1;
  for (const unsigned byte : frame.data) std::printf("%02X", byte);
}
""", encoding="utf-8")
        run("g++", "-std=c++17", f"-I{self.folder}", f"-I{ROOT}", self.folder / "main.cpp", *self.folder.rglob("s4tp_codec.cpp"),
            ROOT / "firmware/wire/signal.cpp", "-o", self.folder / "main")
        self.assertEqual(run(self.folder / "main"), golden)
        self.message_goes_from_sender_to_reader()
        self.assertIn("kWireVersion", run(sys.executable, "-B", ROOT / "toolchain/check_versions.py", self.folder, code=1))

    # Whatever lists the targets is named by the recipe for a new one, and it names nothing else; the toolchain file that it
    # shows is as short as it says.
    def test_target(self):
        section = PAGE[PAGE.index("## A target"):PAGE.index("## A release")]
        places = [ROOT / "s4tp", ROOT / ".ci/run", ROOT / "CMakePresets.json",
                  *(file for file in (ROOT / "toolchain").iterdir() if file.suffix in (".py", ".sh", ".json"))]
        lists = [file.relative_to(ROOT).as_posix() for file in places if re.search(r"\bm55\b", file.read_text(encoding="utf-8"))]
        self.assertGreater(len(lists), 4)
        named = re.findall(r"`(s4tp|\.ci/run|CMakePresets\.json|toolchain/\w+\.(?:py|sh|json))`", section)
        self.assertEqual(sorted(named), sorted(lists))
        self.assertIn("`toolchain/m55.cmake` is four lines", section)
        lines = (ROOT / "toolchain/m55.cmake").read_text(encoding="utf-8").splitlines()
        self.assertEqual(len([line for line in lines if line and not line.startswith("#")]), 4)


class Hook(unittest.TestCase):
    # A sound tree passes; a requirement nobody tests and a file badly formatted do not.
    def test_hook_sees_what_it_should(self):
        with tempfile.TemporaryDirectory(prefix="s4tp_hook_") as folder:
            tree = pathlib.Path(folder) / "tree"
            for name in ("algo", "hal", "firmware", "sim_host", "tests", "toolchain", "docs", ".githooks"):
                shutil.copytree(ROOT / name, tree / name, ignore=shutil.ignore_patterns("__pycache__"))
            for file in (*ROOT.glob("*.md"), *ROOT.glob(".clang-format"), ROOT / "CMakeLists.txt", ROOT / "LICENSE"):
                shutil.copy(file, tree)
            run("git", "init", "--quiet", tree)
            run(tree / ".githooks/pre-commit")
            bad = tree / "algo/core/bad.hpp"
            bad.write_text(f"#pragma once\n/// {'GA'}{'TE'}-999 is promised.\nint   f( );\n", encoding="utf-8")
            run("git", "add", "algo/core/bad.hpp", cwd=tree)
            said = run(tree / ".githooks/pre-commit", code=1)
            self.assertIn("cited by no test", said)
            self.assertIn("clang-format -i", said)


if __name__ == "__main__":
    unittest.main()
