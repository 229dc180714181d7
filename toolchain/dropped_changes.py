#!/usr/bin/env python3
"""Counts lane changes that a planner takes up and drops again at once, from what it says on the bus (PlanReason).

    dropped_changes.py TOOL [--scenarios A,B] [--traffic builtin] [--flavours smarts,social] [--first-seed N] [--episodes N] [--parameters FILE] [--list]

A change is taken up when a plan leads to another lane and the one before it led elsewhere. It is dropped when a later plan
does not lead there any more; sooner than 0.9 s after it was taken up it cannot have been made, not even by half.
"""

import argparse
import collections
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).parent.parent
SOON_CYCLES = 9  # of 0.1 s
DRIVING = (2, 3)  # modes of the ECU in which plans are driven by (firmware/ecu/modes.hpp)


def signal(dbc, message, name):
    """(frame id, first bit, bits)"""
    found = re.search(rf"^BO_ (\d+) {message}:(?:.*\n SG_)*? {name} : (\d+)\|(\d+)@1\+", dbc, re.MULTILINE)
    if not found:
        raise SystemExit(f"s4tp.dbc has no {message} with {name}")
    return tuple(int(text) for text in found.groups())


def paths(log, path, mode):
    """The path of each plan driven by, in their order; 0 is the lane under us."""
    drives = False
    for line in log:
        found = re.search(r" ([0-9A-F]{3})#([0-9A-F]+)", line)
        frame = int(found[1], 16) if found else None
        for of in (path, mode):
            if frame != of[0]:
                continue
            value = int.from_bytes(bytes.fromhex(found[2]), "little") >> of[1] & (1 << of[2]) - 1
            if of is mode:
                drives = value in DRIVING
            elif drives:
                yield value


def runs(values):
    """(value, how often it comes in a row, at which place)"""
    result = []
    for place, value in enumerate(values):
        if result and result[-1][0] == value:
            result[-1][1] += 1
        else:
            result.append([value, 1, place])
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tool")
    parser.add_argument("--scenarios", default="merge,overtake,cut_in")
    parser.add_argument("--traffic", default="builtin")
    parser.add_argument("--flavours", default="smarts,social")
    parser.add_argument("--first-seed", type=int, default=300)
    parser.add_argument("--episodes", type=int, default=20)
    parser.add_argument("--parameters", help="TOML file")
    parser.add_argument("--list", action="store_true", help="each one that was dropped")
    options = parser.parse_args()
    dbc = (ROOT / "firmware/wire/s4tp.dbc").read_text(encoding="utf-8")
    where = signal(dbc, "PlanReason", "path"), signal(dbc, "Command", "mode")
    begun, dropped = collections.Counter(), collections.Counter()
    with tempfile.TemporaryDirectory() as folder:
        log = pathlib.Path(folder) / "drive.log"
        for flavour in options.flavours.split(","):
            for scenario in options.scenarios.split(","):
                for seed in range(options.first_seed, options.first_seed + options.episodes):
                    more = ["--parameters", options.parameters] if options.parameters else []
                    log.unlink(missing_ok=True)  # a run that could not begin must not leave the one before to be counted again
                    subprocess.run([options.tool, "run", "--scenario", scenario, "--traffic", options.traffic, "--flavour", flavour,
                                    "--seed", str(seed), "--log", log, "--out", folder, *more], stdout=subprocess.DEVNULL, check=False)
                    if not log.exists():
                        sys.exit(f"{options.tool} drove no {scenario} {flavour} {seed}: it said why above")
                    with log.open(encoding="utf-8") as lines:
                        drive = runs(list(paths(lines, *where)))
                    for path, cycles, place in drive[:-1]:  # the last one is cut off by the drive's end
                        begun[scenario] += path != 0
                        soon = path != 0 and cycles < SOON_CYCLES
                        dropped[scenario] += soon
                        if soon and options.list:
                            print(f"{scenario} {flavour} {seed}: path {path} for {cycles} cycles, from cycle {place} on")
    for scenario in [*options.scenarios.split(","), "all"]:
        of = begun.total() if scenario == "all" else begun[scenario]
        soon = dropped.total() if scenario == "all" else dropped[scenario]
        print(f"{scenario:12} {of:5} changes taken up, {soon:4} dropped within 0.9 s ({100 * soon / max(of, 1):.1f} %)")
    return 0


if __name__ == "__main__":
    sys.exit(main())
