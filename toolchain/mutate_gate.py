#!/usr/bin/env python3
"""Mutation run of the command gate: each small fault planted in it must fail its unit test.

    mutate_gate.py (--all | --sample COUNT [--seed SEED] | --list) [--compiler g++] [--build build/host] [--test FILE...]

Mutants: relational and logical operators and their boundaries, arithmetic and bit operators, dropped signs, constants
one up and one down, negated and constant conditions, dropped statements, swapped returns and choices. One that does
not compile is none. One that no test can kill is named in EQUIVALENT with the reason; an entry there that a test kills,
or that fits no mutant, is a fault too. The seed of a sample is the commit's hash unless given, and printed.
"""

import concurrent.futures
import dataclasses
import hashlib
import os
import pathlib
import random
import re
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
import gate_bench  # noqa: E402

# statement as it is: ({as mutated}, why nobody can tell them apart)
EQUIVALENT = {
    "if (numerator >= 1.7F * speed_squared) return limits.steering_max_rad;": (
        {"if (numerator > 1.7F * speed_squared) return limits.steering_max_rad;",
         "if (numerator >= 1.8F * speed_squared) return limits.steering_max_rad;",
         "if (numerator >= 1.6F * speed_squared) return limits.steering_max_rad;"},
        "3 m / (3 + m^2) is above 0.86 from m = 1.6 to 1.8, and the steering's own limit is at most 0.8"),
    "const bool harder = command.acceleration_mps2 < -limits_.gentle_braking_mps2;": (
        {"const bool harder = command.acceleration_mps2 <= -limits_.gentle_braking_mps2;"},
        "where they differ the choice is between equals"),
    "Violations ignored = 0;": ({"Violations ignored = 1;"}, "nobody reads it"),
    "last_.steering_rad = is_finite(steering_rad) ? within(steering_rad, limits_.steering_max_rad, 0, ignored) : 0.0F;": (
        {"last_.steering_rad = is_finite(steering_rad) ? within(steering_rad, limits_.steering_max_rad, 1, ignored) : 0.0F;"},
        "what it sets is ignored"),
    "last_.acceleration_mps2 = at_least(at_most(acceleration_mps2_, limits_.acceleration_max_mps2, 0, ignored), "
    "-limits_.braking_max_mps2, 0, ignored);": (
        {"last_.acceleration_mps2 = at_least(at_most(acceleration_mps2_, limits_.acceleration_max_mps2, 1, ignored), "
         "-limits_.braking_max_mps2, 0, ignored);",
         "last_.acceleration_mps2 = at_least(at_most(acceleration_mps2_, limits_.acceleration_max_mps2, 0, ignored), "
         "-limits_.braking_max_mps2, 1, ignored);"},
        "what it sets is ignored"),
    "inline constexpr Violations kAccelerationLimited = 1U << 0;": (
        {"inline constexpr Violations kAccelerationLimited = 1U >> 0;"}, "the same number"),
    "std::uint16_t motion_age_ticks_ = 0xFFFF;": (
        {"std::uint16_t motion_age_ticks_ = 0xFFFE;"}, "both are beyond any limit of eight bits, and it saturates"),
    "std::uint8_t last_counter_ = 0xFF;": (
        {"std::uint8_t last_counter_ = 0xFE;"}, "no counter of four bits is either"),
}

OPERATORS = {
    "<": ("<=", ">="), "<=": ("<", ">"), ">": (">=", "<="), ">=": (">", "<"), "==": ("!=",), "!=": ("==",),
    "&&": ("||",), "||": ("&&",), "+": ("-",), "-": ("+",), "*": ("/",), "/": ("*",), "&": ("|",), "|": ("&",),
    "<<": (">>",),
}
BINARY = re.compile(r"(?<= )(" + "|".join(sorted(map(re.escape, OPERATORS), key=len, reverse=True)) + r")(?= )")
SIGN = re.compile(r"(?<=[(,=?:{ ])-(?=[A-Za-z_(])|(?<=return )-(?=\w)")
COMPOUND = re.compile(r"(\+\+|--)(?=\w)")
NUMBER = re.compile(r"(?<![\w.])(0[xX][0-9a-fA-F]+|\d+\.\d*(?:[eE][+-]?\d+)?|\d+[eE][+-]?\d+|\d+)([uUfF]*)(?![\w.])")
STATEMENT = re.compile(r"^ +(?:if \(.*|[a-z_]\w*(?:\.\w+)* = .*|\w+\(.*|\+\+.*);$")  # no declaration, no bare return
CONDITION = re.compile(r"\bif \(")
RETURN = re.compile(r"\breturn ([^;]+);")
CHOICE = re.compile(r" \? ([^;?]+?) : ([^;,})]+)")


