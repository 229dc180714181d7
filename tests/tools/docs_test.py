"""The pages' checker finds dead links and missing words; the list of requirements has each promise with its text and tests."""

import pathlib
import shutil
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "toolchain"))
import check_docs  # noqa: E402
import requirements_document  # noqa: E402

# Put together here, so that the requirement checker does not take this file's examples for citations.
FIRST, SECOND, THIRD = (f"{'GA'}{'TE'}-90{i}" for i in (1, 2, 3))


class Pages(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="s4tp_docs_")
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        (self.root / "docs").mkdir()
        shutil.copy(ROOT / "docs/glossary.md", self.root / "docs")
        self.write("README.md", "# Here\n")
        for page in ("safety.md",):
            self.write(f"docs/{page}", "# Guard\n")
        self.write("algo/names.hpp", " ".join(check_docs.glossary(ROOT)[1]))
        self.write("toolchain/requirements_document.py", "")
        self.write(check_docs.LIST, requirements_document.document(self.root)[0])

    def write(self, path, text):
        (self.root / path).parent.mkdir(parents=True, exist_ok=True)
        (self.root / path).write_text(text, encoding="utf-8")

    def found(self):
        return check_docs.findings(self.root)

    # The project's own pages.
    def test_pages_are_whole(self):
        self.assertEqual(check_docs.findings(ROOT), [])
        self.assertGreater(len(check_docs.pages(ROOT)), 10)

    def test_sound_pages_pass(self):
        self.write("docs/a.md", "[s](safety.md#guard) [h](#a-b) [w](https://x.org) `algo/names.hpp` `safety.md`\n# A `b`\n")
        self.assertEqual(self.found(), [])

    def test_dead_link_is_found(self):
        self.write("docs/a.md", "[s](gone.md) ![p](gone.png) [h](safety.md#gone)\n")
        self.assertEqual(len(self.found()), 3)

    def test_file_that_is_gone_is_found(self):
        self.write("docs/a.md", "`algo/gone.hpp` and `gone.md`\n")
        self.assertEqual(len(self.found()), 2)

    # A test that is there and one that is not; a requirement of a header and one of none.
    def test_evidence_that_is_gone_is_found(self):
        self.write("algo/a.hpp", f"/// {FIRST} Brakes hard.\n")
        self.write("tests/unit/a_test.cpp", f"// {FIRST}\nTEST(Gate, Brakes) {{\n}}\n")
        self.write(check_docs.LIST, requirements_document.document(self.root)[0])
        self.write("docs/a.md", f"{FIRST} by `Gate.Brakes`; {SECOND} by `Gate.Steers`; `gate.steers`, on US-101\n")
        self.assertEqual(self.found(), ["docs/a.md: names the test Gate.Steers, which is not there",
                                        f"docs/a.md: names {SECOND}, which no header promises"])

    # A promise that is a row of a table is listed in words, without its bars.
    def test_a_row_of_a_table_is_listed_in_words(self):
        self.write("algo/a.hpp", f"/// | id | what | who |\n/// |---|---|---|\n/// | {FIRST} | brakes hard | we |\n")
        self.assertIn(f"| {FIRST} | brakes hard; we | ", requirements_document.document(self.root)[0])

    # A page, and a section of one, that a comment names.
    def test_what_the_code_cites_is_looked_for(self):
        self.write("docs/method.md", "# Method\n## 3 Field\n**4.8 Refinement** x\n")
        self.write("algo/a.hpp", "/// method.md 3 and docs/method.md 4.8, safety.md\nint f();  // method.md 4.9, gone.md\n")
        self.assertEqual(self.found(), ["algo/a.hpp: cites method.md 4.9: there is no such section",
                                        "algo/a.hpp: cites gone.md: there is no such page"])

    # A word struck out, and one whose name in the code is no more.
    def test_word_without_definition_is_found(self):
        page = (self.root / "docs/glossary.md").read_text(encoding="utf-8")
        self.write("docs/glossary.md", "".join(line for line in page.splitlines(True) if not line.startswith("| guard ")))
        self.write("algo/names.hpp", (self.root / "algo/names.hpp").read_text(encoding="utf-8").replace("PathHypothesis", "Hypothesis"))
        self.assertEqual(self.found(), ["docs/glossary.md: guard is not defined",
                                        "docs/glossary.md: there is no PathHypothesis in algo any more"])

    # A promise that is new, and no list at all.
    def test_old_list_of_requirements_is_found(self):
        self.write("algo/a.hpp", f"/// {FIRST} Brakes hard.\n")
        self.assertEqual(len(self.found()), 1)
        self.assertIn("requirements_document.py > docs/requirements.md", self.found()[0])
        (self.root / check_docs.LIST).unlink()
        self.assertEqual(len(self.found()), 1)

    def test_long_readme_is_found(self):
        self.write("README.md", "x\n" * (check_docs.README_LINES + 1))
        self.assertEqual(len(self.found()), 1)


class RequirementList(unittest.TestCase):
    def page(self, header, test):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for path, text in (("firmware/gate/gate.hpp", header), ("tests/unit/gate_test.cpp", test)):
                (root / path).parent.mkdir(parents=True)
                (root / path).write_text(text, encoding="utf-8")
            page, missing = requirements_document.document(root)
            return [line for line in page.splitlines() if line.startswith("| GATE")], missing

    # Every promise of the project has a text, and a test that is named.
    def test_every_promise_is_listed(self):
        page, missing = requirements_document.document(ROOT)
        self.assertEqual(missing, [])
        rows = [line.split(" | ") for line in page.splitlines() if line.startswith("| ") and not line.startswith("| id ")]
        self.assertGreater(len(rows), 400)
        self.assertEqual([row[0] for row in rows if len(row) != 4 or len(row[1]) < 3 or len(row[3]) < 5], [])

    # Two promises in one comment, wrapped; one behind a value; the test is the one below the comment that cites.
    def test_text_and_test_are_found(self):
        rows, missing = self.page(f"/// {FIRST} Brakes\n/// hard. {SECOND} Steers. \\return it\nint f();\n"
                                  f"  int limit = 3;  ///< {THIRD} at most\n",
                                  f"// {FIRST}: as it\n// says, {THIRD}\nTEST(Gate, Brakes) {{\n}}\n// {SECOND}\nTEST(Gate, Steers) {{\n")
        self.assertEqual(missing, [])
        self.assertEqual(rows, [f"| {FIRST} | Brakes hard. | `firmware/gate/gate.hpp` | Gate.Brakes |",
                                f"| {SECOND} | Steers. | `firmware/gate/gate.hpp` | Gate.Steers |",
                                f"| {THIRD} | `int limit = 3`: at most | `firmware/gate/gate.hpp` | Gate.Brakes |"])

    def test_promise_without_test_is_found(self):
        self.assertEqual(len(self.page(f"/// {FIRST} Brakes hard.\n", "")[1]), 1)


if __name__ == "__main__":
    unittest.main()
