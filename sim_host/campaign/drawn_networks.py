#!/usr/bin/env python3
"""Scenario folders on junctions as people draw them, by SUMO's netconvert.

    drawn_networks.py crossroads --first 0 --count 100 out/crossroads   one junction, 3 to 5 arms of 1 to 4 lanes at odd angles, bent
    drawn_networks.py arterial   --first 0 --count 100 out/arterial     2 to 4 of them in a row, lanes come and go
    drawn_networks.py roundabout --first 0 --count 100 out/roundabout   3 to 5 arms, 1 or 2 lanes, radius 10 to 30 m
    ./s4tp eval --roads out/crossroads --traffic sumo --episodes 1

As `other_networks.py`, to find out what the planner does on roads it was not tuned on. A network is a function of its number for one
version of SUMO. Traffic is of cars, medium; with --busy crossroads carry more than they can.
"""
import argparse
import math
import pathlib
import random
import subprocess
import sys

import other_networks as other

Point = tuple[float, float]


def at(point: Point) -> str:
    return f"{point[0]:.1f},{point[1]:.1f}"


def beside(point: Point, heading_rad: float, left_m: float) -> Point:
    return point[0] - left_m * math.sin(heading_rad), point[1] + left_m * math.cos(heading_rad)


def convert(folder: pathlib.Path, nodes: str, edges: str) -> bool:
    """Writes the plain files and has netconvert make net.xml of them."""
    (folder / "n.nod.xml").write_text(f"<nodes>{nodes}</nodes>")
    (folder / "n.edg.xml").write_text(f"<edges>{edges}</edges>")
    ask = ["netconvert", "-n", str(folder / "n.nod.xml"), "-e", str(folder / "n.edg.xml"), "--no-turnarounds", "true"]
    asked = subprocess.run([*ask, "-o", str(folder / "net.xml")], capture_output=True, check=False)
    return asked.returncode == 0


def edge(name: str, start: str, end: str, lanes: int, limit_mps: float, priority: int, width_m: float, shape: str) -> str:
    return (
        f'<edge id="{name}" from="{start}" to="{end}" numLanes="{lanes}" speed="{limit_mps}" priority="{priority}" '
        f'width="{width_m}" shape="{shape}"/>'
    )


def write(rng: random.Random, folder: pathlib.Path, network: other.Network, way: list[str], pairs, entry_s: float, limit_s: float):
    (folder / "rou.xml").write_text(other.flows(pairs, "best", False))
    ends = [f"{name}_{rng.randrange(network.lanes[name])}" for name in (way[0], way[-1])]
    (folder / "scenario.toml").write_text(other.toml(" ".join(way), *ends, entry_s, limit_s, 8.0))


def draw_crossroads(rng: random.Random, folder: pathlib.Path, busy: bool) -> bool:
    """From any arm to any other. \\return False: netconvert can make nothing of it; draw again"""
    arms = rng.choice([3, 4, 4, 4, 5])
    first_deg = rng.uniform(0, 360)
    turns_deg = [0, 90, 180] if arms == 3 else [360 / arms * i for i in range(arms)]
    angles = [math.radians(first_deg + turn + rng.uniform(-20, 20)) for turn in turns_deg]
    kind = rng.choice(["priority"] * 5 + ["right_before_left", "allway_stop", "priority_stop"])
    major = rng.randint(1, 4), rng.choice([11.11, 13.89, 16.67, 19.44, 22.22])
    minor = rng.randint(1, 3), rng.choice([8.33, 11.11, 13.89])
    ends, roads = [], []
    for i, angle in enumerate(angles):
        big = {3: i != 1, 5: i in (0, 2)}.get(arms, i % 2 == 0)
        lanes, limit_mps = major if big else minor
        length_m, bend_m = rng.uniform(90, 200), rng.uniform(-25, 25)
        end = length_m * math.cos(angle), length_m * math.sin(angle)
        middle = beside((0.55 * end[0], 0.55 * end[1]), angle, 0.6 * bend_m)
        into = min(max(1, lanes + rng.choice([0, 0, 0, 1])), 4)
        ends.append((f"n{i}", end))
        roads.append((f"i{i}", f"n{i}", "c", into, limit_mps, 10 if big else 3, f"{at(end)} {at(middle)} 0,0"))
        roads.append((f"o{i}", "c", f"n{i}", lanes, limit_mps, 10 if big else 3, f"0,0 {at(middle)} {at(end)}"))
    width_m = rng.choice([3.0, 3.2, 3.5, 3.75])
    nodes = f'<node id="c" x="0" y="0" type="{kind}" radius="{rng.choice([3, 6, 10])}"/>'
    nodes += "".join(f'<node id="{i}" x="{x:.1f}" y="{y:.1f}" type="dead_end"/>' for i, (x, y) in ends)
    if not convert(folder, nodes, "".join(edge(*road[:6], width_m, road[6]) for road in roads)):
        return False
    network = other.Network(folder / "net.xml")
    starts = [name for name in network.edges if name.startswith("i") and network.after[name]]
    if not starts:
        return False
    start = rng.choice(starts)
    way = [start, rng.choice(sorted(network.after[start]))]
    pairs = []
    for name in starts:
        big = float(network.edges[name].get("priority")) > 5
        rate = rng.uniform(*((0.08, 0.22) if busy else (0.03, 0.09)))
        rate *= (1.0 if big else 0.35) * (1 + 0.3 * (network.lanes[name] - 1))
        outs = sorted(network.after[name])
        shares = [rng.uniform(0.1, 0.3) if network.sharpest_deg([name, out]) > 45 else 1.0 for out in outs]
        pairs += [(name, out, rate * share / sum(shares)) for out, share in zip(outs, shares)]
    write(rng, folder, network, way, pairs, 20.0, 80)
    return True


