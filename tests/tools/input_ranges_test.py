"""The ranges that the headers promise a caller are those of the table that ECU and planner compute with."""

import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
FIELD = re.compile(r"^\s*float (\w+)(?: = [^;]*)?;\s*///<(.*)$", re.MULTILINE)
RANGE = re.compile(r"(-?[\d.]+) \.\. (-?[\d.]+)")


def read(path):
    return (ROOT / path).read_text(encoding="utf-8")


def promised(path, name):
    """Field -> (low, high), as the comments of this struct have it."""
    body = re.search(rf"^(?:typedef )?struct {name} \{{\n(.*?)^\}}", read(path), re.MULTILINE | re.DOTALL)[1]
    ranges = {field: RANGE.search(comment) for field, comment in FIELD.findall(body)}
    return {field: (float(found[1]), float(found[2])) for field, found in ranges.items() if found}


def table(whose):
    """The same of the table's rows: kTrackSpeedMps is speed_mps of a track."""
    rows = re.findall(rf"InputRange k{whose}(\w+) = \{{(.*?)\}};", read("algo/core/input_ranges.hpp"))
    values = {re.sub(r"(?<!^)(?=[A-Z])", "_", name).lower(): [float(value.rstrip("F")) for value in row.split(", ")] for name, row in rows}
    return {field: (low, high) for field, (low, high, least, most) in values.items() if least <= low < high <= most}


class InputRanges(unittest.TestCase):
    # Every row is promised in both headers, with the same numbers, and no more ranges than there are rows.
    def test_headers_promise_what_the_table_has(self):
        for whose, rows, cpp, c in (("Ego", 4, "EgoState", "s4tp_ego"), ("Track", 5, "Track", "s4tp_track")):
            self.assertEqual(len(table(whose)), rows)
            self.assertEqual(promised("algo/core/world_state.hpp", cpp), table(whose))
            self.assertEqual(promised("algo/api/s4tp.h", c), table(whose))


if __name__ == "__main__":
    unittest.main()
