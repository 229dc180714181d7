"""What the tool says to who has just met it: without a word, and at the slips everybody makes. S4TP_BUILD names the host's
build folder.
"""

import os
import pathlib
import subprocess
import tempfile
import unittest

TOOL = pathlib.Path(os.environ["S4TP_BUILD"]).resolve() / "sim_host/s4tp_tool"


class FirstMinutes(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="s4tp_first_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def said(self, *arguments, code=2):
        done = subprocess.run([TOOL, *arguments], check=False, text=True, timeout=120, cwd=self.folder, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.assertEqual(done.returncode, code, done.stdout)
        return done.stdout

    # Without a word: what to try first, and where the rest is.
    def test_without_a_word(self):
        said = self.said(code=0)
        for word in ("s4tp demo", "s4tp run --scenario left_turn", "s4tp --help"):
            self.assertIn(word, said)

    # The plainest drive, of which nothing is chosen, reaches its goal.
    def test_the_first_drive_arrives(self):
        self.assertRegex(self.said("run", code=0), r"(?m)^s4tp, left_turn, seed \d+: goal after ")

    # A command or an option mistyped is named with the one that was meant; what is near to none, with where all are listed.
    def test_mistyped_words(self):
        for arguments, answer in ((("rnu",), "there is no command 'rnu'; did you mean run?"),
                                  (("frobnicate",), "there is no command 'frobnicate'; --help lists them"),
                                  (("run", "--senario", "merge"), "run has no option --senario; did you mean --scenario?"),
                                  (("eval", "report", "x", "--replay=3"), "report has no option --replay; did you mean --replays?"),
                                  (("faults", "--frobnicate", "1"), "faults has no option --frobnicate; --help lists them"),
                                  (("run", "merge"), "run does not know what to do with merge; --help lists")):
            self.assertIn(answer, self.said(*arguments))

    # A value that is none of those accepted comes with them.
    def test_wrong_values_name_the_right_ones(self):
        for arguments, accepted in ((("run", "--planner", "s4pt"), "s4tp,"), (("run", "--scenario", "lefturn"), "left_turn"),
                                    (("run", "--flavour", "socail"), "social"), (("run", "--seed", "-1"), "0 to"),
                                    (("eval", "--roads", "5:"), "N:K"), (("run", "--traffic", "smuo"), "sumo"),
                                    (("run", "--parameters", "none.toml"), "none.toml: there is no such file"),
                                    (("faults", "--script", "/dev/null"), "/dev/null: is no ordinary file"),
                                    (("eval", "compare", "/dev/null", "--planner", "s4tp", "--against", "blind"), "/dev/null: is no ordinary file")):
            self.assertIn(accepted, self.said(*arguments))

    # A folder that cannot be made is named, with the option that names another one.
    def test_results_nobody_can_write(self):
        (self.folder / "file").write_text("in the way", encoding="utf-8")
        said = self.said("run", "--scenario", "cruise", "--out", "file/out")
        self.assertRegex(said, "file/out: .*; results need a folder that can be written: --out FOLDER names one")
        self.assertRegex(self.said("run", "--scenario", "cruise", "--log", "file/x.log"), "file/x.log: cannot write the log: .+")

    # A run that could not begin leaves no folder behind, so the next one has its usual place.
    def test_a_slip_leaves_nothing(self):
        self.said("run", "--scenario", "lefturn")
        self.assertFalse((self.folder / "out/run").exists())
        self.assertNotIn("holds a result already", self.said("run", "--scenario", "cruise", "--seed", "0", code=0))

    # FILE-010 A second report and a second drawing leave the first ones alone, and say where theirs are.
    def test_a_second_result_has_a_place_of_its_own(self):
        self.said("eval", "--scenarios", "cruise", "--planner", "constant_speed", "--guard", "off", "--episodes", "1", "--out", "drives", code=0)
        for arguments, first in ((("eval", "report", "drives"), "report/index.html"), (("risk", "field"), "risk/field_paper.svg")):
            file = self.folder / "out" / first
            self.assertNotIn("holds a result already", self.said(*arguments, code=0))
            self.assertTrue(file.exists(), first)
            file.write_text("the first one", encoding="utf-8")
            self.assertIn(f"{file.parent.relative_to(self.folder)} holds a result already", self.said(*arguments, code=0))
            self.assertEqual(file.read_text(encoding="utf-8"), "the first one")
            self.assertTrue((file.parent.with_name(file.parent.name + "-2") / file.name).exists(), first)


if __name__ == "__main__":
    unittest.main()
