#!/usr/bin/env python3
"""Scenario folders on networks that are not of our own making.

    other_networks.py random    --first 0 --count 100 out/random      towns by SUMO's netgenerate
    other_networks.py motorway  --first 0 --count 100 out/motorway    motorway stretches with ramps by netconvert
    ./s4tp eval --roads out/random --traffic sumo --episodes 2

`./s4tp roads` draws the shapes of road that the planner is tuned on; these are there to find out what it does on others. A network
is a function of its number for one version of SUMO. Traffic is of cars alone, or with --mix of lorries, buses, motorcycles and
slow and hasty cars, too: the planner is made for cars (README), and what it does among others is to be known.
"""
import argparse
import collections
import heapq
import math
import pathlib
import random
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ET

MIX = """  <vTypeDistribution id="mix">
    <vType id="car" probability="0.62" speedFactor="normc(1,0.1,0.7,1.2)"/>
    <vType id="hasty" probability="0.08" accel="3.5" decel="6" sigma="0.8" tau="0.6" speedFactor="1.15" minGap="1.5"/>
    <vType id="truck" vClass="truck" probability="0.1" length="9" width="2.4" accel="1.3" decel="4" maxSpeed="22"/>
    <vType id="trailer" vClass="trailer" probability="0.04" length="15" width="2.5" accel="1" decel="4" maxSpeed="22"/>
    <vType id="bus" vClass="bus" probability="0.05" length="12" width="2.5" accel="1.2" decel="4" maxSpeed="22"/>
    <vType id="motorcycle" vClass="motorcycle" probability="0.07" length="2.2" width="0.9" accel="5" decel="8"/>
    <vType id="slow" probability="0.04" maxSpeed="6" accel="1.2" length="4" width="2"/>
  </vTypeDistribution>
"""


class Network:
    """What of a SUMO network a mission is chosen by."""

    def __init__(self, file: pathlib.Path):
        tree = ET.parse(file).getroot()
        self.edges = {e.get("id"): e for e in tree.findall("edge") if e.get("function") != "internal"}
        self.length_m = {i: float(e.find("lane").get("length")) for i, e in self.edges.items()}
        self.lanes = {i: len(e.findall("lane")) for i, e in self.edges.items()}
        self.after = collections.defaultdict(set)
        for c in tree.findall("connection"):
            if c.get("from") in self.edges and c.get("to") in self.edges:
                self.after[c.get("from")].add(c.get("to"))
        self.arms = collections.Counter(e.get("to") for e in self.edges.values())

    def ways_from(self, start: str) -> dict[str, list[str]]:
        """The shortest way to each edge that can be reached."""
        best = {start: (0.0, [start])}
        queue = [(0.0, start)]
        while queue:
            way_m, at = heapq.heappop(queue)
            if way_m > best[at][0]:
                continue
            for edge in sorted(self.after[at]):
                to_m = way_m + self.length_m[edge]
                if edge not in best or to_m < best[edge][0]:
                    best[edge] = (to_m, best[at][1] + [edge])
                    heapq.heappush(queue, (to_m, edge))
        return {edge: way for edge, (_, way) in best.items()}

    def heading(self, edge: str, at_end: bool) -> float:
        shape = [tuple(map(float, p.split(",")[:2])) for p in self.edges[edge].find("lane").get("shape").split()]
        (x0, y0), (x1, y1) = shape[-2:] if at_end else shape[:2]
        return math.atan2(y1 - y0, x1 - x0)

    def sharpest_deg(self, way: list[str]) -> float:
        """The sharpest turn from edge to edge."""
        turns = [self.heading(b, False) - self.heading(a, True) for a, b in zip(way, way[1:])]
        return max(abs(math.degrees(math.atan2(math.sin(t), math.cos(t)))) for t in turns)


def toml(comment: str, start: str, goal: str, entry_s: float, limit_s: float, entry_mps: float) -> str:
    return (
        f'# {comment}\n[network]\nfile = "net.xml"\n[traffic]\nroutes = ["rou.xml"]\n[mission]\nstart_lane = "{start}"\n'
        f'start_pos_m = 8.0\ngoal_lane = "{goal}"\ngoal_pos_m = -1.0\nentry_time_s = {entry_s}\n'
        f"time_limit_s = {limit_s:.0f}\nentry_speed_mps = {entry_mps:.1f}\n"
    )


def flows(pairs: list[tuple[str, str, float]], lane: str, mix: bool) -> str:
    kind = ' type="mix"' if mix else ""
    lines = [
        f'  <flow id="{i}"{kind} from="{a}" to="{b}" begin="0" end="400" departLane="{lane}" departSpeed="max" '
        f'period="exp({rate:.4f})"/>'
        for i, (a, b, rate) in enumerate(pairs)
    ]
    return "<routes>\n" + (MIX if mix else "") + "\n".join(lines) + "\n</routes>\n"