@dataclasses.dataclass(frozen=True)
class Mutant:
    file: pathlib.Path
    line: int  # counted from 1
    before: str
    after: str

    def __str__(self):
        return f"{self.file}:{self.line}: {self.before.strip()}  ->  {self.after.strip() or '(dropped)'}"

    @property
    def is_equivalent(self):
        return self.after.strip() in EQUIVALENT.get(self.before.strip(), ((), ""))[0]


def without_comment(line):
    return line.split("//", 1)[0].rstrip()


def closing(text, opened):
    """Index of the parenthesis that closes the one at `opened`, or -1."""
    depth = 0
    for i in range(opened, len(text)):
        depth += (text[i] == "(") - (text[i] == ")")
        if depth == 0:
            return i
    return -1


def one_off(number, suffix):
    if number.lower().startswith("0x"):
        return [f"0x{int(number, 16) + step:X}{suffix}" for step in (1, -1) if int(number, 16) + step >= 0]
    if number.isdigit():
        return [f"{int(number) + step}{suffix}" for step in (1, -1) if int(number) + step >= 0]
    digits = len(re.split("[eE]", number)[0].partition(".")[2])
    steps = (1.0, -1.0) if "e" in number.lower() else (1.0, -1.0, 0.1 ** digits, -(0.1 ** digits))
    return [f"{float(number) + step:.{max(digits, 1)}f}{suffix}" for step in steps]


def changed_lines(code):
    """What one line may become."""
    def replaced(match, text):
        return code[:match.start()] + text + code[match.end():]

    for match in BINARY.finditer(code):
        for other in OPERATORS[match[1]]:
            yield replaced(match, other)
    for match in SIGN.finditer(code):
        yield replaced(match, "")
    for match in COMPOUND.finditer(code):
        yield replaced(match, "--" if match[1] == "++" else "++")
    for match in NUMBER.finditer(code):
        for other in one_off(match[1], match[2]):
            yield replaced(match, other)
    for match in CONDITION.finditer(code):
        end = closing(code, match.end() - 1)
        if end > 0:
            condition = code[match.end():end]
            for other in (f"!({condition})", "true", "false"):
                yield code[:match.end()] + other + code[end:]
    for match in CHOICE.finditer(code):
        yield replaced(match, f" ? {match[2]} : {match[1]}")
    if STATEMENT.match(code):
        yield ""


def statements(text):
    """(first line, lines) of each statement: clang-format breaks long ones."""
    lines = text.splitlines()
    i = 0
    while i < len(lines):
        first = i
        code = without_comment(lines[i])
        while code.strip() and not code.lstrip().startswith("#") and code[-1] not in ";{}:" and i + 1 < len(lines):
            i += 1
            code += " " + without_comment(lines[i]).strip()
        yield first, i, code
        i += 1


def mutants_of(file, text):
    """Every mutant of a source file; a statement over several lines becomes one line in its mutants."""
    found = []
    returns = []  # of the function at hand
    for first, last, code in statements(text):
        if code == "}":  # a function's end: nothing else stands in column 0
            found += swapped_returns(file, returns)
            returns = []
        if not code.strip() or code.lstrip().startswith("#"):
            continue
        returns += [(first, code, match) for match in RETURN.finditer(code)]
        found += [(Mutant(file, first + 1, code, other), last) for other in dict.fromkeys(changed_lines(code))]
    return found


