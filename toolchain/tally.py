#!/usr/bin/env python3
"""Sums ctest's JUnit files into the one closing line of ./s4tp test; exit code 1 unless all passed.

    tally.py FILE...
"""

import pathlib
import sys
import xml.etree.ElementTree as ElementTree


def count(text):
    """(passed, failed, skipped) of one JUnit file."""
    suite = ElementTree.fromstring(text)
    total, failed, skipped = (int(suite.get(name, 0)) for name in ("tests", "failures", "skipped"))
    skipped += int(suite.get("disabled", 0))
    return total - failed - skipped, failed, skipped


def closing_line(passed, failed, skipped):
    return f"{passed} passed, {failed} failed" + (f", {skipped} skipped" if skipped else "")


def main(files):
    passed = failed = skipped = 0
    for file in map(pathlib.Path, files):
        # A suite that left no file did not run: that is a failure, not nothing.
        one = count(file.read_text(encoding="utf-8")) if file.exists() else (0, 1, 0)
        passed, failed, skipped = passed + one[0], failed + one[1], skipped + one[2]
    print(closing_line(passed, failed, skipped))
    return 0 if passed and not failed and not skipped else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