def draw_arterial(rng: random.Random, folder: pathlib.Path, _busy: bool) -> bool:
    """Through, into it or out of it, over three edges or more. \\return False: no such way; draw again"""
    count, heading_rad = rng.randint(2, 4), rng.uniform(-3, 3)
    kind = rng.choice(["priority"] * 6 + ["right_before_left", "allway_stop"])
    points: list[Point] = [(0.0, 0.0)]
    for _ in range(count + 1):
        length_m = rng.uniform(80, 180)
        heading_rad += rng.uniform(-0.5, 0.5)
        x, y = points[-1]
        points.append((x + length_m * math.cos(heading_rad), y + length_m * math.sin(heading_rad)))
    places = {f"m{i}": point for i, point in enumerate(points)}
    junctions = {f"m{i}" for i in range(1, count + 1)}
    limit_mps, width_m = rng.choice([11.11, 13.89, 16.67, 19.44, 22.22]), rng.choice([3.0, 3.2, 3.5])
    lanes, roads = rng.randint(1, 3), []
    for i, (a, b) in enumerate(zip(points, points[1:])):
        along_rad = math.atan2(b[1] - a[1], b[0] - a[0])
        shape = [a, *(beside((a[0] + q * (b[0] - a[0]), a[1] + q * (b[1] - a[1])), along_rad, rng.uniform(-8, 8)) for q in (0.3, 0.65)), b]
        lanes = max(1, min(4, lanes + rng.choice([-1, 0, 0, 0, 1])))
        back = max(1, min(4, lanes + rng.choice([-1, 0, 0, 1])))
        roads.append((f"f{i}", f"m{i}", f"m{i + 1}", lanes, limit_mps, 8, width_m, " ".join(map(at, shape))))
        roads.append((f"b{i}", f"m{i + 1}", f"m{i}", back, limit_mps, 8, width_m, " ".join(map(at, shape[::-1]))))
    for i in range(1, count + 1):
        (x0, y0), (x1, y1) = points[i - 1], points[i + 1]
        along_rad = math.atan2(y1 - y0, x1 - x0)
        for side in rng.choice([(1,), (-1,), (1, -1), (1, -1)]):
            turned_rad = along_rad + side * math.pi / 2 + rng.uniform(-0.4, 0.4)
            length_m = rng.uniform(70, 120)
            end = points[i][0] + length_m * math.cos(turned_rad), points[i][1] + length_m * math.sin(turned_rad)
            name = f's{i}{"l" if side > 0 else "r"}'
            places[name] = end
            into, side_mps, priority = rng.randint(1, 2), rng.choice([8.33, 11.11, 13.89]), rng.choice([2, 2, 2, 8])
            roads.append((name + "i", name, f"m{i}", into, side_mps, priority, width_m, f"{at(end)} {at(points[i])}"))
            out = rng.randint(1, 2)
            roads.append((name + "o", f"m{i}", name, out, side_mps, priority, width_m, f"{at(points[i])} {at(end)}"))
    nodes = "".join(
        f'<node id="{i}" x="{x:.1f}" y="{y:.1f}" type="{kind if i in junctions else "dead_end"}"/>' for i, (x, y) in places.items()
    )
    if not convert(folder, nodes, "".join(edge(*road) for road in roads)):
        return False
    network = other.Network(folder / "net.xml")
    starts = [name for name, e in network.edges.items() if e.get("from") not in junctions]
    goals = [name for name, e in network.edges.items() if e.get("to") not in junctions]
    ways = [
        way
        for start in starts
        for goal, way in network.ways_from(start).items()
        if goal in goals and 3 <= len(way) <= 6 and network.sharpest_deg(way) < 125
    ]
    if not ways:
        return False
    way = rng.choice(ways)
    pairs = []
    for start in starts:
        big = start[0] in "fb"
        rate = rng.uniform(0.03, 0.10) * (1.0 if big else 0.4) * (1 + 0.3 * (network.lanes[start] - 1))
        reached = network.ways_from(start)
        outs = [goal for goal in goals if goal in reached and goal != start]
        if not outs:
            continue
        outs = rng.sample(outs, min(len(outs), 3))
        shares = [3.0 if big and out[0] in "fb" else 1.0 for out in outs]
        pairs += [(start, out, rate * share / sum(shares)) for out, share in zip(outs, shares)]
    write(rng, folder, network, way, pairs, 25.0, 50 + sum(network.length_m[name] for name in way) / 4)
    return True


