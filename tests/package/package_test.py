"""The library as its users get it: installed, as a folder of sources, as a Debian package; on the host and on Cortex-M7.

Every consumer stands outside our tree and has its own flags. S4TP_BUILD names the host's build folder, in which all of
the package is built; S4TP_LAUNCHER, if set, a compiler cache.
"""

import json
import os
import pathlib
import platform
import re
import shutil
import socket
import subprocess
import sys
import tempfile
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "toolchain"))
import check_headers  # noqa: E402
import check_includes  # noqa: E402

BUILD = pathlib.Path(os.environ["S4TP_BUILD"])
M7_BUILD = BUILD.parent / "m7"  # the preset's: ./s4tp test has built it by then
LAUNCHER = os.environ.get("S4TP_LAUNCHER", "")
CYCLES = 5


def run(*command, code=0, **options):
    """The command's output; fails unless it answers `code`."""
    result = subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                            check=False, stdin=subprocess.DEVNULL, timeout=280, **options)
    if result.returncode != code:
        raise AssertionError(f"{' '.join(map(str, command))}\nanswered {result.returncode}, not {code}:\n{result.stdout}")
    return result.stdout


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def run_image(target, image, *arguments, code=0):
    return run(ROOT / "toolchain/run_image.sh", target, image, *arguments, code=code)


