"""The mutants of the guard can be planted in it as it is today, and each is judged by the drives that only it fails."""

import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "toolchain"))
sys.dont_write_bytecode = True
import guard_mutants  # noqa: E402

COMES_THROUGH = guard_mutants.Mutant("nothing", {}, lives="it is the guard")
TO_BE_SEEN = guard_mutants.Mutant("much", {})


def touching(*drives):
    """A tool that touches in these drives (planner, seed, cell) and counts what it is asked."""
    asked = []

    def own_touches(planner, seed):
        asked.append((planner, seed))
        return {cell for its_planner, its_seed, cell in drives if (its_planner, its_seed) == (planner, seed)}

    return own_touches, asked


class GuardMutants(unittest.TestCase):
    # What is replaced stands in the sources once, and becomes something else.
    def test_each_can_be_planted(self):
        for name, mutant in guard_mutants.MUTANTS.items():
            for file, text in guard_mutants.planted(mutant).items():
                self.assertNotEqual(text, (guard_mutants.SAFETY / file).read_text(encoding="utf-8"), name)

    # Text that is not there, or is there twice, is named, and nothing is planted.
    def test_text_that_is_not_there_once_is_named(self):
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "x.cpp").write_text("a; b; b;", encoding="utf-8")
            for old, times in (("c;", 0), ("b;", 2)):
                mutant = guard_mutants.Mutant("", {"x.cpp": [("a;", "d;"), (old, "e;")]})
                with self.assertRaisesRegex(ValueError, f"x.cpp holds {times} times, not once: {old}"):
                    guard_mutants.planted(mutant, pathlib.Path(folder))

    # Of twelve cells a seed the third cell of the second seed is drive 15, and nothing is driven after it.
    def test_first_touch_ends_it(self):
        mutated, asked = touching(("blind", 501, ("smarts", "merge")), ("blind", 501, ("social", "merge")))
        good, said = guard_mutants.judge("m", TO_BE_SEEN, mutated, touching()[0])
        self.assertTrue(good)
        self.assertEqual(said, "m: touches in merge smarts 501 (blind, drive 15)")
        self.assertEqual(asked, [("blind", 500), ("blind", 501)])

    # A touch that the guard as it is has, too, is none of the mutant's; our own planner drives after the blind one.
    def test_touches_of_the_guard_as_it_is_do_not_count(self):
        both = ("blind", 500, ("smarts", "left_turn"))
        mutated, asked = touching(both, ("s4tp", 519, ("social", "cut_in")))
        good, said = guard_mutants.judge("m", TO_BE_SEEN, mutated, touching(both)[0])
        self.assertTrue(good)
        self.assertEqual(said, "m: touches in cut_in social 519 (s4tp, drive 240)")
        self.assertEqual(len(asked), 40)

    # One that is not seen fails, unless it says why; one that says why and is seen fails.
    def test_one_that_lives_says_why(self):
        nothing = touching()[0]
        said = "m: lives through 480 drives"
        self.assertEqual(guard_mutants.judge("m", TO_BE_SEEN, nothing, nothing), (False, said))
        self.assertEqual(guard_mutants.judge("m", COMES_THROUGH, nothing, nothing), (True, said))
        seen = touching(("s4tp", 500, ("smarts", "left_turn")))[0]
        good, said = guard_mutants.judge("m", COMES_THROUGH, seen, nothing)
        self.assertFalse(good)
        self.assertIn("but is said to live: it is the guard", said)


if __name__ == "__main__":
    unittest.main()
