#!/usr/bin/env python3
"""Runs the fuzz targets (docs/fuzzing.md) that a build folder holds; exit code 1 when one finds something.

    fuzz.py [TARGET...] [--seconds N] [--runs N] [--shards N]     fuzzes; what is new goes to BUILD/corpus/TARGET
    fuzz.py [TARGET...] --replay                                  runs the kept inputs, no others, and keeps nothing
    fuzz.py [TARGET...] --planted                                 the other way round: the planted fault must be found
    fuzz.py [TARGET...] --memory [--seconds N ...]                with the memory sanitizer, those targets that can be
    fuzz.py [TARGET...] --coverage                                lines that the inputs known reach, by source file
    fuzz.py [TARGET...] --keep                                    makes the kept inputs anew: few that reach as much
"""

import argparse
import json
import pathlib
import posixpath
import re
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, field

ROOT = pathlib.Path(__file__).resolve().parent.parent
KEPT = ROOT / "tests/fuzz/corpus"
WORLD = "sim_host/world"


@dataclass
class Target:
    longest: int  # bytes of an input
    covers: list = field(default_factory=list)  # the sources it is for


TARGETS = {
    "candump": Target(128, ["firmware/wire/candump.cpp"]),
    "cut": Target(1024, [f"{WORLD}/scenario/cut.cpp"]),
    "ecu": Target(1024, ["firmware/ecu", "firmware/gate/command_gate.cpp", "hal/sim/bus.cpp"]),
    "facade": Target(1024, ["algo/planner", "algo/safety", "algo/scene", "algo/trajectory", "algo/occupancy"]),
    "map": Target(512, ["firmware/wire/map_receiver.cpp", "firmware/wire/map_record.cpp"]),
    "network": Target(4096, [f"{WORLD}/map/{name}.cpp" for name in (
        "sumo_network", "sumo_junction", "sumo_lane", "xml_values", "conflicts", "junction_bridge")]),
    "records": Target(4096, [f"sim_host/campaign/{name}.cpp" for name in ("records", "record_limits", "episode_record", "compare")]),
    "routes": Target(2048, [f"{WORLD}/{name}.cpp" for name in (
        "scenario/route_file", "scenario/route_choices", "scenario/vehicle_types", "scenario/flow_attributes", "map/xml_values")]),
    "secoc": Target(512, ["firmware/secoc"]),
    "slcan": Target(96, ["hal/slcan.cpp"]),
    "texts": Target(4096, ["sim_host/faults/script.cpp", "hal/linux/key_file.cpp", "sim_host/clips/clip.cpp"]),
    "toml": Target(2048, [f"{WORLD}/scenario/{name}.cpp" for name in ("scenario", "toml_table", "toml_shape")]
                   + ["sim_host/campaign/parameters_file.cpp"]),
    "traci": Target(256, [f"sim_host/sumo/{name}.cpp" for name in ("traci_client", "traci_message")]),
    "weights": Target(128, ["algo/satp/weight_image.cpp"]),
    "wire": Target(512, [f"firmware/wire/{name}.cpp" for name in ("e2e", "signal", "track_list", "crc16")]),
}


def program(options, target):
    return options.build / "tests/fuzz" / f"{target}{'_planted' if options.planted else ''}_fuzz"


def arguments(options, target, shard):
    """libFuzzer's own options."""
    found = options.build / "findings"
    found.mkdir(parents=True, exist_ok=True)
    result = [f"-seed={options.seed + shard}", f"-max_len={TARGETS[target].longest}", "-len_control=0", "-timeout=20", "-rss_limit_mb=2048",
              "-print_final_stats=1", f"-artifact_prefix={found}/{target}-"]
    words = ROOT / "tests/fuzz" / f"{target}.dict"
    if words.exists():
        result.append(f"-dict={words}")
    if options.runs is not None:
        result.append(f"-runs={options.runs if options.planted else -(-options.runs // options.shards)}")
    if options.seconds:
        result.append(f"-max_total_time={options.seconds}")
    return result


