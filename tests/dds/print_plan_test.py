#!/usr/bin/env python3
"""As a user has it: a drive, s4tp-telemetry, and a subscriber of another vendor that prints the plan.

    print_plan_test.py S4TP_TOOL S4TP_TELEMETRY PRINT_PLAN
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile

SECONDS = 12


def main(tool, telemetry, print_plan):
    # The C++ tests claim domains 20 to 219 (wait_for.hpp).
    memory, domain = f"/s4tp_print_{os.getpid()}", str(220 + os.getpid() % 12)
    with tempfile.TemporaryDirectory() as folder:
        running = [subprocess.Popen(command, stdout=subprocess.DEVNULL) for command in (
            [telemetry, "--ecu", memory, "--domain", domain],
            [tool, "run", "--scenario", "left_turn", "--seed", "7", "--live", "--telemetry", memory, "--out", folder])]
        try:
            done = subprocess.run([print_plan, domain, str(SECONDS)], capture_output=True, text=True, timeout=60, check=False)
        finally:
            for process in running:
                process.terminate()
                process.wait(timeout=30)
            pathlib.Path("/dev/shm" + memory).unlink(missing_ok=True)  # whoever is killed leaves it behind
    print(done.stdout)
    plans = re.findall(r"^([\d.]+) s: 31 points, from [\d.]+ m/s at .* m/s at .*\)\. \w+.*\.$", done.stdout, re.MULTILINE)
    times = list(map(float, plans))
    if done.returncode != 0 or len(times) < SECONDS / 3 or times != sorted(set(times)):
        sys.exit(f"print_plan_test: exit code {done.returncode}, plans of {times}\n{done.stderr}")


if __name__ == "__main__":
    main(*sys.argv[1:])
