"""Scenario folders on networks not of our making: each a function of its number, with a mission as it was asked for."""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "sim_host/campaign"
sys.path.insert(0, str(SCRIPTS))
import other_networks  # noqa: E402

OTHER, DRAWN = "other_networks.py", "drawn_networks.py"


def draw(script, *options, env=None):
    return subprocess.run([sys.executable, "-B", str(SCRIPTS / script), *options], env=env, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, check=False)


class NetworkScripts(unittest.TestCase):
    # Twice the same number: the same mission and traffic, to the byte; the next one is another.
    def test_a_network_is_a_function_of_its_number(self):
        asked = [(OTHER, "random", "--mix"), (OTHER, "motorway", "--mix"), (DRAWN, "crossroads"), (DRAWN, "arterial"),
                 (DRAWN, "roundabout")]
        for script, kind, *options in asked:
            with tempfile.TemporaryDirectory() as one, tempfile.TemporaryDirectory() as two:
                self.assertEqual(draw(script, kind, "--first", "7", "--count", "2", *options, one).returncode, 0)
                self.assertEqual(draw(script, kind, "--first", "7", "--count", "1", *options, two).returncode, 0)
                first, again = (pathlib.Path(each) / f"{kind}_00007" for each in (one, two))
                for name in ("scenario.toml", "rou.xml"):
                    self.assertEqual((first / name).read_bytes(), (again / name).read_bytes(), name)
                other = pathlib.Path(one) / f"{kind}_00008" / "rou.xml"
                self.assertNotEqual((first / "rou.xml").read_bytes(), other.read_bytes())

    # Missions without a turn of more than 60 degrees have none.
    def test_no_turn_is_sharper_than_asked(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(draw(OTHER, "random", "--count", "3", "--sharpest", "60", folder).returncode, 0)
            drawn = sorted(pathlib.Path(folder).iterdir())
            self.assertEqual(len(drawn), 3)
            for each in drawn:
                comment = (each / "scenario.toml").read_text(encoding="utf-8").split("\n", maxsplit=1)[0]
                way = re.search(r"; \d+ m: (.*)", comment).group(1).split()
                self.assertLessEqual(other_networks.Network(each / "net.xml").sharpest_deg(way), 60.0)

    # The way named in a drawn mission's first line is one of the network.
    def test_the_way_is_one_of_the_network(self):
        for kind in ("crossroads", "arterial"):
            with tempfile.TemporaryDirectory() as folder:
                self.assertEqual(draw(DRAWN, kind, "--count", "4", folder).returncode, 0)
                for each in pathlib.Path(folder).iterdir():
                    way = (each / "scenario.toml").read_text(encoding="utf-8").split("\n", maxsplit=1)[0][2:].split()
                    network = other_networks.Network(each / "net.xml")
                    for before, after in zip(way, way[1:]):
                        self.assertIn(after, network.after[before], each)

    # Busy crossroads have the shape of the others, and about 0.15 / 0.06 = 2.5 times their traffic.
    def test_busy_ones_carry_more(self):
        with tempfile.TemporaryDirectory() as one, tempfile.TemporaryDirectory() as two:
            self.assertEqual(draw(DRAWN, "crossroads", "--count", "1", one).returncode, 0)
            self.assertEqual(draw(DRAWN, "crossroads", "--count", "1", "--busy", two).returncode, 0)
            calm, busy = (pathlib.Path(each) / "crossroads_00000" for each in (one, two))
            self.assertEqual((calm / "n.edg.xml").read_bytes(), (busy / "n.edg.xml").read_bytes())

            def rate(folder):
                return sum(float(part.split(")")[0]) for part in (folder / "rou.xml").read_text(encoding="utf-8").split("exp(")[1:])

            self.assertGreater(rate(busy), 2.0 * rate(calm))

    # Without SUMO's tools: what is missing, and where it comes from, in one line.
    def test_a_missing_tool_is_named(self):
        for script, kind, tool in ((OTHER, "random", "netgenerate"), (DRAWN, "crossroads", "netconvert")):
            with tempfile.TemporaryDirectory() as folder:
                result = draw(script, kind, folder, env={**os.environ, "PATH": folder})
            self.assertEqual(result.returncode, 2)
            self.assertEqual(result.stdout.count("\n"), 1, result.stdout)
            self.assertIn(tool, result.stdout)
            self.assertIn("sumo", result.stdout)


if __name__ == "__main__":
    unittest.main()
