#!/usr/bin/env python3
"""What changing a parameter by 30 % does to success: all of them changed at once, at random, in many settings.

    parameter_screen.py drive --out OUT [--settings N] [--first-seed S] [--roads N:K:M] [--jobs N] [-- OPTIONS OF eval]
    parameter_screen.py table OUT... [--json FILE]

In each setting every parameter is 30 % lower with probability 1/4, 30 % higher with 1/4, else at its default (algo/core/parameters.def),
independently of the others and of what is driven; setting i drives seed S + i of what the options name, and M of the roads N .. N + K - 1
in turn. So every episode tells of every parameter, and a difference is an average over what the others may be.
What stands in OUT/settings.jsonl is not driven again. Differences are of a setting's share of goals, with 95 % intervals over settings.
"""

import argparse
import concurrent.futures
import json
import math
import os
import pathlib
import random
import re
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
TABLE = ROOT / "algo/core/parameters.def"
TOOL = ROOT / "build/host/sim_host/s4tp_tool"
CHANGE = 0.3
FACTS = "vehicle"  # what is measured on the vehicle is not chosen
LEVELS = "-0+"
ROW = re.compile(r'^P\((\w+), (\w+), "[^"]*", ([-\d.e]+)F?, ([-\d.e]+)F?, ([-\d.e]+)F?,', re.MULTILINE)


class Field:
    """A parameter and the values it takes at each level; None where bounds or a default of 0 leave no other."""

    def __init__(self, group, name, default, least, most):
        self.group, self.name, self.default = group, name, default
        lower = max(least, default * (1.0 - CHANGE))
        higher = min(most, default * (1.0 + CHANGE))
        self.values = {"-": lower if lower < default else None, "0": default, "+": higher if higher > default else None}

    def __str__(self):
        return f"{self.group}.{self.name}"


def read_fields(text):
    """All parameters but the vehicle's own measures, in the table's order."""
    return [Field(group, name, *map(float, numbers)) for group, name, *numbers in ROW.findall(text) if group != FACTS]


def draw(fields, number):
    """The levels of setting `number`, one character a parameter."""
    chance = random.Random(f"parameters {number}")
    levels = ""
    for field in fields:
        level = chance.choice("-00+")
        levels += level if field.values[level] is not None else "0"
    return levels


def as_toml(fields, levels):
    groups = {}
    for field, level in zip(fields, levels):
        groups.setdefault(field.group, []).append(f"{field.name} = {field.values[level]:.7g}")
    return "".join(f"[{group}]\n" + "\n".join(lines) + "\n" for group, lines in groups.items())


def roads_of(text, number):
    """Of N:K:M, or nothing, the roads of setting `number` as eval names them."""
    if not text:
        return []
    first, count, each = map(int, text.split(":"))
    return ["--roads", f"{first + number * each % (count - count % each)}:{each}"]


def drive_setting(tool, fields, number, first_seed, options, roads):
    """The line of one setting."""
    levels = draw(fields, number)
    with tempfile.TemporaryDirectory() as folder:
        parameters = pathlib.Path(folder) / "parameters.toml"
        parameters.write_text(as_toml(fields, levels), encoding="utf-8")
        command = [str(tool), "eval", "--planner", "s4tp", "--guard", "on", "--episodes", "1", "--first-seed", str(first_seed + number), "--jobs",
                   "1", "--parameters", str(parameters), "--out", folder, *options, *roads_of(roads, number)]
        run = subprocess.run(command, cwd=ROOT, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
        if run.returncode not in (0, 1):  # 1: an episode failed, which is what is counted here
            sys.exit(f"parameter_screen: {' '.join(command)}\n{run.stdout}{run.stderr}")
        episodes = [json.loads(line) for line in (pathlib.Path(folder) / "episodes.jsonl").read_text(encoding="utf-8").splitlines()[1:]]
    return {"setting": number, "levels": levels, "episodes": len(episodes), "goals": sum(one["ending"] == "goal" for one in episodes),
            "own": sum(one["collisions_at_fault"] > 0 for one in episodes), "options": options, "first_seed": first_seed, "roads": roads}


def read_settings(folder):
    path = folder / "settings.jsonl"
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()] if path.exists() else []


