"""./s4tp installs what a command needs, and says how far a long step is."""

import os
import pathlib
import re
import subprocess
import tempfile
import unittest

LAUNCHER = pathlib.Path(__file__).resolve().parents[2] / "s4tp"
# A system that has every package but sumo, and cannot build.
PROGRAMS = {
    "dpkg-query": '[ "${@: -1}" = sumo ] || echo installed',
    "sudo": 'while [ "$1" != apt-get ] && [ $# != 0 ]; do shift; done; [ $# = 0 ] || exec "$@"',
    "apt-get": 'echo "$@" >>"$(dirname "$0")/asked"',
    "cmake": "echo '[1/2] Building'; exit 1",
}


class Launcher(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="s4tp_launcher_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "s4tp").write_bytes(LAUNCHER.read_bytes())
        for name, text in PROGRAMS.items():
            (self.folder / name).write_text(f"#!/bin/bash\n{text}\n", encoding="utf-8")
            (self.folder / name).chmod(0o755)

    def asked_for(self, *arguments):
        """What the launcher would have installed."""
        done = subprocess.run(["bash", self.folder / "s4tp", *arguments], check=False, text=True, timeout=60,
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              env={**os.environ, "PATH": f"{self.folder}:{os.environ['PATH']}"})
        self.assertRegex(done.stdout, r"configuring host +\d+ s  FAILED")
        asked = self.folder / "asked"
        return asked.read_text(encoding="utf-8") if asked.exists() else ""

    # SUMO is installed when it is to simulate, alone or beside our own traffic, and only then.
    def test_sumo_is_installed_when_it_is_asked_for(self):
        for arguments in (("run",), ("eval", "--traffic", "builtin"), ("run", "--out", "sumo")):
            self.assertEqual(self.asked_for(*arguments), "", arguments)
        for arguments in (("run", "--traffic", "sumo"), ("eval", "--traffic=sumo"), ("coupling",), ("roads",), ("eval", "--roads", "0:5"),
                          ("traffic", "--traffic", "builtin,sumo")):
            self.assertRegex(self.asked_for(*arguments), r"update\ninstall .* sumo\n", arguments)
            (self.folder / "asked").unlink()

    # ctest's count of finished tests and ninja's of steps; of any other program the last line.
    def test_progress_is_told_in_steps_and_tests(self):
        function = re.search(r"^progress\(\) {\n.*?^}\n", LAUNCHER.read_text(encoding="utf-8"), re.M | re.S).group()
        for output, said in (
                ("  7/1043 Test   #9: unit.Gate.Denies ....   Passed    0.02 sec\n      Start   12: unit.Gate.Stops\n",
                 "test 7 of 1043: unit.Gate.Denies"),
                ("[3/250] Building CXX object a.o\n", "step 3 of 250"),
                ("Get:1 http://deb.debian.org\nUnpacking cmake\n", "Unpacking cmake"), ("", "")):
            file = self.folder / "output"
            file.write_text(output, encoding="utf-8")
            done = subprocess.run(["bash", "-c", f"{function}progress '{file}'"], check=True, text=True,
                                  stdout=subprocess.PIPE)
            self.assertEqual(done.stdout.strip(), said)


if __name__ == "__main__":
    unittest.main()
