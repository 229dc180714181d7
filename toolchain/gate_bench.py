"""Builds the command gate alone, with its unit test: what gate_coverage.py and mutate_gate.py work on."""

import argparse
import os
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent
SOURCE = pathlib.Path("firmware/gate/command_gate.cpp")
HEADER = pathlib.Path("firmware/gate/command_gate.hpp")
TESTS = [pathlib.Path("tests/unit") / name for name in ("gate_test.cpp", "gate_denial_test.cpp")]


def arguments(description):
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--compiler", default="g++", help="GCC's C++ compiler (default g++)")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/host",
                        help="a host build: its wire library and generated codec are used (default build/host)")
    parser.add_argument("--test", type=pathlib.Path, nargs="+", default=[ROOT / test for test in TESTS],
                        help="the unit test's files (default %s)" % " ".join(map(str, TESTS)))
    return parser


class BuildError(Exception):
    """Says which command failed, and how."""


def execute(command, **options):
    done = subprocess.run([str(part) for part in command], text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, check=False, **options)
    if done.returncode:
        raise BuildError(f"{' '.join(map(str, command))}\n{done.stdout}")
    return done.stdout


class Bench:
    """The gate is a shared library beside the test, so that another gate costs one small compilation."""

    def __init__(self, options, root=ROOT):
        self.options = options
        self.root = root  # where the gate's own files are taken from; all else is the repository's
        self.wire = options.build.resolve() / "firmware/libs4tp_wire.a"
        self.includes = [f"-I{root}", f"-I{ROOT}", f"-I{options.build.resolve() / 'generated'}"]

    def compile_gate(self, folder, *flags):
        execute([self.options.compiler, "-std=c++17", "-O0", "-w", "-fPIC", "-fno-exceptions", "-fno-rtti", "-shared",
                 *flags, *self.includes, self.root / SOURCE, "-o", folder / "libgate.so"], cwd=folder)

    def precompile(self, folder):
        """Reads GoogleTest once for all the tests that are compiled later on."""
        (folder / "gtest.hpp").write_text("#include <gtest/gtest.h>\n", encoding="utf-8")
        execute([self.options.compiler, "-std=c++20", "-O0", "-x", "c++-header", folder / "gtest.hpp"])
        return ["-include", folder / "gtest.hpp"]

    def compile_test(self, folder, *flags):
        execute([self.options.compiler, "-std=c++20", "-O0", "-w", *flags, *self.includes, *self.options.test, "-rdynamic",
                 "-Wl,--whole-archive", self.wire, "-Wl,--no-whole-archive", f"-L{folder}", "-lgate", "-lgtest_main",
                 "-lgtest", "-o", folder / "gate_test"], cwd=folder)

    @staticmethod
    def passes(test_folder, gate_folder, timeout_s=120):
        """The test's verdict on the gate in `gate_folder`; hanging is failing."""
        try:
            done = subprocess.run([test_folder / "gate_test", "--gtest_brief=1", "--gtest_fail_fast"], check=False,
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=timeout_s,
                                  env={**os.environ, "LD_LIBRARY_PATH": str(gate_folder)})
        except subprocess.TimeoutExpired:
            return False, "hangs"
        return done.returncode == 0, done.stdout
