#!/usr/bin/env python3
"""A number of the core has a name: fails where a float literal stands in code outside a constant's or a default's definition.

    check_numbers.py [ROOT]

What shapes behaviour is a parameter (algo/core/parameters.def); geometry, physics and formats are named constants beside their use.
Halves, quarters, doubles and factors between units say themselves what they are, and coefficients of a series or of a polynomial
have no name but their place: FORMULAS says where those stand.
"""

import pathlib
import re
import sys

SUFFIXES = (".hpp", ".cpp")
# Arithmetic, and units: milliseconds, centimetres, percent.
PLAIN = {0.0, 0.25, 0.5, 1.0, 2.0, 1e-3, 1e3, 1e-2, 1e2}
ANY = None
# Files whose literals are coefficients: all of them, or these values.
FORMULAS = {
    "algo/core/math.cpp": ANY,  # minimax polynomials
    "algo/core/self_test.cpp": ANY,  # probes of the arithmetic
    "algo/occupancy/pace.cpp": {6.0},  # way of a jerk
    "algo/sadrf/box_integral.cpp": {1.25331414, 0.707106781},  # sqrt(pi / 2), 1 / sqrt(2)
    "algo/sadrf/box_slices_gradient.cpp": {3.0, 6.0, 24.0, 120.0, 720.0, 5040.0},  # a ramp; sine and cosine
    "algo/sadrf/field.cpp": ANY,  # the published presets
    "algo/sadrf/path_coordinates.cpp": {1 / 3, 1 / 5, 1 / 7, 1 / 9},  # arc tangent
    "algo/sadrf/road_risk.cpp": {6.0},  # Simpson
    "algo/sadrf/slices.cpp": {6.0, 24.0, 120.0, 720.0, 5040.0, 40320.0},  # sine and cosine
    "algo/satp/embedding.hpp": ANY,  # ends of the integers
    "algo/satp/path_motion.cpp": {3.0, 6.0},  # a cubic's slope
    "algo/trajectory/bend_widening.cpp": {4.0, 8.0},  # second differences
    "algo/trajectory/ilqr_dynamics.cpp": {3.0, 4.0},  # a cubic's slope
    "algo/trajectory/reference_line.cpp": {3.0, 9.0},  # a triangle of five
    "algo/trajectory/roll_out.cpp": {3.0, 4.0, 5.0, 6.0, 7.0, 10.0, 12.0, 15.0, 20.0},  # a quintic
}
LITERAL = re.compile(r"(?<![\w.])((?:\d+\.\d*|\.\d+|\d+)(?:[eE][-+]?\d+)?)F\b")
NO_CODE = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', re.DOTALL)
# A constant's definition, to its end, but no constexpr function; a member's or an argument's default.
NAMED = re.compile(r"\bconstexpr\b[^;{(]*(?:=|\{)[^;]*;|\bfloat\s+\w+(?:\[\w*\])*\s*(?:=\s*-?[\d.eE+-]+F|\{-?[\d.eE+-]+F\})(?=\s*[;,)])")


def blank(found):
    return re.sub(r"[^\n]", " ", found[0])


def plain(value, allowed):
    return value in PLAIN or allowed is ANY or any(abs(value - other) < 1e-6 * other for other in allowed)


def findings(root):
    result = []
    for file in sorted((root / "algo").rglob("*")):
        if file.suffix not in SUFFIXES:
            continue
        path = file.relative_to(root).as_posix()
        text = NAMED.sub(blank, NO_CODE.sub(blank, file.read_text(encoding="utf-8")))
        for number, line in enumerate(text.splitlines(), 1):
            for literal in LITERAL.findall(line):
                if not plain(float(literal), FORMULAS.get(path, set())):
                    result.append(f"{path}:{number}: {literal} has no name; a parameter or a constant says what it is")
    return result


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parent.parent)
    wrong = findings(root)
    for line in wrong:
        print(line)
    if wrong:
        return 1
    print("numbers: all named")
    return 0


if __name__ == "__main__":
    sys.exit(main())
