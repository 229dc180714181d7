"""The header checker sees planted faults, and lets what is right pass."""

import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "toolchain"))
import check_headers  # noqa: E402
from small_project import findings_in  # noqa: E402


def findings(text, name="x.hpp"):
    return findings_in(check_headers, {name: "#pragma once\n" + text})[0]


class Headers(unittest.TestCase):
    # Declarations, constants, default values, integers, and floats that are only handed on.
    def test_what_is_right_passes(self):
        self.assertEqual(findings("float f(float x);\n"
                                  "inline constexpr float kTwo = 1.0F + 1.0F;\n"
                                  "struct S { float a = 0.5F; float get() const { return a; } };\n"
                                  "inline int twice(int x) { return 2 * x; }\n"), [])

    # The caller's -ffast-math or fused multiply-add would reach into them.
    def test_float_inline_functions_are_found(self):
        for text in ("inline float f(float x) { return x * 2.0F; }\n",
                     "constexpr float f(float x) { return x + 1.0F; }\n",
                     "struct S { float a = 0; float f() const { return a / 3.0F; } };\n",
                     "struct S { double a = 0; double f() const { return a - 1.0; } };\n",
                     "inline int f(float x) { return static_cast<int>(x); }\n",
                     "inline float f(int x) { return static_cast<float>(x); }\n",
                     "inline bool f(float x, float y) { return x < y; }\n",
                     "inline float f(float x) { return __builtin_sqrtf(x); }\n"):
            found = findings(text)
            self.assertEqual(len(found), 1, text)
            self.assertIn("f(", found[0])

    # A template is only looked at through a use, so one without is a finding; so is a function template's body.
    def test_templates_cannot_hide(self):
        self.assertEqual(len(findings("template <class T>\nstruct Hidden { T f(T x) { return x * x; } };\n")), 1)
        self.assertEqual(len(findings("template <class T>\nT f(T x) { return x * x; }\n")), 1)
        self.assertEqual(findings("template <class T>\nT f(T x);\n"), [])

    # Declarations alone do nothing.
    def test_template_without_bodies_passes(self):
        self.assertEqual(findings("template <int N>\nstruct Table {\n  int rows[N] = {};\n  float row(int i) const;\n};\n"), [])

    # Known templates are looked into: this one adds floats once it holds floats.
    def test_known_template_is_looked_into(self):
        self.assertEqual(len(findings("namespace s4tp {\ntemplate <typename T, int N>\nclass BoundedVector {\n"
                                      " T sum() { return a + a; }\n T a = {};\n};\n}\n")), 1)

    # It would bind users to our version and alignment.
    def test_eigen_is_found(self):
        self.assertTrue(any("Eigen" in line for line in findings("#include <Eigen/Core>\n")))

    def test_header_that_needs_another_first_is_found(self):
        self.assertEqual(len(findings("std::uint32_t f();\n")), 1)

    # A .h is C as well: no references, no C++ words.
    def test_header_for_c_must_be_c(self):
        self.assertEqual(findings("int f(const int* x);\n", "x.h"), [])
        self.assertEqual(len(findings("int f(const int& x);\n", "x.h")), 1)

    # A wrong folder must not pass for a clean one.
    def test_nothing_to_check_is_a_failure(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(check_headers.main([folder]), 1)


if __name__ == "__main__":
    unittest.main()
