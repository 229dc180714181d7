#!/usr/bin/env python3
"""Builds NAME.net.xml, .rou.xml and .toml for every network below (needs netconvert, Debian package sumo).

What it writes is committed: the tests need no SUMO. Nodes: id -> (x, y, type); edges: id -> (from, to, lanes, speed,
extras); connections: (from, to, from lane, to lane) where netconvert's own guess is not meant.
"""
import math
import pathlib
import re
import subprocess
import sys
import tempfile
from xml.sax.saxutils import quoteattr

HERE = pathlib.Path(__file__).parent


def arms(angles_deg, length_m, kind, lanes=1, at=(0.0, 0.0), speed=13.89, priorities=None, names="nesw"):
    """A junction with one road each way along every angle."""
    nodes = {"c": (*at, kind)}
    edges = {}
    for k, angle in enumerate(angles_deg):
        name = names[k]
        a = math.radians(angle)
        nodes[name] = (at[0] + length_m * math.cos(a), at[1] + length_m * math.sin(a), "dead_end")
        extra = {"priority": priorities[k]} if priorities else {}
        edges[name + "_in"] = (name, "c", lanes, speed, extra)
        edges[name + "_out"] = ("c", name, lanes, speed, extra)
    return nodes, edges


def skewed():
    return (*arms([37, 100, 217, 280], 80, "priority", priorities=[5, 1, 5, 1], names="enws"), [], {})


def all_way_stop():
    return (*arms([90, 0, 270, 180], 80, "allway_stop"), [], {})


def right_before_left():
    return (*arms([90, 0, 270, 180], 80, "right_before_left", speed=8.33), [], {})


def zipper():
    nodes = {"a": (0, 0, "dead_end"), "z": (120, 0, "zipper"), "b": (240, 0, "dead_end")}
    edges = {"two": ("a", "z", 2, 13.89, {}), "one": ("z", "b", 1, 13.89, {})}
    return nodes, edges, [("two", "one", 0, 0), ("two", "one", 1, 0)], {}


def roundabout():
    nodes, edges = {}, {}
    for k, name in enumerate("esnw"):
        angle = {"e": 0, "n": 90, "w": 180, "s": 270}[name]
        a = math.radians(angle)
        nodes["r" + name] = (18 * math.cos(a), 18 * math.sin(a), "priority")
        nodes[name] = (90 * math.cos(a), 90 * math.sin(a), "dead_end")
        edges[name + "_in"] = (name, "r" + name, 1, 11.11, {"priority": 1})
        edges[name + "_out"] = ("r" + name, name, 1, 11.11, {"priority": 1})
    ring = "enws"
    for k, name in enumerate(ring):
        after = ring[(k + 1) % 4]
        start = {"e": 0, "n": 90, "w": 180, "s": 270}[name]
        shape = " ".join("%.3f,%.3f" % (18 * math.cos(math.radians(start + d)), 18 * math.sin(math.radians(start + d)))
                         for d in range(0, 91, 9))
        edges["ring_" + name] = ("r" + name, "r" + after, 1, 8.33, {"priority": 3, "shape": shape})
    return nodes, edges, [], {}


def tee():
    return (*arms([0, 180, 270], 80, "priority", priorities=[5, 5, 1], names="ews"), [], {})


def four_lanes():
    nodes, edges = arms([0, 180], 120, "priority", lanes=4, priorities=[5, 5], names="ew")
    nodes["s"] = (0, -80, "dead_end")
    edges["s_in"] = ("s", "c", 2, 13.89, {"priority": 1})
    edges["s_out"] = ("c", "s", 1, 13.89, {"priority": 1})
    return nodes, edges, [], {}


def short_ramp():
    nodes = {"a": (-150, 0, "dead_end"), "r": (-100, -30, "dead_end"), "j": (0, 0, "priority"),
             "k": (50, 0, "priority"), "b": (200, 0, "dead_end")}
    edges = {"main": ("a", "j", 2, 22.22, {"priority": 9}), "ramp": ("r", "j", 1, 13.89, {"priority": 1}),
             "both": ("j", "k", 3, 22.22, {"priority": 9}), "on": ("k", "b", 2, 22.22, {"priority": 9})}
    return nodes, edges, [("ramp", "both", 0, 0), ("main", "both", 0, 1), ("main", "both", 1, 2),
                          ("both", "on", 1, 0), ("both", "on", 2, 1)], {}


def curve():
    nodes = {"a": (0, 0, "dead_end"), "b": (0, 120, "dead_end")}
    shape = " ".join("%.3f,%.3f" % (60 + 60 * math.sin(math.radians(d)), 60 - 60 * math.cos(math.radians(d)))
                     for d in range(0, 181, 6))
    edges = {"bend": ("a", "b", 2, 13.89, {"shape": "0,0 " + shape + " 0,120", "shoulder": True})}
    return nodes, edges, [], {}


