"""Codec generator and bus-load table notice what they are there for. WIRE-050: the layout hash follows the layout."""

import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
DBC = ROOT / "firmware/wire/s4tp.dbc"


def run(tool, *arguments):
    return subprocess.run([sys.executable, str(ROOT / "toolchain" / tool), *map(str, arguments)],
                          capture_output=True, text=True, check=False)


class Generator(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.text = DBC.read_text(encoding="utf-8")

    def generate(self, text):
        folder = pathlib.Path(self.folder.name)
        source = folder / "changed.dbc"
        source.write_text(text, encoding="utf-8")
        result = run("dbc_codec.py", source, "--output", folder / "out")
        outputs = {path.name: path.read_text(encoding="utf-8") for path in (folder / "out").glob("*")}
        return result, outputs

    def layout_hash(self, text):
        result, outputs = self.generate(text)
        self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "", ""))
        return re.search(r"kLayoutHash = (0x[0-9A-F]{8});", outputs["s4tp_codec.hpp"])[1]

    def replaced(self, old, new):
        self.assertEqual(self.text.count(old), 1, old)
        return self.text.replace(old, new)

    def test_is_deterministic(self):
        self.assertEqual(self.generate(self.text)[1], self.generate(self.text)[1])

    def test_hash_follows_the_layout(self):
        hashes = {self.layout_hash(text) for text in (
            self.text,
            self.replaced("speed_mps : 28|14@1+ (0.005,0) [0|81.915]", "speed_mps : 28|14@1+ (0.004,0) [0|65.532]"),
            self.replaced("engage : 28|1@1+", "engage : 30|1@1+"),
            self.replaced("SG_ plan_kind :", "SG_ plan_sort :"),
            self.replaced("speed_mps : 24|10@1+ (0.06,0) [0|60]", "speed_mps : 24|10@1+ (0.06,0) [0|54]"))}
        self.assertEqual(len(hashes), 5)

    def test_hash_ignores_what_is_not_layout(self):
        comment = self.replaced("steering_rad : 12|16@1-", "steering_rad  :  12|16@1-").replace("opens a", "begins a")
        self.assertEqual(self.layout_hash(comment), self.layout_hash(self.text))

    def test_refuses_what_the_codec_cannot_carry(self):
        for old, new in (("engage : 28|1@1+", "engage : 27|1@1+"),  # overlaps steering_rad
                         ("engage : 28|1@1+", "engage : 28|1@0+"),  # big-endian
                         ("engage : 28|1@1+ (1,0)", "engage : 28|1@1+ (1,1)"),  # offset
                         ("speed_mps : 24|10@1+ (0.06,0) [0|60]", "speed_mps : 24|10@1+ (0.06,0) [0|70]"),
                         ("BO_ 19 Tick: 8", "BO_ 19 Tick: 7"),
                         ('BA_ "GenMsgCycleTime" BO_ 19 10;', ""),
                         (re.search(r'VERSION "\d+"', self.text).group(), 'VERSION "one"')):
            result, _ = self.generate(self.replaced(old, new))
            self.assertNotEqual(result.returncode, 0, new)
            self.assertIn("dbc_codec:", result.stderr, new)


    # AUTH-007 Of a message without a CRC only the companions are taken, whole: 48 bits of MAC, 16 of freshness.
    def test_only_companions_have_no_crc(self):
        for old, new in (('SG_ crc : 0|8@1+ (1,0) [0|255] "" ECU\n SG_ counter : 8|4@1+ (1,0) [0|14] "" ECU\n SG_ tick',
                          "SG_ tick"),
                         ("BO_ 9 CommandAuth: 8 ECU\n SG_ mac_low : 0|32@1+ (1,0) [0|4294967295]",
                          "BO_ 9 CommandAuth: 8 ECU\n SG_ mac_low : 0|31@1+ (1,0) [0|2147483647]")):
            result, _ = self.generate(self.replaced(old, new))
            self.assertIn("has no crc", result.stderr, new)


class BusLoad(unittest.TestCase):
    """The table in the documentation is the one of this DBC, and a bus that is too full fails."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def test_document_is_up_to_date(self):
        result = run("bus_load.py", DBC, ROOT / "docs/bus_load.md", "--check")
        self.assertEqual((result.returncode, result.stderr), (0, ""))

    def test_a_change_is_noticed(self):
        text = DBC.read_text(encoding="utf-8")
        changed = pathlib.Path(self.folder.name) / "changed.dbc"
        for cycle_ms, message in ((20, "not up to date"), (2, "the limit is")):
            changed.write_text(text.replace('"GenMsgCycleTime" BO_ 16 10;', f'"GenMsgCycleTime" BO_ 16 {cycle_ms};'),
                               encoding="utf-8")
            result = run("bus_load.py", changed, ROOT / "docs/bus_load.md", "--check")
            self.assertEqual(result.returncode, 1)
            self.assertIn(message, result.stderr)

    # 34 stuffable bits and 64 of payload, 13 others, (98 - 1) / 4 = 24 stuff bits: 135. Motion: 100 x 135 bits.
    def test_arithmetic(self):
        document = (ROOT / "docs/bus_load.md").read_text(encoding="utf-8")
        self.assertIn("Every frame counts 135 bits", document)
        self.assertIn("| Motion | VEHICLE | 100.0 | 13.5 | 2.7 % |", document)
        self.assertIn("| CommandAuth | ECU | 100.0 | 13.5 | 2.7 % |", document)
        self.assertIn("| TrackPose | PERCEPTION | 160.0 | 21.6 | 4.3 % |", document)


if __name__ == "__main__":
    unittest.main()
