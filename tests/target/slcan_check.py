#!/usr/bin/env python3
"""The other end of the board's CAN line: slcan_check.py RUNNER TARGET IMAGE. Bytes go over a real socket to QEMU's UART 1.
"""

import re
import socket
import subprocess
import sys

WAIT_S = 60
ID = 0x123


def line(number, identifier=ID):
    return b"t%03X8%016X\r" % (identifier, number)


class Board:
    def __init__(self, runner, target, image):
        self.end, boards_end = socket.socketpair()
        boards_end.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 2048)
        self.process = subprocess.Popen([runner, "--count", "--can", str(boards_end.fileno()), target, image],
                                        pass_fds=[boards_end.fileno()], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                        text=True)
        boards_end.close()
        self.end.settimeout(WAIT_S)
        self.heard = b""

    def send(self, data):
        self.end.sendall(data)

    def lines(self, count):
        """The next `count` lines, without their CR."""
        while self.heard.count(b"\r") < count:
            data = self.end.recv(4096)
            assert data, "the board hung up"
            self.heard += data
        *lines, self.heard = self.heard.split(b"\r", count)
        return lines

    def finish(self):
        """What the image counted: name -> number."""
        self.send(b"t7FF0\r")
        out, _ = self.process.communicate(timeout=WAIT_S)
        assert "down before start yes" in out, out
        return {name: int(number) for name, number in re.findall(r"(\w+) (\d+)", out)}


def expect(found, wanted, what):
    assert found == wanted, f"{what}: {found} instead of {wanted}"


# MPS-040, MPS-041: the adapter is told to open; frames come in order; others and noise are read over, the noise counted.
def frames_and_noise(board):
    expect(board.lines(3), [b"C", b"S6", b"O"], "hello to the adapter")
    board.send(b"\rz\rV1013\rT000001238" + b"0" * 16 + b"\rr1238\r")  # none of ours, no error
    board.send(b"t12G0\r" + b"x" * 40 + b"\r\a")  # no digit, too long, an adapter's no
    board.send(b"".join(line(i) for i in range(20)))
    expect(board.lines(20), [line(i, ID + 1)[:-1] for i in range(20)], "answers")


# MPS-042: nobody reads the answers of 300 frames: whole lines are dropped, the others stay whole and in order.
def full_queue(board):
    asked = 300
    for number in range(asked):
        board.send(line(number))
    answers = []
    board.end.settimeout(1)
    while not answers or answers[-1] != line(asked - 1, ID + 1)[:-1]:  # the last question is answered after all others
        try:
            answers += board.lines(1)
        except TimeoutError:  # it was among the dropped
            board.send(line(asked))
            asked += 1
    board.end.settimeout(WAIT_S)
    numbers = [int(answer[-16:], 16) for answer in answers]
    assert all(answer == line(number, ID + 1)[:-1] for answer, number in zip(answers, numbers)), "a torn line"
    expect(numbers, sorted(set(numbers)), "order")
    assert len(answers) < asked, "nothing was dropped"
    return asked, len(answers)


def main(runner, target, image):
    board = Board(runner, target, image)
    try:
        frames_and_noise(board)
        asked, answered = full_queue(board)
        counted = board.finish()
    finally:
        board.process.kill()
    expect(counted["received"], 20 + asked + 1, "received")
    expect(counted["sent"], 20 + answered, "sent")
    expect(counted["dropped"], 1 + asked - answered, "dropped, one of them before the start")
    expect(counted["errors"], 3, "errors")
    # MPS-043: frames of the id watched for were noted, each once at most; phase_check.py judges when.
    assert 2 <= counted["arrivals"] <= 20 + asked, f"arrivals: {counted['arrivals']}"
    print(f"{asked - answered} of {asked} frames found the queue full; every line was whole")


if __name__ == "__main__":
    main(*sys.argv[1:])
