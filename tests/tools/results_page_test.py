"""docs/results from a campaign: what is left out of the numbers is counted, and the tables say what the numbers say."""

import json
import pathlib
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "sim_host/campaign"))
import results_page  # noqa: E402


def run(planner, guarded=True, flavour="smarts", scenario="merge", failed=(3, 4)):
    return {"planner": planner, "scenario": scenario, "flavour": flavour, "traffic": "builtin", "guarded": guarded,
            "perception": "ideal", "episodes": 40, "success_rate": 1 - len(failed) / 40, "wilson_low": 0.123456789,
            "collision_rate": len(failed) / 40, "at_fault_collision_rate": 1 / 40,
            "comp1": {"success": 0.95, "time": 60.04, "humanness": 4.8123},
            "failures": [{"seed": seed, "cause": "left road"} for seed in failed]}


class Short(unittest.TestCase):
    # Of s4tp guarded, s4tp bare and another only the first keeps its two failures; the others say that there were two.
    def test_failures_are_kept_of_the_guarded_s4tp_only(self):
        document = {"first_seed": 10000, "runs": [run("s4tp"), run("s4tp", guarded=False), run("blind")]}
        first, *others = results_page.shortened(document)["runs"]
        self.assertEqual([failure["seed"] for failure in first["failures"]], [3, 4])
        self.assertNotIn("failures_left_out", first)
        for other in others:
            self.assertNotIn("failures", other)
            self.assertEqual(other["failures_left_out"], 2)

    # Everything else is there, numbers to five digits; the document given is as it was.
    def test_the_rest_is_kept(self):
        document = {"first_seed": 10000, "runs": [run("s4tp")]}
        short = results_page.shortened(document)
        self.assertEqual(short["first_seed"], 10000)
        self.assertEqual(short["runs"][0]["wilson_low"], 0.12346)
        self.assertEqual(set(short["runs"][0]), set(document["runs"][0]))
        self.assertEqual(document["runs"][0]["wilson_low"], 0.123456789)

    # A line a run, and JSON still: a head, two runs, an end.
    def test_a_line_a_run(self):
        document = {"first_seed": 10000, "runs": [run("s4tp"), run("blind")]}
        text = results_page.a_line_a_run(document)
        self.assertEqual(json.loads(text), document)
        self.assertEqual(text.count("\n"), 4)


class Tables(unittest.TestCase):
    # 40 - 2 and 40 - 1 goals in merge, 38 in cruise smarts alone: 115 of 120; 5 collisions, one a run of them ours.
    def test_goals_by_flavour(self):
        runs = [run("s4tp"), run("s4tp", flavour="social", failed=(7,)), run("s4tp", scenario="cruise")]
        self.assertEqual(results_page.goals(runs).splitlines()[2], "| s4tp | 38 / 39 | 38 / – | 115 of 120 | 5 (3) |")

    # Of 38 goals 29 within the 25 s that the scenario asks for; the limit of all, 80 s, is not said.
    def test_goals_in_time_are_said_where_the_scenario_asks_for_less(self):
        brisk = {**run("s4tp", flavour="social"), "in_time_s": 25.0, "in_time_rate": 29 / 40}
        usual = {**run("s4tp"), "in_time_s": 80.0, "in_time_rate": 38 / 40}
        self.assertEqual(results_page.goals([usual, brisk]).splitlines()[2],
                         "| s4tp | 38 / 38 (29 in 25 s) | 76 of 80 | 4 (2) |")

    # Twelve scenarios of 38 goals: a line each, then the sum, 456 of 480, and 24 collisions, one a scenario ours.
    def test_many_scenarios_stand_below_each_other(self):
        lines = results_page.goals([run("s4tp", scenario=f"road {i}") for i in range(12)]).splitlines()
        self.assertEqual(lines[0], "| planner | s4tp |")
        self.assertEqual(lines[2:4], ["| road 0 | 38 |", "| road 1 | 38 |"])
        self.assertEqual(lines[14:], ["| all | 456 of 480 |", "| collisions (ours) | 24 (12) |"])

    # s4tp alone fails 1 time, the other alone 9 times; their sum over scenarios comes last; nothing is said of what is open.
    def test_comparison_names_both_counts(self):
        cell = {"scenario": "all scenarios", "flavour": "smarts", "only_first_fails": 1, "only_second_fails": 9,
                "first_is": "better"}
        text = results_page.comparisons({"blind": [cell, {**cell, "scenario": "merge", "first_is": "open"}]})
        self.assertEqual(text.splitlines()[0], "| s4tp beside | merge | all scenarios |")
        self.assertEqual(text.splitlines()[2], "| blind | 1 : 9 | 1 : 9 better |")

    # Both reach the goal with seeds 1 and 2: medians of 10, 12 and of 20, 24 s. s4tp alone does with 3, nobody with 4.
    def test_times_are_of_the_episodes_both_finish(self):
        def line(planner, seed, seconds, ending="goal"):
            return json.dumps({"planner": planner, "scenario": "merge", "flavour": "smarts", "guarded": True, "seed": seed,
                               "ending": ending, "duration_s": seconds})

        times = results_page.goal_times(['{"kind": "s4tp campaign"}', line("s4tp", 1, 10.0), line("s4tp", 2, 12.0),
                                         line("s4tp", 3, 90.0), line("s4tp", 4, 80.0, "time-out"), line("blind", 1, 20.0),
                                         line("blind", 2, 24.0), line("blind", 4, 80.0, "time-out")])
        self.assertEqual(results_page.medians(times, ["blind", "idle"]).splitlines()[2:],
                         ["| blind | 11.0 : 22.0 |", "| idle | – |"])


if __name__ == "__main__":
    unittest.main()
