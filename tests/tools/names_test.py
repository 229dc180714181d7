"""The checker of names sees each old one, says what to write, and leaves ordinary English alone."""

import pathlib
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "toolchain"))
import check_docs  # noqa: E402
import check_names  # noqa: E402
from small_project import findings_in  # noqa: E402


def findings(path, text):
    return findings_in(check_names, {path: text})


class Names(unittest.TestCase):
    # The project itself.
    def test_project_has_no_old_name(self):
        self.assertEqual(check_names.findings(ROOT), [])

    # One line each, in the code, in a comment or on a page, found once with the word to use.
    def test_old_name_is_found(self):
        for path, line, word in (
                ("algo/satp/x.hpp", "struct Way {", "path hypothesis"),
                ("algo/satp/x.hpp", "std::vector<Way> all;", "path hypothesis"),
                ("algo/scene/x.hpp", "constexpr float kLikelyWay = 0.1F;", "path hypothesis"),
                ("algo/satp/x.hpp", "EgoPassage passage(int zone);", "right-of-way verdict"),
                ("algo/satp/x.cpp", "return Resolve{};", "right-of-way verdict"),
                ("algo/satp/x.cpp", "case State::kTrusted:", "yield belief"),
                ("algo/satp/x.cpp", "case State::kGivenUp:", "yield belief"),
                ("algo/satp/x.cpp", "case State::kIdle:", "yield belief"),
                ("algo/trajectory/x.cpp", "// We keep aside of it.", "lateral offset"),
                ("algo/trajectory/x.hpp", "float aside_m = 0.0F;", "lateral offset"),
                ("tests/unit/x_test.cpp", "constexpr float kAsideM = 0.35F;", "lateral offset"),
                ("algo/planner/x.cpp", "for (int i = 0; i < n; ++i) ways += 1;", "path hypothesis"),
                ("tests/unit/x_test.cpp", "TEST(StandingRoom, Exists) {", "lateral offset"),
                ("algo/planner/x.cpp", "note_held_up(path);", "blocking reason"),
                ("sim_host/view/x.html", "<dt>held up by</dt>", "blocking reason"),
                ("sim_host/view/x.js", "who.holds_up", "blocking reason"),
                ("docs/x.md", "The outlook beyond 3 s.", "lane cost-to-go"),
                ("algo/trajectory/x.hpp", "struct GapAim {};", "merge target"),
                ("algo/safety/x.cpp", "context = look_along(path);", "path context"),
                ("algo/safety/x.cpp", "context = sights_[0];", "path context"),
                ("algo/safety/x.hpp", "const PathSight& seen;", "path context"),
                ("algo/trajectory/x.cpp", "if (swings_wide(points)) continue;", "overshoots"),
                ("README.md", "Risk as it is felt.", "ego-side risk"),
                ("algo/sadrf/x.cpp", "risk = for_feeling(risk);", "ego-side risk"),
                ("algo/satp/x.cpp", "// the unconditioned one", "marginal prediction"),
                ("firmware/ecu/x.hpp", "/// Somebody who just keeps going.", "constant-velocity prediction"),
                ("algo/satp/x.cpp", "keep_going(prediction);", "constant-velocity prediction"),
                ("hal/x.hpp", "/// A driver looks for his gap.", "the vehicle"),
                ("algo/satp/x.cpp", "// Who is there keeps what he has.", "the vehicle")):
            found = findings(path, f"\n{line}\n")
            self.assertEqual(len(found), 1, (line, found))
            self.assertTrue(found[0].startswith(f"{path}:2: "), found)
            self.assertIn(word, found[0])

    # What the right of way, a gate, a queue and a sentence may be called.
    def test_ordinary_words_pass(self):
        for path, line in (
                ("algo/occupancy/x.hpp", "/// Way covered until it stands; Resolve, Idle and Passage are words here."),
                ("algo/occupancy/x.cpp", "const float way_m = stopping_way_m(speed_mps, braking_mps2);"),
                ("sim_host/view/x.cpp", 'case Because::kGivingWay: return "Way ahead";'),
                ("hal/linux/x.cpp", "if (!resolve(reason)) idle();"),
                ("firmware/ecu/x.hpp", "/// Planning never holds it up, whoever is trusted or was given up."),
                ("sim_host/world/traffic/x.cpp", "plan.ways.push_back(route);  // of the traffic"),
                ("algo/scene/x.hpp", "int known = 0;  ///< vehicles in sight, wherever ways cross"),
                ("algo/satp/x.hpp", "void put_aside(const PredictionSet& prediction);"),
                ("docs/x.md", "Each driver feels a place as its own; the path goes on, the vehicle stands aside."),
                ("docs/x.md", "The Way home: Passage, Idle.")):
            self.assertEqual(findings(path, line + "\n"), [], line)

    # A new name that the glossary does not have would be a name nobody can look up.
    def test_words_to_use_are_in_the_glossary(self):
        words = [word for _, word in (*check_names.ANYWHERE, *check_names.NAMES, *check_names.CORE_NAMES) if "the vehicle" not in word]
        for word in words:
            for one in word.split(":")[0].split(", "):
                self.assertIn({"overshoots": "overshoot"}.get(one, one), check_docs.WORDS)


if __name__ == "__main__":
    unittest.main()
