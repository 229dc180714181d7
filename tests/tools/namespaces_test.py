"""The checker of namespaces sees one of another folder, and lets a folder's own pass."""

import pathlib
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "toolchain"))
import check_namespaces  # noqa: E402
from small_project import findings_in  # noqa: E402


def findings(path, text):
    return findings_in(check_namespaces, {path: text})


def around(*names):
    """Namespaces within each other, as clang-format leaves them."""
    return "".join(f"namespace {name} {{\n" for name in names) + "".join(f"}}  // namespace {name}\n" for name in names[::-1])


class Namespaces(unittest.TestCase):
    # The project itself; and no line of the tables is about a folder or a namespace that has gone.
    def test_project_keeps_to_its_folders(self):
        self.assertEqual(check_namespaces.findings(ROOT), [])
        for folder in {**check_namespaces.NAMESPACES, **check_namespaces.WITHIN}:
            files = [file for file in (ROOT / folder).iterdir() if file.suffix in check_namespaces.SUFFIXES]
            used = {name for file in files for _, name in check_namespaces.opened(file.read_text(encoding="utf-8"))}
            self.assertEqual(set(check_namespaces.allowed(folder)), used, folder)

    # A folder's last name, however deep it lies; the neighbour's and the one above are not its own.
    def test_folder_has_its_own_name(self):
        for path in ("algo/scene/x.hpp", "firmware/ecu/x.cpp", "sim_host/view/x.hpp", "sim_host/world/map/x.cpp"):
            name = path.split("/")[-2]
            self.assertEqual(findings(path, around(f"s4tp::{name}", "")), [], path)
            for other in ("s4tp", "s4tp::world", "s4tp::traffic", f"s4tp::world::{name}", name, f"s4tp::{name}::detail"):
                found = findings(path, "\n" + around(other))
                self.assertEqual(len(found), 1, (path, other, found))
                self.assertTrue(found[0].startswith(f"{path}:2: opens {other}: "), found)

    # A name within another counts as both together, also behind one that is closed on its line or without a word.
    def test_names_add_up(self):
        self.assertEqual(findings("hal/mps/x.hpp", around("s4tp::hal::mps", "semihosting")), [])
        self.assertEqual(len(findings("hal/mps/x.hpp", around("s4tp::hal::mps", "semihosting", "traps"))), 1)
        self.assertEqual(len(findings("algo/core/x.hpp", around("s4tp", "scene"))), 1)
        self.assertEqual(len(findings("algo/core/x.hpp", "namespace s4tp { class A; }\n" + around("s4tp::scene"))), 1)
        self.assertEqual(findings("algo/satp/x.hpp", "namespace s4tp::satp {\n}\n" + around("s4tp::satp")), [])
        self.assertEqual(len(findings("sim_host/sumo/x.hpp", around("s4tp::sumo") + "inline " + around("s4tp::map"))), 1)

    # Another name for a namespace, its use and its mention open none.
    def test_what_opens_none_passes(self):
        for line in ("namespace fs = std::filesystem;", "using namespace s4tp::map;", "// namespace s4tp::map {", "using map::Lane;"):
            self.assertEqual(findings("sim_host/view/x.cpp", line + "\n"), [], line)


if __name__ == "__main__":
    unittest.main()