def town(rng: random.Random, file: pathlib.Path) -> list[str]:
    """What netgenerate is asked for."""
    shape = rng.choice(["rand", "rand", "grid", "spider"])
    junctions = ["priority", "priority", "right_before_left", "allway_stop", "priority_stop"]
    speeds = [8.33, 13.89, 13.89, 19.44, 27.78 if shape == "rand" else 13.89]
    ask = ["--output-file", str(file), "--seed", str(rng.randrange(1 << 20)), "--no-turnarounds", "true"]
    ask += ["--default-junction-type", rng.choice(junctions), "--default.speed", str(rng.choice(speeds))]
    ask += ["--default.lanenumber", str(rng.choice([1, 1, 2, 2, 3]))]
    for share, option in [
        (0.5, ["--random-lanenumber", "true"]),
        (0.6, ["--random-priority", "true"]),
        (0.3, ["--turn-lanes", "1", "--turn-lanes.length", str(rng.randint(15, 40))]),
        (0.3, ["--default.junctions.radius", str(rng.choice([2, 6, 10]))]),
        (0.3, ["--rectangular-lane-cut", "true"]),
        (0.3, ["--junctions.join", "true"]),
        (0.2, ["--default.lanewidth", str(rng.choice([2.8, 3.0, 3.75]))]),
        (0.5, ["--roundabouts.guess", "true"]),
    ]:
        if rng.random() < share:
            ask += option
    if shape == "rand":
        least_m = rng.randint(50, 110)
        ask += ["--rand", "--rand.iterations", str(rng.randint(8, 22)), "--rand.min-distance", str(least_m)]
        ask += ["--rand.max-distance", str(least_m + rng.randint(30, 150)), "--rand.min-angle", str(rng.randint(35, 60))]
        ask += ["--rand.connectivity", f"{rng.uniform(0.5, 0.98):.2f}"]
    elif shape == "grid":
        ask += ["--grid", "--grid.x-number", str(rng.randint(2, 4)), "--grid.y-number", str(rng.randint(1, 3))]
        ask += ["--grid.x-length", str(rng.randint(60, 180)), "--grid.y-length", str(rng.randint(60, 180))]
        ask += ["--grid.attach-length", str(rng.randint(60, 150))]
        if rng.random() < 0.6:
            shift = f"normal(0,{rng.randint(5, 20)})"
            ask += ["--perturb-x", shift, "--perturb-y", shift]
    else:
        ask += ["--spider", "--spider.arm-number", str(rng.randint(3, 7)), "--spider.circle-number", str(rng.randint(1, 3))]
        ask += ["--spider.space-radius", str(rng.randint(40, 120))]
        if rng.random() < 0.5:
            ask += ["--spider.omit-center", "true"]
    return ask


def draw_town(rng: random.Random, folder: pathlib.Path, sharpest_deg: float, mix: bool) -> bool:
    """A mission of 100 to 900 m over at least one junction. \\return False: there is none; draw again"""
    file = folder / "net.xml"
    ask = town(rng, file)
    if subprocess.run(["netgenerate", *ask], capture_output=True, check=False).returncode != 0:
        return False
    network = Network(file)
    missions = []
    for start, length_m in network.length_m.items():
        for goal, way in network.ways_from(start).items() if length_m >= 40 else []:
            way_m = sum(network.length_m[edge] for edge in way)
            crosses = any(network.arms[network.edges[edge].get("to")] >= 3 for edge in way[:-1])
            if not (3 <= len(way) <= 6 and crosses and 100 < way_m < 900 and network.length_m[goal] > 25):
                continue
            if network.sharpest_deg(way) <= sharpest_deg:
                missions.append((way, way_m))
    if not missions:
        return False
    way, way_m = rng.choice(missions)
    names = list(network.edges)
    ways = {edge: network.ways_from(edge) for edge in names}
    pairs = [(start, rng.choice(list(ways[start]))) for start in (rng.choice(names) for _ in range(rng.randint(8, 24)))]
    for _ in range(rng.randint(3, 8)):  # who comes into our way from elsewhere
        joint = rng.choice(way[1:])
        starts = [edge for edge in names if joint in ways[edge] and edge not in way]
        if starts:
            pairs.append((rng.choice(starts), rng.choice(list(ways[joint]))))
    rate = rng.uniform(0.01, 0.045)
    (folder / "rou.xml").write_text(flows([(a, b, rate) for a, b in pairs if a != b], "best", mix))
    lanes = [f"{edge}_{rng.randrange(network.lanes[edge])}" for edge in (way[0], way[-1])]
    comment = f"netgenerate {' '.join(ask[2:])}; {way_m:.0f} m: {' '.join(way)}"
    (folder / "scenario.toml").write_text(toml(comment, *lanes, 20.0, 60 + way_m / 3, 8.0))
    return True


