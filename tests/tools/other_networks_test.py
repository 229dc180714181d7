"""Scenario folders on networks of SUMO's own generators: each a function of its number, with a mission as it was asked for."""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "sim_host/campaign/other_networks.py"
sys.path.insert(0, str(SCRIPT.parent))
import other_networks  # noqa: E402


def draw(*options, env=None):
    return subprocess.run([sys.executable, "-B", str(SCRIPT), *options], env=env, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True, check=False)


class OtherNetworks(unittest.TestCase):
    # Twice the same number: the same mission and traffic, to the byte; the next one is another.
    def test_a_network_is_a_function_of_its_number(self):
        for kind in ("random", "motorway"):
            with tempfile.TemporaryDirectory() as one, tempfile.TemporaryDirectory() as two:
                self.assertEqual(draw(kind, "--first", "7", "--count", "2", "--mix", one).returncode, 0)
                self.assertEqual(draw(kind, "--first", "7", "--count", "1", "--mix", two).returncode, 0)
                first, again = (pathlib.Path(each) / f"{kind}_00007" for each in (one, two))
                for name in ("scenario.toml", "rou.xml"):
                    self.assertEqual((first / name).read_bytes(), (again / name).read_bytes(), name)
                other = pathlib.Path(one) / f"{kind}_00008" / "scenario.toml"
                self.assertNotEqual((first / "scenario.toml").read_bytes(), other.read_bytes())

    # Missions without a turn of more than 60 degrees have none.
    def test_no_turn_is_sharper_than_asked(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(draw("random", "--count", "3", "--sharpest", "60", folder).returncode, 0)
            drawn = sorted(pathlib.Path(folder).iterdir())
            self.assertEqual(len(drawn), 3)
            for each in drawn:
                comment = (each / "scenario.toml").read_text(encoding="utf-8").split("\n", maxsplit=1)[0]
                way = re.search(r"; \d+ m: (.*)", comment).group(1).split()
                self.assertLessEqual(other_networks.Network(each / "net.xml").sharpest_deg(way), 60.0)

    # Without SUMO's tools: what is missing, and where it comes from, in one line.
    def test_a_missing_tool_is_named(self):
        with tempfile.TemporaryDirectory() as folder:
            result = draw("random", folder, env={**os.environ, "PATH": folder})
        self.assertEqual(result.returncode, 2)
        self.assertEqual(result.stdout.count("\n"), 1, result.stdout)
        self.assertIn("netgenerate", result.stdout)
        self.assertIn("sumo", result.stdout)


if __name__ == "__main__":
    unittest.main()
