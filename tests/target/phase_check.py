#!/usr/bin/env python3
"""The car's image keeps its tick's distance to the motion frames: phase_check.py RUNNER TARGET IMAGE.

How long ticks took is said by the board's own clock, in its status line of each 100 ticks. The frames come as fast as the host hands
them over, so a busy host decides how far they shift a tick (tests/target/hal_check.cpp has the exact shifts), but not that they do.
"""

import re
import socket
import statistics
import sys
import threading

from slcan_check import Board

COMMAND, STEERING, MOTION = (f"t{number:03X}".encode() for number in (0x008, 0x011, 0x010))
SETTLES, JUDGED = 95, 510  # ticks; status lines are told of the hundreds
# The newest of many motion frames is that right before the tick, which wants to be 4 ms behind it: so each tick is put off, by half a
# millisecond at most, and the next frames come as close again. Measured: 10.5 ms on a quiet host, 10.03 at least on a busy one.
UNSHIFTED_MS, SHIFT_MS = (9.9, 10.02), 0.02


def drive(board, identifier):
    """So many ticks, one command each, while frames of that id come."""
    over = threading.Event()

    def flood():
        while not over.is_set():
            board.end.sendall(20 * (identifier + b"8" + 16 * b"0" + b"\r"))

    sender = threading.Thread(target=flood, daemon=True)
    sender.start()
    commands = 0
    while commands < SETTLES + JUDGED:
        commands += board.lines(1)[0].startswith(COMMAND)
    over.set()
    sender.join()


# MPS-043 HAL-023 The image watches for motion frames, and for no others, and its ticks follow them.
def main(runner, target, image):
    board = Board(runner, target, image)
    board.end.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 2048)  # of one leg little is left for the next
    try:
        for identifier in (STEERING, MOTION):
            drive(board, identifier)
    finally:
        board.process.kill()
        said = board.process.communicate()[0]
    lines = [tuple(map(int, line)) for line in re.findall(r"^tick (\d+) at (\d+) ms ", said, re.MULTILINE)]
    typical_ms = []
    for number, identifier in enumerate((STEERING, MOTION)):
        end = (number + 1) * (SETTLES + JUDGED)
        judged = [line for line in lines if end - JUDGED <= line[0] < end]
        assert len(judged) >= 4, said
        hundreds_ms = [(ended - began) / (last - first) for (first, began), (last, ended) in zip(judged, judged[1:])]
        print(f"frames {identifier.decode()}: ticks of {', '.join(f'{each:.2f}' for each in hundreds_ms)} ms")
        typical_ms.append(statistics.median(hundreds_ms))
    steering_ms, motion_ms = typical_ms
    least, most = UNSHIFTED_MS
    assert least <= steering_ms <= most, f"{least} to {most} ms wanted with steering frames\n{said}"
    assert motion_ms >= steering_ms + SHIFT_MS, f"{SHIFT_MS} ms more wanted with motion frames\n{said}"


if __name__ == "__main__":
    main(*sys.argv[1:])
