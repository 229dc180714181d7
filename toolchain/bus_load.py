#!/usr/bin/python3
"""Bus load by message, worst-case bit stuffing, written as Markdown; fails when the bus is too full."""

import argparse
import pathlib
import sys

sys.dont_write_bytecode = True
import dbc  # noqa: E402  (the flag above has to come first)

BITRATE = 500_000
LIMIT = 0.40
PAYLOAD_BITS = 64
# Standard frame: 34 bits open to stuffing besides the payload, one stuff bit for every 4 after the first;
# 13 more without stuffing (CRC delimiter, acknowledge, end of frame, 3 bits of interframe space).
FRAME_BITS = 34 + PAYLOAD_BITS + 13 + (34 + PAYLOAD_BITS - 1) // 4

TRACKS = 16
LANES = 64
POINTS = 12
CONFLICTS = 128
# Frames of a message in each of its cycles, where it is not one: sizes of firmware/wire, all full.
PER_CYCLE = {
    "TrackPose": TRACKS, "TrackMotion": TRACKS, "MapSlots": 2,
    "LaneHeader": LANES, "LaneRoute": LANES, "LaneLinks": LANES, "LanePoint": LANES * POINTS,
    "ConflictFirst": CONFLICTS, "ConflictSecond": CONFLICTS,
}
MAP_PERIOD_MS = 4800  # kRepeatPeriod_ms of map_sender.cpp
RECORDS = {"LaneHeader", "LaneRoute", "LaneLinks", "LanePoint", "ConflictFirst", "ConflictSecond"}
# Of authentication (firmware/secoc), which is optional. MapAuth goes out once more with each change of the map, which the
# map node looks for five times a second; nonces only while there is no session.
AUTHENTICATION = {"CommandAuth", "MotionAuth", "TrackListAuth", "MapAuth", "NonceWorld", "NonceEcu"}
PER_CYCLE["MapAuth"] = 1.5
START_PACE = 1000  # frames/s: the map node sends up to 10 every 10 ms (WIRE-031)


def frames_per_second(frame):
    period_ms = MAP_PERIOD_MS if frame.name in RECORDS else frame.cycle_time
    return PER_CYCLE.get(frame.name, 1) * 1000 / period_ms


def percent(rate):
    return f"{100 * rate * FRAME_BITS / BITRATE:.1f} %"


def row(*cells):
    return "| " + " | ".join(str(cell) for cell in cells) + " |"


def report(frames):
    """The document, and the share of the bus that is taken in steady state."""
    rates = {frame.name: frames_per_second(frame) for frame in frames}
    records = sum(rate for name, rate in rates.items() if name in RECORDS)
    everything = sum(rates.values())
    total = everything - sum(rates[name] for name in AUTHENTICATION)
    headers = rates["MapHeader"] + rates["MapSlots"]  # go out within the pace of the map node
    start = total - records - headers + START_PACE
    map_frames = sum(PER_CYCLE[name] for name in RECORDS)
    lines = ["# Bus load", "",
             "Made by toolchain/bus_load.py from firmware/wire/s4tp.dbc; do not edit.", "",
             f"{BITRATE // 1000} kbit/s. Every frame counts {FRAME_BITS} bits: 11-bit id, 8 bytes, as many stuff "
             "bits as can occur, interframe space.",
             f"Every list is full: {TRACKS} tracks; {LANES} lanes of {POINTS} points and {CONFLICTS} conflicts, "
             f"each again every {MAP_PERIOD_MS / 1000} s.", "",
             row("id", "message", "from", "frames/s", "kbit/s", "load"), row("---", "---", "---", "--:", "--:", "--:")]
    for frame in frames:
        rate = rates[frame.name]
        lines.append(row(f"0x{frame.arbitration_id.id:03X}", frame.name, frame.transmitters[0], f"{rate:.1f}",
                         f"{rate * FRAME_BITS / 1000:.1f}", percent(rate)))
    lines += [row("", f"**{what}**", "", f"**{rate:.1f}**", f"**{rate * FRAME_BITS / 1000:.1f}**", f"**{percent(rate)}**")
              for what, rate in (("all without authentication", total), ("all", everything))]
    lines += ["",
              f"Limit: {100 * LIMIT:.0f} %.", "",
              "While the map is sent for the first time, or changes all over, the map node takes its whole pace of "
              f"{START_PACE} frames/s: {percent(start)} at most.",
              f"The {map_frames} frames of the largest map then take {map_frames / (START_PACE - headers):.2f} s.", "",
              "With authentication (companions and nonces, docs/threat_model.md): "
              f"{percent(start + everything - total)} at most then.", ""]
    return "\n".join(lines), everything * FRAME_BITS / BITRATE


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("dbc", type=pathlib.Path)
    parser.add_argument("document", type=pathlib.Path)
    parser.add_argument("--check", action="store_true", help="compare with the document instead of writing it")
    arguments = parser.parse_args()
    frames, _ = dbc.load(arguments.dbc)
    text, load = report(frames)
    if load >= LIMIT:
        return f"bus_load: {load:.1%} of the bus, the limit is {LIMIT:.0%}"
    if not arguments.check:
        arguments.document.write_text(text, encoding="utf-8")
    elif arguments.document.read_text(encoding="utf-8") != text:
        return f"bus_load: {arguments.document} is not up to date"
    return 0


if __name__ == "__main__":
    sys.exit(main())