def corpora(options, target, scratch):
    """Where new inputs go, and where there are some; a folder must be there."""
    kept = KEPT / target
    if options.replay or options.planted or options.fresh:
        own = scratch / target
    else:
        own = options.build / "corpus" / target
    own.mkdir(parents=True, exist_ok=True)
    return [own, kept] if kept.is_dir() else [own]


@dataclass
class Result:
    executions: int = 0
    seconds: float = 0.0
    edges: int = 0
    finding: str = ""
    words: str = ""


def run(options, target, scratch):
    begin = time.monotonic()
    shards = []
    for shard in range(1 if options.planted else options.shards):
        folders = corpora(options, target, scratch)
        command = [program(options, target), *arguments(options, target, shard), *folders]
        log = open(scratch / f"{target}-{shard}.log", "w+", encoding="utf-8", errors="replace")
        shards.append((subprocess.Popen(command, stdout=log, stderr=log, cwd=scratch,
                                        env={"TMPDIR": str(scratch), "PATH": "/usr/bin:/bin"}), log))
    result = Result()
    for process, log in shards:
        code = process.wait()
        log.seek(0)
        text = log.read()
        log.close()
        result.executions += sum(map(int, re.findall(r"stat::number_of_executed_units: +(\d+)", text)))
        result.edges = max([result.edges, *map(int, re.findall(r"\bcov: (\d+)", text))])
        if code != 0:
            named = re.findall(r"Test unit written to (\S+)", text)
            result.finding = named[-1] if named else f"exit code {code}, no input"
            result.words = "\n".join(line for line in text.splitlines() if re.search(r"fuzz:|ERROR|SUMMARY|runtime error", line)) or text[-2000:]
    result.seconds = time.monotonic() - begin
    return result


def fuzz(options):
    bad = 0
    print(f"{'target':10} {'executions':>12} {'seconds':>8} {'a second':>9} {'edges':>6}  {'found' if options.planted else 'finding'}")
    for target in options.targets:
        with tempfile.TemporaryDirectory(prefix="s4tp-fuzz-", dir="/dev/shm" if pathlib.Path("/dev/shm").is_dir() else None) as scratch:
            result = run(options, target, pathlib.Path(scratch))
        verdict = result.finding
        if options.planted:
            verdict = "yes" if result.finding else "NO: the planted fault was not found"
        print(f"{target:10} {result.executions:12,} {result.seconds:8.1f} {result.executions / result.seconds:9,.0f} "
              f"{result.edges:6}  {verdict}", flush=True)
        if bool(result.finding) != options.planted:
            bad += 1
            print(result.words)
            if result.finding:
                print(f"again: {program(options, target)} {result.finding}")
    return 1 if bad else 0


def known(options, target):
    return [folder for folder in (KEPT / target, options.build.parent / "sanitize/corpus" / target) if folder.is_dir()]


def coverage(options):
    """Lines of the sources a target is for that the known inputs reach; needs a build of the preset fuzz_coverage."""
    bad = 0
    for target in options.targets:
        with tempfile.TemporaryDirectory(prefix="s4tp-fuzz-") as scratch:
            raw, data = pathlib.Path(scratch) / "raw", pathlib.Path(scratch) / "data"
            subprocess.run([program(options, target), "-runs=0", "-detect_leaks=0", *known(options, target)], check=True,
                           capture_output=True, cwd=scratch, env={"LLVM_PROFILE_FILE": str(raw), "TMPDIR": scratch})
            subprocess.run(["llvm-profdata-14", "merge", "-sparse", raw, "-o", data], check=True)
            report = subprocess.run(["llvm-cov-14", "export", "--summary-only", program(options, target), f"-instr-profile={data}"],
                                    check=True, capture_output=True, text=True).stdout
        count = reached = 0
        unseen = set(TARGETS[target].covers)
        for file in json.loads(report)["data"][0]["files"]:
            # build/fuzz_coverage/../../hal/can.hpp, and build/fuzz_coverage/hal/can.cpp where sources are compiled together
            name = posixpath.normpath(file["filename"].removeprefix(f"{ROOT}/")).removeprefix(f"build/{options.build.name}/")
            of = {one for one in TARGETS[target].covers if name == one or name.startswith(f"{one}/")}
            if not of:
                continue
            unseen -= of
            lines = file["summary"]["lines"]
            count, reached = count + lines["count"], reached + lines["covered"]
            if options.verbose:
                print(f"  {name:50} {lines['covered']:5} of {lines['count']:5} lines")
        print(f"{target:10} {reached:5} of {count:5} lines, {100 * reached / max(count, 1):5.1f} %", flush=True)
        for one in sorted(unseen):
            print(f"{target:10} {one}: not in the program")
        bad += bool(unseen)
    return 1 if bad else 0


