#!/usr/bin/env python3
"""Writes a copy of a source with one text replaced, which must stand there exactly once.

    flip_constant.py SOURCE OLD NEW COPY
"""

import pathlib
import sys

source, old, new, copy = sys.argv[1:]
text = pathlib.Path(source).read_text(encoding="utf-8")
if text.count(old) != 1:
    sys.exit(f"{source}: '{old}' stands there {text.count(old)} times, not once")
pathlib.Path(copy).write_text(text.replace(old, new), encoding="utf-8")
