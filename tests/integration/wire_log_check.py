#!/usr/bin/python3
"""The wire as others see it: canmatrix reads the DBC, python-can our log, and both find the values our codec finds.

    wire_log_check.py WIRE_LOG_PROGRAM
"""

import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest
from decimal import Decimal

import can

ROOT = pathlib.Path(__file__).resolve().parents[2]
DBC = ROOT / "firmware/wire/s4tp.dbc"
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "toolchain"))
import dbc  # noqa: E402  (found by the path above)

PROGRAM = None


def as_float(value):
    """The float nearest to a decimal value."""
    return struct.unpack("<f", struct.pack("<f", float(value)))[0]


def crc8(octets):
    """CRC-8, polynomial 0x1D, bit by bit: written again here so that it can disagree."""
    crc = 0xFF
    for octet in octets:
        for bit in range(8):
            feedback = (crc >> 7) ^ (octet >> (7 - bit) & 1)
            crc = (crc << 1 & 0xFF) ^ (0x1D if feedback else 0)
    return crc ^ 0xFF


class Log(unittest.TestCase):
    """WIRE-002, WIRE-003, WIRE-040: a log written by us, read by others."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        log, values = (pathlib.Path(cls.folder.name) / name for name in ("wire.log", "values"))
        subprocess.run([PROGRAM, log, values], check=True)
        with can.CanutilsLogReader(str(log)) as reader:
            cls.messages = list(reader)
        cls.values = values.read_text(encoding="utf-8").splitlines()
        frames, _ = dbc.load(DBC)
        cls.frames = {frame.arbitration_id.id: frame for frame in frames}

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_has_every_message(self):
        self.assertEqual(len(self.messages), len(self.values))
        self.assertEqual({message.arbitration_id for message in self.messages}, set(self.frames))

    def test_times_and_interface(self):
        for i, message in enumerate(self.messages):
            self.assertAlmostEqual(message.timestamp, 1_700_000_000 + i * 0.001234, places=5)
            self.assertEqual(message.channel, "can0")
            self.assertFalse(message.is_extended_id)

    def test_values_are_the_same(self):
        compared = 0
        for message, line in zip(self.messages, self.values):
            frame = self.frames[message.arbitration_id]
            name, *words = line.split()
            self.assertEqual(name, frame.name)
            decoded = frame.decode(bytes(message.data))
            ours = dict(word.split("=") for word in words)
            self.assertEqual(set(ours), set(decoded) - set(dbc.PROTECTION))
            for signal in dbc.fields(frame):
                theirs = decoded[signal.name].phys_value
                if not dbc.is_scaled(signal):
                    self.assertEqual(int(ours[signal.name]), theirs, line)
                elif (1 / signal.factor) % 1 == 0:
                    self.assertEqual(as_float(ours[signal.name]), as_float(theirs), line)
                else:  # two roundings where the step is no whole fraction
                    self.assertAlmostEqual(Decimal(ours[signal.name]), theirs, delta=abs(theirs) * Decimal("2e-7"))
                compared += 1
        self.assertGreater(compared, 5000)

    def test_protection(self):
        counters = {}
        for message in self.messages:
            ident = message.arbitration_id
            self.assertEqual(message.data[0], crc8(bytes([ident & 0xFF, ident >> 8]) + bytes(message.data[1:])))
            if "counter" in self.frames[ident].decode(bytes(message.data)):
                counter = message.data[1] & 0xF
                self.assertEqual(counter, counters.get(ident, -1) + 1)
                counters[ident] = -1 if counter == 14 else counter


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    unittest.main()
