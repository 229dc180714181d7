"""FILE-010 A second comparison without --out leaves the first one alone, and says where its own is.

    own_folder_test.py OPTIMIZER_BENCH
"""

import pathlib
import subprocess
import sys
import tempfile


def said(folder, *arguments):
    done = subprocess.run([sys.argv[1], *arguments], check=False, text=True, timeout=280, cwd=folder, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    assert done.returncode in (0, 1), done.stdout  # how good it is one problem does not tell
    return done.stdout


with tempfile.TemporaryDirectory(prefix="s4tp_bench_") as name:
    first = pathlib.Path(name) / "out/bench"
    assert "holds a result already" not in said(name, "--problems", "1", "--stride", "1")
    kept = {file.name: file.read_bytes() for file in first.iterdir()}
    assert sorted(kept) == ["problems.bin", "results.json"], kept
    assert "out/bench holds a result already; this one goes to out/bench-2" in said(name, "--read", first / "problems.bin")
    assert {file.name: file.read_bytes() for file in first.iterdir()} == kept
    assert [file.name for file in first.with_name("bench-2").iterdir()] == ["results.json"]
