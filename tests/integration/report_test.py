#!/usr/bin/env python3
"""VIEW-002 The report of a campaign, opened from disk in headless Chromium as a reader would.

    report_test.py S4TP_TOOL          needs Debian's chromium; says so and fails without it
"""

import html.parser
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

CAMPAIGN = ["--planner", "constant_speed,blind", "--scenarios", "overtake,merge", "--guard", "on,off", "--episodes", "4"]
BROWSER_S = 120

# What a reader does, from inside the page; the answers are left on the document.
READER = """<script>
(async () => {
  const wait = (ms) => new Promise((done) => setTimeout(done, ms));
  const root = document.documentElement, scene = document.getElementById('scene');
  for (let i = 0; i < 200 && !root.dataset.time; ++i) await wait(50);
  const seen = () => ({ time: Number(root.dataset.time), picture: scene.toDataURL(),
    words: document.getElementById('words').textContent, speed: document.querySelector('#figures b').textContent });
  const press = (key) => document.body.dispatchEvent(new KeyboardEvent('keydown', { key, bubbles: true }));
  const look = async (address) => { location.hash = address; await wait(60); return seen(); };
  const answers = { at1: await look('#t=1'), at3: await look('#t=3'), again1: await look('#t=1') };
  const haze = document.querySelector('[data-layer=haze]');
  haze.click(); answers.noHaze = seen(); haze.click();
  document.getElementById('play').click();
  for (let i = 0; i < 200 && seen().time < 1.5; ++i) await wait(50);
  answers.played = seen();
  press(' '); await wait(60); answers.paused = seen(); await wait(200); answers.still = seen();
  press('ArrowRight'); answers.stepped = seen();
  press('End'); answers.end = seen();
  root.dataset.answers = JSON.stringify(answers);
})();
</script>
"""


def fail(text):
    sys.exit("report_test: " + text)


def check(holds, text):
    if not holds:
        fail(text)


class Tables(html.parser.HTMLParser):
    """Rows of cells by the table's class or id; all text; addresses a browser could fetch."""

    def __init__(self):
        super().__init__()
        self.tables, self.name, self.row, self.cell, self.text, self.addresses = {}, None, None, None, "", []

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.addresses += [attributes[key] for key in ("src", "href") if attributes.get(key)]
        if tag == "table":
            self.name = attributes.get("class") or attributes.get("id")
        elif tag == "tr":
            self.row = []
        elif tag in ("td", "th"):
            self.cell = ""

    def handle_endtag(self, tag):
        if tag in ("td", "th") and self.cell is not None:
            self.row.append(" ".join(self.cell.split()))
            self.cell = None
        elif tag == "tr":
            self.tables.setdefault(self.name, []).append(self.row)

    def handle_data(self, data):
        self.text += data
        if self.cell is not None:
            self.cell += data


def browse(browser, page, folder):
    """The document after its scripts have run, what was said on the console, and what the page asked the network for."""
    log = folder / "net.json"
    result = subprocess.run(
        [browser, "--headless=new", "--no-sandbox", "--disable-gpu", f"--user-data-dir={folder / 'profile'}",
         "--disable-background-networking", "--disable-component-update", "--no-first-run",
         "--window-size=1400,1000", "--virtual-time-budget=20000", "--enable-logging=stderr", f"--log-net-log={log}",
         "--dump-dom", page.as_uri()],
        capture_output=True, text=True, timeout=BROWSER_S, check=False,
        env={**os.environ, "HOME": str(folder)})
    check("</html>" in result.stdout, f"{browser} shows nothing of {page}:\n{result.stderr[-2000:]}")
    said = [line for line in result.stderr.splitlines() if "CONSOLE" in line]
    # An event a line; what the browser asks on its own behalf belongs to no page.
    asked = {url[1] for line in log.read_text(errors="replace").splitlines()
             if '"network_isolation_key":"file:' in line and (url := re.search(r'"url":"((?:http|ws)s?:[^"]*)"', line))}
    return result.stdout, said, asked


def open_page(browser, page, folder):
    dom, said, asked = browse(browser, page, folder)
    check(not said, f"{page}: the console says\n" + "\n".join(said))
    check(not asked, f"{page}: asks the network for {asked}")
    return dom


def check_browser(browser, folder):
    """That a page which is not as it should be is noticed."""
    bad = folder / "bad.html"
    bad.write_text('<!doctype html><img src="http://127.0.0.1:9/there.png"><script>nobody.knows();</script>')
    _, said, asked = browse(browser, bad, folder)
    check(any("nobody" in line for line in said), f"an error was not seen on the console: {said}")
    check(asked == {"http://127.0.0.1:9/there.png"}, f"a request was not seen: {asked}")


def tables_of(text):
    tables = Tables()
    tables.feed(text)
    return tables


