#!/usr/bin/env python3
"""Whether the planner still drives as it did: goals and own touches on tuning seeds, each cell by a sequential test.

    performance_gate.py [--tool PROGRAM] [--jobs N]

Each cell of performance.json is driven in batches, both flavours in turn, until Wald's sequential probability ratio test
tells the rate that is good from the one that is bad, with the errors it allows; a cell not decided by the last batch is
judged by the nearer of the two. The seeds are for tuning: the same build gives the same answer.
"""

import argparse
import json
import math
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
FLAVOURS = ("smarts", "social")


def ratio(successes, failures, good, bad):
    """Logarithm of how much likelier the counts are at the bad rate than at the good one."""
    return successes * math.log(bad / good) + failures * math.log((1.0 - bad) / (1.0 - good))


def verdict(successes, failures, rates, wrong, last=False):
    """'good', 'bad', or None: not decided yet."""
    bound = math.log((1.0 - wrong) / wrong)
    evidence = ratio(successes, failures, rates["good"], rates["bad"])
    if last:
        return "bad" if evidence > 0.0 else "good"
    if evidence >= bound:
        return "bad"
    return "good" if evidence <= -bound else None


def drive(tool, jobs, cell, first_seed, count):
    """The episodes of one batch."""
    with tempfile.TemporaryDirectory() as folder:
        command = [tool, "eval", "--planner", "s4tp", "--scenario", cell["scenario"], "--traffic", cell["traffic"], "--flavour", *FLAVOURS,
                   "--episodes", str(count), "--first-seed", str(first_seed), "--out", folder]
        if jobs:
            command += ["--jobs", str(jobs)]
        run = subprocess.run(command, cwd=ROOT, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
        # 1: an episode failed, which is what is counted here.
        if run.returncode not in (0, 1):
            sys.exit(f"performance_gate: {' '.join(map(str, command))}\n{run.stdout}{run.stderr}")
        lines = (pathlib.Path(folder) / "episodes.jsonl").read_text(encoding="utf-8").splitlines()
        return [json.loads(line) for line in lines[1:]]


def judge(cell, table, driver):
    """(verdicts by quantity, episodes, goals, own touches) of one cell; `driver(first_seed, count)` drives a batch."""
    episodes = []
    verdicts = {}
    while len(verdicts) < 2:
        batch = table["batch"] // len(FLAVOURS)
        episodes += driver(table["first_seed"] + len(episodes) // len(FLAVOURS), batch)
        goals = sum(episode["ending"] == "goal" for episode in episodes)
        touched = sum(episode["collisions_at_fault"] > 0 for episode in episodes)
        last = len(episodes) >= table["most_episodes"]
        for quantity, failures in (("goal", len(episodes) - goals), ("no_own_touch", touched)):
            found = verdict(len(episodes) - failures, failures, cell[quantity], table["wrong"], last)
            if quantity not in verdicts and found:
                verdicts[quantity] = found
    return verdicts, len(episodes), goals, touched


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tool", type=pathlib.Path, default=ROOT / "build/host/sim_host/s4tp_tool")
    parser.add_argument("--jobs", type=int, default=0)
    arguments = parser.parse_args()
    table = json.loads((ROOT / "toolchain/performance.json").read_text(encoding="utf-8"))
    failed = False
    for cell in table["cells"]:
        verdicts, episodes, goals, touched = judge(
            cell, table, lambda seed, count, cell=cell: drive(arguments.tool, arguments.jobs, cell, seed, count))
        bad = "bad" in verdicts.values()
        failed = failed or bad
        print(f"{cell['scenario']:12} {cell['traffic']:8} {goals} of {episodes} goals, {touched} own touches: "
              f"{'WORSE THAN IT WAS' if bad else 'as good as it was'} "
              f"(goal {cell['goal']['good']} or {cell['goal']['bad']}: {verdicts['goal']}; own touches: {verdicts['no_own_touch']})", flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