class Package(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="s4tp_consumer_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.assertFalse(self.folder.resolve().is_relative_to(ROOT))
        self.consumer = self.folder / "consumer"
        shutil.copytree(ROOT / "tests/consumer", self.consumer)

    def install(self, build):
        prefix = self.folder / f"prefix_{build.name}"
        run("cmake", "--install", build, "--prefix", prefix)
        return prefix

    def configure(self, source, *options, code=0):
        build = self.folder / "build" / str(len(list(self.folder.glob("build/*"))))
        log = run("cmake", "-S", source, "-B", build, "-G", "Ninja", *options, code=code)
        return build, log

    def build(self, source, *options):
        """A consumer's program, configured and built."""
        build, _ = self.configure(source, *options)
        run("cmake", "--build", build)
        return build / "consumer"

    def on_host(self, prefix, *options):
        return self.build(self.consumer, f"-DCMAKE_PREFIX_PATH={prefix}", *options)

    # The prerequisite of the others: the same sources and install rules with the cross compiler.
    def test_m7_library_builds(self):
        launcher = [f"-DCMAKE_CXX_COMPILER_LAUNCHER={LAUNCHER}"] if LAUNCHER else []
        run("cmake", "--preset", "m7", "-B", M7_BUILD, *launcher, cwd=ROOT)
        run("cmake", "--build", M7_BUILD, "--target", "s4tp_package")

    # API-011: plain C with own flags, own linker script and own start-up. Every bit of five plans and of what
    # they cost goes into the checksum printed, so equal output is equal bits.
    def test_same_bits_on_host_and_m7(self):
        host = run_image("host", self.on_host(self.install(BUILD)))
        toolchain = f"-DCMAKE_TOOLCHAIN_FILE={self.consumer}/m7/toolchain.cmake"
        m7 = run_image("m7", self.build(self.consumer, toolchain, f"-DCMAKE_PREFIX_PATH={self.install(M7_BUILD)}"))
        print(host)
        self.assertEqual(host.count("S4TP_OK, kind 1"), CYCLES)
        self.assertEqual(host, m7)

    # A checksum that cannot differ would prove nothing: a vehicle 1 mm elsewhere is in it.
    def test_checksum_sees_one_millimetre(self):
        program = self.on_host(self.install(BUILD))
        usual, moved = run_image("host", program), run_image("host", program, "moved")
        self.assertEqual(usual.splitlines()[0], moved.splitlines()[0])
        self.assertNotEqual(usual.splitlines()[CYCLES][-8:], moved.splitlines()[CYCLES][-8:])

    # In somebody's source tree we are the library only, and the bits are the installed one's, though compiled without
    # optimization.
    def test_subdirectory_is_the_library_only(self):
        launcher = [f"-DCMAKE_CXX_COMPILER_LAUNCHER={LAUNCHER}"] if LAUNCHER else []
        program = self.build(self.consumer / "subdirectory", f"-DS4TP_SOURCE={ROOT}", *launcher)
        targets = run("cmake", "--build", program.parent, "--target", "help")
        self.assertIn("s4tp_ecu", targets)
        for ours in ("s4tp_tool", "s4tp_world", "unit_tests", "replay"):
            self.assertNotIn(ours, targets)
        self.assertFalse((program.parent / "s4tp/firmware/libs4tp_wire.a").exists())  # nobody asked for it
        self.assertEqual(run(program), run(self.on_host(self.install(BUILD))))

    # API-015: who does not say what to do about a fault of the library does not get a program.
    def test_assertion_handler_is_owed(self):
        build, _ = self.configure(self.consumer, f"-DCMAKE_PREFIX_PATH={self.install(BUILD)}",
                                  "-DCMAKE_C_FLAGS=-Ds4tp_on_assertion=something_else")
        self.assertIn("undefined reference to `s4tp_on_assertion'", run("cmake", "--build", build, code=1))

    # The gate, the wire and the application are in the package too.
    def test_ecu_application_links(self):
        run(self.build(self.consumer / "ecu", f"-DCMAKE_PREFIX_PATH={self.install(BUILD)}"))

    # Another version, and a library for another word size, are not found at all.
    def test_wrong_version_and_wrong_processor_are_refused(self):
        prefix = self.install(BUILD)
        lists = self.consumer / "CMakeLists.txt"
        _, log = self.configure(self.consumer, f"-DCMAKE_PREFIX_PATH={prefix}",
                                f"-DCMAKE_TOOLCHAIN_FILE={self.consumer}/m7/toolchain.cmake", code=1)
        self.assertIn("64bit", log)
        lists.write_text(lists.read_text(encoding="utf-8").replace("find_package(s4tp 0.1", "find_package(s4tp 9.9"),
                         encoding="utf-8")
        _, log = self.configure(self.consumer, f"-DCMAKE_PREFIX_PATH={prefix}", code=1)
        self.assertIn('"9.9"', log)

    # API-010: linking with -ffast-math makes an x86 flush denormals; the planner says so instead of planning other bits.
    @unittest.skipUnless(platform.machine() == "x86_64", "the linker flag does this on x86 only")
    def test_flushed_denormals_are_refused(self):
        program = self.on_host(self.install(BUILD), "-DCMAKE_EXE_LINKER_FLAGS=-ffast-math")
        self.assertIn("init: S4TP_ARITHMETIC", run(program, code=1))

    # Whatever is installed needs no flags of ours, and does not say where it was built.
    def test_installed_headers_bind_nobody(self):
        prefix = self.install(M7_BUILD)
        found, count = check_headers.findings(prefix / "include/s4tp")
        self.assertEqual(found, [])
        self.assertGreater(count, 60)
        for file in prefix.rglob("*.cmake"):  # who links the library needs no Eigen
            self.assertNotIn("igen", file.read_text(encoding="utf-8"), file)

    # Of the core what algo/api/headers.txt says, s4tp.h beside it; and whatever an installed header includes is there.
    def test_only_the_list_is_installed(self):
        include = self.install(BUILD) / "include/s4tp"
        files = {file.relative_to(include).as_posix(): file for file in include.rglob("*") if file.is_file()}
        public, others = check_includes.installed(ROOT)
        self.assertEqual(sorted(path for path in files if path.startswith("algo/")), sorted(public + others))
        self.assertIn("s4tp.h", files)
        for path, file in files.items():
            for header in re.findall(r'^\s*#\s*include\s*"([^"]+)"', file.read_text(encoding="utf-8"), re.MULTILINE):
                self.assertIn(header, files, path)

    def test_nothing_installed_names_our_folder(self):
        for file in self.install(BUILD).rglob("*"):
            if file.is_file():
                self.assertFalse(str(ROOT).encode() in file.read_bytes(), file)

    # A C program by way of pkg-config alone, wherever the prefix is.
    def test_pkg_config(self):
        prefix = self.install(BUILD)
        folder, = prefix.rglob("pkgconfig")
        said = run("pkg-config", "--cflags", "--libs", "s4tp", env={**os.environ, "PKG_CONFIG_PATH": str(folder)})
        self.assertIn(str(prefix), said)
        sources = sorted(self.consumer.glob("*.c"))
        run("cc", "-O2", *sources, *said.split(), "-o", self.folder / "consumer_c")
        self.assertEqual(run(self.folder / "consumer_c"), run(self.on_host(prefix)))

    # PROC-047: installed anywhere, moved after that, called through the link: the programs find their own scenarios and
    # each other.
    def test_programs_find_what_is_theirs(self):
        prefix = self.install(BUILD).rename(self.folder / "moved")
        tool = prefix / "bin/s4tp"
        self.assertEqual(run(tool, "--version"), run(ROOT / "s4tp", "--version"))
        self.assertRegex(run(tool, "run", "--scenario", "cruise", cwd=self.folder), r": goal after [\d.]+ s")
        said = run(tool, "run", "--scenario", "cruise", "--bus", f"slcan:tcp:127.0.0.1:{free_port()}", "--out", "bus", cwd=self.folder)
        self.assertIn("goal after", said)
        for program in ("view", "telemetry"):
            if (prefix / f"lib/s4tp/s4tp-{program}").exists():
                self.assertIn("--ecu", run(tool, program, "--help"))
        (prefix / "share/s4tp/scenarios").rename(prefix / "elsewhere")
        self.assertIn("s4tp: share/s4tp/scenarios is in no folder above", run(tool, "run", code=2))

    # Every library a program loads, and those of which only headers are used, are in the bill, with version and licence.
    def test_bill_of_materials(self):
        prefix = self.install(BUILD)
        bill = json.loads((prefix / "share/doc/s4tp/s4tp.spdx.json").read_text(encoding="utf-8"))
        self.assertEqual(bill["spdxVersion"], "SPDX-2.3")
        self.assertEqual(bill["relationships"][0]["relationshipType"], "DESCRIBES")
        packages = {package["SPDXID"]: package for package in bill["packages"]}
        kinds = {(row["relationshipType"], packages[row["relatedSpdxElement"]]["name"]) for row in bill["relationships"]}
        programs = [file for file in (prefix / "lib/s4tp").iterdir() if file.is_file()]
        self.assertGreater(len(programs), 2)
        for program in programs:
            for soname in re.findall(r"\(NEEDED\).*\[(.*)\]", run("readelf", "--dynamic", "--wide", program)):
                path = re.search(rf"{re.escape(soname)}(?: => | )\(?(\S+)|(\S*{re.escape(soname)}) \(", run("ldd", program))
                file = pathlib.Path(path[1] or path[2]).resolve()
                owner = run("sh", "-c", f"dpkg-query -S {file} 2>/dev/null || dpkg-query -S {str(file).removeprefix('/usr')}").split(":")[0]
                self.assertIn(("DYNAMIC_LINK", owner), kinds, soname)
        for header_only in ("libcli11-dev", "libeigen3-dev", "libtoml11-dev", "nlohmann-json3-dev", "libstdc++-12-dev"):
            self.assertIn(("STATIC_LINK", header_only), kinds)
        texts = {entry["licenseId"] for entry in bill["hasExtractedLicensingInfos"]}
        for package in packages.values():
            self.assertTrue(package["versionInfo"], package)
            names = set(package["licenseDeclared"].split(" AND "))
            self.assertLessEqual({name for name in names if name.startswith("LicenseRef-")}, texts, package)
        self.assertEqual({package["name"]: package["licenseDeclared"] for package in packages.values()}["nlohmann-json3-dev"].count("MIT"), 1)

    def debian_package(self, folder):
        run("cpack", "--config", BUILD / "CPackConfig.cmake", "-B", self.folder / folder, env={**os.environ, "SOURCE_DATE_EPOCH": "1700000000"})
        package, = (self.folder / folder).glob("s4tp_*.deb")
        return package

    # The Debian package, unpacked instead of installed; made twice it is the same to the byte.
    def test_debian_package(self):
        package = self.debian_package("deb")
        self.assertEqual(run("dpkg-deb", "--field", package, "Architecture").strip(),
                         run("dpkg", "--print-architecture").strip())
        self.assertIn("libpugixml1", run("dpkg-deb", "--field", package, "Depends"))
        run("dpkg-deb", "--extract", package, self.folder / "root")
        usr = self.folder / "root/usr"
        self.assertEqual({file.name for file in usr.iterdir()}, {"bin", "include", "lib", "share"})
        for path in ("bin/s4tp", "include/s4tp/s4tp.h", "share/s4tp/s4tp.dbc", "share/man/man1/s4tp.1",
                     "share/bash-completion/completions/s4tp", *(f"share/doc/s4tp/{name}" for name in (
                         "README.md", "CHANGELOG.md", "copyright", "docs/architecture.md", "docs/requirements.md", "s4tp.spdx.json"))):
            self.assertTrue((usr / path).is_file(), path)
        self.assertIn("S4TP_OK", run(self.on_host(usr)))
        time.sleep(1.1)  # tar knows seconds
        self.assertEqual(package.read_bytes(), self.debian_package("again").read_bytes())


if __name__ == "__main__":
    unittest.main()
