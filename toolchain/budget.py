#!/usr/bin/env python3
"""What a recorded drive costs on a board: instructions of each planning stage, counted by QEMU's -icount.

    budget.py --target m7|m55 --log LOG [--build FOLDER]
    budget.py --target m7|m55 --scenes FILE [--uncapped]      kept scenes, the dearest that were found
    budget.py --target m7|m55 --scenes FILE --search SEED EVALUATIONS [--keep]      looks for dearer ones from there on

A file of scenes has a line each, `scene GENOME`. --keep writes back to it the dearest of each stage, and those that took
the most beyond what they were charged. On m7, whose instructions the charges are, nothing may take more than its charge.

QEMU knows neither caches nor wait states: these are instructions, and the milliseconds rest on the assumed cycles per
instruction. They are no execution times and no worst case.
"""

import argparse
import json
import pathlib
import re
import subprocess
import sys
import tempfile

# SysTick counts per instruction at one instruction per 64 ns: 25 MHz and 32 MHz.
COUNTS_PER_INSTRUCTION = {"m7": 1.6, "m55": 2.048}
INSTRUCTIONS_PER_UNIT = 100  # algo/core/work_meter.hpp
CYCLES_PER_INSTRUCTION = 1.5
CLOCK_MHZ = 480
# The budget of a cycle, docs/budget.md [million instructions].
BUDGET = json.loads((pathlib.Path(__file__).parent / "budget.json").read_text(encoding="utf-8"))["million_instructions"]


def table(output, counts_per_instruction):
    """(stage, cycles, mean, maximum) in million instructions, from the image's lines."""
    rows = re.findall(r"^stage (\w+) cycles (\d+) mean (\d+) max (\d+)", output, re.MULTILINE)
    return [(name, int(cycles), int(mean) / counts_per_instruction / 1e6, int(most) / counts_per_instruction / 1e6)
            for name, cycles, mean, most in rows]


def run_image(arguments, image, *options):
    root = pathlib.Path(__file__).parent
    build = arguments.build or root.parent / "build" / arguments.target
    return subprocess.run([root / "run_image.sh", "--count", arguments.target, build / "firmware/targets" / image, *options],
                          stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)


def rows_of_log(arguments):
    run = run_image(arguments, "replay", arguments.log, "--stages")
    rows = table(run.stdout, COUNTS_PER_INSTRUCTION[arguments.target])
    if run.returncode or not rows:
        print(run.stdout)
    return rows, run.returncode


def rows_of_scenes(arguments):
    """(rows as table() gives them, exit code, {stage: most beyond its charge [million instructions]}): of any scene; with
    --search of those found, too."""
    kept = [] if arguments.fresh else arguments.scenes.read_text(encoding="utf-8").splitlines()
    counts = COUNTS_PER_INSTRUCTION[arguments.target]
    script = [f"unit {round(INSTRUCTIONS_PER_UNIT * counts)}", *(["uncapped"] if arguments.uncapped else []), *kept]
    if arguments.search:
        script.append(f"search {arguments.search[0]} {arguments.search[1]}")
    with tempfile.NamedTemporaryFile("w", suffix=".txt") as file:
        file.write("\n".join(script) + "\n")
        file.flush()
        run = run_image(arguments, "cycle_cost", file.name)
    costs = [[int(count) for count in line.split()] for line in re.findall(r"^cost ([-\d ]+)$", run.stdout, re.MULTILINE)]
    best = {(kind, name): (int(count), genome) for kind, name, count, genome in
            re.findall(r"^(best|short) (\w+) (-?\d+) of \d+ (\w+)$", run.stdout, re.MULTILINE)}
    scenes = sum(line.startswith("scene") for line in kept)
    if run.returncode or len(costs) != scenes or bool(best) != bool(arguments.search):
        print(run.stdout + run.stderr)
        return [], 2, {}
    rows, beyond = [], {}
    for i, name in enumerate(BUDGET):
        took = [cost[i] / counts / 1e6 for cost in costs]
        short = [cost[len(BUDGET) + i] / counts / 1e6 for cost in costs]
        if best:
            took.append(best["best", name][0] / counts / 1e6)
            short.append(best["short", name][0] / counts / 1e6)
        rows.append((name, len(took), sum(took) / len(took), max(took)))
        beyond[name] = max(short)
    if arguments.keep:
        comments = [line for line in kept if line.startswith("#")]
        genomes = dict.fromkeys(genome for _, genome in best.values())
        arguments.scenes.write_text("\n".join(comments + [f"scene {genome}" for genome in genomes]) + "\n", encoding="utf-8")
    return rows, 0, beyond


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--target", required=True, choices=sorted(COUNTS_PER_INSTRUCTION))
    source = parser.add_mutually_exclusive_group(required=True)
    source.add_argument("--log")
    source.add_argument("--scenes", type=pathlib.Path)
    parser.add_argument("--uncapped", action="store_true", help="without the allowances of work")
    parser.add_argument("--search", type=int, nargs=2, metavar=("SEED", "EVALUATIONS"))
    parser.add_argument("--fresh", action="store_true", help="not from the kept scenes on")
    parser.add_argument("--keep", action="store_true", help="write the dearest scenes of each row to the file")
    parser.add_argument("--build", type=pathlib.Path)
    arguments = parser.parse_args()
    rows, code, beyond = (*rows_of_log(arguments), {}) if arguments.log else rows_of_scenes(arguments)
    print(f"{arguments.target}: million instructions a planning cycle")
    print(f"{'stage':12s}{'cycles' if arguments.log else 'scenes':>8s}{'mean':>9s}{'max':>9s}{'budget':>9s}"
          + (f"{'beyond its charge':>19s}" if beyond else ""))
    over = []
    for name, cycles, mean, most in rows:
        print(f"{name:12s}{cycles:8d}{mean:9.3f}{most:9.3f}{BUDGET[name]:9.1f}"
              + (f"{beyond[name]:19.3f}" if beyond else ""))
        if most > BUDGET[name]:
            over.append(name)
    undercharged = [name for name, most in beyond.items() if most > 0 and arguments.target == "m7"]
    if rows:
        milliseconds = rows[-1][3] * CYCLES_PER_INSTRUCTION / CLOCK_MHZ * 1e3
        print(f"largest cycle: {milliseconds:.1f} ms at {CLOCK_MHZ} MHz, assuming {CYCLES_PER_INSTRUCTION} cycles an "
              "instruction")
    if over:
        print(f"over budget: {', '.join(over)}")
    if undercharged:
        print(f"charged too little: {', '.join(undercharged)}")
    if code or not rows:
        return 2
    return 1 if over or undercharged else 0


if __name__ == "__main__":
    sys.exit(main())
