#!/usr/bin/env python3
"""Every C and C++ file of the project stands as .clang-format wants it.

    check_format.py [ROOT]
"""

import pathlib
import subprocess
import sys

FOLDERS = ("algo", "hal", "firmware", "sim_host", "tests")


def files(root):
    return [file for folder in FOLDERS for file in sorted((root / folder).rglob("*")) if file.suffix in (".hpp", ".cpp", ".h", ".c")]


def main(arguments):
    root = pathlib.Path(arguments[0] if arguments else pathlib.Path(__file__).parent.parent)
    found = files(root)
    if not found:
        print(f"format: no C++ file under {root}")
        return 1
    style = f"--style=file:{pathlib.Path(__file__).parent.parent / '.clang-format'}"
    result = subprocess.run(["clang-format", "--dry-run", "-Werror", style, *map(str, found)],
                            stderr=subprocess.PIPE, text=True, check=False)
    places = [line for line in result.stderr.splitlines() if "error:" in line]
    print("\n".join(places) if result.returncode else f"format: {len(found)} files")
    return 1 if result.returncode else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