def edges_of(options, target, scratch):
    """input -> edges it reaches, of all that are known, as libFuzzer notes them when it merges."""
    notes, merged = scratch / "notes", scratch / "merged"
    merged.mkdir()
    subprocess.run([program(options, target), "-merge=1", f"-merge_control_file={notes}", f"-max_len={TARGETS[target].longest}",
                    merged, *known(options, target)], check=True, capture_output=True, env={"TMPDIR": str(scratch)})
    lines = notes.read_text(encoding="utf-8").splitlines()
    files = [pathlib.Path(line) for line in lines[2:2 + int(lines[0])]]
    # Of each input the edges that those before it, smaller ones, had not.
    noted = [line.split() for line in lines if line.startswith("COV ")]
    return {files[int(words[1])]: set(words[2:]) for words in noted if len(words) > 2}


def keep(options):
    """Smallest first, what reaches an edge that those before it did not."""
    for target in options.targets:
        with tempfile.TemporaryDirectory(prefix="s4tp-fuzz-") as scratch:
            edges = edges_of(options, target, pathlib.Path(scratch))
            inputs = {file.name: file.read_bytes() for file in edges}
        (KEPT / target).mkdir(parents=True, exist_ok=True)
        for old in KEPT.glob(f"{target}/*"):
            if re.fullmatch(r"[0-9a-f]{40}", old.name):  # those that were named were written by hand: they stay
                old.unlink()
        for name, content in inputs.items():
            (KEPT / target / name).write_bytes(content)
        print(f"{target:10} {len(inputs):4} inputs, {sum(map(len, inputs.values())):7} bytes")
    return 0


def main(arguments_given):
    parser = argparse.ArgumentParser(prog="s4tp fuzz", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("targets", nargs="*", metavar="TARGET", help=f"of {', '.join(TARGETS)}; all that are built when none is named")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/sanitize", help=argparse.SUPPRESS)
    parser.add_argument("--seconds", type=int, help="for each target; a minute where nothing is said")
    parser.add_argument("--runs", type=int, help="executions for each target, shared out to the shards")
    parser.add_argument("--shards", type=int, default=1, help="processes at a time, each with a seed of its own")
    parser.add_argument("--seed", type=int, default=1, help="of the first shard")
    parser.add_argument("--fresh", action="store_true", help="begin with the kept inputs, leave nothing behind")
    parser.add_argument("--verbose", action="store_true", help="coverage of every file")
    for name in ("replay", "planted", "memory", "coverage", "keep"):
        parser.add_argument(f"--{name}", action="store_true")
    options = parser.parse_args(arguments_given)
    unknown = [name for name in options.targets if name not in TARGETS]
    if unknown or options.shards < 1:
        parser.error(f"no such target: {', '.join(unknown)}; there are {', '.join(TARGETS)}" if unknown else "--shards: expected 1 or more")
    options.build = options.build.resolve()
    options.targets = options.targets or [name for name in TARGETS if program(options, name).exists()]
    if not options.targets:
        parser.error(f"{options.build} holds no fuzz targets: ./s4tp fuzz builds them")
    if options.replay:
        options.runs = 0
    if options.runs is None and options.seconds is None:
        options.seconds = 60
    if options.coverage:
        return coverage(options)
    return keep(options) if options.keep else fuzz(options)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
