#!/usr/bin/env python3
"""Who may include whom: fails on any include that this table does not allow, on a table by which rooms include each other,
and on a list of installed headers (algo/api/headers.txt) that is not what firmware includes and what those include in turn.

    check_includes.py [ROOT]
"""

import graphlib
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).parent.parent
HEADERS = "algo/api/headers.txt"


def installed(root):
    """(headers of the core for firmware and users, those that only come with them) as the list of `root` has them"""
    lines = [line for line in (root / HEADERS).read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    return [line for line in lines if line[0] != " "], [line.strip() for line in lines if line[0] == " "]


PUBLIC, _ = installed(ROOT)
# The core's folders, each with what it may include, in the order in which data flows. A name with .hpp is one header of a
# folder further on that still has to move down; no other one of it may be included.
ALGO = {
    "core": [],
    "scene": ["core/"],
    "occupancy": ["core/", "scene/"],
    "satp": ["core/", "scene/", "occupancy/"],
    "sadrf": ["core/", "scene/", "satp/", "trajectory/bicycle.hpp"],
    "behavior": ["core/", "scene/", "occupancy/"],
    "trajectory": ["core/", "scene/", "occupancy/", "satp/", "sadrf/", "behavior/"],
    # Never predictions, beliefs or the field: what protects must not rest on what decides.
    "safety": ["core/", "scene/", "occupancy/", *(f"trajectory/{name}.hpp" for name in (
        "along_path", "bicycle", "path_walk", "plan_limits", "speed_profile"))],
    "planner": [""],
    "api": [],
}
# The same for the world's rooms; the files directly in sim_host/world are the whole of it.
WORLD = {
    "map": [],
    "scenario": ["map/"],
    "traffic": ["map/", "scenario/"],
    "nodes": ["map/", "scenario/", "traffic/"],
    "judge": ["map/", "traffic/"],
    "adversary": ["map/", "scenario/", "traffic/", "judge/"],
}
# What only looks at the world.
MEASURING = {"metrics": ["world/"], "roads": ["world/"]}
# What drives a planner in it, all of them above the world, each by those before it. A planner is known by its name in the
# registry, and to nobody else.
REGISTRY = ["baselines/any_ecu.hpp", "baselines/planner_registry.hpp"]
DRIVING = {
    "baselines": ["metrics/"],
    "campaign": [*REGISTRY, "metrics/", "roads/", "sumo/"],
    "clips": [],
    "faults": [*REGISTRY, "campaign/fault_names.hpp", "metrics/"],
    "train": ["campaign/", "clips/"],
    "view": ["campaign/", "metrics/"],
    "recording": ["campaign/", "metrics/", "view/"],
    "telemetry": ["campaign/", "view/"],
    "processes": [*REGISTRY, "campaign/", "metrics/", "recording/", "telemetry/"],
}
# Room (longest prefix wins) -> prefixes of project headers it may include, besides its own.
ALLOWED = {
    **{f"algo/{room}/": [f"algo/{below}" for below in under] for room, under in ALGO.items()},
    "hal/": [],  # the interfaces: the files directly in hal/
    "hal/linux/": ["hal/"],
    "hal/mps/": ["hal/"],
    "hal/sim/": ["hal/"],
    "firmware/wire/": [],
    "firmware/gate/": ["firmware/wire/"],
    "firmware/can/": ["firmware/wire/", "hal/"],
    "firmware/ecu/": [*PUBLIC, "firmware/can/", "firmware/gate/", "firmware/wire/", "hal/"],
    "firmware/lockstep/": ["firmware/can/", "firmware/ecu/", "firmware/wire/", "hal/"],
    "firmware/secoc/": ["firmware/can/", "firmware/wire/", "hal/"],
    "firmware/targets/": [*PUBLIC, "firmware/", "hal/"],
    **{f"sim_host/world/{room}/": ["firmware/wire/", *(f"sim_host/world/{below}" for below in under)]
       for room, under in WORLD.items()},
    "sim_host/sumo/": [f"sim_host/world/{room}/" for room in ("map", "scenario", "traffic")],
    "sim_host/world/": ["firmware/wire/", "sim_host/sumo/", "sim_host/world/"],
    **{f"sim_host/{room}/": [f"sim_host/{below}" for below in under] for room, under in MEASURING.items()},
    **{f"sim_host/{room}/": ["algo/", *(f"firmware/{part}/" for part in ("can", "ecu", "gate", "lockstep", "secoc", "wire")), "hal/",
                             "sim_host/world/", *(f"sim_host/{below}" for below in under)]
       for room, under in DRIVING.items()},
    "sim_host/": ["algo/", "firmware/", "hal/", "sim_host/"],  # main.cpp and its commands, and the other programs
    "tests/": ["algo/", "firmware/", "hal/", "sim_host/", "tests/"],
}
# May not even be reached through a directory that is allowed: interfaces know no platform, nor does the ECU.
FORBIDDEN = {
    "firmware/ecu/": ["hal/linux/", "hal/mps/", "hal/sim/"],
    "firmware/secoc/": ["hal/linux/", "hal/mps/", "hal/sim/"],
    "hal/linux/": ["hal/mps/", "hal/sim/"],
    "hal/mps/": ["hal/linux/", "hal/sim/"],
    "hal/sim/": ["hal/linux/", "hal/mps/"],
}
# The core, the firmware and the interfaces: no library but the C++ headers that need none, and Eigen in algo's .cpp by
# way of one header. None of them is installed (algo/api/headers.txt): check_headers.py sees to that.
EIGEN_HEADER = "algo/core/linear_algebra.hpp"
FREESTANDING = ("algo/", "hal/", "firmware/")
STANDARD = {"cstdint", "cstddef", "cstring", "climits", "limits", "type_traits", "utility", "atomic", "array", "new",
            "stdint.h", "stddef.h",
            "arm_mve.h"}  # a vector instruction each, as the compiler has them
HOSTED_FILES = ("firmware/targets/platform_stdio.cpp", "hal/linux/")
ROOTS = ("algo", "hal", "firmware", "sim_host", "tests")

INCLUDE = re.compile(r'^\s*#\s*include\s*(["<])([^">]+)[">]')


def room_of(path):
    room = max((prefix for prefix in ALLOWED if path.startswith(prefix)), key=len, default=None)
    return room


def judge(path, quote, header):
    """The reason why `path` may not include `header`, or None."""
    room = room_of(path)
    if room is None:
        return "stands in no room of the table"
    if quote == '"':
        if header.split("/")[0] not in ROOTS:
            return "project headers are named from the root"
        if any(header.startswith(prefix) for prefix in FORBIDDEN.get(room, [])):
            return f"{room} knows no platform"
        if room_of(header) == room or any(header.startswith(prefix) for prefix in ALLOWED[room]):
            return None
        return f"{room} may include only {', '.join([room] + ALLOWED[room])}"
    if not room.startswith(FREESTANDING) or path.startswith(HOSTED_FILES) or header in STANDARD:
        return None
    if header.split("/")[0] in ("Eigen", "unsupported"):
        return None if path == EIGEN_HEADER else f"Eigen only by way of {EIGEN_HEADER}"
    return "the core uses no such library"


def circle(allowed):
    """Rooms that the table lets include each other, as a finding; headers it names one by one do not count."""
    graph = {}
    for room, prefixes in allowed.items():
        refused = tuple(FORBIDDEN.get(room, ()))
        graph[room] = {other for other in allowed for prefix in prefixes
                       if other != room and other.startswith(prefix) and not other.startswith(refused)}
    try:
        graphlib.TopologicalSorter(graph).prepare()
    except graphlib.CycleError as error:
        return [f"the table lets these include each other: {' <- '.join(error.args[1])}"]
    return []


def core_includes(text):
    return {match[2] for match in map(INCLUDE.match, text.splitlines()) if match and match[2].startswith("algo/")}


def list_findings(root):
    """What is wrong with the list of installed headers."""
    public, others = installed(root)
    reached, to_read = set(), set(public)
    while to_read:
        reached |= to_read
        to_read = set().union(*(core_includes((root / header).read_text(encoding="utf-8")) for header in to_read)) - reached
    firmware = [file for file in (root / "firmware").rglob("*") if file.suffix in (".hpp", ".cpp")]
    used = set().union(*(core_includes(file.read_text(encoding="utf-8")) for file in firmware))
    return [*(f"{HEADERS}: {header}: no firmware includes it" for header in sorted(set(public) - used)),
            *(f"{HEADERS}: {header}: is missing, a header of the list includes it" for header in sorted(reached - {*public, *others})),
            *(f"{HEADERS}: {header}: no header at the margin needs it" for header in sorted(set(others) - reached | set(public) & set(others)))]


def findings(root):
    result = circle(ALLOWED)
    for folder in ROOTS:
        for file in sorted((root / folder).rglob("*")):
            if file.suffix not in (".hpp", ".cpp", ".h", ".c", ".def"):
                continue
            path = file.relative_to(root).as_posix()
            for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
                match = INCLUDE.match(line)
                reason = match and judge(path, match[1], match[2])
                if reason:
                    result.append(f"{path}:{number}: includes {match[2]}: {reason}")
    return result


def main(arguments):
    root = pathlib.Path(arguments[0]) if arguments else ROOT
    found = findings(root) + list_findings(root)
    print("\n".join(found) if found else "includes: all allowed by the table")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