def swapped_returns(file, returns):
    values = list(dict.fromkeys(match[1] for _, _, match in returns))
    return [(Mutant(file, first + 1, code, code[:match.start(1)] + value + code[match.end(1):]), first)
            for first, code, match in returns for value in values if value != match[1] and "\n" not in code]


def every_mutant(root):
    found = []
    for file in (gate_bench.SOURCE, gate_bench.HEADER):
        found += mutants_of(file, (root / file).read_text(encoding="utf-8"))
    return found


class Run:
    def __init__(self, options, folder):
        self.options = options
        self.folder = folder
        bench = gate_bench.Bench(options)
        bench.compile_gate(folder)
        self.flags = bench.precompile(folder)
        bench.compile_test(folder, *self.flags)
        passed, output = bench.passes(folder, folder)
        if not passed:
            raise gate_bench.BuildError(output)

    def judge(self, number, mutant, last):
        """\\return killed, lives or none (it does not compile)"""
        root = self.folder / str(number)
        for file in (gate_bench.SOURCE, gate_bench.HEADER):
            lines = (gate_bench.ROOT / file).read_text(encoding="utf-8").splitlines()
            if file == mutant.file:
                lines[mutant.line - 1:last + 1] = [mutant.after]
            (root / file).parent.mkdir(parents=True, exist_ok=True)
            (root / file).write_text("\n".join(lines) + "\n", encoding="utf-8")
        bench = gate_bench.Bench(self.options, root)
        test_folder = self.folder
        try:
            bench.compile_gate(root)
            if mutant.file == gate_bench.HEADER:  # the test reads it, too
                bench.compile_test(root, *self.flags)
                test_folder = root
        except gate_bench.BuildError:
            return "none"
        return "lives" if bench.passes(test_folder, root)[0] else "killed"


def commit():
    """The commit's hash, or without one that of the gate's text."""
    done = subprocess.run(["git", "rev-parse", "HEAD"], cwd=gate_bench.ROOT, check=False, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    if done.returncode == 0:
        return done.stdout.strip()[:12]
    return hashlib.sha256((gate_bench.ROOT / gate_bench.SOURCE).read_bytes()).hexdigest()[:12]


def main():
    parser = gate_bench.arguments(__doc__.splitlines()[0])
    how_many = parser.add_mutually_exclusive_group(required=True)
    how_many.add_argument("--all", action="store_true", help="every mutant")
    how_many.add_argument("--sample", type=int, metavar="COUNT", help="so many, drawn by the seed")
    how_many.add_argument("--list", action="store_true", help="print every mutant and stop")
    parser.add_argument("--seed", default=commit(), help="of the sample (default: the commit's hash)")
    options = parser.parse_args()

    found = every_mutant(gate_bench.ROOT)
    if options.list:
        print("\n".join(str(mutant) for mutant, _ in found))
        return 0
    known = {(mutant.before.strip(), mutant.after.strip()) for mutant, _ in found}
    faults = [f"EQUIVALENT names no mutant: {before}  ->  {after}"
              for before, (mutated, _) in EQUIVALENT.items() for after in sorted(mutated) if (before, after) not in known]
    chosen = found
    if options.sample is not None:
        chosen = random.Random(options.seed).sample(found, min(options.sample, len(found)))
        print(f"seed {options.seed}: {len(chosen)} of {len(found)} mutants")
    with tempfile.TemporaryDirectory() as folder:
        try:
            run = Run(options, pathlib.Path(folder))
        except gate_bench.BuildError as error:
            print(error)
            return 2
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            verdicts = list(pool.map(lambda job: run.judge(job[0], *job[1]), enumerate(chosen)))
    alive = []
    for (mutant, _), verdict in zip(chosen, verdicts):
        if verdict == "killed" and mutant.is_equivalent:
            faults.append(f"named in EQUIVALENT, but killed: {mutant}")
        if verdict == "lives" and not mutant.is_equivalent:
            alive.append(f"lives: {mutant}")
    print("\n".join(alive + faults + [
        f"{len(chosen)} mutants: {verdicts.count('killed')} killed, {len(alive)} live, "
        f"{verdicts.count('lives') - len(alive)} equivalent, {verdicts.count('none')} do not compile"]))
    faults += alive
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
