#!/usr/bin/env python3
"""Draws roads nobody has tuned anything to: road_NUMBER.net.xml and .toml, the same for the same number on every machine.

    random_roads.py --first 0 --count 10 --out tests/networks/roads     the committed ones: a regression set
    random_roads.py --first 10000 --count 50 --out DIR                  as many new ones as you like, to report on

Each number draws one kind of road, its angles, lengths, lanes, limits and right of way, a mission through it, and its
traffic, in both flavours. Needs netconvert (Debian package sumo).
"""
import argparse
import math
import pathlib
import random

from build import arms, build_network

JUNCTIONS = ["priority", "priority", "priority_stop", "allway_stop", "right_before_left", "unregulated"]
LIMITS_MPS = [8.33, 11.11, 13.89, 16.67]


def angles(draw, count):
    """Arms at least 55 degrees apart, so that they do not lie on each other."""
    while True:
        drawn = sorted(draw.uniform(0, 360) for _ in range(count))
        if min((b - a) % 360 for a, b in zip(drawn, drawn[1:] + drawn[:1])) >= 55:
            return drawn


def crossing(draw):
    count = draw.choice([3, 3, 4, 4, 4])
    kind = draw.choice(JUNCTIONS)
    main = draw.sample(range(count), 2)
    lanes = draw.choice([1, 1, 2, 2, 3]) if kind.startswith("priority") else 1
    names = "stuv"[:count]
    priorities = [5 if k in main else 1 for k in range(count)]
    if not kind.startswith("priority"):
        priorities = [1] * count
    nodes, edges = arms(angles(draw, count), draw.uniform(70, 140), kind, speed=draw.choice(LIMITS_MPS),
                        priorities=priorities, names=names)
    for k in main:
        for way in ("_in", "_out"):
            start, end, _, speed, extra = edges[names[k] + way]
            edges[names[k] + way] = (start, end, lanes, speed, extra)
    begin, end = draw.sample(names, 2)
    flows = [(f"{a}_in", f"{b}_out") for a in names for b in names if a != b and a != begin]
    mission = (f"{begin}_in", f"{end}_out")
    return nodes, edges, [], mission, flows, draw.randint(2, 4), 5.0


def ramp(draw):
    lanes = draw.choice([1, 2, 3])
    speed = draw.choice([13.89, 16.67, 22.22])
    zone = draw.uniform(60, 140)
    nodes = {"a": (-150, 0, "dead_end"), "r": (-90, -draw.uniform(18, 40), "dead_end"),
             "j": (0, 0, "priority"), "k": (zone, 0, "priority"), "b": (zone + draw.uniform(60, 200), 0, "dead_end")}
    edges = {"main": ("a", "j", lanes, speed, {"priority": 9}), "ramp": ("r", "j", 1, min(speed, 13.89), {"priority": 1}),
             "both": ("j", "k", lanes + 1, speed, {"priority": 9}), "on": ("k", "b", lanes, speed, {"priority": 9})}
    ways = [("ramp", "both", 0, 0)] + [("main", "both", i, i + 1) for i in range(lanes)]
    ways += [("both", "on", i + 1, i) for i in range(lanes)]
    return nodes, edges, ways, ("ramp", "on"), [("main", "on")], 1, 12.0 * lanes


def bend(draw):
    radius, lanes, turn = draw.uniform(35, 110), draw.choice([1, 2, 2, 3]), draw.choice([-1, 1])
    far = math.radians(draw.uniform(60, 160))
    points = [(radius * math.sin(t), turn * radius * (1 - math.cos(t))) for t in (far * k / 24 for k in range(25))]
    # and back again: an S
    out = [(2 * points[-1][0] - x, 2 * points[-1][1] - y) for x, y in reversed(points[:-1])]
    points += out
    nodes = {"a": (*points[0], "dead_end"), "b": (*points[-1], "dead_end")}
    shape = " ".join(f"{x:.3f},{y:.3f}" for x, y in points)
    edges = {"bend": ("a", "b", lanes, draw.choice([11.11, 13.89]), {"shape": shape})}
    return nodes, edges, [], ("bend", "bend"), [("bend", "bend")], 1, 8.0 * lanes