def drive(arguments, options):
    fields = read_fields(TABLE.read_text(encoding="utf-8"))
    arguments.out.mkdir(parents=True, exist_ok=True)
    done = read_settings(arguments.out)
    for row in done:
        if (row["options"], row["first_seed"], row["roads"], len(row["levels"])) != (options, arguments.first_seed, arguments.roads, len(fields)):
            sys.exit(f"{arguments.out} holds settings of other options ({row['options']} from seed {row['first_seed']}, roads {row['roads']}); "
                     "take another --out")
    left = sorted(set(range(arguments.settings)) - {row["setting"] for row in done})
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool, (arguments.out / "settings.jsonl").open("a", encoding="utf-8") as file:
        driven = pool.map(lambda i: drive_setting(arguments.tool, fields, i, arguments.first_seed, options, arguments.roads), left)
        for count, row in enumerate(driven, start=1):
            file.write(json.dumps(row) + "\n")
            file.flush()
            if count % 20 == 0 or count == len(left):
                print(f"{count} of {len(left)} settings", file=sys.stderr)


def difference(changed, default):
    """(difference of means, half width), in %."""
    if len(changed) < 2 or len(default) < 2:
        return None
    half = 1.96 * math.sqrt(statistics.variance(changed) / len(changed) + statistics.variance(default) / len(default))
    return 100.0 * (statistics.fmean(changed) - statistics.fmean(default)), 100.0 * half


def effects(fields, rows):
    """[{parameter, lower: {value, settings, difference, half_width}, higher}], None where there is no other value."""
    table = []
    for index, field in enumerate(fields):
        shares = {level: [row["goals"] / row["episodes"] for row in rows if row["levels"][index] == level] for level in LEVELS}
        line = {"parameter": str(field), "default": field.default}
        for word, level in (("lower", "-"), ("higher", "+")):
            found = difference(shares[level], shares["0"])
            line[word] = found and {"value": field.values[level], "settings": len(shares[level]), "difference": found[0], "half_width": found[1]}
        table.append(line)
    return table


def print_table(arguments):
    fields = read_fields(TABLE.read_text(encoding="utf-8"))
    rows = [row for folder in arguments.out for row in read_settings(folder)]
    if not rows or any(len(row["levels"]) != len(fields) for row in rows):
        sys.exit(f"no settings of these {len(fields)} parameters in {', '.join(map(str, arguments.out))}; 'drive' writes them")
    table = effects(fields, rows)
    episodes, goals = (sum(row[key] for row in rows) for key in ("episodes", "goals"))
    print(f"{len(rows)} settings, {episodes} episodes, {100.0 * goals / episodes:.2f} % goals, {sum(row['own'] for row in rows)} own touches\n")
    print("| parameter | default | 30 % lower | 30 % higher |\n|---|---|---|---|")
    for line in table:
        cells = ["none" if line[word] is None else f"{line[word]['difference']:+.1f} +- {line[word]['half_width']:.1f}" for word in ("lower", "higher")]
        print(f"| {line['parameter']} | {line['default']:g} | {cells[0]} | {cells[1]} |")
    if arguments.json:
        arguments.json.write_text(json.dumps({"episodes": episodes, "goals": goals, "settings": len(rows), "parameters": table}, indent=1) + "\n",
                                  encoding="utf-8")


def roads_option(text):
    if not re.fullmatch(r"\d+:[1-9]\d*:[1-9]\d*", text) or int(text.split(":")[2]) > int(text.split(":")[1]):
        raise argparse.ArgumentTypeError(f"{text}: accepted is N:K:M, M roads a setting of the K from number N on")
    return text


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    driving = commands.add_parser("drive")
    driving.add_argument("--out", type=pathlib.Path, required=True)
    driving.add_argument("--settings", type=int, default=400)
    driving.add_argument("--first-seed", type=int, default=2000)
    driving.add_argument("--roads", type=roads_option)
    driving.add_argument("--jobs", type=int, default=os.cpu_count())
    driving.add_argument("--tool", type=pathlib.Path, default=TOOL)
    printing = commands.add_parser("table")
    printing.add_argument("out", type=pathlib.Path, nargs="+")
    printing.add_argument("--json", type=pathlib.Path)
    own, options = sys.argv[1:], []
    if "--" in own:
        cut = own.index("--")
        own, options = own[:cut], own[cut + 1:]
    arguments = parser.parse_args(own)
    if arguments.command == "drive":
        drive(arguments, options)
    else:
        print_table(arguments)


if __name__ == "__main__":
    main()
