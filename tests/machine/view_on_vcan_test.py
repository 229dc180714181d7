#!/usr/bin/env python3
"""The live view beside a drive on a vcan, both on a kernel that has one: view_on_vcan_test.py S4TP_TOOL S4TP_VIEW

Runs in the machine (toolchain/vcan_machine.sh), beside its vcan0.
"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "view"))
from browser import WebSocket  # noqa: E402

CYCLES = 20


def main(tool, view):
    with tempfile.TemporaryDirectory() as folder:
        page = subprocess.Popen([view, "--port", "0"], stdout=subprocess.PIPE, text=True)
        port = int(re.search(r"http://127\.0\.0\.1:(\d+)/", page.stdout.readline())[1])
        run = subprocess.Popen([tool, "run", "--scenario", "left_turn", "--seed", "3", "--bus", "vcan0", "--patience", "60", "--out",
                                folder], cwd=folder, stdout=subprocess.DEVNULL)
        try:
            stream, cycles = WebSocket(port, "/", "s4tp-live", timeout_s=200), []
            while len(cycles) < CYCLES:
                message = json.loads(stream.receive())
                if message["kind"] == "cycle":
                    cycles.append(message)
        finally:
            for process in (run, page):
                process.terminate()
                process.wait(timeout=60)
    buses = {cycle["ecu"]["bus"] for cycle in cycles}
    times = [cycle["t"] for cycle in cycles]
    if buses != {"vcan0"} or times != sorted(set(times)):
        sys.exit(f"view_on_vcan_test: {buses}, {times}")
    print(f"{len(cycles)} cycles of the ECU on vcan0; the last one says: {cycles[-1]['words']}")


if __name__ == "__main__":
    main(*sys.argv[1:])
