#!/usr/bin/env python3
"""Man page and bash completion of s4tp, made from what each of its commands says for --help.

    manual.py PROGRAM OUT      writes OUT/s4tp.1 and OUT/s4tp.bash
"""

import dataclasses
import pathlib
import re
import subprocess
import sys

COLUMN = 30  # where CLI11 begins a description
PAGE = """.TH S4TP 1 "" "{version}" "User Commands"
.SH NAME
s4tp \\- {about}
.SH SYNOPSIS
.B s4tp
.I COMMAND
[\\fIOPTION\\fR]...
.SH DESCRIPTION
Programs around the s4tp planner: an ECU, a virtual world on the other end of its CAN bus, and what measures both.
Whatever needs the sources (tests, training, emulated boards, fuzzing) is a command of the source tree's own launcher.
.SH COMMANDS
{commands}
.SH EXIT STATUS
0 done, 1 the result is not good enough or an episode failed, 2 wrong use or broken input, 130 stopped by a signal.
.SH SEE ALSO
Every page of the documentation, of which README.md is the first, lies in the package's folder of
.IR share/doc/s4tp .
"""
COMPLETION = """# bash completion of s4tp, made from its commands' --help.
_s4tp() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} command= i words=
  for ((i = 1; i < COMP_CWORD; i++)); do
    case "$command ${{COMP_WORDS[i]}}" in
{commands}
    esac
  done
  case "$command $before" in
{choices}
    *) case $command in
{words}
      esac ;;
  esac
  COMPREPLY=($(compgen -W "$words" -- "$word"))
}}
complete -o default -F _s4tp s4tp
"""


@dataclasses.dataclass
class Option:
    names: list
    argument: str  # as --help has it, with what it excludes and needs
    text: str

    def choices(self):
        found = re.search(r"\{([^}]*)\}", self.argument)
        return found[1].split(",") if found else []


@dataclasses.dataclass
class Command:
    path: list  # words behind the program
    about: str
    usage: str
    options: list
    commands: list


def ask(program, *words):
    done = subprocess.run([program, *words], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True, timeout=60, check=True)
    return done.stdout


def entries(lines):
    """(left, text) of each entry of a section."""
    result = []
    for number, line in enumerate(lines):
        following = lines[number + 1] if number + 1 < len(lines) else ""
        if line.startswith(" " * COLUMN):
            continue
        if following.startswith(" " * COLUMN):  # too long for its column
            result.append((line.strip(), following.strip()))
        else:
            result.append((line[:COLUMN].strip(), line[COLUMN:].strip()))
    return result


def read(program, path=()):
    """The command and all below it. A command of which --help says nothing has neither options nor commands."""
    text = ask(program, *path, "--help")
    about, _, rest = text.partition("\nUsage: ")
    sections = {head: entries(body.rstrip("\n").split("\n"))
                for head, body in re.findall(r"^(\w+):\n((?:  .*(?:\n|$))*)", rest, re.MULTILINE)}
    options = []
    for left, description in sections.get("Options", []) + sections.get("Positionals", []):
        names, _, argument = left.partition(" ")
        options.append(Option(names.split(","), argument, description))
    below = [read(program, (*path, left.split(" ")[0])) for left, _ in sections.get("Subcommands", [])]
    return Command(list(path), about.strip(), rest.split("\n")[0], options, below)


def all_of(command):
    yield command
    for below in command.commands:
        yield from all_of(below)


def roff(text):
    return re.sub(r"^([.'])", r"\\&\1", text.replace("\\", "\\e").replace("-", "\\-"))


def man_page(tool, version):
    lines = []
    for command in all_of(tool):
        if command.path:
            lines += [f".SS s4tp {' '.join(command.path)}", roff(command.about)]
        for option in command.options:
            if command.path and "--help" in option.names:
                continue  # said once
            names = ", ".join(f"\\fB{roff(name)}\\fR" for name in option.names)
            lines += [".TP", f"{names} {roff(option.argument)}".strip(), roff(option.text)]
    return PAGE.format(version=version, about=roff(tool.about.removeprefix("s4tp: ")), commands="\n".join(lines))


def completion(tool):
    commands, choices, words = [], [], []
    for command in all_of(tool):
        path = " ".join(command.path)
        long = [name for option in command.options for name in option.names if name.startswith("-")]
        words.append(f"      '{path}') words='{' '.join([below.path[-1] for below in command.commands] + long)}' ;;")
        for below in command.commands:
            commands.append(f"      '{path} {below.path[-1]}') command='{' '.join(below.path)}' ;;")
        for option in command.options:
            for name in option.names if option.choices() else ():
                choices.append(f"    '{path} {name}') words='{' '.join(option.choices())}' ;;")
    return COMPLETION.format(commands="\n".join(commands), choices="\n".join(choices), words="\n".join(words))


def main(arguments):
    program, out = pathlib.Path(arguments[0]).resolve(), pathlib.Path(arguments[1])
    tool = read(program)
    if not tool.commands:
        raise SystemExit(f"manual.py: {program} --help names no commands")
    (out / "s4tp.1").write_text(man_page(tool, ask(program, "--version").strip()), encoding="utf-8")
    (out / "s4tp.bash").write_text(completion(tool), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