def draw_roundabout(rng: random.Random, folder: pathlib.Path, _busy: bool) -> bool:
    """From any arm to any other. \\return False: netconvert can make nothing of it; draw again"""
    arms, radius_m, lanes, first_deg = rng.randint(3, 5), rng.uniform(10, 30), rng.choice([1, 1, 2]), rng.uniform(0, 360)
    angles = [math.radians(first_deg + 360 / arms * i + rng.uniform(-15, 15)) for i in range(arms)]
    ring_mps, limit_mps = rng.choice([6.94, 8.33, 11.11]), rng.choice([11.11, 13.89, 16.67])
    ends: list[Point] = []
    for angle in angles:
        length_m = radius_m + rng.uniform(80, 150)
        ends.append((length_m * math.cos(angle), length_m * math.sin(angle)))
    roads = []
    for i, angle in enumerate(angles):
        following = angles[(i + 1) % arms]
        while following < angle:
            following += 2 * math.pi
        on_ring = [angle + (following - angle) * k / 8 for k in range(9)]
        ring = " ".join(f"{radius_m * math.cos(a):.2f},{radius_m * math.sin(a):.2f}" for a in on_ring)
        roads.append((f"c{i}", f"r{i}", f"r{(i + 1) % arms}", lanes, ring_mps, 9, 3.5, ring))
        into, (x, y) = rng.choice([1, lanes]), ends[i]
        middle = beside((0.6 * x, 0.6 * y), angle, rng.uniform(-6, 6))
        shape = [(x, y), middle, (radius_m * math.cos(angle), radius_m * math.sin(angle))]
        roads.append((f"i{i}", f"a{i}", f"r{i}", into, limit_mps, 3, 3.5, " ".join(map(at, shape))))
        roads.append((f"o{i}", f"r{i}", f"a{i}", rng.choice([1, lanes]), limit_mps, 3, 3.5, " ".join(map(at, shape[::-1]))))
    nodes = "".join(
        f'<node id="r{i}" x="{radius_m * math.cos(a):.1f}" y="{radius_m * math.sin(a):.1f}" type="priority"/>'
        f'<node id="a{i}" x="{ends[i][0]:.1f}" y="{ends[i][1]:.1f}" type="dead_end"/>'
        for i, a in enumerate(angles)
    )
    ring = f'<roundabout nodes="{" ".join(f"r{i}" for i in range(arms))}" edges="{" ".join(f"c{i}" for i in range(arms))}"/>'
    if not convert(folder, nodes, "".join(edge(*road) for road in roads) + ring):
        return False
    network = other.Network(folder / "net.xml")
    start = rng.choice([f"i{i}" for i in range(arms)])
    goals = {f"i{i}": [f"o{k}" for k in range(arms) if k != i and f"o{k}" in network.ways_from(f"i{i}")] for i in range(arms)}
    if not goals[start]:
        return False
    way = [start, rng.choice(goals[start])]
    pairs = []
    for name, outs in goals.items():
        rate = rng.uniform(0.04, 0.12)
        pairs += [(name, out, rate / len(outs)) for out in outs]
    write(rng, folder, network, way, pairs, 20.0, 80)
    return True


DRAW = {"crossroads": draw_crossroads, "arterial": draw_arterial, "roundabout": draw_roundabout}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("kind", choices=sorted(DRAW))
    parser.add_argument("--first", type=int, default=0, help="number of the first network")
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--busy", action="store_true", help="crossroads: more traffic than they can carry")
    parser.add_argument("out", type=pathlib.Path)
    args = parser.parse_args()

    def draw(rng: random.Random, folder: pathlib.Path) -> bool:
        return DRAW[args.kind](rng, folder, args.busy)

    return other.draw_all("drawn_networks", "netconvert", args.kind, args.first, args.count, args.out, draw)


if __name__ == "__main__":
    sys.exit(main())
