#!/usr/bin/env python3
"""The list of requirements: id, text, where it is promised, by what it is verified.

    requirements_document.py [ROOT] > docs/requirements.md

Promises stand beside the code that keeps them, and move with it; this list is made from them (check_docs.py compares).
Exit code 1 when one is verified by no test.
"""

import pathlib
import re
import sys

import check_requirements

PROMISE = re.compile(r"\b([A-Z]+-\d{3})\b")
MARK = re.compile(r"^\s*(?:///?<?|\*+/?|/\*+)\s?")
TEST = re.compile(r"^\s*(?:TEST(?:_[FP])?|RC_GTEST(?:_FIXTURE)?_PROP|TYPED_TEST)\s*\(\s*(\w+)\s*,\s*(\w+)")
PYTHON_TEST = re.compile(r"^\s+def (test_\w+)")
END = re.compile(r"\\(?:param|return|throws|note|pre|post|code)\b|\bWork:")
RANGED = re.compile(r"\s*(?:\.\.+|to)\s*$")


def paragraphs(lines):
    """(text, True for a comment) of each run of comment lines; a comment behind code begins a run of its own."""
    run = []
    for line in lines:
        code, slashes, behind = line.partition("//")
        if MARK.match(line) or line.lstrip().startswith(("*", "#")):
            text = MARK.sub("", line).rstrip("\\ /*")
            if text.strip():
                run.append(text.strip())
                continue
        if run:
            yield " ".join(run)
            run = []
        if slashes and code.strip():
            text = behind.lstrip("/<! ").rstrip()
            run = [text] if behind.startswith("/<") or PROMISE.search(text) else []
            if PROMISE.match(text):
                run = [f"`{code.strip().rstrip(',;{ ')}`: {text}"]
    if run:
        yield " ".join(run)


def texts(paragraph):
    """(id, text) of each promise in it: what stands behind the id, or before it where it closes the sentence."""
    found = [match for match in PROMISE.finditer(paragraph) if match[1].split("-")[0] not in check_requirements.NOT_OURS]
    for number, match in enumerate(found):
        end = found[number + 1].start() if number + 1 < len(found) else len(paragraph)
        text = END.split(paragraph[match.end():end], maxsplit=1)[0]
        if number + 1 < len(found) and RANGED.search(text) and len(text) < 6:
            text = texts_behind(paragraph, found[number + 1].end())
        before = paragraph[:match.start()].rstrip()
        if before.endswith("(") or re.match(r"[:),.;]*\s*$|\s*\)", text):
            text = re.split(r"(?<=[.;:])\s+", before.rstrip(" ("))[-1]
            if len(text.strip(" ,;:.()")) < 6:
                text = texts_behind(paragraph, match.end())
            if len(text.strip(" ,;:.()")) < 3:
                text = re.sub(r"[A-Z]+-\d{3}|\\return", "", paragraph)
        if paragraph.startswith("`") and match is found[0]:
            text = re.sub(r"[A-Z]+-\d{3} ?", "", paragraph[:end])
        if match.start() and paragraph[match.start() - 2:match.start()] == "| ":  # a row of a table
            text = re.sub(r"(?:\s*\|)+\s*", "; ", text.strip(" |"))
        yield match[1], re.sub(r"\s+", " ", text).strip(" ,;:()")


def texts_behind(paragraph, begin):
    return END.split(re.sub(r"^[\s,;:)]*(?:(?:and |to )?[A-Z]+-\d{3}[\s,;:)]*)*", "", paragraph[begin:]), maxsplit=1)[0]


def promises(root):
    """id -> (text, file); the longest text where an id stands more than once in headers."""
    result = {}
    for folder in check_requirements.PROMISING:
        for file in sorted((root / folder).rglob("*")):
            if file.suffix not in {".hpp", ".h", ".def"}:
                continue
            for paragraph in paragraphs(file.read_text(encoding="utf-8").splitlines()):
                for name, text in texts(paragraph):
                    if len(text) > len(result.get(name, ("", ""))[0]) or name not in result:
                        result[name] = (text, file.relative_to(root).as_posix())
    return result


def verifications(root):
    """id -> names of the tests whose comment or body cites it."""
    result = {}
    for file in sorted((root / "tests").rglob("*")):
        if file.suffix not in {".cpp", ".hpp", ".py", ".sh"}:
            continue
        lines = file.read_text(encoding="utf-8").splitlines()
        path = file.relative_to(root).as_posix()
        last = path
        for number, line in enumerate(lines):
            test = TEST.match(line)
            if test:
                last = f"{test[1]}.{test[2]}"
            elif PYTHON_TEST.match(line):
                last = f"{file.stem}.{PYTHON_TEST.match(line)[1]}"
            names = check_requirements.ids(line)
            if not names:
                continue
            verified = last
            if re.match(r"\s*(//|#)", line):  # a comment speaks of the test below it
                for below in lines[number + 1:number + 12]:
                    test = TEST.match(below)
                    python = PYTHON_TEST.match(below)
                    if test or python:
                        verified = f"{test[1]}.{test[2]}" if test else f"{file.stem}.{python[1]}"
                        break
                    if not re.match(r"\s*(//|#|$|@)", below):
                        break
            for name in names:
                listed = result.setdefault(name, [])
                if verified not in listed:
                    listed.append(verified)
    return result


def document(root):
    """The page, and which promises no test verifies."""
    promised, verified = promises(root), verifications(root)
    lines = ["# Requirements", "", "Made by `toolchain/requirements_document.py` from the headers and the tests; do not edit.",
             f"{len(promised)} requirements. Prefixes are rooms, not ranks.", ""]
    missing, room = [], None
    for name in sorted(promised):
        text, file = promised[name]
        if name.split("-")[0] != room:
            room = name.split("-")[0]
            lines += [f"## {room}", "", "| id | text | stands in | verified by |", "|---|---|---|---|"]
        if not verified.get(name):
            missing.append(f"{file}: {name} is verified by no test")
        tests = ", ".join(verified.get(name, []))
        lines.append(f"| {name} | {text.replace('|', '&#124;')} | `{file}` | {tests} |")
    return "\n".join(lines) + "\n", missing


def main(arguments):
    root = pathlib.Path(arguments[0] if arguments else pathlib.Path(__file__).parent.parent)
    page, missing = document(root)
    sys.stdout.write(page)
    print("\n".join(missing), end="\n" if missing else "", file=sys.stderr)
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
