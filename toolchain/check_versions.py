#!/usr/bin/env python3
"""The same version must not be said twice and differently: versions.hpp and the DBC; CMake's project and the newest changes.

    check_versions.py [ROOT]
"""

import pathlib
import re
import sys


def find(text, pattern, name):
    match = re.search(pattern, text, re.MULTILINE)
    if not match:
        raise SystemExit(f"versions: {name} not found")
    return match[1]


def findings(root):
    dbc = find((root / "firmware/wire/s4tp.dbc").read_text(encoding="utf-8"), r'^VERSION "(\d+)"', "VERSION of the DBC")
    header = (root / "algo/core/versions.hpp").read_text(encoding="utf-8")
    result = []
    wire = find(header, r"kWireVersion = (\d+);", "kWireVersion")
    if wire != dbc:
        result.append(f"versions: kWireVersion is {wire}, VERSION of s4tp.dbc is {dbc}")
    for name in ("kApiVersion", "kParametersVersion", "kWeightsVersion"):
        find(header, rf"{name} = (\d+);", name)
    project = find((root / "CMakeLists.txt").read_text(encoding="utf-8"), r"^project\(s4tp VERSION ([\d.]+)", "VERSION of the project")
    changes = find((root / "CHANGELOG.md").read_text(encoding="utf-8"), r"^## ([\d.]+)", "a version in CHANGELOG.md")
    if changes != project:
        result.append(f"versions: the project is {project}, the newest entry of CHANGELOG.md {changes}")
    return result


def main(arguments):
    root = pathlib.Path(arguments[0] if arguments else pathlib.Path(__file__).parent.parent)
    found = findings(root)
    print("\n".join(found) if found else "versions: agree")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