def late_changes():
    nodes, edges = arms([0, 180, 90, 270], 120, "priority", priorities=[5, 5, 1, 1], names="ewns")
    nodes["m"] = (-60, 0, "priority")
    del edges["w_in"]
    edges["w_far"] = ("w", "m", 1, 13.89, {"priority": 5})
    edges["w_in"] = ("m", "c", 3, 13.89, {"priority": 5})
    return nodes, edges, [("w_far", "w_in", 0, 2), ("w_in", "s_out", 0, 0), ("w_in", "e_out", 1, 0),
                          ("w_in", "n_out", 2, 0)], {}


def far_away():
    nodes, edges = arms([20, 110, 200, 290], 80, "priority", priorities=[5, 1, 5, 1], at=(691234.56, 5336789.01),
                        names="enws")
    return nodes, edges, [], {}


def strange_names():
    nodes, edges = arms([0, 180, 270], 80, "priority", priorities=[5, 5, 1], names="ews")
    new = {"e_in": "-12#3", "e_out": "12#3", "w_in": "gneE:4", "w_out": "-gneE:4", "s_in": "Straße_0", "s_out": "a+b.1_0"}
    return nodes, {new[k]: v for k, v in edges.items()}, [], {}


def no_inner_lanes():
    nodes, edges = arms([0, 180, 270], 80, "priority", priorities=[5, 5, 1], names="ews", lanes=1)
    return nodes, edges, [], {"--no-internal-links": "true"}


def unregulated():
    return (*arms([90, 0, 270, 180], 80, "unregulated"), [], {})


def stop_signs():
    return (*arms([90, 0, 270, 180], 80, "priority_stop", priorities=[1, 5, 1, 5]), [], {})


def signals():
    return (*arms([90, 0, 270, 180], 80, "traffic_light", priorities=[1, 5, 1, 5]), [], {})


def sharp_fast():
    """Roads of 28 m/s with a turn by 119 degrees; the goal lane leads on into the next junction."""
    nodes = {"a": (-200, 60, "dead_end"), "b": (0, 0, "priority"), "c": (190, 110, "priority"), "d": (0, 230, "priority"),
             "e": (-150, 330, "dead_end"), "x": (120, -120, "dead_end"), "y": (330, 80, "dead_end"), "z": (120, 330, "dead_end")}
    edges = {}
    for near, far in (("a", "b"), ("b", "c"), ("c", "d"), ("d", "e"), ("b", "x"), ("c", "y"), ("d", "z")):
        edges[f"{near}_{far}"] = (near, far, 1, 27.78, {})
        edges[f"{far}_{near}"] = (far, near, 1, 27.78, {})
    return nodes, edges, [], {}


# What is driven there: (start lane, goal lane), further missions as flavours, and who else drives: (from, to, cars/h).
SCENARIOS = {
    "skewed": ("s_in_0", "w_out_0", {}, [("e_in", "w_out", 300), ("n_in", "s_out", 150), ("w_in", "e_out", 300)]),
    "all_way_stop": ("s_in_0", "w_out_0", {}, [("n_in", "s_out", 200), ("e_in", "w_out", 200), ("w_in", "e_out", 200)]),
    "right_before_left": ("s_in_0", "n_out_0", {}, [("e_in", "w_out", 200), ("w_in", "e_out", 200), ("n_in", "e_out", 100)]),
    "zipper": ("two_0", "one_0", {"left": ("two_1", "one_0")}, [("two", "one", 700)]),
    "roundabout": ("s_in_0", "w_out_0", {"right": ("s_in_0", "e_out_0"), "over": ("s_in_0", "n_out_0")},
                   [("e_in", "w_out", 200), ("w_in", "s_out", 200), ("n_in", "e_out", 200)]),
    "tee": ("s_in_0", "w_out_0", {"right": ("s_in_0", "e_out_0"), "main_left": ("e_in_0", "s_out_0"),
                                  "main_right": ("w_in_0", "s_out_0"), "straight": ("e_in_0", "w_out_0")},
            [("e_in", "w_out", 300), ("w_in", "e_out", 300)]),
    "four_lanes": ("s_in_0", "e_out_0", {"right": ("w_in_2", "s_out_0"), "left": ("s_in_1", "w_out_3")},
                   [("e_in", "w_out", 900), ("w_in", "e_out", 900)]),
    "short_ramp": ("ramp_0", "on_1", {}, [("main", "on", 900)]),
    "curve": ("bend_1", "bend_1", {"change": ("bend_1", "bend_2")}, [("bend", "bend", 600)]),
    "late_changes": ("w_far_0", "s_out_0", {"left": ("w_far_0", "n_out_0")},
                     [("w_far", "e_out", 300), ("e_in", "w_out", 300)]),
    "far_away": ("s_in_0", "w_out_0", {}, [("n_in", "s_out", 150), ("e_in", "w_out", 200), ("w_in", "e_out", 200)]),
    "strange_names": ("Straße_0_0", "-gneE:4_0", {}, [("-12#3", "-gneE:4", 300), ("gneE:4", "12#3", 300)]),
    "no_inner_lanes": ("s_in_0", "w_out_0", {}, [("e_in", "w_out", 300), ("w_in", "e_out", 300)]),
    "unregulated": ("s_in_0", "w_out_0", {}, [("e_in", "w_out", 150), ("w_in", "e_out", 150)]),
    "stop_signs": ("s_in_0", "w_out_0", {}, [("e_in", "w_out", 300), ("w_in", "e_out", 300)]),
    "sharp_fast": ("a_b_0", "c_d_0", {}, [("y_c", "c_b", 60), ("e_d", "d_z", 60)]),
    "signals": ("s_in_0", "w_out_0", {}, [("e_in", "w_out", 300), ("w_in", "e_out", 300)]),
}

