#!/usr/bin/env python3
"""The pages are whole: no dead link, no file, test or requirement named that is not there, every word of the list in the glossary,
a short README; what the code cites, a page and a section of it, is there; and the list of requirements is that of today's headers
and tests.

    check_docs.py [ROOT]
"""

import pathlib
import re
import sys

import check_requirements
import requirements_document

README_LINES = 120
LINK = re.compile(r"!?\[[^\]\n]*\]\(([^()\s]+)\)")
# A file or folder of ours named in backticks; braces, stars and capitals (places to fill in) are no names.
NAMED = re.compile(r"`((?:algo|hal|firmware|sim_host|tests|toolchain|docs)/[\w./-]*|[\w-]+\.md)(?:[ :][^`]*)?`")
# A test as gtest names it.
NAMED_TEST = re.compile(r"`([A-Z]\w+\.[A-Z]\w+)`")
HEADING = re.compile(r"^#+\s+(.*)$", re.MULTILINE)
# A page cited in the code, and its section: "method.md 4.8".
CITED = re.compile(r"\b([\w/-]+\.md)\b(?: (\d+(?:\.\d+)?)(?![\w%]))?")
CODE = ("algo", "hal", "firmware", "sim_host", "tests")
SECTION = re.compile(r"^(?:#+ |\*\*)(\d+(?:\.\d+)?) ", re.MULTILINE)
# Made by a build or a run, not kept.
MADE = ("algo/satp/shipped_weights.inc",)
# Made, too, yet kept: who gets a package has no tests to make it from.
LIST = "docs/requirements.md"
# Words that a reader of the pages must find explained.
WORDS = ("path hypothesis", "right-of-way verdict", "commitment", "yield belief", "lateral offset", "blocking reason", "lane cost-to-go",
         "merge target", "path context", "overshoot", "ego-side risk", "other-side risk", "marginal prediction",
         "conditional prediction", "constant-velocity prediction", "ego", "track", "candidate", "decision", "conflict zone", "zone group",
         "horizon", "boundary", "ECU mode", "vehicle time", "judge", "scenario", "flavour", "seed", "episode", "guarded", "bare", "driving risk field", "look-ahead distance", "cost map", "guard", "fail-safe", "legal occupancy",
         "minimum-risk manoeuvre", "RSS", "command gate", "end-to-end protection", "lock-step", "bit-exact", "iLQR", "fork", "standing")


def pages(root):
    return [file for folder in (".", "docs", "docs/results", "docs/templates", "sim_host/scenarios") for file in sorted((root / folder).glob("*.md"))]


def anchors(page):
    """The names a link may have behind its #."""
    return {re.sub(r"[^\w\- ]", "", head.lower()).strip().replace(" ", "-") for head in HEADING.findall(page.read_text(encoding="utf-8"))}


def dead(root, page):
    """What the page names that is not there."""
    text = re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
    where = page.relative_to(root).as_posix()
    for target in LINK.findall(text):
        if re.match(r"[a-z]+:", target):
            continue
        name, _, anchor = target.partition("#")
        file = page.parent / name if name else page
        if not file.exists():
            yield f"{where}: link to {target}: there is no such file"
        elif anchor and anchor not in anchors(file):
            yield f"{where}: link to {target}: there is no such heading"
    for name in NAMED.findall(text):
        places = (root / name, page.parent / name)
        if name not in MADE and not any(place.exists() for place in places):
            yield f"{where}: names {name}, which is not there"


def evidence(root):
    """Tests and requirements that a page names and nobody has."""
    sources = [file.read_text(encoding="utf-8").splitlines() for file in sorted((root / "tests").rglob("*.cpp"))]
    tests = {f"{test[1]}.{test[2]}" for lines in sources for test in map(requirements_document.TEST.match, lines) if test}
    promised = check_requirements.collect(root, check_requirements.PROMISING, {".hpp", ".h", ".def"})
    for page in pages(root):
        text, where = page.read_text(encoding="utf-8"), page.relative_to(root).as_posix()
        for name in sorted(set(NAMED_TEST.findall(text)) - tests):
            yield f"{where}: names the test {name}, which is not there"
        ids = {f"{room}-{number}" for room, number in check_requirements.ID.findall(text) if room not in check_requirements.NOT_OURS}
        for name in sorted(ids - promised.keys()):
            yield f"{where}: names {name}, which no header promises"


def cited(root):
    """Pages that the code cites and nobody has."""
    sections = {page.name: set(SECTION.findall(page.read_text(encoding="utf-8"))) for page in pages(root)}
    for file in sorted(file for folder in CODE for file in (root / folder).rglob("*.[hc]*") if file.suffix in (".hpp", ".cpp", ".h", ".c")):
        for line in file.read_text(encoding="utf-8").splitlines():
            comment = re.search(r"//.*", line)
            for name, section in CITED.findall(comment[0]) if comment else ():
                page = pathlib.PurePath(name).name
                where = file.relative_to(root).as_posix()
                if page not in sections:
                    yield f"{where}: cites {name}: there is no such page"
                elif section and sections[page] and section not in sections[page]:
                    yield f"{where}: cites {name} {section}: there is no such section"


def glossary(root):
    """Words defined, and names of the code given for them."""
    words, names = set(), []
    for line in (root / "docs/glossary.md").read_text(encoding="utf-8").splitlines():
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if line.startswith("| ") and len(cells) == 3 and len(cells[1]) > 10:
            words.update(word.strip() for word in re.split(r",(?! or)|\(", cells[0].replace(")", "")))
            names += re.findall(r"`(\w+)`", cells[2])
    return words, names


def outdated(root):
    page = root / LIST
    if not page.exists() or page.read_text(encoding="utf-8") != requirements_document.document(root)[0]:
        yield f"{LIST}: not what headers and tests say today; write it anew: python3 toolchain/requirements_document.py > {LIST}"


def findings(root):
    result = [line for page in pages(root) for line in dead(root, page)]
    result += evidence(root)
    result += cited(root)
    result += outdated(root)
    words, names = glossary(root)
    result += [f"docs/glossary.md: {word} is not defined" for word in WORDS if word not in words]
    code = " ".join(file.read_text(encoding="utf-8") for file in (root / "algo").rglob("*.[hc]pp"))
    result += [f"docs/glossary.md: there is no {name} in algo any more" for name in names if not re.search(rf"\b{name}\b", code)]
    lines = len((root / "README.md").read_text(encoding="utf-8").splitlines())
    if lines > README_LINES:
        result.append(f"README.md: {lines} lines, at most {README_LINES}")
    return result


def main(arguments):
    root = pathlib.Path(arguments[0] if arguments else pathlib.Path(__file__).parent.parent).resolve()
    found = findings(root)
    print("\n".join(found) if found else f"docs: {len(pages(root))} pages, no dead link")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
