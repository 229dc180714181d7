#!/usr/bin/env python3
"""Installed headers bind nobody to our compiler flags: no Eigen, and no inline function that computes with floats.

    check_headers.py INCLUDE_FOLDER

Identical bits need our flags, so every float operation belongs into a .cpp file. Each header is compiled by itself for a
processor without floating point, all its inline functions kept: there each float operation shows as a call.
"""

import concurrent.futures
import pathlib
import re
import subprocess
import sys
import tempfile

COMPILER = "arm-none-eabi-"
FLAGS = ("-mcpu=cortex-m7", "-mthumb", "-mfloat-abi=soft", "-O0", "-Wall", "-Wextra", "-Wpedantic", "-Werror")
CPP = ("-std=c++17", "-fkeep-inline-functions", "-fno-exceptions", "-fno-rtti", "-x", "c++")
C = ("-std=c99", "-x", "c")
# Class templates say nothing until they are used: how each is.
USES = {
    "BoundedVector": "s4tp::BoundedVector<float, 4>",
    "EventRing": "s4tp::ecu::EventRing<float, 4>",
    "TripleBuffer": "s4tp::ecu::TripleBuffer<float>",
    "Ecu": "s4tp::ecu::Ecu<s4tp::planner::Planner>",
    "PlannerWeights": "s4tp::ecu::PlannerWeights<s4tp::planner::Planner>",
    "Rows": "s4tp::satp::Rows<float>",
}
PLANNER = '#include "algo/planner/planner.hpp"\n'
EXTRA_INCLUDES = {"Ecu": PLANNER, "PlannerWeights": PLANNER}
# Run-time calls of the Arm ABI that compute with float or double, and the C mathematics library.
FLOAT_CALL = re.compile(r"__aeabi_(c?[fd](add|r?sub|mul|div|neg|cmp\w*|2\w+)|u?[il]2[fd])"
                        r"|(sqrt|sin|cos|tan|asin|acos|atan|atan2|exp|log|pow|tanh|erf|fmod|floor|ceil|round|fma)f?")
TEMPLATE = re.compile(r"\btemplate\s*<[^<>]*>\s*([^;{]*)([;{])")
FUNCTION_BODY = re.compile(r"\)[\w\s]*(?:->[^;{]*)?\{")
EIGEN = re.compile(r'#\s*include\s*["<](unsupported/)?Eigen/')


def braced(text, begin):
    """What stands from `begin`, just behind an opening brace, to the brace that closes it."""
    depth, end = 1, begin
    while depth and end < len(text):
        depth += {"{": 1, "}": -1}.get(text[end], 0)
        end += 1
    return text[begin:end]


def templates(text):
    """(names of class templates with function bodies, heads of function templates with a body)"""
    classes, functions = [], []
    text = re.sub(r"//[^\n]*", "", text)
    for template in TEMPLATE.finditer(text):
        head = " ".join(template[1].split())
        match = re.match(r"(?:class|struct) (\w+)", head)
        if template[2] != "{" or match and not FUNCTION_BODY.search(braced(text, template.end())):
            continue
        if match:
            classes.append(match[1])
        else:
            functions.append(head)
    return classes, functions


def float_functions(disassembly):
    """Names of the functions that call a float operation."""
    found, function = set(), "?"
    for line in disassembly.splitlines():
        head = re.match(r"^[0-9a-f]+ <(.*)>:$", line)
        if head:
            function = head[1]
        call = re.search(r"\bR_ARM_\w+\s+(\w+)", line)
        if call and FLOAT_CALL.fullmatch(call[1]):
            found.add(function)
    return sorted(found)


def judge(root, header, scratch):
    path = header.relative_to(root).as_posix()
    text = header.read_text(encoding="utf-8")
    found = [f"{path}: includes Eigen"] if EIGEN.search(text) else []
    classes, functions = templates(text)
    found += [f"{path}: function template with a body: {head}" for head in functions]
    found += [f"{path}: class template {name}: say in check_headers.py how it is used" for name in classes if name not in USES]
    source = "".join(EXTRA_INCLUDES.get(name, "") for name in classes) + f'#include "{path}"\n'
    source += "".join(f"template class {USES[name]};\n" for name in classes if name in USES)

    languages = [("g++", CPP)] + ([("gcc", C)] if header.suffix == ".h" else [])
    for number, (compiler, language) in enumerate(languages):
        output = scratch / f"{path.replace('/', '_')}_{number}.o"
        result = subprocess.run([COMPILER + compiler, *FLAGS, f"-I{root}", *language, "-", "-c", "-o", output], input=source,
                                capture_output=True, text=True, check=False)
        if result.returncode:
            errors = [line for line in result.stderr.splitlines() if "error" in line] or result.stderr.splitlines()
            return found + [f"{path}: does not compile by itself: {errors[0]}"]
        listing = subprocess.run([f"{COMPILER}objdump", "-drC", output], capture_output=True, text=True, check=True).stdout
        found += [f"{path}: {function} computes with floats" for function in float_functions(listing)]
    return found


def findings(root):
    headers = sorted(file for file in root.rglob("*") if file.suffix in (".hpp", ".h"))
    with tempfile.TemporaryDirectory() as scratch, concurrent.futures.ThreadPoolExecutor() as pool:
        found = pool.map(lambda header: judge(root, header, pathlib.Path(scratch)), headers)
        return [line for lines in found for line in lines], len(headers)


def main(arguments):
    found, headers = findings(pathlib.Path(arguments[0]))
    if not headers:
        found = [f"headers: none under {arguments[0]}"]
    print("\n".join(found) if found else f"headers: {headers}, none computes with floats or needs Eigen")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
