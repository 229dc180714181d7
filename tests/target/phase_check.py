#!/usr/bin/env python3
"""The car's image keeps its tick's distance to the motion frames: phase_check.py RUNNER TARGET IMAGE.

Frames come as fast as the board takes them, and how long ticks took is said by the board's own clock, in its status line of each
100 ticks. So it does not matter how fast the host is.
"""

import re
import socket
import sys
import threading

from slcan_check import Board

COMMAND, STEERING, MOTION = (f"t{number:03X}".encode() for number in (0x008, 0x011, 0x010))
SETTLES, JUDGED = 95, 210  # ticks; status lines are told of the hundreds
# What comes, and from how many to how many ms a tick then takes. The newest of many motion frames is that right before the tick, which
# wants to be 4 ms behind it: so each tick is put off, by half a millisecond at most, and the next frames come as close again.
LEGS = ((STEERING, 9.9, 10.1), (MOTION, 10.3, 10.6))


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
        for identifier, _, _ in LEGS:
            drive(board, identifier)
    finally:
        board.process.kill()
        said = board.process.communicate()[0]
    lines = [tuple(map(int, line)) for line in re.findall(r"^tick (\d+) at (\d+) ms ", said, re.MULTILINE)]
    for number, (identifier, least, most) in enumerate(LEGS):
        end = (number + 1) * (SETTLES + JUDGED)
        judged = [line for line in lines if end - JUDGED <= line[0] < end]
        assert len(judged) >= 2, said
        (first, began_ms), (last, ended_ms) = judged[0], judged[-1]
        tick_ms = (ended_ms - began_ms) / (last - first)
        print(f"frames {identifier.decode()}: {last - first} ticks of {tick_ms:.2f} ms")
        assert least <= tick_ms <= most, f"{least} to {most} ms wanted\n{said}"


if __name__ == "__main__":
    main(*sys.argv[1:])
