"""Lane changes dropped at once: counted from the frames of a log."""

import pathlib
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "toolchain"))
import dropped_changes  # noqa: E402

DBC = (ROOT / "firmware/wire/s4tp.dbc").read_text(encoding="utf-8")
PATH = dropped_changes.signal(DBC, "PlanReason", "path")
MODE = dropped_changes.signal(DBC, "Command", "mode")


def frame(signal, value):
    number, first, _ = signal
    return f"(0000000000.000000) vcan0 {number:03X}#{(value << first).to_bytes(8, 'little').hex().upper()}"


class DroppedChanges(unittest.TestCase):
    # Plans count while the ECU drives (2, 3), not while it is ready (1).
    def test_paths_of_plans_driven(self):
        log = ["# a comment", frame(MODE, 1), frame(PATH, 2), frame(MODE, 2), frame(PATH, 1), frame(PATH, 3), frame(MODE, 3),
               frame(PATH, 0), frame(MODE, 4), frame(PATH, 1)]
        self.assertEqual(list(dropped_changes.paths(log, PATH, MODE)), [1, 3, 0])

    # Two plans of the same path are one run.
    def test_runs(self):
        self.assertEqual(dropped_changes.runs([0, 1, 1, 0]), [[0, 1, 0], [1, 2, 1], [0, 1, 3]])

    # A message that the bus does not have is named.
    def test_unknown_signal(self):
        with self.assertRaisesRegex(SystemExit, "PlanReason with speed"):
            dropped_changes.signal(DBC, "PlanReason", "speed")


if __name__ == "__main__":
    unittest.main()
