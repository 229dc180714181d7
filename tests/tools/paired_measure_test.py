"""Planners compared by a measure: pairs, chance and Holm's correction, on episodes made for it."""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "sim_host/campaign/paired_measure.py"
sys.path.insert(0, str(SCRIPT.parent))
import paired_measure  # noqa: E402


def episode(planner, seed, imposed, ending="goal"):
    return {"planner": planner, "scenario": "merge", "flavour": "social", "traffic": "builtin", "perception": "ideal", "guarded": True,
            "seed": seed, "ending": ending, "duration_s": 20.0, "imposed_braking_mps2": imposed}


def run(lines, *options, code=0):
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "episodes.jsonl"
        path.write_text("\n".join(["{}"] + lines) + "\n", encoding="utf-8")
        result = subprocess.run([sys.executable, str(SCRIPT), str(path), *options], stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, text=True, check=False)
    assert result.returncode == code, result.stdout
    return result.stdout


class PairedMeasure(unittest.TestCase):
    # 40 pairs, the first always 0.5 lower: +-0 around -0.5, and no chance (2^-39); a seed that only one drove is no pair. One
    # of the first's 40 is not at the goal: 80 s instead of 20, 60 / 40 more.
    def test_a_lasting_difference_is_found(self):
        lines = [json.dumps(episode("a", seed, 1.0, "goal" if seed else "time-out")) for seed in range(40)]
        lines += [json.dumps(episode("b", seed, 1.5)) for seed in range(41)]
        out = run(lines, "--first", "a", "--second", "b")
        self.assertRegex(out, r"imposed_braking_mps2 +merge social builtin ideal guarded +40 +-0\.500 \+- 0\.000 +0\.0001 +0\.0002")
        self.assertRegex(out, r"restricted_time_s +merge social builtin ideal guarded +40 +\+1\.500 \+- 2\.940 +1\.0000 +1\.0000")

    # As often +1 as -1 is chance.
    def test_no_difference_is_chance(self):
        self.assertGreater(paired_measure.by_chance([1.0, -1.0] * 20, flips=500), 0.9)

    # Holm: the least of three times 3, the next times 2 and no less than that, the last as it is.
    def test_many_tests_are_corrected_for(self):
        self.assertEqual(paired_measure.holm([0.04, 0.01, 0.02]), [0.04, 0.03, 0.04])

    def test_what_is_wrong_is_named(self):
        lines = [json.dumps(episode("a", 0, 1.0))]
        self.assertIn("no episode of b; there are a", run(lines, "--first", "a", "--second", "b", code=1))
        self.assertIn("line 3", run(lines + ["{"], "--first", "a", "--second", "a", code=1))
        for measure in ("speed", "ending"):  # none, and a word
            self.assertIn(f"no measure {measure}", run(lines, "--first", "a", "--second", "a", "--measure", measure, code=1))
        other = [json.dumps(episode("b", 1, 1.0))]
        self.assertIn("no episode in common", run(lines + other, "--first", "a", "--second", "b", code=1))
        missing = subprocess.run([sys.executable, str(SCRIPT), "/no/where", "--first", "a", "--second", "b"], check=False,
                                 stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.assertIn("/no/where cannot be read", missing.stdout)
        self.assertNotIn("Traceback", missing.stdout)


if __name__ == "__main__":
    unittest.main()
