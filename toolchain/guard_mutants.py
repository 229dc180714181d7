#!/usr/bin/env python3
"""Faults planted in the guard, driven among the legal adversary: each must touch somebody by our own fault.

    guard_mutants.py [MUTANT...] [--count] [--build build/host] [--jobs N]

A mutant is text replaced in copies of sources of algo/safety; they are compiled as the build compiles theirs, and
linked before its libraries into another s4tp_tool. That drives tuning seeds of docs/adversary.md, first with a planner
that looks at nobody and leaves everything to the guard, then with ours, until somebody is touched by our own fault in a
drive in which the guard as it is touches nobody so. A mutant that is not to be seen so says why in `lives`; one such
that is seen is a fault, too. --count drives all and prints the rows of the table in docs/adversary.md.
"""

import argparse
import concurrent.futures
import dataclasses
import functools
import itertools
import json
import os
import pathlib
import shlex
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
SAFETY = ROOT / "algo/safety"
PLANNERS = ("blind", "s4tp")  # the quick one first
SCENARIOS = ("left_turn", "left_turn_t", "merge", "cruise", "overtake", "cut_in")
FLAVOURS = ("smarts", "social")
CELLS = tuple(itertools.product(FLAVOURS, SCENARIOS))  # of each seed, in the order in which they are counted
SEEDS = range(500, 520)


def looking_at(*changes):
    """The guard looks at a copy of scene and parameters, changed."""
    head = ("int Guard::look(const scene::Scene& {0}scene, const TrajectoryPoint& start, float lead_s,\n"
            "                const Parameters& {0}parameters) {{\n")
    lines = ("static thread_local scene::Scene scene;", "static thread_local Parameters parameters;",
             "scene = true_scene;", "parameters = true_parameters;", *changes)
    return {"guard_context.cpp": [(head.format(""), head.format("true_") + "\n".join(lines) + "\n")]}


@dataclasses.dataclass(frozen=True)
class Mutant:
    changed: str  # what, in the table's words
    edits: dict  # source in algo/safety: [(text that it holds once, what stands there instead)]
    lives: str = ""  # why it is not seen


MUTANTS = {
    "no_d1": Mutant("whoever can still stop for us owes us the way, priority or not", {
        "legal_occupancy.cpp": [("if (zone.priority == Priority::kFirstHasPriority) {", "if (true) {")]}),
    "rho_0": Mutant("others answer at once, and our fail-safe brakes from plan start on", {
        **looking_at("parameters.law.duty_response_s = 0.0F;", "parameters.law.ask_response_s = 0.0F;",
                     "parameters.rss.response_s = 0.0F;"),
        "guard.cpp": [("const int branch = to_int(guard.takeover_s / kStepS - 0.5F, 0, kHorizonSteps - 1);",
                       "const int branch = 0;"),
                      ("const float on_s = guard.takeover_s - static_cast<float>(branch) * kStepS;",
                       "const float on_s = 0.0F;")]}),
    "smaller_boxes": Mutant("every box, ours too, is 20 % shorter and narrower, and zones are by as much", looking_at(
        "auto& own = parameters.vehicle;",
        "const float end_m = 0.1F * own.length_m;",
        "const float side_m = 0.1F * own.width_m;",
        "own.rear_overhang_m -= end_m;",
        "own.length_m -= 2.0F * end_m;",
        "own.width_m -= 2.0F * side_m;",
        "for (scene::Agent& agent : scene.agents) {",
        "  agent.track.length_m *= 0.8F;",
        "  agent.track.width_m *= 0.8F;",
        "}",
        "for (scene::EgoPath& path : scene.ego_paths) {",
        "  for (scene::ConflictZone& zone : path.zones) {",
        "    zone.entry_s_m += end_m + side_m;",
        "    zone.exit_s_m -= end_m + side_m;",
        "    zone.other_entry_m += side_m;",  # the other's length zone_occupancy() sees by itself
        "    zone.other_exit_m -= side_m;",
        "  }",
        "}")),
    # Without any latch the guard is no less careful, see below: the fault is one that never ends.
    "endless_latch": Mutant("a licence is never used up: not by a stand, nor by going too late, nor unused", {
        "guard_context.cpp": [("    latched_.clear();\n    free_ms_", "    free_ms_"),
                              ("const bool bound = context.stop_s_m > used_from_s_m;",
                               "const bool bound = used_from_s_m > 0.0F || true;")],
        "guard.cpp": [("  latched_.clear();\n  if (!verdict.clears ||", "  if (!verdict.clears ||")],
        "guard_group.cpp": [("if (threat.kind == ThreatKind::kLicensed && (own.blocked || leaves_in_time(group, own, kLateS))) continue;",
                             "if (threat.kind == ThreatKind::kLicensed) continue;")]}),
    "no_latch": Mutant("a licence used is asked anew each cycle", {
        "guard.cpp": [("if (latch.track == track && latch.lane == lane) return true;", "")]},
        lives="GUARD-007 lets a plan pass that leaves the zone when it was to; who is later is refused, and goes "
              "through by the fail-safe in force"),
    "soft_leader": Mutant("whoever is ahead brakes with 4 m/s^2 at most", looking_at(
        "parameters.law.braking_max_mps2 = 4.0F;")),
    "no_follower": Mutant("a lane change leaves nobody behind room to brake", {"guard_followers.cpp": [
        ("for (const InLane& behind : context.behind) {", "for (const InLane& behind : InLaneList{}) {")]}),
    "only_strip": Mutant("a leader beside the path's strip is not looked at while our box comes over", {
        "guard_context.cpp": [("context.swing_left_m - context.swing_right_m < kInStripM", "true")]}),
    "no_unseen": Mutant("nobody is beyond the known ground", {"guard_context.cpp": [
        ("if (scene.known.left_out > 0) look_beyond(reach);", "")]}),
}


