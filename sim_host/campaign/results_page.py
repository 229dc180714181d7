#!/usr/bin/env python3
"""What docs/results holds, from a folder of main_table.sh: the page of tables, and the numbers of each part.

    results_page.py FOLDER --out DOCS [--commit HASH]

The seeds of failures are kept of the guarded s4tp only; what is left out of a run is counted (failures_left_out).
"""

import argparse
import json
import pathlib
import statistics

PARTS = {
    "builtin": "The built-in traffic",
    "sumo": "SUMO's traffic",
    "long": "More episodes, the built-in traffic",
    "raw": "`smarts_raw`: the left turn entered at 13.89 m/s, as published; the built-in traffic",
    "real": "Perception as it is: noise, 100 ms latency, dropouts, occlusion; the built-in traffic",
    "networks": "Further networks (`tests/networks`), the built-in traffic",
    "networks_sumo": "Further networks, SUMO's traffic",
}
SIGNIFICANT = 5  # digits
LIMIT_S = 80.0  # of an episode; a scenario may ask for less, counted apart
MOST_COLUMNS = 10  # a wider table is turned on its side

PAGE = """# Results

`sim_host/campaign/main_table.sh --jobs 2 --first-seed {first_seed} out/main` drives all of this, with as many episodes a cell as each section says
(`--episodes`, `--parts`), and goes on where it was stopped; `out/main/report/index.html` then shows every table, plots, and replays of failures, `out/main/docs` is this folder. Seeds {first_seed:,} and on, on which
nothing was tuned; commit {commit}. Each cell is **goals in `smarts` / in `social`**; ours: collisions through our own fault. Bare: with the
command gate alone; guarded: with the guard and the fail-safe, whoever plans. The other numbers of each run (intervals,
rates, gaps, comfort, the competition's own metrics) are in the JSON beside this page, a line a run.

A comparison is of the same episodes, driven by both: `3 : 11` are the episodes in which only s4tp failed and only the other did.
Better and worse: McNemar's exact test, p < 0.05; no worse: the failure rates differ by less than 1 % (upper end of the 95 % interval); without a word none of
them is shown.

Where a scenario asks for a goal sooner than within 80 s, those in time stand in brackets.

The other files here are blocks driven for one question each: `fresh.json` (seeds and roads 20,000 on) and `roads*.json` (generated roads, a line a road): [safety_record.md](../safety_record.md),
`other_networks*.json` and `drawn_networks*.json` (networks of other generators: [safety_record.md](../safety_record.md)), `closed_loop*.json` (beside the kinematic predictor: [training.md](../training.md)), `parameter_screen.json` (all parameters changed by 30 %: [sensitivity.md](../sensitivity.md)).
"""


def rounded(value):
    if isinstance(value, float):
        return float(f"{value:.{SIGNIFICANT}g}")
    if isinstance(value, list):
        return [rounded(each) for each in value]
    if isinstance(value, dict):
        return {key: rounded(each) for key, each in value.items()}
    return value


def shortened(document):
    """The same results, with the failures of the guarded s4tp only."""
    runs = []
    for run in document["runs"]:
        short = {key: rounded(value) for key, value in run.items() if key != "failures"}
        if run["planner"] == "s4tp" and run["guarded"]:
            short["failures"] = run["failures"]
        else:
            short["failures_left_out"] = len(run["failures"])
        runs.append(short)
    return {**document, "runs": runs}


def a_line_a_run(document):
    head = json.dumps({**document, "runs": None}, ensure_ascii=False)
    lines = ",\n".join(json.dumps(run, ensure_ascii=False) for run in document["runs"])
    return head.replace('"runs": null', f'"runs": [\n{lines}\n]') + "\n"


def distinct(rows, key):
    return list(dict.fromkeys(row[key] for row in rows))


def table(head, rows):
    if len(head) > MOST_COLUMNS:
        head, *rows = [list(column) for column in zip(head, *rows)]
    lines = [head, ["---"] * len(head), *rows]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def count(run, rate):
    return round(run[rate] * run["episodes"])


def beside(cells, flavours, text):
    """`text` of the cell of each flavour, as 99 / 98."""
    by_flavour = {cell["flavour"]: cell for cell in cells}
    return " / ".join(text(by_flavour[flavour]) if flavour in by_flavour else "–" for flavour in flavours)


def goals_of(run):
    """How many, and of them those in time where that is less than the 80 s of all."""
    goals, in_time_s = count(run, "success_rate"), run.get("in_time_s", LIMIT_S)
    return f"{goals}" if in_time_s >= LIMIT_S else f"{goals} ({count(run, 'in_time_rate')} in {in_time_s:.0f} s)"


def goals(runs):
    """Planners x scenarios, of runs that are alike in all else."""
    scenarios, flavours = distinct(runs, "scenario"), distinct(runs, "flavour")
    rows = []
    for planner in distinct(runs, "planner"):
        own = [run for run in runs if run["planner"] == planner]
        cells = [beside([run for run in own if run["scenario"] == scenario], flavours,
                        goals_of) for scenario in scenarios]
        total, hits, ours = (sum(count(run, rate) for run in own)
                             for rate in ("success_rate", "collision_rate", "at_fault_collision_rate"))
        rows.append([planner, *cells, f"{total} of {sum(run['episodes'] for run in own)}", f"{hits} ({ours})"])
    return table(["planner", *scenarios, "all", "collisions (ours)"], rows)