def late_changes(draw):
    """A road that widens before a crossing: the lane needed is one or two to the side, with little room to get there."""
    nodes, edges = arms([0, 180, 90, 270], 130, "priority", priorities=[5, 5, 1, 1], names="ewns")
    room, lanes = draw.uniform(45, 80), draw.choice([2, 3])
    nodes["m"] = (-room, 0, "priority")
    del edges["w_in"]
    edges["w_far"] = ("w", "m", 1, 13.89, {"priority": 5})
    edges["w_in"] = ("m", "c", lanes, 13.89, {"priority": 5})
    wide = draw.choice([0, lanes - 1])
    ways = [("w_far", "w_in", 0, wide), ("w_in", "s_out", 0, 0), ("w_in", "n_out", lanes - 1, 0),
            ("w_in", "e_out", 1 if lanes == 3 else 0, 0)]
    goal = "s_out" if wide == lanes - 1 else "n_out"
    return nodes, edges, ways, ("w_far", goal), [("w_far", "e_out"), ("e_in", "w_out"), ("n_in", "s_out")], 2, 5.0


def lane_drop(draw):
    lanes = draw.choice([2, 3, 4])
    nodes = {"a": (0, 0, "dead_end"), "z": (140, 0, draw.choice(["zipper", "priority"])), "b": (280, 0, "dead_end")}
    edges = {"wide": ("a", "z", lanes, 13.89, {}), "narrow": ("z", "b", lanes - 1, 13.89, {})}
    ways = [("wide", "narrow", i, max(0, i - 1)) for i in range(lanes)]
    if nodes["z"][2] == "priority":
        ways = [way for way in ways if way[2] != 0]
    return nodes, edges, ways, ("wide", "narrow"), [("wide", "narrow")], 1, 6.0 * lanes


KINDS = [crossing, crossing, crossing, ramp, bend, late_changes, lane_drop]


def lane_of(draw, edges, edge):
    return f"{edge}_{draw.randrange(edges[edge][2])}"


def road(number, out):
    draw = random.Random(number)
    nodes, edges, ways, (begin, end), flows, choose, per_minute = draw.choice(KINDS)(draw)
    name = f"road_{number:05d}"
    turn, at = draw.uniform(0, 2 * math.pi), (draw.uniform(-5000, 5000), draw.uniform(-5000, 5000))

    def placed(x, y):
        return (at[0] + x * math.cos(turn) - y * math.sin(turn), at[1] + x * math.sin(turn) + y * math.cos(turn))

    nodes = {k: (*placed(v[0], v[1]), v[2]) for k, v in nodes.items()}
    for k, (a, b, lanes, speed, extra) in edges.items():
        if "shape" in extra:
            shape = [placed(*map(float, p.split(","))) for p in extra["shape"].split()]
            edges[k] = (a, b, lanes, speed, {**extra, "shape": " ".join(f"{x:.3f},{y:.3f}" for x, y in shape)})
    build_network(out / f"{name}.net.xml", nodes, edges, ways, {})

    goal = lane_of(draw, edges, end)
    start = lane_of(draw, edges, begin)
    routes = ",\n".join("  { edges = [%s] }" % ", ".join(f'"{e}"' for e in dict.fromkeys(flow)) for flow in way_of(flows, edges))
    low, high = per_minute * 0.5, per_minute * 1.5
    (out / f"{name}.toml").write_text(f"""# Drawn by tests/networks/random_roads.py.
[network]
file = "{name}.net.xml"

[mission]
start_lane = "{start}"
start_pos_m = 15.0
goal_lane = "{goal}"
goal_pos_m = -1.0
entry_time_s = {draw.uniform(8, 20):.1f}
time_limit_s = 80.0
entry_speed_mps = {draw.uniform(5, 9):.1f}

[[traffic.flow]]
choose = [1, {min(choose, len(flows))}]
vehicles_per_minute = [{low:.1f}, {high:.1f}]
begin_s = [0, 3]
spacing = "random"
routes = [
{routes},
]

[flavour.social.traffic]
mix = "MIX"
""")


def way_of(flows, edges):
    """Each flow as the list of its edges; the only ways longer than two edges are those on ramps and widenings."""
    middle = {("main", "on"): ["main", "both", "on"], ("w_far", "e_out"): ["w_far", "w_in", "e_out"]}
    return [middle.get(flow, list(flow)) for flow in flows]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=10)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    given = parser.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    mix = pathlib.Path(__file__).resolve().parents[2] / "sim_host" / "scenarios" / "social.toml"
    for number in range(given.first, given.first + given.count):
        road(number, given.out)
        file = given.out / f"road_{number:05d}.toml"
        here = given.out.resolve()
        shared = pathlib.Path(*[".."] * (len(here.parts) - len(mix.parents[2].parts))) if here.is_relative_to(mix.parents[2]) else None
        file.write_text(file.read_text().replace("MIX", str(shared / mix.relative_to(mix.parents[2]) if shared else mix)))


if __name__ == "__main__":
    main()
