"""A command that takes long says how far it is, into a log, too. S4TP_BUILD names the host's build folder."""

import os
import pathlib
import subprocess
import unittest

TOOL = pathlib.Path(os.environ["S4TP_BUILD"]).resolve() / "sim_host/s4tp_tool"


class Progress(unittest.TestCase):
    # Two drives, one of each kind of driver, each with its replays: the first and the last are told.
    def test_coupling_says_how_far_it_is(self):
        done = subprocess.run([TOOL, "coupling", "--scenarios", "cruise", "--episodes", "1"], check=False, text=True, timeout=280,
                              stdin=subprocess.DEVNULL, capture_output=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stderr, r"(?m)^1/2, .* left  cruise, seed 0\n(.*\n)*2/2, 0 s left  cruise, bold driver, seed 0$")


if __name__ == "__main__":
    unittest.main()
