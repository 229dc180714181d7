#!/usr/bin/env python3
"""What a recorded drive costs on a board: instructions of each planning stage, counted by QEMU's -icount.

    budget.py --target m7|m55 --log LOG [--build FOLDER]

QEMU knows neither caches nor wait states: these are instructions, and the milliseconds rest on the assumed cycles per
instruction. They are no execution times and no worst case.
"""

import argparse
import json
import pathlib
import re
import subprocess
import sys

# SysTick counts per instruction at one instruction per 64 ns: 25 MHz and 32 MHz.
COUNTS_PER_INSTRUCTION = {"m7": 1.6, "m55": 2.048}
CYCLES_PER_INSTRUCTION = 1.5
CLOCK_MHZ = 480
# The budget of a cycle, docs/budget.md [million instructions].
BUDGET = json.loads((pathlib.Path(__file__).parent / "budget.json").read_text(encoding="utf-8"))["million_instructions"]


def table(output, counts_per_instruction):
    """(stage, cycles, mean, maximum) in million instructions, from the image's lines."""
    rows = re.findall(r"^stage (\w+) cycles (\d+) mean (\d+) max (\d+)", output, re.MULTILINE)
    return [(name, int(cycles), int(mean) / counts_per_instruction / 1e6, int(most) / counts_per_instruction / 1e6)
            for name, cycles, mean, most in rows]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--target", required=True, choices=sorted(COUNTS_PER_INSTRUCTION))
    parser.add_argument("--log", required=True)
    parser.add_argument("--build", type=pathlib.Path)
    arguments = parser.parse_args()
    root = pathlib.Path(__file__).parent
    build = arguments.build or root.parent / "build" / arguments.target
    run = subprocess.run([root / "run_image.sh", "--count", arguments.target, build / "firmware/targets/replay",
                          arguments.log, "--stages"], stdin=subprocess.DEVNULL, capture_output=True, text=True,
                         check=False)
    rows = table(run.stdout, COUNTS_PER_INSTRUCTION[arguments.target])
    print(f"{arguments.target}: million instructions a planning cycle")
    print(f"{'stage':12s}{'cycles':>8s}{'mean':>9s}{'max':>9s}{'budget':>9s}")
    over = []
    for name, cycles, mean, most in rows:
        print(f"{name:12s}{cycles:8d}{mean:9.3f}{most:9.3f}{BUDGET[name]:9.1f}")
        if most > BUDGET[name]:
            over.append(name)
    if rows:
        milliseconds = rows[-1][3] * CYCLES_PER_INSTRUCTION / CLOCK_MHZ * 1e3
        print(f"largest cycle: {milliseconds:.1f} ms at {CLOCK_MHZ} MHz, assuming {CYCLES_PER_INSTRUCTION} cycles an "
              "instruction")
    if over:
        print(f"over budget: {', '.join(over)}")
    if run.returncode or not rows:
        print(run.stdout)
        return 2
    return 1 if over else 0


if __name__ == "__main__":
    sys.exit(main())
