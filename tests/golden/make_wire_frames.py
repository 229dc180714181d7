#!/usr/bin/python3
"""Writes tests/golden/wire_frames.txt: messages packed by canmatrix, an encoder that is not ours.

    python3 tests/golden/make_wire_frames.py > tests/golden/wire_frames.txt

A line is: message, payload with crc and counter zero, signal=value ... Every message with all signals at their
least, at their most, and at four mixed values; all on the grid of their step, so that there is nothing to round.
"""

import pathlib
import random
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "toolchain"))
import dbc  # noqa: E402  (found by the path above)


def main():
    frames, _ = dbc.load(ROOT / "firmware/wire/s4tp.dbc")
    draw = random.Random(1)
    for frame in frames:
        fields = dbc.fields(frame)
        ranges = [dbc.raw_range(signal) for signal in fields]
        raws = [[low for low, _ in ranges], [high for _, high in ranges]]
        raws += [[draw.randint(low, high) for low, high in ranges] for _ in range(4)]
        for values in raws:
            raw = {signal.name: value for signal, value in zip(fields, values)}
            protection = {name: 0 for name in dbc.PROTECTION if frame.signal_by_name(name)}
            payload = frame.encode(protection | raw)  # canmatrix takes raw values here
            print(frame.name, payload.hex().upper(),
                  *(f"{signal.name}={raw[signal.name] * signal.factor}" for signal in fields))


if __name__ == "__main__":
    main()