def competition(runs):
    scenarios, flavours = distinct(runs, "scenario"), distinct(runs, "flavour")

    def words(run):
        comp1 = run["comp1"]
        return f"{100 * comp1['success']:.0f}, {comp1['time']:.0f}, {comp1['humanness']:.3g}"

    rows = [[planner, *(beside([run for run in runs if (run["planner"], run["scenario"]) == (planner, scenario)], flavours,
                               words) for scenario in scenarios)] for planner in distinct(runs, "planner")]
    return table(["planner", *scenarios], rows)


def comparisons(against):
    """Other planner -> its cells beside s4tp's."""
    cells = [cell for other in against.values() for cell in other]
    scenarios, flavours = distinct(cells, "scenario"), distinct(cells, "flavour")
    scenarios.sort(key=lambda scenario: scenario == "all scenarios")

    def words(cell):
        said = "" if cell["first_is"] == "open" else f" {cell['first_is']}"
        return f"{cell['only_first_fails']} : {cell['only_second_fails']}{said}"

    return table(["s4tp beside", *scenarios],
                 [[other, *(beside([cell for cell in own if cell["scenario"] == scenario], flavours, words)
                            for scenario in scenarios)] for other, own in against.items() if own])


def goal_times(lines):
    """(scenario, flavour, guarded) -> planner -> seed -> seconds, of the episodes that reached the goal; `lines` of a record."""
    times = {}
    for episode in map(json.loads, lines):
        if episode.get("ending") != "goal":  # the head is no episode
            continue
        cell = (episode["scenario"], episode["flavour"], episode["guarded"])
        times.setdefault(cell, {}).setdefault(episode["planner"], {})[episode["seed"]] = episode["duration_s"]
    return times


def medians(times, others):
    """Of the episodes in which both reached the goal, for `times` of runs that are alike in all else."""
    scenarios = distinct([{"scenario": cell[0]} for cell in times], "scenario")
    flavours = distinct([{"flavour": cell[1]} for cell in times], "flavour")

    def words(other, scenario, flavour):
        ours, theirs = (next((times[cell].get(planner, {}) for cell in times if cell[:2] == (scenario, flavour)), {})
                        for planner in ("s4tp", other))
        both = [seed for seed in ours if seed in theirs]
        if not both:
            return "–"
        return f"{statistics.median(ours[seed] for seed in both):.1f} : {statistics.median(theirs[seed] for seed in both):.1f}"

    return table(["s4tp beside", *scenarios],
                 [[other, *(" / ".join(words(other, scenario, flavour) for flavour in flavours) for scenario in scenarios)]
                  for other in others])


def section(name, document, against, times):
    runs = document["runs"]
    text = f"\n## {PARTS[name]}\n\n{runs[0]['episodes']} episodes a cell; `{name}.json`.\n"
    for guarded in sorted(distinct(runs, "guarded"), reverse=True):
        some = [run for run in runs if run["guarded"] == guarded]
        text += f"\n**{'Guarded' if guarded else 'Bare'}**\n\n" + goals(some)
        compared = {other: [cell for cell in cells if cell["guarded"] == guarded] for other, cells in against.items()}
        if any(compared.values()):
            text += "\n" + comparisons(compared)
            text += "\nMedian time to goal in s, s4tp : the other, of the episodes in which both reached it.\n\n"
            text += medians({cell: each for cell, each in times.items() if cell[2] == guarded},
                            [other for other, cells in compared.items() if cells])
        if name == "builtin":
            text += "\nAs the competition counts: success in %, time in 0.1 s steps + m, humanness.\n\n" + competition(some)
    return text


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--commit", default="unknown")
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    sections = ""
    first_seeds = set()
    for name in PARTS:
        folder = arguments.folder / name
        if not (folder / "results.json").exists():
            continue
        document = json.loads((folder / "results.json").read_text(encoding="utf-8"))
        against = {planner: json.loads((folder / f"against_{planner}.json").read_text(encoding="utf-8"))
                   for planner in distinct(document["runs"], "planner") if planner != "s4tp"}
        (arguments.out / f"{name}.json").write_text(a_line_a_run(shortened(document)), encoding="utf-8")
        with open(folder / "episodes.jsonl", encoding="utf-8") as record:
            times = goal_times(record)
        sections += section(name, document, against, times)
        first_seeds.add(document["first_seed"])
    if not first_seeds:
        parser.error(f"{arguments.folder}: holds no part of a table (a folder with results.json)")
    if len(first_seeds) > 1:
        parser.error(f"{arguments.folder}: parts of different blocks, from seeds {sorted(first_seeds)} on")
    page = PAGE.format(commit=arguments.commit, first_seed=first_seeds.pop()) + sections
    (arguments.out / "README.md").write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main()
