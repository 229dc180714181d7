"""Drives recorded, replayed and cut, as a user does it. S4TP_BUILD names the host's build folder."""

import base64
import json
import math
import os
import pathlib
import re
import shutil
import socket
import subprocess
import tempfile
import time
import unittest
import zlib

import can

TOOL = pathlib.Path(os.environ["S4TP_BUILD"]) / "sim_host/s4tp_tool"
SCENARIOS = pathlib.Path(__file__).resolve().parents[2] / "sim_host/scenarios"
PRE_ROLL = 300  # ticks before the ECU takes over
COMMAND = " 008#"
SEED = 16  # of a drive of more than half a minute; how it ends is not what is looked at here
ENDED = (0, 1)  # exit codes of a drive that was driven: at the goal, or not


def run(*arguments, folder, code=0):
    done = subprocess.run([TOOL, *map(str, arguments)], cwd=folder, check=False, text=True, timeout=240,
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if code is not None and done.returncode not in (code if isinstance(code, tuple) else (code,)):
        raise AssertionError(f"{arguments}: exit code {done.returncode}, not {code}\n{done.stdout}")
    return done.stdout


def drive(folder, *options, scenario="left_turn", seed=SEED, code=ENDED):
    return run("run", "--scenario", scenario, "--seed", seed, *options, folder=folder, code=code)


class Recording(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        kept = tempfile.TemporaryDirectory(prefix="s4tp_recording_")
        cls.addClassCleanup(kept.cleanup)
        cls.kept = pathlib.Path(kept.name)
        drive(cls.kept, "--record", "drive.log", "--out", "driven")

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="s4tp_recording_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def lines(self):
        return (self.kept / "drive.log").read_text(encoding="ascii").splitlines(keepends=True)

    def recording_of(self, text, name="part.log"):
        """A recording with these frames and the drive's own note."""
        (self.folder / name).write_bytes(text if isinstance(text, bytes) else text.encode())
        shutil.copytree(self.kept / "drive.log.drive", self.folder / (name + ".drive"), dirs_exist_ok=True)
        return name

    # Recording changes nothing: the frames are those of --log without its comments, the result is that of a drive without it.
    def test_the_drive_is_the_same_to_the_bit(self):
        drive(self.folder, "--log", "plain.log", "--out", "out")
        plain = (self.folder / "plain.log").read_text(encoding="ascii").splitlines(keepends=True)
        self.assertTrue(plain[0].startswith("# s4tp log:"))
        self.assertEqual(plain[1:], self.lines())
        self.assertEqual((self.folder / "out/run.json").read_bytes(), (self.kept / "driven/run.json").read_bytes())
        # The older log replays as well, and what it says of the ECU is heeded.
        self.assertIn("the same plans and commands, to the bit", run("replay", "plain.log", folder=self.folder))
        self.assertIn("--planner and --guard", run("replay", "plain.log", "--guard", "off", folder=self.folder, code=2))

    # Another reader of candump's format takes every line; a line of ours that is no frame it would not.
    def test_python_can_reads_it(self):
        with can.CanutilsLogReader(str(self.kept / "drive.log")) as reader:
            self.assertEqual(sum(1 for _ in reader), len(self.lines()))

    # PROC-025 World and ECU as two processes record the same frames as within one; with --live at the pace of the clock. 4 s
    # of driving, as the clock takes its time.
    def test_a_bus_records_the_same(self):
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        short = self.folder / "left_turn"
        shutil.copytree(SCENARIOS / "left_turn", short)
        shutil.copy(SCENARIOS / "social.toml", self.folder)
        text = (short / "scenario.toml").read_text(encoding="utf-8")
        (short / "scenario.toml").write_text(re.sub(r"time_limit_s = .*", "time_limit_s = 4.0", text), encoding="utf-8")
        drive(self.folder, "--record", "one.log", "--out", "one", scenario=short, code=1)
        begin = time.monotonic()
        drive(self.folder, "--bus", f"slcan:tcp:127.0.0.1:{port}", "--telemetry", "", "--patience", 30, "--record", "bus.log", "--live",
              "--out", "out", scenario=short, code=1)
        one = (self.folder / "one.log").read_text(encoding="ascii")
        last_us = time_us(one.splitlines()[-1])
        self.assertGreater(last_us, 6_500_000)
        self.assertGreater(time.monotonic() - begin, last_us * 1e-6)
        self.assertEqual((self.folder / "bus.log").read_text(encoding="ascii"), one)
        note = json.loads((self.folder / "bus.log.drive/drive.json").read_text(encoding="utf-8"))
        self.assertEqual((note["bus"], note["seed"], note["planner"]), ("lock-step", SEED, "s4tp"))
        self.assertIn("to the bit", run("replay", "bus.log", folder=self.folder))

    # REC-001, REC-006 What is recorded is not written over, and a drive that never began leaves nothing.
    def test_nothing_is_written_over(self):
        self.assertIn("name another --record, or remove it",
                      drive(self.kept, "--record", "drive.log", "--out", "again", code=2))
        self.assertIn("to the bit", run("replay", "drive.log", folder=self.kept))
        drive(self.folder, "--bus", "slcan:listen:127.0.0.1:1", "--no-ecu", "--record", "never.log", "--out", "out", code=2)
        self.assertEqual([file.name for file in self.folder.glob("never.log*")], [])

    # REC-002 Files of limited size, each from the beginning of a tick; together they are the whole drive and replay as it.
    def test_files_rotate_by_size(self):
        drive(self.folder, "--record", "r.log", "--record-size-mb", 0.1, "--out", "out")
        files = [self.folder / name for name in ["r.log", *(f"r.log.{i}" for i in range(1, 100))] if (self.folder / name).exists()]
        self.assertGreater(len(files), 10)
        self.assertEqual(b"".join(file.read_bytes() for file in files), (self.kept / "drive.log").read_bytes())
        first_id = self.lines()[0].split()[2].split("#")[0]
        for file in files:
            self.assertLess(file.stat().st_size, 100_000 + 12_000)  # and what the last tick had
            self.assertEqual(file.read_text(encoding="ascii").split()[2].split("#")[0], first_id)
        self.assertIn("to the bit", run("replay", "r.log", folder=self.folder))
        # A file lost in between ends it there, and is named.
        files[5].unlink()
        said = run("replay", "r.log", folder=self.folder, code=2)
        self.assertRegex(said, r"r\.log\.4: the file after it is missing \(there is r\.log\.6\)")

    # REC-004 Of a few kept files the newest stay; without the beginning nothing is judged, and that is said.
    def test_few_files_are_kept(self):
        drive(self.folder, "--record", "k.log", "--record-size-mb", 0.2, "--record-keep", 2, "--out", "out")
        files = sorted(file.name for file in self.folder.glob("k.log*") if file.is_file())
        self.assertEqual(len(files), 2)
        self.assertNotIn("k.log", files)
        self.assertIn("cannot be judged: its beginning was not kept", run("replay", "k.log", folder=self.folder, code=2))

    # REC-030, REC-031 A cut without the drive's beginning, or in another world, is the same start on the recording's own roads, and
    # says so; nobody has to name them.
    def test_a_recording_names_its_own_roads(self):
        drive(self.folder, "--record", "k.log", "--record-size-mb", 0.1, "--out", "out")
        (self.folder / "k.log").unlink()  # as --record-keep does: 3 s and the pre-roll's map are gone
        name = self.recording_of("".join(self.lines()))
        note = self.folder / "part.log.drive/drive.json"
        note.write_text(note.read_text(encoding="utf-8").replace(f'"seed": {SEED}', '"seed": 8'), encoding="utf-8")
        for log, why in (("k.log", r"--record-keep 0 keeps all"), (name, r"recorded .*, now ")):
            said = run("replay", log, "--cut", 14, "--out", "c" + log, folder=self.folder)
            self.assertRegex(said, why + r"(.|\n)*so it is the same start on the recording's own roads(.|\n)*vehicles told")
            named = run("replay", log, "--cut", 14, "--out", "n" + log, "--scenario", "left_turn", folder=self.folder)
            self.assertIn("vehicles told", named)
            for file in ("scenario.toml", "traffic.rou.xml"):
                self.assertEqual((self.folder / ("c" + log) / file).read_bytes(), (self.folder / ("n" + log) / file).read_bytes())
        # Where it starts is the same in both: that the first files are gone moves no time.
        places = [place_in(self.folder / ("c" + log) / "scenario.toml") for log in ("k.log", name)]
        self.assertAlmostEqual(*places, delta=0.1)

    # REC-003, REC-005 Cut off at every byte of its last record: read up to the record before, reported by file and line.
    def test_cut_off_at_every_byte(self):
        lines = self.lines()[:400]
        whole = "".join(lines)
        complete = len("".join(lines[:-1]))
        ticks = {}
        for size in range(complete, len(whole) + 1):
            said = run("replay", self.recording_of(whole[:size]), folder=self.folder, code=2)
            cut_off = complete < size < len(whole)
            self.assertEqual("part.log:400: the line has no end: cut off" in said, cut_off, f"at byte {size}: {said}")
            self.assertRegex(said, r" 0 differ\n")
            self.assertIn("it ends early: the drive had", said)
            ticks[size] = int(re.search(r": (\d+) ticks", said).group(1))
        inside = {ticks[size] for size in range(complete + 1, len(whole))}
        self.assertEqual(len(inside), 1)  # the same whichever byte it was
        self.assertLessEqual(ticks[len(whole)] - inside.pop(), 1)

    # REC-003 Corrupt at any byte of a record: either it is no frame any more, which is named, or the bit shows as a difference.
    def test_corrupt_bytes(self):
        lines = self.lines()[:400]
        at = max(i for i, line in enumerate(lines[:380]) if COMMAND in line)
        begin = len("".join(lines[:at]))
        for byte in range(len(lines[at])):
            text = bytearray("".join(lines).encode())
            text[begin + byte] = 0xFF
            said = run("replay", self.recording_of(bytes(text)), folder=self.folder, code=2)
            self.assertRegex(said, rf"part\.log:{at + 1}: no frame as candump writes it: \"[ -~]*\"")
        for byte in range(lines[at].index("#") + 1, len(lines[at]) - 1):
            text = bytearray("".join(lines).encode())
            text[begin + byte] = ord("0") if text[begin + byte] != ord("0") else ord("1")
            said = run("replay", self.recording_of(bytes(text)), folder=self.folder, code=1)
            self.assertIn(f"part.log:{at + 1}: recorded", said)
        # Bytes of no text at all, a time that steps back, another kind of file.
        for text, what in ((b"\x00" * 5000, "no line of candump's is that long"), (b"PNG\r\n\x1a\n", "no frame as candump writes it"),
                           ("".join(lines[:200] + lines[:10]).encode(), "part.log:201: time steps back")):
            self.assertIn(what, run("replay", self.recording_of(text), folder=self.folder, code=2))

    # Frames of other kinds on a real bus (29 bits, FD, remote) are passed over, and counted.
    def test_other_frames_are_passed_over(self):
        lines = self.lines()[:400]
        others = ["(0000000000.000000) can1 12345678#0102\n", "(0000000000.000000) can1 123##1010203\n", "(0000000000.000000) can1 7DF#R\n"]
        said = run("replay", self.recording_of("".join(others + lines)), folder=self.folder, code=2)
        self.assertIn("passed over 3 frames of other kinds", said)
        self.assertRegex(said, " 0 differ\n")

    # REC-020, REC-021 A changed frame of the ECU's is found: time, tick, file, line, both frames and the byte. --from leaves out what was before.
    def test_the_first_difference_is_named(self):
        lines = self.lines()
        at = next(i for i, line in enumerate(lines) if line.startswith("(0000000010.") and COMMAND in line)
        data = lines[at].rstrip("\n")
        flipped = data[:-1] + ("0" if data[-1] != "0" else "1")
        name = self.recording_of("".join(lines[:at] + [flipped + "\n"] + lines[at + 1:]), "flipped.log")
        said = run("replay", name, folder=self.folder, code=1)
        frame = flipped.split()[2]
        self.assertRegex(said, rf"first difference at 7\.0\d s, tick 100\d, flipped\.log:{at + 1}: recorded \w+ {frame}, now \w+ "
                         rf"{data.split()[2]} \(byte 7\)")
        self.assertRegex(said, r" 1 differ\n")
        later = run("replay", name, "--from", 8, folder=self.folder)
        self.assertRegex(later, r" 0 differ\nbefore that 1 of \d+ differ, first at 7\.0")
        self.assertIn("cannot be judged", run("replay", name, "--from", 1000, folder=self.folder, code=2))

    # REC-023 What a cycle cost on another processor is no difference; a missed deadline is.
    def test_costs_are_the_processors(self):
        lines = self.lines()
        at = next(i for i, line in enumerate(lines) if line.startswith("(0000000010.") and " 031#" in line)
        head, data = lines[at].rstrip("\n").split("#")
        for changed, differing in (("FFA" + data[3] + "BCDE" + data[8:], 0), (data[:-2] + "01", 1)):  # CRC and cost; slips
            name = self.recording_of("".join(lines[:at] + [f"{head}#{changed}\n"] + lines[at + 1:]))
            said = run("replay", name, folder=self.folder, code=differing)
            self.assertRegex(said, rf" {differing} differ\n")

    # The page of a recording shows the drive that the page of the drive shows.
    def test_the_page_is_the_drives(self):
        said = run("replay", "drive.log", "--view", "--from", 5, "--out", self.folder / "page", folder=self.kept)
        self.assertIn(f"replay: {self.folder}/page/replay.html#t=5.00", said)
        self.assertEqual(page_data(self.folder / "page/replay.html"), page_data(self.kept / "driven/replay.html"))

    # REC-040, REC-041 Without its note a recording still has a page: poses and words as the ECU had them, at most a tick's way beside
    # the true ones; so does one whose world draws other traffic, and that is said.
    def test_a_page_from_the_bus_alone(self):
        truth = page_data(self.kept / "driven/replay.html")
        (self.folder / "alone.log").write_text("".join(self.lines()), encoding="ascii")
        said = run("replay", "alone.log", "--view", "--out", "alone", folder=self.folder)
        self.assertIn("the page shows what the ECU was told", said)
        seen = page_data(self.folder / "alone/replay.html")
        self.assertGreater(len(seen["road"]), 10)
        true_places = {frame["t"]: frame["ego"][:2] for frame in truth["frames"]}
        compared = 0
        for frame in seen["frames"]:
            place = true_places.get(round((frame["t"] - 10 * PRE_ROLL) / 100) * 100)  # a log's time has the pre-roll in it
            if place is not None:
                compared += 1
                self.assertLess(math.dist(place, frame["ego"][:2]) * truth["unit_m"], 1.5)  # 0.1 s at 13.9 m/s
        self.assertGreater(compared, 300)
        self.assertEqual([cycle["words"] for cycle in truth["cycles"] if "words" in cycle][-5:],
                         [cycle["words"] for cycle in seen["cycles"] if "words" in cycle][-5:])
        self.assertEqual({len(cycle["plan"]) for cycle in seen["cycles"]}, {32})
        # The same frames under the note of another seed: not that world.
        name = self.recording_of("".join(self.lines()))
        note = self.folder / "part.log.drive/drive.json"
        note.write_text(note.read_text(encoding="utf-8").replace(f'"seed": {SEED}', '"seed": 8'), encoding="utf-8")
        said = run("replay", name, "--view", "--out", "other", folder=self.folder)
        self.assertIn("this program's world is not the recording's", said)

    # REC-031 A log of roads that are known becomes a scenario that starts as things stood: our place and speed, the others on their
    # lanes; what could not be kept is counted.
    def test_the_same_start_on_known_roads(self):
        truth = page_data(self.kept / "driven/replay.html")
        (self.folder / "alone.log").write_text("".join(self.lines()), encoding="ascii")
        cut = ("--out", "start", "--scenario", "left_turn")
        said = run("replay", "alone.log", "--cut", 14, *cut, folder=self.folder)  # 4 s after the log's beginning: 1 s after take-over
        told, there, waiting, left_out = map(int, re.search(r"of (\d+) vehicles told (\d+) are there .*?, (\d+) find .*?, (\d+) were",
                                                            said).groups())
        self.assertEqual(told, there + waiting + left_out)
        self.assertGreater(there, 0)
        run("run", "--scenario", "start", "--out", "out", folder=self.folder, code=None)
        start = page_data(self.folder / "out/replay.html")
        was = next(frame for frame in truth["frames"] if frame["t"] == 1000)
        now = start["frames"][0]
        self.assertLess(abs(was["ego"][3] - now["ego"][3]), 30)  # cm/s
        # Lengths are counted from where the drive began, to 0.1 m: places differ by as much as the beginnings do.
        moved = place_in(self.folder / "start/scenario.toml") - place_in(self.kept / "drive.log.drive/scenario/left_turn/scenario.toml")
        self.assertLess(abs(moved - math.dist(was["ego"][:2], truth["frames"][0]["ego"][:2]) * truth["unit_m"]), 1.0)
        self.assertEqual(len(start["frames"][2]["cars"]) // 5, there)
        # Before its lane begins, as in the pre-roll, there is no start, and where the log holds no pose there is none to make.
        self.assertIn("on none of its lanes", run("replay", "alone.log", "--cut", 12, *cut[2:], "--out", "c", folder=self.folder, code=2))
        self.assertIn("holds no pose of ours", run("replay", "alone.log", "--cut", 5, *cut[2:], "--out", "c", folder=self.folder, code=2))
        self.assertFalse((self.folder / "c").exists())

    # REC-022, REC-030 A drive's failure becomes a test: cut out, it goes on to the same end with the same bits.
    def test_a_failure_becomes_a_test(self):
        who = ("--planner", "constant_speed", "--guard", "off")
        self.assertIn("collision", drive(self.folder, *who, "--record", "f.log", "--out", "f", seed=8, code=1))
        failed = json.loads((self.folder / "f/run.json").read_text(encoding="utf-8"))
        moment = failed["runs"][0]["failures"][0]["time_s"]
        said = run("replay", "f.log", "--cut", moment, "--out", "cut", folder=self.folder)
        command = re.search(r"\./s4tp (run .*)", said).group(1).split()
        self.assertEqual(command, ["run", "--scenario", "cut", *who])
        for file in ("f.log", "f.log.drive"):  # the cut stands by itself
            (self.folder / file).rename(self.folder / ("kept" + file))
        self.assertIn("collision", run(*command, "--record", "again.log", "--out", "a", folder=self.folder, code=1))
        self.assertEqual((self.folder / "again.log").read_bytes(), (self.folder / "keptf.log").read_bytes())

    # Another planner finds the same world at the cut, whatever it would have done before; after it, it drives.
    def test_another_planner_finds_the_same_world(self):
        run("replay", "drive.log", "--cut", 15, "--out", self.folder / "cut", folder=self.kept)
        start_tick = int(re.search(r"start_tick = (\d+)", (self.folder / "cut/scenario.toml").read_text(encoding="utf-8")).group(1))
        self.assertEqual(start_tick, PRE_ROLL + 500)
        run("run", "--scenario", "cut", "--planner", "constant_speed", "--guard", "off", "--record", "other.log", "--out", "o",
            folder=self.folder, code=None)
        commands = self.folder / "cut/commands.log"
        self.assertTrue(all(COMMAND in line for line in commands.read_text(encoding="ascii").splitlines()))
        ecu_ids = {f"{message:03X}" for message in ecu_messages()}

        def of_world(lines, last_us):
            return [line for line in lines if line.split()[2].split("#")[0] not in ecu_ids and time_us(line) <= last_us]
        other = (self.folder / "other.log").read_text(encoding="ascii").splitlines(keepends=True)
        until = start_tick * 10_000
        self.assertEqual(of_world(other, until), of_world(self.lines(), until))
        self.assertNotEqual(of_world(other, until + 2_000_000), of_world(self.lines(), until + 2_000_000))

    # A cut of a drive from a cut is a cut of the first drive; parameters and perception of a drive are kept.
    def test_cut_of_a_cut(self):
        drive(self.folder, "--perception", "real", "--flavour", "social", "--record", "first.log", "--out", "first", scenario="merge",
              seed=2, code=None)
        run("replay", "first.log", "--cut", 12, "--out", "one", folder=self.folder)
        run("run", "--scenario", "one", "--record", "second.log", "--out", "second", folder=self.folder, code=None)
        run("replay", "second.log", "--cut", 14, "--out", "two", folder=self.folder)
        run("run", "--scenario", "two", "--record", "third.log", "--out", "third", folder=self.folder, code=None)
        first = (self.folder / "first.log").read_bytes()
        self.assertEqual((self.folder / "second.log").read_bytes(), first)
        self.assertEqual((self.folder / "third.log").read_bytes(), first)

    # REC-010 What does not fit is refused with what to do: files changed since, no note, a moment outside, a folder in the way.
    def test_what_does_not_fit_is_refused(self):
        lines = self.lines()
        name = self.recording_of("".join(lines))
        toml = self.folder / "part.log.drive/scenario/left_turn/scenario.toml"
        toml.write_text(toml.read_text(encoding="utf-8") + "\n# changed\n", encoding="utf-8")
        self.assertIn("files are not as they were in the drive", run("replay", name, "--cut", 5, "--out", "c", folder=self.folder, code=2))
        name = self.recording_of("".join(lines))
        self.assertRegex(run("replay", name, "--cut", 500, "--out", "c", folder=self.folder, code=2),
                         r"--cut 500\.00 s: part\.log goes from -2\.99 s to \d+\.\d\d s")
        self.assertIn("--out DIR", run("replay", name, "--cut", 5, folder=self.folder, code=2))
        (self.folder / "there").mkdir()
        (self.folder / "there/file").write_text("", encoding="utf-8")
        self.assertIn("name another --out", run("replay", name, "--cut", 5, "--out", "there", folder=self.folder, code=2))
        (self.folder / "alone.log").write_text("".join(lines), encoding="ascii")
        self.assertIn("./s4tp run --record writes one", run("replay", "alone.log", "--cut", 5, "--out", "c", folder=self.folder, code=2))
        self.assertIn("accepted is a time in seconds", run("replay", name, "--cut", "nan", "--out", "c", folder=self.folder, code=2))
        self.assertIn("./s4tp run --record FILE makes one", run("replay", "nothing.log", folder=self.folder, code=2))
        note = self.folder / "part.log.drive/drive.json"
        for text, what in (("{", "drive.json"), ("{}", "kind"), (note.read_text(encoding="utf-8").replace(f'"seed": {SEED}', '"seed": -7'), "seed"),
                           (note.read_text(encoding="utf-8").replace("lock-step", "x").replace("in process", "x"), "lock-step")):
            note.write_text(text, encoding="utf-8")
            self.assertIn(what, run("replay", name, folder=self.folder, code=2))
            self.recording_of("".join(lines))

    # A cut's files are read as any from outside: what is wrong is named by file and key.
    def test_broken_cuts_are_named(self):
        run("replay", "drive.log", "--cut", 12, "--out", self.folder / "cut", folder=self.kept)
        toml = self.folder / "cut/scenario.toml"
        good = toml.read_text(encoding="utf-8")
        for old, new, what in ((f"seed = {SEED}", "seed = -1", "cut.seed: expected a whole number"), ("start_tick = 500", "", "cut.start_tick"),
                               ("start_tick = 500", "start_tick = 20", "expected a frame as candump writes it, before start_tick"),
                               ('"builtin"', '"mine"', "cut.traffic: expected one of builtin, sumo"),
                               (f"seed = {SEED}", f"seed = {SEED}\nsped = 1", "unknown key"), ("drive/left_turn/", "", "no cut itself"),
                               ('of = "', 'was = "', "cut.of: missing"), ("drive/left_turn/", "drove/", "cut.of: cut/drove/"),
                               ('commands = "', 'orders = "', "cut.commands: missing"),
                               ('"commands.log"', '"none.log"', "cut.commands: cut/none.log: there is no such file")):
            self.assertIn(old, good)
            toml.write_text(good.replace(old, new), encoding="utf-8")
            self.assertIn(what, run("run", "--scenario", "cut", folder=self.folder, code=2))


def ecu_messages():
    """Ids of what the DBC says the ECU sends."""
    dbc = pathlib.Path(__file__).resolve().parents[2] / "firmware/wire/s4tp.dbc"
    return [int(number) for number in re.findall(r"^BO_ (\d+) \w+: \d+ ECU", dbc.read_text(encoding="utf-8"), re.M)]


def page_data(page):
    """What a page's scripts find in it."""
    packed = re.search(r'id="data"[^>]*>([^<]*)<', page.read_text(encoding="utf-8")).group(1)
    return json.loads(zlib.decompress(base64.b64decode(packed)))


def place_in(scenario):
    """Where on its lane a mission starts."""
    return float(re.search(r"start_pos_m = ([\d.]+)", scenario.read_text(encoding="utf-8")).group(1))


def time_us(line):
    seconds, microseconds = line[1:line.index(")")].split(".")
    return int(seconds) * 1_000_000 + int(microseconds)


if __name__ == "__main__":
    unittest.main()
