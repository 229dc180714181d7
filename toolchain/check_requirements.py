#!/usr/bin/env python3
"""Every requirement id that stands in a header must be cited by a test, and no test cites one that does not exist.

    check_requirements.py [ROOT]
"""

import pathlib
import re
import sys

ID = re.compile(r"\b([A-Z]+)-(\d{3})\b")
RANGE = re.compile(r"\b([A-Z]+)-(\d{3})(?:\s*\.\.+\s*|\s+to\s+)(?:\1-)?(\d{3})\b")
# Names that look like ids but are those of the trade.
NOT_OURS = {"AES", "AN", "CRC", "IEEE", "ISO", "US", "UTF"}
PROMISING = ("algo", "hal", "firmware", "sim_host", "toolchain")


def ids(text):
    found = {f"{prefix}-{number}" for prefix, number in ID.findall(text) if prefix not in NOT_OURS}
    for prefix, first, last in RANGE.findall(text):
        found |= {f"{prefix}-{number:03d}" for number in range(int(first), int(last) + 1)}
    return found


def collect(root, folders, suffixes):
    """id -> first file that names it."""
    result = {}
    for folder in folders:
        for file in sorted((root / folder).rglob("*")):
            if file.suffix in suffixes:
                for name in ids(file.read_text(encoding="utf-8")):
                    result.setdefault(name, file.relative_to(root).as_posix())
    return result


def findings(root):
    promised = collect(root, PROMISING, {".hpp", ".h", ".def"})
    cited = collect(root, ["tests"], {".cpp", ".hpp", ".py", ".sh"})
    result = [f"{promised[name]}: {name} is cited by no test" for name in sorted(promised.keys() - cited.keys())]
    result += [f"{cited[name]}: {name} is promised by no header" for name in sorted(cited.keys() - promised.keys())]
    return result, len(promised)


def main(arguments):
    root = pathlib.Path(arguments[0] if arguments else pathlib.Path(__file__).parent.parent)
    found, promised = findings(root)
    print("\n".join(found) if found else f"requirements: all {promised} ids are cited by tests")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
