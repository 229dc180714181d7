"""A project of a few files, to see what a checker says about it."""

import pathlib
import tempfile


def findings_in(checker, files):
    """What `checker.findings` says about a project that consists of these files. `files`: text by path"""
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for path, text in files.items():
            (root / path).parent.mkdir(parents=True, exist_ok=True)
            (root / path).write_text(text, encoding="utf-8")
        return checker.findings(root)
