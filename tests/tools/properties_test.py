"""rc::check only returns whether the property holds: every use of it in a test is one that fails the test."""

import pathlib
import re
import unittest

TESTS = pathlib.Path(__file__).resolve().parents[1]


def unheard(text):
    return len(re.findall(r"\brc::check\s*\(", text)) - len(re.findall(r"\bEXPECT_TRUE\(\s*rc::check\(", text))


class Properties(unittest.TestCase):
    def test_no_property_is_checked_in_vain(self):
        files = sorted(TESTS.rglob("*_test.cpp"))
        self.assertTrue(any("rc::check" in file.read_text(encoding="utf-8") for file in files))
        for file in files:
            self.assertEqual(unheard(file.read_text(encoding="utf-8")), 0, file)

    def test_unheard_check_is_found(self):
        self.assertEqual(unheard("  rc::check([] {"), 1)
        self.assertEqual(unheard("  EXPECT_TRUE(rc::check([] {"), 0)


if __name__ == "__main__":
    unittest.main()
