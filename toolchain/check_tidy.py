#!/usr/bin/env python3
"""clang-tidy finds nothing in the core, the firmware and the interfaces, as .clang-tidy asks.

    check_tidy.py [--build build/host] [FILE...]

Needs a configured build folder: what it compiles of algo, hal and firmware is looked at, generated code is not. The
boards' own files are not part of a host build.
"""

import argparse
import concurrent.futures
import json
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
CONFIGURATION = f"--config-file={ROOT / '.clang-tidy'}"
FOLDERS = ("algo", "hal", "firmware")


def files(build):
    compiled = {pathlib.Path(entry["file"]) for entry in json.loads((build / "compile_commands.json").read_text())}
    return sorted(file for file in compiled if any(file.is_relative_to(ROOT / folder) for folder in FOLDERS))


def tidy(build, file):
    command = ["clang-tidy", "--quiet", CONFIGURATION, "-p", build, file]
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    return result.returncode, result.stdout


def main(arguments):
    parser = argparse.ArgumentParser()
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/host")
    parser.add_argument("files", nargs="*", type=pathlib.Path)
    options = parser.parse_args(arguments)
    if not (options.build / "compile_commands.json").exists():
        print(f"tidy: {options.build} is not configured; cmake --preset host does that")
        return 1
    chosen = options.files or files(options.build)
    if not chosen:
        print(f"tidy: {options.build} compiles no file of {', '.join(FOLDERS)}")
        return 1
    with concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        results = list(pool.map(lambda file: tidy(options.build, file), chosen))
    found = [text for code, text in results if code]
    print("\n".join(found) if found else f"tidy: {len(chosen)} files")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
