#!/usr/bin/env python3
"""An idea has one name: fails where an old one comes back, with the word to use (docs/glossary.md says what it means).

    check_names.py [ROOT]
"""

import pathlib
import re
import sys

FOLDERS = ("algo", "hal", "firmware", "sim_host", "tests", "docs")
PAGES = ("README.md", "CONTRIBUTING.md")  # what CHANGELOG.md tells was called so then
SUFFIXES = (".hpp", ".cpp", ".h", ".c", ".def", ".dbc", ".js", ".html", ".md", ".toml")
# Old names wherever they stand, in comments and pages too.
ANYWHERE = (
    (r"keeps?[ _]aside|standing[ _]room|KeepAside|StandingRoom", "lateral offset"),
    (r"held[ _]up|holds?_up|HeldUp", "blocking reason: blocked, blocks"),
    (r"outlook", "lane cost-to-go"),
    (r"GapAim|gap_aim", "merge target"),
    (r"PathSight|path_sight|look_along", "path context: look_at_path"),
    (r"swings?[ _]wide|SwingsWide", "overshoots"),
    (r"(?<![A-Za-z])felt(?![A-Za-z])|for_feeling", "ego-side risk, other-side risk"),
    (r"unconditioned", "marginal prediction"),
    (r"keeps?[ _]going|KeepGoing", "constant-velocity prediction"),
    (r"\b(?:he|his|him|himself)\b", "it, its: the vehicle, the ego"),
)
# What is ordinary English otherwise: as names in the code only.
NAMES = (
    (r"\w*(?:aside_m|Aside)\w*", "lateral offset"),
    (r"Ways?|kLikelyWay", "path hypothesis"),
    (r"(?:Ego)?Passage|Resolve", "right-of-way verdict"),
    (r"k?(?:Trusted|GivenUp|Idle)", "yield belief"),
)
# What the world's traffic has by that name: as names in the core only.
CORE_NAMES = (
    (r"ways", "path hypothesis: paths"),
    (r"sights?_?|Sight", "path context"),
)
NO_CODE = re.compile(r'"(?:\\.|[^"\\])*"|//.*|^\s*\*.*')


def old_names(line, names):
    """(what stands there, what to write) for each old name of the line; `names`: those old as names of this code."""
    for pattern, word in ANYWHERE:
        for found in re.finditer(pattern, line, re.IGNORECASE):
            yield found[0], word
    for pattern, word in names:
        for found in re.finditer(rf"(?<!\w)(?:{pattern})(?!\w)", NO_CODE.sub("", line)):
            yield found[0], word


def findings(root):
    result = []
    pages = [root / name for name in PAGES if (root / name).exists()]
    files = [file for folder in FOLDERS for file in sorted((root / folder).rglob("*")) if file.suffix in SUFFIXES]
    for file in [*pages, *files]:
        path = file.relative_to(root).as_posix()
        code = NAMES + CORE_NAMES if path.startswith("algo/") else NAMES
        names = () if file.suffix in (".md", ".html", ".toml") else code
        for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
            result += [f"{path}:{number}: {name}: {word}" for name, word in old_names(line, names)]
    return result


def main(arguments):
    root = pathlib.Path(arguments[0] if arguments else pathlib.Path(__file__).parent.parent).resolve()
    found = findings(root)
    print("\n".join(found) if found else "names: none of the old ones")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
