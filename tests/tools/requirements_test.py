"""The requirement checker sees ids nobody tests and tests of ids nobody promised."""

import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "toolchain"))
import check_requirements  # noqa: E402
from small_project import findings_in  # noqa: E402

# Put together here, so that the checker does not take this file's examples for citations.
FIRST, SECOND, THIRD = (f"{'GA'}{'TE'}-90{i}" for i in (1, 2, 3))


def findings(header, test):
    return findings_in(check_requirements, {"firmware/gate/gate.hpp": header, "tests/unit/gate_test.cpp": test})[0]


class Requirements(unittest.TestCase):
    def test_cited_id_passes(self):
        self.assertEqual(findings(f"/// {FIRST} brakes\n", f"// {FIRST}\n"), [])

    def test_uncited_id_is_found(self):
        found = findings(f"/// {FIRST} brakes, {SECOND} steers\n", f"// {FIRST}\n")
        self.assertEqual(len(found), 1)
        self.assertIn(SECOND, found[0])

    def test_citation_of_an_unknown_id_is_found(self):
        self.assertEqual(len(findings(f"/// {FIRST}\n", f"// {FIRST} {SECOND}\n")), 1)

    # First to third cites the one in between too.
    def test_range_cites_what_lies_between(self):
        header = f"/// {FIRST}\n/// {SECOND}\n/// {THIRD}\n"
        self.assertEqual(findings(header, f"// {FIRST} .. {THIRD}\n"), [])

    # CRC-32 and ISO-885 are names of the trade.
    def test_names_of_the_trade_are_no_ids(self):
        self.assertEqual(findings("/// CRC-320 ISO-885\n", ""), [])


if __name__ == "__main__":
    unittest.main()
