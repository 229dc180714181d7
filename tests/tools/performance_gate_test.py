#!/usr/bin/env python3
"""The gate on how it drives: its sequential test."""

import pathlib
import random
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "toolchain"))
import performance_gate as gate  # noqa: E402

TABLE = {"first_seed": 4000, "batch": 40, "most_episodes": 480, "wrong": 0.01}
CELL = {"goal": {"good": 0.9, "bad": 0.8}, "no_own_touch": {"good": 0.995, "bad": 0.96}}


def driver(goal_rate, touch_rate, seed):
    """Episodes drawn by lot; remembers the seeds asked for."""
    lots = random.Random(seed)
    asked = []

    def drive(first_seed, count):
        asked.append((first_seed, count))
        return [{"ending": "goal" if lots.random() < goal_rate else "time_out", "collisions_at_fault": int(lots.random() < touch_rate)}
                for _ in range(2 * count)]

    return drive, asked


class PerformanceGate(unittest.TestCase):
    # 0.9 against 0.8, each wrong once in a hundred: with bound ln 99 = 4.595 a goal weighs ln(8/9) = -0.118 and a
    # failure ln 2 = 0.693. 40 goals are good (-4.71), 39 are not decided (-4.59), 7 failures alone are bad (4.85).
    def test_bounds(self):
        self.assertEqual(gate.verdict(40, 0, CELL["goal"], 0.01), "good")
        self.assertIsNone(gate.verdict(39, 0, CELL["goal"], 0.01))
        self.assertIsNone(gate.verdict(0, 6, CELL["goal"], 0.01))
        self.assertEqual(gate.verdict(0, 7, CELL["goal"], 0.01), "bad")
        # In between the nearer rate has the last word: of 100, 85 goals are nearer to 0.8 in likelihood, 86 to 0.9.
        self.assertEqual(gate.verdict(85, 15, CELL["goal"], 0.01, last=True), "bad")
        self.assertEqual(gate.verdict(86, 14, CELL["goal"], 0.01, last=True), "good")

    # At the good and at the bad rates at most 5 of 200 campaigns each are misjudged (1 in 100 are allowed, and the end
    # adds some); one that touches others is refused however many goals it reaches.
    def test_rates(self):
        counts = {"good": 0, "bad": 0, "touches": 0}
        for seed in range(200):
            verdicts = gate.judge(CELL, TABLE, driver(0.9, 0.0, seed)[0])[0]
            counts["good"] += "bad" in verdicts.values()
            counts["bad"] += gate.judge(CELL, TABLE, driver(0.8, 0.0, seed)[0])[0]["goal"] == "good"
            counts["touches"] += gate.judge(CELL, TABLE, driver(1.0, 0.04, seed)[0])[0]["no_own_touch"] == "good"
        self.assertLessEqual(max(counts.values()), 5, counts)

    # Each batch goes on with the seeds after the last one's: 20 of both flavours are 40 episodes.
    def test_seeds(self):
        drive, asked = driver(0.85, 0.0, 1)
        _, episodes, _, _ = gate.judge(CELL, TABLE, drive)
        self.assertEqual(asked, [(4000 + 20 * i, 20) for i in range(episodes // 40)])
        self.assertLessEqual(episodes, 480)


if __name__ == "__main__":
    unittest.main()