def planted(mutant, folder=SAFETY):
    """source -> its text with the fault. \\throws ValueError where it does not hold just once what is replaced"""
    texts = {}
    for file, edits in mutant.edits.items():
        text = (folder / file).read_text(encoding="utf-8")
        for old, new in edits:
            if text.count(old) != 1:
                raise ValueError(f"{file} holds {text.count(old)} times, not once: {old}")
            text = text.replace(old, new)
        texts[file] = text
    return texts


def execute(command, folder):
    done = subprocess.run([str(part) for part in command], cwd=folder, check=False, text=True, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    # 1: an episode failed, which is what is counted here.
    if done.returncode not in ((0, 1) if "eval" in command else (0,)):
        raise RuntimeError(f"{shlex.join(map(str, command))}\n{done.stdout}")
    return done.stdout


def build_tool(mutant, build, folder):
    """\\return s4tp_tool with the mutant for its guard, in `folder`"""
    database = json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))
    commands = {pathlib.Path(entry["file"]): shlex.split(entry["command"]) for entry in database}
    objects = []
    for file, text in planted(mutant).items():
        (folder / file).write_text(text, encoding="utf-8")
        objects.append(folder / f"{file}.o")
        command = [*commands[SAFETY / file], "-w"]
        command[command.index("-o") + 1] = objects[-1]
        command[command.index("-c") + 1] = folder / file
        execute(command, build)
    last = execute(["ninja", "-t", "commands", "s4tp_tool"], build).splitlines()[-1]
    link = shlex.split(last.removeprefix(": && ").removesuffix(" && :"))
    at = link.index("-o")
    link[at + 1] = folder / "s4tp_tool"
    execute([*link[:at], *objects, *link[at:]], build)
    return folder / "s4tp_tool"


@functools.cache
def own_touches(tool, planner, seed):
    """The cells of that seed in which somebody is touched by our own fault."""
    with tempfile.TemporaryDirectory() as folder:
        execute([tool, "eval", "--planner", planner, "--traffic", "adversary", "--scenarios", *SCENARIOS,
                 "--flavours", *FLAVOURS, "--episodes", "1", "--first-seed", seed, "--jobs", "1",
                 "--out", folder], ROOT)
        lines = (pathlib.Path(folder) / "episodes.jsonl").read_text(encoding="utf-8").splitlines()[1:]
    episodes = [json.loads(line) for line in lines]
    return {(episode["flavour"], episode["scenario"]) for episode in episodes if episode["collisions_at_fault"] > 0}


def seen(planner, mutated, unmutated):
    """(number of the drive, what it is) of each in which only the mutant touches; of a planner and a seed the two
    functions tell the cells in which somebody is touched."""
    for i, seed in enumerate(SEEDS):
        touched = mutated(planner, seed)
        new = touched - unmutated(planner, seed) if touched else touched
        for flavour, scenario in CELLS:
            if (flavour, scenario) in new:
                number = len(CELLS) * i + CELLS.index((flavour, scenario)) + 1
                yield number, f"{scenario} {flavour} {seed}"


def judge(name, mutant, mutated, unmutated):
    """(whether it is as it should be, in words)"""
    for planner in PLANNERS:
        for number, drive in seen(planner, mutated, unmutated):
            said = f"{name}: touches in {drive} ({planner}, drive {number})"
            return (False, f"{said}, but is said to live: {mutant.lives}") if mutant.lives else (True, said)
    return bool(mutant.lives), f"{name}: lives through {len(PLANNERS) * len(SEEDS) * len(CELLS)} drives"


def row(name, mutant, mutated, unmutated):
    """Of the table in docs/adversary.md: touches, and the drives until the first."""
    columns = []
    for planner in reversed(PLANNERS):
        found = list(seen(planner, mutated, unmutated))
        columns.append(f"{len(found)} ({found[0][0]})" if found else "0")
    return True, f"| `{name}` | {mutant.changed} | {' | '.join(columns)} |"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mutants", nargs="*", metavar="MUTANT", help=f"of {', '.join(MUTANTS)} (default all)")
    parser.add_argument("--count", action="store_true", help="drive all drives and print the table's rows")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/host",
                        help="a host build (default build/host)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="mutants at a time (default one a core)")
    options = parser.parse_args()
    unknown = set(options.mutants) - MUTANTS.keys()
    if unknown:
        parser.error(f"no such mutant: {', '.join(sorted(unknown))}")
    build = options.build.resolve()
    # The tool looks for its scenarios in the folders above it.
    with tempfile.TemporaryDirectory(dir=build, prefix="guard_mutants_") as above:
        def run(name):
            folder = pathlib.Path(above) / name
            folder.mkdir()
            try:
                tool = build_tool(MUTANTS[name], build, folder)
            except (ValueError, RuntimeError) as error:
                return False, f"{name}: {error}"
            tell = row if options.count else judge
            return tell(name, MUTANTS[name], functools.partial(own_touches, tool),
                        functools.partial(own_touches, build / "sim_host/s4tp_tool"))

        good = True
        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            for is_good, said in pool.map(run, options.mutants or MUTANTS):
                good = good and is_good
                print(said if is_good else f"FAULT: {said}", flush=True)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
