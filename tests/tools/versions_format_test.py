"""The version and format checkers see planted faults; the closing line of the tests counts rightly."""

import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "toolchain"))
import check_versions  # noqa: E402


class Versions(unittest.TestCase):
    # The same files, once as they are and once each with one of them a version ahead.
    def test_version_ahead_of_the_others_is_found(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for path in ("firmware/wire/s4tp.dbc", "algo/core/versions.hpp", "CMakeLists.txt", "CHANGELOG.md"):
                (root / path).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(ROOT / path, root / path)
            self.assertEqual(check_versions.findings(root), [])
            for path, before in (("firmware/wire/s4tp.dbc", 'VERSION "'), ("CMakeLists.txt", "(s4tp VERSION "), ("CHANGELOG.md", "## ")):
                text = (root / path).read_text(encoding="utf-8")
                (root / path).write_text(text.replace(before, before + "9", 1), encoding="utf-8")
                self.assertEqual(len(check_versions.findings(root)), 1, path)
                (root / path).write_text(text, encoding="utf-8")


class Format(unittest.TestCase):
    def check(self, text):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "algo/core/x.cpp"
            file.parent.mkdir(parents=True)
            file.write_text(text, encoding="utf-8")
            return subprocess.run([sys.executable, "-B", ROOT / "toolchain/check_format.py", folder],
                                  capture_output=True, check=False).returncode

    def test_unformatted_file_is_found(self):
        self.assertEqual(self.check("int f();\n"), 0)
        self.assertEqual(self.check("int   f( );\n"), 1)

    # A wrong folder must not pass for a clean one.
    def test_nothing_to_check_is_a_failure(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(subprocess.run([sys.executable, "-B", ROOT / "toolchain/check_format.py", folder],
                                            capture_output=True, check=False).returncode, 1)


class Tally(unittest.TestCase):
    JUNIT = '<testsuite name="x" tests="10" failures="{}" disabled="{}" skipped="0"/>'

    def tally(self, *suites):
        with tempfile.TemporaryDirectory() as folder:
            files = []
            for number, suite in enumerate(suites):
                files.append(pathlib.Path(folder) / f"{number}.xml")
                if suite:
                    files[-1].write_text(suite, encoding="utf-8")
            result = subprocess.run([sys.executable, "-B", ROOT / "toolchain/tally.py", *files], capture_output=True,
                                    text=True, check=False)
            return result.stdout.strip(), result.returncode

    # 10 + 10 tests.
    def test_sums_over_suites(self):
        self.assertEqual(self.tally(self.JUNIT.format(0, 0), self.JUNIT.format(0, 0)), ("20 passed, 0 failed", 0))

    def test_failure_and_skip_fail(self):
        self.assertEqual(self.tally(self.JUNIT.format(2, 0)), ("8 passed, 2 failed", 1))
        self.assertEqual(self.tally(self.JUNIT.format(0, 1)), ("9 passed, 0 failed, 1 skipped", 1))

    # A suite that crashed before writing its file must not vanish from the sum.
    def test_missing_file_is_a_failure(self):
        self.assertEqual(self.tally(self.JUNIT.format(0, 0), None), ("10 passed, 1 failed", 1))


if __name__ == "__main__":
    unittest.main()
