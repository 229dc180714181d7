#!/usr/bin/env python3
"""What a user starts on a host whose kernel has no CAN, from outside: run_in_machine_test.py S4TP_TOOL [S4TP_VIEW]"""

import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "view"))
from browser import WebSocket  # noqa: E402

TOOL = sys.argv.pop(1)
VIEW = sys.argv.pop(1) if len(sys.argv) > 1 else None
CRUISE = pathlib.Path(__file__).resolve().parents[2] / "sim_host" / "scenarios" / "cruise"
DRIVE = ["run", "--scenario", "short", "--seed", "3"]
TIMEOUT_S = 180


def children_of(pid):
    """All processes below one, with their names."""
    found = {}
    for stat in pathlib.Path("/proc").glob("[0-9]*/stat"):
        try:
            head, tail = stat.read_text().rsplit(")", 1)
        except OSError:
            continue
        found[int(stat.parent.name)] = (head.split("(", 1)[1], int(tail.split()[1]))
    below = {pid}
    for _ in found:
        more = {child for child, (_, parent) in found.items() if parent in below} - below
        if not more:
            break
        below |= more
    return {child: found[child][0] for child in below - {pid} if child in found}


class RunInMachine(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        # 3 s to get somewhere: ends soon, with code 1.
        shutil.copytree(CRUISE, self.folder / "short")
        mission = self.folder / "short" / "scenario.toml"
        mission.write_text(re.sub(r"time_limit_s = .*", "time_limit_s = 3.0", mission.read_text()))

    # PROC-030, PROC-031 The log and the result of a drive in the machine lie here, the log is that of the in-process
    # drive, and so are its result and its exit code: 1, too late.
    def test_outputs_and_exit_code_come_back(self):
        inside = subprocess.run([TOOL, *DRIVE, "--log", "inside.log", "--out", "inside"], cwd=self.folder,
                                capture_output=True, text=True, timeout=TIMEOUT_S)
        self.assertEqual(inside.returncode, 1, inside.stderr)
        done = subprocess.run([TOOL, *DRIVE, "--bus", "vcan5", "--vm", "--patience", "20", "--log", "vcan.log", "--out",
                               "out"], cwd=self.folder, capture_output=True, text=True, timeout=TIMEOUT_S)
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        self.assertIn(inside.stdout.splitlines()[0], done.stdout)
        self.assertEqual((self.folder / "vcan.log").read_bytes(), (self.folder / "inside.log").read_bytes())
        self.assertIn('"ending": "time-out"', (self.folder / "out" / "run.json").read_text())

    # PROC-032 TELE-008 What the machine's ECU thinks is seen outside, by a twin that hears the log of its bus: plan after plan,
    # to the end of the drive, and no frame of the two differs.
    @unittest.skipUnless(VIEW, "no libwebsockets")
    def test_the_machines_ecu_is_seen_outside(self):
        memory = f"/s4tp_machine_{os.getpid()}"
        page = subprocess.Popen([VIEW, "--ecu", memory, "--port", "0"], stdout=subprocess.PIPE, text=True)
        run = subprocess.Popen([TOOL, *DRIVE, "--bus", "vcan0", "--vm", "--patience", "20", "--telemetry", memory], cwd=self.folder,
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        try:
            port = int(re.search(r"http://127\.0\.0\.1:(\d+)/", page.stdout.readline())[1])
            stream, cycles, ended = WebSocket(port, "/", "s4tp-live", timeout_s=TIMEOUT_S), [], False
            while not ended:
                message = json.loads(stream.receive())
                if message["kind"] == "cycle":
                    cycles.append(message)
                ended = cycles and message["kind"] == "state" and not message["present"]
            stream.line.close()
            said = run.communicate(timeout=TIMEOUT_S)[0]
        finally:
            for process in (run, page):
                process.kill()
                process.wait()
            page.stdout.close()
        self.assertNotIn("not shown any longer", said)
        self.assertEqual({cycle["ecu"]["bus"] for cycle in cycles},
                         {"vcan0 of the virtual machine, by a twin that hears the same frames"})
        times = [cycle["t"] for cycle in cycles]
        self.assertEqual(times, sorted(set(times)))
        self.assertGreater(times[-1] - times[0], 3000, "3 s after the pre-roll the drive is over")
        self.assertGreater(len(cycles), 20)
        self.assertEqual(list(pathlib.Path("/dev/shm").glob(memory[1:] + "*")), [])

    # PROC-030 The machine has one bus, whose name is an interface's, and no other ECU.
    def test_wrong_use_is_refused(self):
        for wrong in (["--bus", "slcan:tcp:127.0.0.1:1"], ["--bus", "vcan0", "--no-ecu"], []):
            done = subprocess.run([TOOL, "run", "--vm", *wrong], cwd=self.folder, capture_output=True, text=True,
                                  timeout=TIMEOUT_S)
            self.assertEqual(done.returncode, 2, wrong)
            self.assertNotEqual(done.stderr, "", wrong)

    # PROC-031 Control-C ends the machine at once, and nothing of it is left.
    def test_interrupt_ends_the_machine(self):
        run = subprocess.Popen([TOOL, *DRIVE, "--bus", "vcan0", "--vm", "--realtime"], cwd=self.folder,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            below = {}
            for _ in range(300):
                below = children_of(run.pid)
                if any(name.startswith("qemu") for name in below.values()):
                    break
                time.sleep(0.1)
            self.assertTrue(any(name.startswith("qemu") for name in below.values()), below)
            run.send_signal(signal.SIGINT)
            self.assertEqual(run.wait(timeout=30), 130)
        finally:
            run.kill()
        for _ in range(100):
            left = [pid for pid in below if pathlib.Path(f"/proc/{pid}/cmdline").exists()
                    and pathlib.Path(f"/proc/{pid}/cmdline").read_bytes()]
            if not left:
                break
            time.sleep(0.1)
        self.assertEqual(left, [])


if __name__ == "__main__":
    unittest.main()
