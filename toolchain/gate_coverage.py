#!/usr/bin/env python3
"""Every line and every branch of the command gate is run by its own unit test; names those that are not.

    gate_coverage.py [--compiler g++] [--build build/host] [--test FILE...]
"""

import json
import pathlib
import sys
import tempfile

sys.dont_write_bytecode = True
import gate_bench  # noqa: E402


def gcov_of(compiler):
    """GCC's gcov reads the notes of its own version only."""
    version = gate_bench.execute([compiler, "-dumpversion"]).strip().split(".")[0]
    return f"gcov-{version}"


def measure(options, folder):
    """file -> line -> (runs, [runs of each branch]); several units may hold the same header line."""
    bench = gate_bench.Bench(options)
    bench.compile_gate(folder, "--coverage")
    bench.compile_test(folder, "--coverage")
    passed, output = bench.passes(folder, folder)
    if not passed:
        raise gate_bench.BuildError(output)
    lines = {}
    for notes in sorted(folder.glob("*.gcda")):
        text = gate_bench.execute([gcov_of(options.compiler), "--json-format", "--stdout", "--branch-probabilities", notes],
                                  cwd=folder)
        for file in json.loads(text)["files"]:
            name = file["file"]
            for known in (gate_bench.SOURCE, gate_bench.HEADER):
                if name.endswith(known.as_posix()):
                    add(lines.setdefault(known.as_posix(), {}), file["lines"])
    return lines


def add(lines, found):
    for line in found:
        runs, branches = lines.get(line["line_number"], (0, []))
        more = [branch["count"] for branch in line["branches"] if not branch["throw"]]
        width = max(len(branches), len(more))
        padded = [list(counts) + [0] * (width - len(counts)) for counts in (branches, more)]
        lines[line["line_number"]] = (runs + line["count"], [a + b for a, b in zip(*padded)])


def findings(lines):
    found = []
    for name in sorted(lines):
        for number, (runs, branches) in sorted(lines[name].items()):
            if runs == 0:
                found.append(f"{name}:{number}: never run")
            found += [f"{name}:{number}: branch {i} of {len(branches)} never taken"
                      for i, taken in enumerate(branches) if runs and not taken]
    return found


def main():
    options = gate_bench.arguments(__doc__.splitlines()[0]).parse_args()
    with tempfile.TemporaryDirectory() as folder:
        try:
            lines = measure(options, pathlib.Path(folder))
        except gate_bench.BuildError as error:
            print(error)
            return 2
    if gate_bench.SOURCE.as_posix() not in lines:
        print(f"{gate_bench.SOURCE}: gcov saw none of it")
        return 2
    found = findings(lines)
    every = [entry for file in lines.values() for entry in file.values()]
    print("\n".join(found) if found else
          f"gate: all {len(every)} lines and all {sum(len(branches) for _, branches in every)} branches are run by "
          f"{', '.join(test.name for test in options.test)}")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