def draw_motorway(rng: random.Random, folder: pathlib.Path, _sharpest_deg: float, mix: bool) -> bool:
    """On from the first ramp, off at the second, or through. \\return False: draw again"""
    limit_mps, ramp_mps = rng.choice([19.44, 22.22, 27.78, 33.33, 36.11]), rng.choice([11.11, 13.89, 16.67, 22.22])
    lanes, ramp_lanes = rng.randint(2, 4), rng.choice([1, 1, 2])
    on_m, between_m, after_m = rng.uniform(180, 300), rng.uniform(250, 450), rng.uniform(150, 300)
    bend_m, ramp_m, angle = rng.uniform(-40, 40), rng.uniform(90, 200), rng.uniform(0.15, 0.7)
    off_m = on_m + between_m
    nodes = {
        "w": (0.0, 0.0),
        "m": (on_m, rng.uniform(-5, 5)),
        "d": (off_m, bend_m),
        "e": (off_m + after_m, 1.5 * bend_m),
        "on": (on_m - ramp_m * math.cos(angle), -ramp_m * math.sin(angle) - 4),
        "off": (off_m + ramp_m * math.cos(angle), bend_m - ramp_m * math.sin(angle) - 4),
    }
    edges = [
        ("main1", "w", "m", lanes, limit_mps, 10),
        ("main2", "m", "d", lanes, limit_mps, 10),
        ("main3", "d", "e", lanes, limit_mps, 10),
        ("onramp", "on", "m", ramp_lanes, ramp_mps, 5),
        ("offramp", "d", "off", 1, ramp_mps, 5),
    ]
    node = [f'<node id="{i}" x="{x:.1f}" y="{y:.1f}" type="priority"/>' for i, (x, y) in nodes.items()]
    edge = [
        f'<edge id="{i}" from="{a}" to="{b}" numLanes="{n}" speed="{v}" priority="{p}"/>' for i, a, b, n, v, p in edges
    ]
    (folder / "n.nod.xml").write_text("<nodes>" + "".join(node) + "</nodes>")
    (folder / "n.edg.xml").write_text("<edges>" + "".join(edge) + "</edges>")
    ask = ["-n", str(folder / "n.nod.xml"), "-e", str(folder / "n.edg.xml"), "-o", str(folder / "net.xml")]
    if rng.random() < 0.75:
        ask += ["--ramps.guess", "true", "--ramps.min-highway-speed", "15", "--ramps.max-ramp-speed", "30"]
        ask += ["--ramps.ramp-length", str(rng.randint(80, 250))]
    asked = subprocess.run(["netconvert", *ask, "--no-turnarounds", "true"], capture_output=True, check=False)
    if asked.returncode != 0:
        return False
    network = Network(folder / "net.xml")
    start, goal = rng.choice([("onramp", "main3"), ("onramp", "main3"), ("main1", "offramp"), ("main1", "main3")])
    rate = 0.5 * lanes * rng.uniform(0.05, 0.25)
    pairs = [("main1", "main3", rate), ("main1", "offramp", 0.35 * rate), ("onramp", "main3", 0.4 * rate)]
    (folder / "rou.xml").write_text(flows(pairs + [("onramp", "offramp", 0.1 * rate)], "random", mix))
    entry_mps = min(ramp_mps, 15.0) if start == "onramp" else 0.7 * limit_mps
    ends = [f"{edge}_{rng.randrange(network.lanes[edge])}" for edge in (start, goal)]
    comment = f"{start} to {goal}, {limit_mps} m/s, {lanes} lanes; ramps {ramp_lanes}, {ramp_mps} m/s"
    (folder / "scenario.toml").write_text(toml(comment, *ends, 25.0, 90, entry_mps))
    return True


DRAW = {"random": draw_town, "motorway": draw_motorway}
TOOL = {"random": "netgenerate", "motorway": "netconvert"}
MOST_TRIES = 100


def draw_all(script: str, tool: str, kind: str, first: int, count: int, out: pathlib.Path, draw) -> int:
    """Draws `count` networks; each until there is a mission on it. \\return the exit status"""
    if shutil.which(tool) is None:
        print(f"{script}: there is no {tool} here; it comes with Debian's package sumo", file=sys.stderr)
        return 2
    for number in range(first, first + count):
        folder = out / f"{kind}_{number:05d}"
        for attempt in range(MOST_TRIES):
            shutil.rmtree(folder, ignore_errors=True)
            folder.mkdir(parents=True)
            if draw(random.Random(1000 * number + attempt), folder):
                break
        else:
            print(f"{script}: {folder}: nothing usable in {MOST_TRIES} tries", file=sys.stderr)
            return 1
    return 0


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("kind", choices=sorted(DRAW))
    parser.add_argument("--first", type=int, default=0, help="number of the first network")
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--sharpest", type=float, default=180.0, help="no mission with a sharper turn, in degrees")
    parser.add_argument("--mix", action="store_true", help="lorries, buses, motorcycles, too")
    parser.add_argument("out", type=pathlib.Path)
    args = parser.parse_args()

    def draw(rng: random.Random, folder: pathlib.Path) -> bool:
        return DRAW[args.kind](rng, folder, args.sharpest, args.mix)

    return draw_all("other_networks", TOOL[args.kind], args.kind, args.first, args.count, args.out, draw)


if __name__ == "__main__":
    sys.exit(main())
