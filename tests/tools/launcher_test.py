"""./s4tp installs what a command needs, and says how far a long step is."""

import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest

LAUNCHER = pathlib.Path(__file__).resolve().parents[2] / "s4tp"
# A system that has every package but sumo, and cannot build.
PROGRAMS = {
    "dpkg-query": '[ "${@: -1}" = sumo ] || echo installed',
    "sudo": 'while [ "$1" != apt-get ] && [ $# != 0 ]; do shift; done; [ $# = 0 ] || exec "$@"',
    "apt-get": 'echo "$@" >>"$(dirname "$0")/asked"',
    "cmake": "echo '[1/2] Building'; exit 1",
}


class Launcher(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="s4tp_launcher_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "s4tp").write_bytes(LAUNCHER.read_bytes())
        for name, text in PROGRAMS.items():
            (self.folder / name).write_text(f"#!/bin/bash\n{text}\n", encoding="utf-8")
            (self.folder / name).chmod(0o755)

    def asked_for(self, *arguments):
        """What the launcher would have installed."""
        done = subprocess.run(["bash", self.folder / "s4tp", *arguments], check=False, text=True, timeout=60,
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              env={**os.environ, "PATH": f"{self.folder}:{os.environ['PATH']}"})
        self.assertRegex(done.stdout, r"configuring host +\d+ s  FAILED")
        asked = self.folder / "asked"
        return asked.read_text(encoding="utf-8") if asked.exists() else ""

    # Without a word it says what to try first; a word it does not know is named, with the one that was meant where one is
    # near, and where the right ones are.
    def test_first_steps_and_wrong_words(self):
        alone = subprocess.run(["bash", LAUNCHER], check=False, text=True, stdout=subprocess.PIPE, timeout=60)
        self.assertEqual(alone.returncode, 0)
        self.assertIn("./s4tp demo", alone.stdout)
        for word, meant in (("rnu", "run"), ("telemetri", "telemetry"), ("bnch", "bench"), ("reply", "replay"), ("frobnicate", ""), ("x", ""), ("\\n", "")):
            wrong = subprocess.run(["bash", LAUNCHER, word], check=False, text=True, stderr=subprocess.PIPE, timeout=60)
            self.assertEqual(wrong.returncode, 2)
            question = f"did you mean {meant}? " if meant else ""
            self.assertEqual(wrong.stderr, f"s4tp: there is no command '{word}'; {question}./s4tp --help lists them\n")

    # SUMO is installed when it is to simulate, alone or beside our own traffic, and only then.
    def test_sumo_is_installed_when_it_is_asked_for(self):
        for arguments in (("run",), ("eval", "--traffic", "builtin"), ("run", "--out", "sumo")):
            self.assertEqual(self.asked_for(*arguments), "", arguments)
        for arguments in (("run", "--traffic", "sumo"), ("eval", "--traffic=sumo"), ("coupling",), ("roads",), ("eval", "--roads", "0:5"),
                          ("traffic", "--traffic", "builtin,sumo")):
            self.assertRegex(self.asked_for(*arguments), r"update\ninstall .* sumo\n", arguments)
            (self.folder / "asked").unlink()

    # ctest's count of finished tests and ninja's of steps; of any other program the last line.
    def test_progress_is_told_in_steps_and_tests(self):
        function = re.search(r"^progress\(\) {\n.*?^}\n", LAUNCHER.read_text(encoding="utf-8"), re.M | re.S).group()
        for output, said in (
                ("  7/1043 Test   #9: unit.Gate.Denies ....   Passed    0.02 sec\n      Start   12: unit.Gate.Stops\n",
                 "test 7 of 1043: unit.Gate.Denies"),
                ("[3/250] Building CXX object a.o\n", "step 3 of 250"),
                ("Get:1 http://mirror.example\nUnpacking cmake\n", "Unpacking cmake"), ("", "")):
            file = self.folder / "output"
            file.write_text(output, encoding="utf-8")
            done = subprocess.run(["bash", "-c", f"{function}progress '{file}'"], check=True, text=True,
                                  stdout=subprocess.PIPE)
            self.assertEqual(done.stdout.strip(), said)


    def launch(self, *arguments, program=None, **options):
        """The launcher in the folder, with this stand-in for a build that works and this one for the program built."""
        (self.folder / "cmake").write_text("#!/bin/bash\nexit 0\n", encoding="utf-8")
        for name in ("sim_host/s4tp_tool", "firmware/targets/replay"):
            file = self.folder / "build/host" / name
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(program or '#!/bin/bash\npwd\necho "$@"\n', encoding="utf-8")
            file.chmod(0o755)
        options.setdefault("env", {}).setdefault("PATH", f"{self.folder}:{os.environ['PATH']}")
        options["env"] = {**os.environ, **options["env"]}
        done = subprocess.run(arguments, check=False, text=True, timeout=60, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, **options)
        return done.stdout

    # The test of the package that a chroot needs says what is missing; ./s4tp test leaves it out then, and shows that line.
    def test_what_cannot_run_is_named(self):
        test = LAUNCHER.parent / "tests/package/bare_debian_test.py"
        done = subprocess.run([sys.executable, "-B", test, "--possible"], check=False, text=True, stdout=subprocess.PIPE, timeout=60,
                              env={**os.environ, "PATH": str(self.folder)})
        self.assertEqual((done.returncode, done.stdout), (1, "mmdebstrap is missing: apt-get install mmdebstrap\n"))
        self.assertIn("tests/package/bare_debian_test.py --possible", LAUNCHER.read_text(encoding="utf-8"))

    # A relative path means the caller's folder, not the launcher's: for a scenario, a log, an output, and of replay.
    def test_paths_are_the_callers(self):
        here = self.folder / "elsewhere"
        here.mkdir()
        launcher = self.folder / "s4tp"
        for arguments in (("run", "--scenario", "mine", "--log", "a.log", "--out", "b"), ("replay", "a.log")):
            said = self.launch("bash", launcher, *arguments, cwd=here)
            self.assertIn(f"\n{here}\n", said)

    # Through a link, also one in PATH, and with CDPATH set, the launcher finds its own tree.
    def test_links_and_cdpath(self):
        elsewhere = self.folder / "elsewhere"
        (elsewhere / "build").mkdir(parents=True)
        link = elsewhere / "link"
        link.symlink_to(self.folder / "s4tp")
        (self.folder / "s4tp").chmod(0o755)
        path = f"{elsewhere}:{self.folder}:{os.environ['PATH']}"
        self.assertIn(f"\n{elsewhere}\nrun\n", self.launch("link", "run", cwd=elsewhere, env={"PATH": path}))
        said = self.launch("bash", "../s4tp", "run", cwd=elsewhere, env={"CDPATH": str(self.folder)})
        self.assertIn(f"\n{elsewhere}\nrun\n", said)
        self.assertEqual(list((elsewhere / "build").iterdir()), [])
        # With CDPATH, cd of a relative name goes elsewhere, and says so on the output of what asks for the folder.
        (elsewhere / "tree").symlink_to(self.folder)
        other = self.folder / "other"
        (other / "tree").mkdir(parents=True)
        said = self.launch("bash", "tree/s4tp", "run", cwd=elsewhere, env={"CDPATH": str(other)})
        self.assertIn(f"\n{elsewhere}\nrun\n", said)

    # A tree that cannot be written is named, with what to do, and nothing else is tried.
    def test_a_tree_that_cannot_be_written(self):
        (self.folder / "build").write_text("in the way", encoding="utf-8")  # for root, who may write everywhere
        done = subprocess.run(["bash", self.folder / "s4tp", "run"], check=False, text=True, timeout=60,
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              env={**os.environ, "PATH": f"{self.folder}:{os.environ['PATH']}"})
        self.assertEqual(done.returncode, 2)
        self.assertEqual(done.stdout.strip(), f"s4tp: {self.folder}/build cannot be written: what is built and logged goes "
                         f"there; use a copy of {self.folder} that you may write to")

    # A build ends with the launcher, and so does whatever it has started.
    def test_sigterm_ends_the_build(self):
        (self.folder / "cmake").write_text('#!/bin/bash\nsleep 300 &\necho $! >"$(dirname "$0")/child"\nwait\n', encoding="utf-8")
        for number, code in ((signal.SIGTERM, 143), (signal.SIGINT, 130), (signal.SIGHUP, 143)):
            child = self.folder / "child"
            child.unlink(missing_ok=True)
            running = subprocess.Popen(["bash", self.folder / "s4tp", "run"], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL,
                                       env={**os.environ, "PATH": f"{self.folder}:{os.environ['PATH']}"})
            for _ in range(600):
                if child.exists() and child.read_text(encoding="utf-8").strip():
                    break
                time.sleep(0.05)
            build = int(child.read_text(encoding="utf-8"))
            running.send_signal(number)
            self.assertEqual(running.wait(timeout=30), code)
            for _ in range(100):
                state = pathlib.Path(f"/proc/{build}/stat")
                if not state.exists() or state.read_text(encoding="utf-8").split(") ")[1].startswith("Z"):
                    break
                time.sleep(0.05)
            else:
                os.kill(build, signal.SIGKILL)
                self.fail(f"{number.name}: the build goes on")


if __name__ == "__main__":
    unittest.main()
