#!/usr/bin/env python3
"""Two planners on the same episodes by a measure of each: the paired difference, its interval, and whether it is chance.

    paired_measure.py EPISODES --first PLANNER --second PLANNER [--measure NAME]...

EPISODES is the episodes.jsonl of a campaign that both drove. NAME is a field of its lines (imposed_braking_mps2,
near_misses, ...), or restricted_time_s: the time to the goal, 80 s where it was not reached. A difference is the first's
less the second's. p is by flipping the signs of the pairs at random (10,000 times, seed 1), then corrected by Holm over
all cells and measures asked for.
"""

import argparse
import collections
import json
import pathlib
import random
import statistics
import sys

FLIPS = 10_000
LATEST_S = 80.0


def value_of(episode, measure):
    if measure != "restricted_time_s":
        return float(episode[measure])
    return episode["duration_s"] if episode["ending"] == "goal" else LATEST_S


def cell_of(episode):
    guard = "guarded" if episode["guarded"] else "bare"
    return f"{episode['scenario']} {episode['flavour']} {episode['traffic']} {episode['perception']} {guard}"


def read(path):
    """{planner: {(cell, seed): episode}}"""
    by_planner = collections.defaultdict(dict)
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        sys.exit(f"{path} cannot be read ({error}); a campaign writes episodes.jsonl into its folder")
    for number, line in enumerate(lines[1:], start=2):
        try:
            episode = json.loads(line)
            by_planner[episode["planner"]][cell_of(episode), episode["seed"]] = episode
        except (ValueError, KeyError) as error:
            sys.exit(f"{path}, line {number}: no episode ({error}); a campaign writes episodes.jsonl into its folder")
    return by_planner


def differences(first, second, measure):
    """{cell: [first less second]} of the seeds both drove."""
    of = collections.defaultdict(list)
    for key in first.keys() & second.keys():
        of[key[0]].append(value_of(first[key], measure) - value_of(second[key], measure))
    return of


def by_chance(pairs, flips=FLIPS):
    """How often signs by chance give a mean at least as far from 0."""
    chance = random.Random(1)
    sizes = [abs(one) for one in pairs if one != 0.0]
    seen = abs(sum(pairs))
    hits = 0
    for _ in range(flips):
        bits = chance.getrandbits(len(sizes)) if sizes else 0
        total = 0.0
        for size in sizes:
            total += size if bits & 1 else -size
            bits >>= 1
        hits += abs(total) >= seen - 1e-9
    return (hits + 1) / (flips + 1)


def holm(ps):
    """The same p's, corrected for being many."""
    corrected = [1.0] * len(ps)
    least = 0.0
    for rank, index in enumerate(sorted(range(len(ps)), key=ps.__getitem__)):
        least = max(least, min(1.0, (len(ps) - rank) * ps[index]))
        corrected[index] = least
    return corrected


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("episodes", type=pathlib.Path)
    parser.add_argument("--first", required=True)
    parser.add_argument("--second", required=True)
    parser.add_argument("--measure", action="append")
    arguments = parser.parse_args()
    by_planner = read(arguments.episodes)
    for planner in (arguments.first, arguments.second):
        if planner not in by_planner:
            sys.exit(f"{arguments.episodes}: no episode of {planner}; there are {', '.join(sorted(by_planner))}")
    rows = []
    for measure in arguments.measure or ["imposed_braking_mps2", "restricted_time_s"]:
        try:
            of = differences(by_planner[arguments.first], by_planner[arguments.second], measure)
        except (KeyError, ValueError):
            one = next(iter(by_planner[arguments.first].values()))
            fields = sorted(name for name, value in one.items() if isinstance(value, (int, float)))
            sys.exit(f"no measure {measure}; there are restricted_time_s, {', '.join(fields)}")
        if not of:
            sys.exit(f"{arguments.episodes}: {arguments.first} and {arguments.second} have no episode in common")
        rows += [(measure, cell, pairs, by_chance(pairs)) for cell, pairs in sorted(of.items())]
    print(f"{arguments.first} less {arguments.second} on the same episodes")
    print(f"{'measure':24}{'cell':42}{'pairs':>6}{'difference':>22}{'p':>9}{'Holm':>9}")
    for (measure, cell, pairs, p), corrected in zip(rows, holm([row[3] for row in rows])):
        half = 1.96 * statistics.stdev(pairs) / len(pairs) ** 0.5 if len(pairs) > 1 else float("nan")
        print(f"{measure:24}{cell:42}{len(pairs):6d}{statistics.fmean(pairs):+13.3f} +- {half:.3f}{p:9.4f}{corrected:9.4f}")


if __name__ == "__main__":
    main()
