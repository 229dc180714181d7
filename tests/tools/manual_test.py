"""Man page and completion are what the commands say for --help. S4TP_BUILD names the host's build folder."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "toolchain"))
import manual  # noqa: E402

BUILD = pathlib.Path(os.environ["S4TP_BUILD"])
HELP = """a program
Usage: x [OPTIONS] SUBCOMMAND

Options:
  -h,--help                   Print this help message and exit

Subcommands:
  go                          it goes
"""
GO_HELP = """it goes
Usage: x go [OPTIONS]

Options:
  -h,--help                   Print this help message and exit
  --far,--further FLOAT:FLOAT in [0 - 1] Needs: --fast
                              .as far as that
  --way TEXT:{up,down}        which
"""


class Manual(unittest.TestCase):
    def complete(self, script, *words):
        """What bash offers for the last of the words."""
        asked = " ".join(f"'{word}'" for word in words)
        done = subprocess.run(["bash", "-c", f". '{script}'; COMP_WORDS=({asked}); COMP_CWORD={len(words) - 1}; _s4tp; echo ${{COMPREPLY[@]}}"],
                              check=True, stdout=subprocess.PIPE, text=True)
        return done.stdout.split()

    # Every command and every option of the built tool is in the page, and is offered.
    def test_everything_is_in_page_and_completion(self):
        page = (BUILD / "manual/s4tp.1").read_text(encoding="utf-8").replace("\\-", "-")
        script = BUILD / "manual/s4tp.bash"
        commands = list(manual.all_of(manual.read(BUILD / "sim_host/s4tp_tool")))
        self.assertGreater(len(commands), 15)
        for command in commands:
            path = " ".join(command.path)
            self.assertIn(f"\n.SS s4tp {path}\n" if path else ".SH NAME\ns4tp - ", page)
            names = [name for option in command.options for name in option.names if name.startswith("-")]
            self.assertLessEqual({*names, *(below.path[-1] for below in command.commands)},
                                 set(self.complete(script, "s4tp", *command.path, "")), path)
            self.assertEqual([name for name in names if f"\\fB{name}\\fR" not in page], [], path)
            self.assertTrue(command.about, path)
            self.assertEqual([option for option in command.options if not option.text], [], path)

    # A new command and its options come by themselves; a dot that begins a line is no request of roff.
    def test_new_command_is_taken(self):
        with tempfile.TemporaryDirectory() as folder:
            program = pathlib.Path(folder) / "x"
            program.write_text(f"#!/bin/sh\ncase $1 in go) cat <<'A'\n{GO_HELP}A\n;; --version) echo 7;; *) cat <<'A'\n{HELP}A\nesac\n", encoding="utf-8")
            program.chmod(0o755)
            manual.main([program, folder])
            page = (pathlib.Path(folder) / "s4tp.1").read_text(encoding="utf-8")
            self.assertIn("\n.SS s4tp go\nit goes\n", page)
            self.assertIn("\\fB\\-\\-far\\fR, \\fB\\-\\-further\\fR FLOAT:FLOAT in [0 \\- 1] Needs: \\-\\-fast\n\\&.as far as that\n", page)
            script = pathlib.Path(folder) / "s4tp.bash"
            self.assertEqual(self.complete(script, "s4tp", "g"), ["go"])
            self.assertEqual(self.complete(script, "s4tp", "go", "--fu"), ["--further"])
            self.assertEqual(self.complete(script, "s4tp", "go", "--way", ""), ["up", "down"])
            self.assertEqual(self.complete(script, "s4tp", "go", "--far", "1", "--way", "d"), ["down"])


if __name__ == "__main__":
    unittest.main()
