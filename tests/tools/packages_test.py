"""Every header that a source includes from outside comes with a package that the launcher asks for, or with one that
such a package depends on: what a developer once installed by hand is missing on a fresh system."""

import pathlib
import re
import subprocess
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SOURCES = ("algo", "hal", "firmware", "sim_host", "tests")
INCLUDE = re.compile(r"^\s*#\s*include\s*<([^>]+)>", re.MULTILINE)
PLACES = ("/usr/include", "/usr/include/x86_64-linux-gnu", "/usr/include/eigen3", "/usr/include/coin",
          "/usr/include/torch/csrc/api/include", "/usr/include/hsl")


def asked_for(launcher):
    """Names of all packages in the launcher's lists."""
    lists = re.findall(r"^packages_\w+=\((.*?)\)$", launcher, re.MULTILINE | re.DOTALL)
    return {word for text in lists for word in text.split() if not word.startswith('"$')}


def with_dependencies(packages):
    """These and all that they depend on, of what is installed."""
    lines = subprocess.run(["dpkg-query", "-W", "-f", "${Package}\t${Depends}, ${Pre-Depends}\n"], check=True,
                           text=True, stdout=subprocess.PIPE).stdout.splitlines()
    needs = {}
    for line in lines:
        name, depends = line.split("\t")
        needs[name] = re.findall(r"[a-z0-9][a-z0-9+.-]+(?=[ :,|(]|$)", re.sub(r"\([^)]*\)", "", depends))
    found, front = set(), set(packages)
    while front:
        found |= front
        front = {need for package in front for need in needs.get(package, [])} - found
    return found


def outside_headers():
    """Header in angle brackets: a source that includes it."""
    headers = {}
    for folder in SOURCES:
        for path in sorted((ROOT / folder).rglob("*.[ch]pp")):
            for header in INCLUDE.findall(path.read_text(encoding="utf-8")):
                headers.setdefault(header, path.relative_to(ROOT))
    return headers


class Packages(unittest.TestCase):
    def missing(self, launcher):
        known = with_dependencies(asked_for(launcher))
        places = {header: [path for place in PLACES if (path := pathlib.Path(place) / header).exists()]
                  for header in outside_headers()}
        owners = owners_of([path for paths in places.values() for path in paths])
        strangers = []
        for header, source in outside_headers().items():
            of_it = {owner for path in places[header] for owner in owners[path]}
            if of_it and not of_it & known:
                strangers.append(f"{source}: <{header}> of {sorted(of_it)}")
        return strangers

    def test_headers_come_with_packages_that_are_asked_for(self):
        """No header of a package that the launcher would not install."""
        self.assertGreater(len(outside_headers()), 20)
        self.assertEqual(self.missing((ROOT / "s4tp").read_text(encoding="utf-8")), [])

    def test_a_package_that_is_not_asked_for_is_found(self):
        """Without libgemmlowp-dev in the lists the test above fails, as `./s4tp test` did on a fresh system."""
        launcher = (ROOT / "s4tp").read_text(encoding="utf-8").replace("libgemmlowp-dev", "")
        strangers = self.missing(launcher)
        self.assertEqual(len(strangers), 1)
        self.assertIn("gemmlowp", strangers[0])


def owners_of(paths):
    """Packages that each file belongs to; where it is a link, those of what it leads to, too."""
    names = sorted({str(name) for path in paths for name in (path, path.resolve())})
    said = subprocess.run(["dpkg-query", "-S", *names], check=False, text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.DEVNULL).stdout
    of = {}
    for line in said.splitlines():
        packages, name = line.rsplit(": ", 1)
        of[name] = {package.split(":")[0].strip() for package in packages.split(",")}
    return {path: of.get(str(path), set()) | of.get(str(path.resolve()), set()) for path in paths}


if __name__ == "__main__":
    unittest.main()
