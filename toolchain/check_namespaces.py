#!/usr/bin/env python3
"""One namespace a folder, so that a name says where it is declared: fails on a file that opens one of another folder.

    check_namespaces.py [ROOT]
"""

import pathlib
import re
import sys

ROOTS = ("algo", "hal", "firmware", "sim_host")
SUFFIXES = (".hpp", ".cpp", ".h", ".c", ".def")
# A folder's namespace is its own name in s4tp, except:
NAMESPACES = {
    "algo/core": "s4tp",
    "firmware/can": "s4tp",
    "hal/linux": "s4tp::hal::linux_host",  # GCC has a macro linux
    "hal/mps": "s4tp::hal::mps",
    "hal/sim": "s4tp::hal::sim",
    "sim_host": "s4tp",
}
# What a folder's namespace has within it.
WITHIN = {
    "algo/planner": ["work"],
    "algo/satp": ["detail", "dsp", "mve", "plain", "reference"],
    "algo/trajectory": ["bound_units"],
    "hal/mps": ["semihosting"],
    "sim_host/sumo": ["traci"],
}

OPENED = re.compile(r"^\s*(?:inline\s+)?namespace\b\s*([\w:]*)\s*\{(.*)")  # no alias; without a name it is the file's own
CLOSED = re.compile(r"^\s*\}\s*// namespace\b")  # as clang-format ends each


def allowed(folder):
    """The namespaces that a file of the folder may open."""
    own = NAMESPACES.get(folder, f"s4tp::{folder.split('/')[-1]}")
    return [own, *(f"{own}::{name}" for name in WITHIN.get(folder, []))]


def opened(text):
    """(line number, whole name) of each named namespace that the text opens."""
    around = []
    for number, line in enumerate(text.splitlines(), 1):
        match = OPENED.match(line)
        if match:
            if match[1].startswith("s4tp"):
                around.clear()  # the outermost: an end without the comment, as one of a line has it, was not seen
            if match[1]:
                yield number, "::".join([*filter(None, around), match[1]])
            if "}" not in match[2]:
                around.append(match[1])
        elif CLOSED.match(line) and around:
            around.pop()


def findings(root):
    result = []
    for folder in ROOTS:
        for file in sorted((root / folder).rglob("*")):
            if file.suffix not in SUFFIXES:
                continue
            names = allowed(file.parent.relative_to(root).as_posix())
            for number, name in opened(file.read_text(encoding="utf-8")):
                if name not in names:
                    result.append(f"{file.relative_to(root).as_posix()}:{number}: opens {name}: here it is {', '.join(names)}")
    return result


def main(arguments):
    root = pathlib.Path(arguments[0] if arguments else pathlib.Path(__file__).parent.parent)
    found = findings(root)
    print("\n".join(found) if found else "namespaces: each its folder's")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
