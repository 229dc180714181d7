"""Reads s4tp.dbc with canmatrix and refuses what the codec could not carry."""

import contextlib
import io
import logging
import re
from decimal import ROUND_HALF_EVEN

# canmatrix reports every optional format it lacks while it is imported.
logging.disable(logging.WARNING)
with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
    try:
        import canmatrix.formats
    except ModuleNotFoundError as error:
        raise SystemExit(f"{error}; apt-get install python3-canmatrix, and Debian's own python3 (/usr/bin/python3)") from error

# Supplied by end-to-end protection (e2e.hpp), so no fields of a message.
PROTECTION = {"crc": (0, 8), "counter": (8, 4)}
# All of a companion frame (firmware/secoc), which needs no CRC: its MAC is one.
COMPANION = {"mac_low": (0, 32), "mac_high": (32, 16), "freshness": (48, 16)}


class DbcError(Exception):
    """The DBC says something that the codec cannot carry."""


def require(condition, text):
    if not condition:
        raise DbcError(text)


def load(path):
    """The frames by ascending id and the version of the DBC."""
    matrix = canmatrix.formats.loadp_flat(str(path))
    require(not matrix.load_errors, f"{path}: {matrix.load_errors}")
    text = path.read_text(encoding="utf-8")
    version = re.search(r'^VERSION "(\d+)"', text, re.MULTILINE)
    require(version and int(version[1]) <= 255, f"{path}: VERSION must be a number up to 255")
    frames = sorted(matrix.frames, key=lambda frame: frame.arbitration_id.id)
    for frame in frames:
        check_frame(frame)
    return frames, int(version[1])


def fields(frame):
    """The signals a program sees, in the order of their bits."""
    signals = sorted(frame.signals, key=lambda signal: signal.start_bit)
    return [signal for signal in signals if signal.name not in PROTECTION]


def is_companion(frame):
    return {signal.name: (signal.start_bit, signal.size) for signal in frame.signals} == COMPANION


def is_scaled(signal):
    return signal.factor != 1


def raw_range(signal):
    """The raw values that stand for the physical range, as far as the bits hold them."""
    low, high = (-(1 << signal.size - 1), (1 << signal.size - 1) - 1) if signal.is_signed \
        else (0, (1 << signal.size) - 1)
    least, most = (int((value / signal.factor).to_integral_value(ROUND_HALF_EVEN))
                   for value in (signal.min, signal.max))
    require(low <= least and most <= high + 1, f"{signal.name}: range exceeds its bits")
    return least, min(most, high)


def check_frame(frame):
    name = frame.name
    require(not frame.arbitration_id.extended and frame.arbitration_id.id < 0x800, f"{name}: id above 11 bit")
    require(frame.size == 8, f"{name}: every message has 8 bytes")
    require(re.fullmatch(r"[A-Z][A-Za-z0-9]*", name), f"{name}: not in CamelCase")
    require(len(frame.transmitters) == 1, f"{name}: needs one sender")
    require(frame.cycle_time > 0, f"{name}: needs GenMsgCycleTime")
    taken = set()
    for signal in frame.signals:
        label = f"{name}.{signal.name}"
        require(signal.is_little_endian and not signal.is_multiplexer and signal.multiplex is None
                and not signal.is_float and signal.offset == 0 and signal.factor > 0,
                f"{label}: only plain little-endian signals without offset")
        require(signal.size <= (24 if is_scaled(signal) else 32), f"{label}: more bits than its field is exact in")
        if signal.name in PROTECTION:
            require((signal.start_bit, signal.size) == PROTECTION[signal.name], f"{label}: not in its place")
        raw_range(signal)
        bits = set(range(signal.start_bit, signal.start_bit + signal.size))
        require(not bits & taken and max(bits) < 64, f"{label}: overlaps or leaves the payload")
        taken |= bits
    require(is_companion(frame) or frame.signal_by_name("crc"), f"{name}: has no crc")
