"""The checker of numbers sees a literal without a name, and lets constants, defaults, arithmetic and coefficients pass."""

import pathlib
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "toolchain"))
import check_numbers  # noqa: E402
from small_project import findings_in  # noqa: E402


def findings(text, path="algo/scene/x.cpp"):
    return findings_in(check_numbers, {path: text})


class Numbers(unittest.TestCase):
    # The project itself; and each file with coefficients is there and has those that it is said to have.
    def test_project_names_its_numbers(self):
        self.assertEqual(check_numbers.findings(ROOT), [])
        for path, values in check_numbers.FORMULAS.items():
            written = {float(value) for value in check_numbers.LITERAL.findall((ROOT / path).read_text(encoding="utf-8"))}
            for value in values or set():
                self.assertTrue(any(abs(value - other) < 1e-6 * value for other in written), (path, value))

    # File, line and literal are said; each of a line's.
    def test_literal_without_a_name(self):
        found = findings("float f(float x) {\n  return 3.7F * x + 15.0F;\n}\n")
        self.assertEqual([line.split(" has ")[0] for line in found], ["algo/scene/x.cpp:2: 3.7", "algo/scene/x.cpp:2: 15.0"])
        for text in ("if (x < 0.3F) return;", "g(-1e6F);", "x = 3.F;", "float y = x * 0.7F;", "constexpr float f() { return 3.7F; }", "if constexpr (kA) { x = 3.7F; }", "return {7.0F, x};"):
            self.assertEqual(len(findings(text)), 1, text)

    # Constants, also over lines and in lists, and defaults of members and arguments are names; comments and words are no code.
    def test_names(self):
        for text in ("constexpr float kGapM = 3.7F;", "inline constexpr float kLong =\n    13.0F;", "constexpr float kByM[] = {0.35F, 0.7F};",
                     "struct A {\n  float width_m = 3.2F;\n};", "void f(float reach_m = 7.0F);", "// 3.7F\n", "/* 3.7F\n 4.5F */", 'print("3.7F");'):
            self.assertEqual(findings(text), [], text)

    # Halves, quarters, doubles and factors between units say what they are.
    def test_arithmetic(self):
        self.assertEqual(findings("return 0.5F * x + 0.25F + 2.0F + 1e-3F * y + 100.0F * z + 1000.0F + 0.01F;"), [])

    # Coefficients have their place for a name: there, and nowhere else.
    def test_coefficients(self):
        text = "return x * x * x / 6.0F;"
        self.assertEqual(findings(text, "algo/occupancy/pace.cpp"), [])
        self.assertEqual(len(findings(text)), 1)
        self.assertEqual(len(findings("return 5.0F * x;", "algo/occupancy/pace.cpp")), 1)


if __name__ == "__main__":
    unittest.main()