NETWORKS = [skewed, all_way_stop, right_before_left, zipper, roundabout, tee, four_lanes, short_ramp, curve,
            late_changes, far_away, strange_names, no_inner_lanes, unregulated, stop_signs, signals, sharp_fast]


def build_network(path, nodes, edges, connections, options):
    """Writes the network netconvert makes of the parts."""
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        text = "<nodes>" + "".join(f'<node id={quoteattr(k)} x="{v[0]:.3f}" y="{v[1]:.3f}" type="{v[2]}"/>'
                                   for k, v in nodes.items()) + "</nodes>"
        (folder / "n.xml").write_text(text)
        text = "<edges>"
        for k, (a, b, lanes, speed, extra) in edges.items():
            text += f'<edge id={quoteattr(k)} from="{a}" to="{b}" numLanes="{lanes + (1 if extra.get("shoulder") else 0)}" speed="{speed}"'
            text += f' priority="{extra.get("priority", 1)}"'
            if "shape" in extra:
                text += f' shape="{extra["shape"]}"'
            text += ">" + ('<lane index="0" allow="emergency authority" width="2.0"/>' if extra.get("shoulder") else "") + "</edge>"
        (folder / "e.xml").write_text(text + "</edges>")
        command = ["netconvert", "-n", folder / "n.xml", "-e", folder / "e.xml", "-o", path,
                   "--no-turnarounds", "true", "--offset.disable-normalization", "true", "--xml-validation", "never"]
        if connections:
            (folder / "x.xml").write_text("<connections>" + "".join(
                f'<connection from="{a}" to="{b}" fromLane="{i}" toLane="{j}"/>' for a, b, i, j in connections) + "</connections>")
            command += ["-x", folder / "x.xml"]
        for key, value in options.items():
            command += [key, value]
        done = subprocess.run([str(c) for c in command], capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"{path}: {done.stderr}")
    text = re.sub(r"<!-- generated on.*?-->\n", "", path.read_text(), flags=re.S)  # date and paths of one machine
    path.write_text(re.sub(r"\n\n+", "\n", text))


def write_scenario(name):
    start, goal, more, flows = SCENARIOS[name]
    text = f'[network]\nfile = "{name}.net.xml"\n\n[mission]\nstart_lane = "{start}"\nstart_pos_m = 20.0\n'
    text += f'goal_lane = "{goal}"\ngoal_pos_m = -1.0\nentry_time_s = 20.0\ntime_limit_s = 80.0\n'
    text += f'entry_speed_mps = 8.0\n\n[traffic]\nroutes = ["{name}.rou.xml"]\n'
    for flavour, (start, goal) in more.items():
        text += f'\n[flavour.{flavour}.mission]\nstart_lane = "{start}"\ngoal_lane = "{goal}"\n'
    (HERE / (name + ".toml")).write_text(text)
    text = "<routes>\n"
    for number, (a, b, per_hour) in enumerate(flows):
        text += (f'    <flow id="{number}" from={quoteattr(a)} to={quoteattr(b)} begin="0" end="300" departLane="best"'
                 f' departSpeed="max" period="exp({per_hour / 3600:.4f})"/>\n')
    (HERE / (name + ".rou.xml")).write_text(text + "</routes>\n")


if __name__ == "__main__":
    for each in NETWORKS:
        if len(sys.argv) < 2 or each.__name__ in sys.argv[1:]:
            build_network(HERE / (each.__name__ + ".net.xml"), *each())
            write_scenario(each.__name__)
