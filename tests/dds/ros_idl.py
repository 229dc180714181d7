#!/usr/bin/env python3
"""IDL as ROS 2's rosidl would write it, from message definitions: one file for Fast DDS's generator.

    ros_idl.py MESSAGES.txt OUTPUT.idl
"""

import pathlib
import re
import sys

BASIC = {"bool": "boolean", "byte": "octet", "uint8": "octet", "int8": "char", "int32": "long", "uint32": "unsigned long",
         "float32": "float", "float64": "double", "string": "string"}


def member(package, line):
    kind, name = line.split()
    base, _, bound = re.fullmatch(r"([\w/]+)(\[(\d*)\])?", kind).groups()
    if base in BASIC:
        base = BASIC[base]
    else:
        base = "::msg::".join(base.split("/") if "/" in base else [package, base])
    if bound is None:
        return f"{base} {name};"
    return f"{base} {name}[{bound}];" if bound else f"sequence<{base}> {name};"


def main(messages, output):
    text = []
    for block in re.split(r"^= ", pathlib.Path(messages).read_text(encoding="utf-8"), flags=re.MULTILINE)[1:]:
        title, *fields = block.strip().splitlines()
        package, name = title.split("/")
        members = " ".join(member(package, field) for field in fields)
        text.append(f"module {package} {{ module msg {{ struct {name} {{ {members} }}; }}; }};")
    pathlib.Path(output).write_text("\n".join(text) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