def check_numbers(rows, runs):
    """Every number of the outcomes' table is the JSON's."""
    head, *rows = rows
    check(len(rows) == len(runs), f"{len(rows)} lines for {len(runs)} runs")
    for row, run in zip(rows, runs):
        rates = ("collision_rate", "at_fault_collision_rate", "off_road_rate", "timeout_rate")
        wanted = [run["scenario"], run["planner"], "guarded" if run["guarded"] else "bare",
                  f'{run["episodes"]} of 4', f'{100 * run["success_rate"]:.1f}',
                  f'{100 * run["wilson_low"]:.1f} – {100 * run["wilson_high"]:.1f}',
                  f'{100 * run["in_time_rate"]:.1f} in {run["in_time_s"]:.0f} s']
        for rate in rates:
            low, high = run[rate.replace("_rate", "_wilson")]
            wanted.append(f"{100 * run[rate]:.1f} [{100 * low:.1f}, {100 * high:.1f}]")
        mean = run["seconds_to_goal_mean"]
        wanted += [f'{100 * run["dead_ecu_rate"]:.1f}', "–" if mean is None else f"{mean:.2f}",
                   f'{run["min_ttc_s_p05"]:.2f}', f'{run["min_gap_m"]:.2f}', f'{run["near_misses"]:.2f}',
                   f'{100 * run["close_encroachment_rate"]:.1f}', f'{run["imposed_braking_mps2"]:.2f}',
                   f'{100 * run["imposed_over_2_rate"]:.1f}', f'{100 * run["imposed_over_3_rate"]:.1f}',
                   f'{100 * run["pressed_rate"]:.1f}',
                   f'{run["mean_abs_jerk_mps3"]:.2f}', f'{run["hardest_braking_mps2"]:.2f}',
                   f'{100 * run["rss_violation_share"]:.1f}', f'{100 * run["comp1"]["success"]:.1f}',
                   f'{run["comp1"]["time"]:.1f}', f'{run["comp1"]["humanness"]:.3g}']
        shown = row[:-1] + [f"{float(row[-1]):.3g}"]
        check(shown == wanted, f"the table shows\n{shown}\nthe JSON has\n{wanted}\nunder {head}")


def check_replay(browser, page, failure, folder):
    text = page.read_text(encoding="utf-8")
    check("Replays to the same frame" in text, f"{page}: another drive than the recorded one")
    read = folder / "read.html"
    read.write_text(text.replace("</body>", READER + "</body>"), encoding="utf-8")
    dom = open_page(browser, read, folder)
    answers = re.search(r'data-answers="([^"]*)"', dom)
    check(answers, f"{page}: the reader did not come to an end")
    seen = json.loads(html.unescape(answers[1]))
    check(seen["at1"]["time"] == 1 and seen["at3"]["time"] == 3, f"{page}: #t= shows another time")
    check(seen["at1"]["picture"] != seen["at3"]["picture"], f"{page}: the same picture at 1 s and at 3 s")
    check(seen["at1"]["picture"] == seen["again1"]["picture"], f"{page}: two pictures of the same instant")
    check(seen["at1"]["picture"] != seen["noHaze"]["picture"], f"{page}: the risk cannot be seen")
    check(seen["played"]["time"] > 1 and seen["played"]["picture"] != seen["noHaze"]["picture"], f"{page}: does not play")
    check(seen["paused"]["time"] == seen["still"]["time"], f"{page}: does not pause")
    check(0 < seen["stepped"]["time"] - seen["still"]["time"] <= 0.16, f"{page}: does not step")
    check(seen["at1"]["words"] and seen["at1"]["speed"].endswith("m/s"), f"{page}: explains nothing")
    check(failure["cause"] in seen["end"]["words"], f"{page}: ends with '{seen['end']['words']}'")
    check(abs(float(re.search(r'data-end="([^"]*)"', dom)[1]) - failure["time_s"]) < 0.005,
          f"{page}: ends at another time than recorded")


def main(tool):
    browser = shutil.which("chromium") or fail("chromium is not installed: apt-get install chromium")
    with tempfile.TemporaryDirectory(prefix="s4tp_report_") as name:
        folder = pathlib.Path(name)

        def run(*arguments, code=0):
            result = subprocess.run([tool, *map(str, arguments)], capture_output=True, text=True, check=False, cwd=folder)
            check(result.returncode == code, f"{arguments}: exit code {result.returncode}\n{result.stdout}{result.stderr}")
            return result.stdout + result.stderr

        check_browser(browser, folder)
        # Of every two episodes of a cell one is driven: the campaign is half done.
        run("eval", *CAMPAIGN, "--shard", "1/2", "--out", folder / "out")
        run("eval", "merge", folder / "out/part-1-of-2.jsonl", "--json", folder / "results.json", code=1)
        said = run("eval", "report", folder / "out", "--out", folder / "report", "--replays", "1")
        check("16 of 32 episodes done" in said, said)
        check(re.search(r"^1/\d+, .* left  replay of ", said, re.MULTILINE), "a log does not show how far the replays are")
        document = json.loads((folder / "results.json").read_text())
        failed = [(run_, failure) for run_ in document["runs"] for failure in run_["failures"]]
        check(any(failure["ending"] == "collision" for _, failure in failed), "nobody collided: nothing to look at")

        dom = open_page(browser, folder / "report/index.html", folder)
        tables = tables_of(dom)
        check("16 of 32 done" in tables.text, "the page does not say how much is done")
        check_numbers(tables.tables["outcomes"], document["runs"])
        check(dom.count("<svg") == 1 and "Wilson" in tables.text, "no plot, or its intervals are not explained")
        check(f"{len(failed)} failures" in tables.text and len(tables.tables["failures"]) == len(failed) + 1,
              "not every failure is listed")
        links = [address for address in tables.addresses if address != "data:,"]
        replays = sorted(folder.glob("report/replays/*.html"))
        check(sorted(links) == [f"replays/{replay.name}" for replay in replays], f"links {links}, files {replays}")
        check(len(replays) == len({(r["planner"], r["scenario"], r["guarded"]) for r, _ in failed}),
              "not one replay a cell with failures")
        check(f"{len(failed) - len(replays)} are left to their command" in tables.text, "does not say what was left out")

        run_, failure = next((r, f) for r, f in failed if f["ending"] == "collision" and not r["guarded"])
        replay = next(page for page in replays if re.search(
            f"{run_['scenario']}_{run_['planner']}_bare_.*", page.name))
        seed = int(re.search(r"_(\d+)\.html", replay.name)[1])
        failure = next(f for f in run_["failures"] if f["seed"] == seed)
        check_replay(browser, replay, failure, folder)
        print(f"report: {len(replays)} replays, {len(failed)} failures, all as recorded")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]).resolve())
