"""The checks of the gate's own test see a test that does too little, and draw the same sample for the same seed."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
TOOLCHAIN = ROOT / "toolchain"
sys.path.insert(0, str(TOOLCHAIN))
sys.dont_write_bytecode = True
import mutate_gate  # noqa: E402

BUILD = os.environ.get("S4TP_BUILD", ROOT / "build/host")
# A test that only looks whether a gate can be made and denies.
IDLE = """
#include <gtest/gtest.h>
#include "firmware/gate/command_gate.hpp"
TEST(Gate, Denies) {
  s4tp::gate::CommandGate gate{s4tp::gate::Limits{}};
  s4tp::gate::Command command;
  EXPECT_NE(gate.apply(false, command), 0);
}
"""


def with_idle_test(script, *arguments):
    with tempfile.TemporaryDirectory() as folder:
        test = pathlib.Path(folder) / "idle_test.cpp"
        test.write_text(IDLE, encoding="utf-8")
        return subprocess.run([sys.executable, "-B", TOOLCHAIN / script, "--build", BUILD, "--test", test, *arguments],
                              check=False, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)


class GateChecks(unittest.TestCase):
    # observe() and reset() are never called: their lines are named.
    def test_coverage_names_the_lines_that_were_not_run(self):
        done = with_idle_test("gate_coverage.py")
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertRegex(done.stdout, r"firmware/gate/command_gate\.cpp:\d+: never run")
        self.assertRegex(done.stdout, r"command_gate\.cpp:\d+: branch \d of \d never taken")

    # Almost no mutant fails such a test; each that lives is named with what was changed.
    def test_mutants_that_live_are_named(self):
        done = with_idle_test("mutate_gate.py", "--sample", "4", "--seed", "1")
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertRegex(done.stdout, r"seed 1: 4 of \d+ mutants")
        self.assertRegex(done.stdout, r"lives: firmware/gate/\S+:\d+: .*  ->  ")

    # One line, by hand: the boundary, its opposite, the condition three ways, the bound up and down, the sign.
    def test_mutants_of_a_line(self):
        code = "  if (x < -2) y = 3;"
        self.assertEqual(list(dict.fromkeys(mutate_gate.changed_lines(code))), [
            "  if (x <= -2) y = 3;", "  if (x >= -2) y = 3;", "  if (x < -3) y = 3;", "  if (x < -1) y = 3;",
            "  if (x < -2) y = 4;", "  if (x < -2) y = 2;", "  if (!(x < -2)) y = 3;", "  if (true) y = 3;",
            "  if (false) y = 3;", ""])

    # Returns of one function change places; those of another stay out of it.
    def test_returns_change_places(self):
        text = "int f() {\n  if (a) return b;\n  return c;\n}\nint g() {\n  return d;\n}\n"
        found = [(mutant.line, mutant.after.strip()) for mutant, _ in
                 mutate_gate.mutants_of(pathlib.Path("x.cpp"), text) if "return" in mutant.after]
        self.assertIn((2, "if (a) return c;"), found)
        self.assertIn((3, "return b;"), found)
        self.assertFalse([after for _, after in found if after in ("return d;", "if (a) return d;")])


if __name__ == "__main__":
    unittest.main()
