#!/usr/bin/env python3
"""Gate on a linked image: no allocator, no exceptions, no RTTI, no double, no DDS, memory and stack within the budgets.

    check_symbols.py --target TARGET --build BUILD_FOLDER [--image NAME]

Bare-metal images are judged by every symbol they hold. A hosted image holds the whole C library, so there the core's
archives are judged by what they ask for from outside.
"""

import argparse
import pathlib
import re
import subprocess
import sys

sys.dont_write_bytecode = True
import stack_depth  # noqa: E402  (the flag above has to come first)

BARE_METAL = ("m7", "m55", "r52")
PREFIX = {"m7": "arm-none-eabi-", "m55": "arm-none-eabi-", "r52": "arm-none-eabi-", "aarch64": "aarch64-linux-gnu-",
          "host": ""}
CORE_ARCHIVES = ("algo/libs4tp_core.a", "firmware/libs4tp_wire.a", "firmware/libs4tp_gate.a", "firmware/libs4tp_ecu.a")

# What must not be in an image, and why.
FORBIDDEN = (
    ("allocator", r"_?(malloc|free|calloc|realloc|memalign|sbrk)(_r)?|_Z(nw|na|dl|da).*|operator (new|delete).*"),
    ("exceptions", r"__cxa_.*|_Unwind_.*|__gxx_personality.*|__aeabi_unwind_cpp_pr[12]|_ZSt9terminatev|__gnu_unwind.*"),
    ("RTTI", r"_ZT[IS].*"),
    ("double", r"__aeabi_(d(?!iv0$).*|[a-z]+2d|cd.*|l2d|ul2d)|__(add|sub|mul|div|eq|ne|lt|le|gt|ge)df.*|__extendsfdf2"
               r"|__truncdfsf2"),
    ("libm", r"(sqrt|sin|cos|tan|asin|acos|atan|atan2|exp|exp2|log|log2|log10|pow|tanh|erf|fmod|floor|ceil|round|fma)f?"
             r"|__ieee754_.*|__kernel_.*"),
    ("recursion of static initialisation", r"__cxa_guard.*|__cxa_atexit|__aeabi_atexit|atexit"),
    ("DDS", r"_?dds[irt]*_.*|.*_msg_dds__.*|.*(cyclone|eprosima|fastdds|fastrtps).*"),
    ("console", r"_?(v?s?n?printf|puts|fwrite|fopen)(_r)?|_ZSt4cout"),
)
FORBIDDEN_SECTIONS = (".ARM.exidx", ".ARM.extab", ".eh_frame", ".gcc_except_table")
# What the core may ask for from outside itself: the compiler's own memory and integer helpers, and our assertion handler.
WANTED = re.compile(r"mem(cpy|set|move|cmp)|str(cmp|len)|__aeabi_mem(cpy|set|move|clr)[48]?|__aeabi_u?(l|i)div(mod)?|__aeabi_l(mul|lsl|lsr|asr)"
                    r"|__aeabi_f2u?lz|__aeabi_u?l2f|_GLOBAL_OFFSET_TABLE_|__stack_chk_(fail|guard)|__(asan|ubsan)_.*"
                    r"|_ZN4s4tp16assertion_failedEPKcS1_i|s4tp_on_assertion")

PLANNER_BUDGET_BYTES = 64 * 1024
# What a Cortex-M with a floating-point unit pushes by itself, with alignment.
EXCEPTION_FRAME_BYTES = 108
# Handlers by priority; those of one do not interrupt one another.
INTERRUPTS = (("pendsv_handler",), ("systick_handler", "uart1_handler"))
SIZE_SYMBOL = "s4tp_size_of_planner"


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def forbidden(symbols):
    """Pairs (symbol, reason) of those that must not be there."""
    return [(symbol, reason) for symbol in symbols for reason, pattern in FORBIDDEN if re.fullmatch(pattern, symbol)]


def unwanted(asked_for):
    """What an archive asks for from outside that is not on the list."""
    return sorted(symbol for symbol in asked_for if not WANTED.fullmatch(symbol))


def parse_symbols(nm_output):
    """(defined, undefined) names of an nm listing."""
    defined, undefined = set(), set()
    for line in nm_output.splitlines():
        parts = line.split()
        if len(parts) >= 2 and len(parts[-2]) == 1:
            (undefined if parts[-2] in "Uwv" and len(parts) == 2 else defined).add(parts[-1])
    return defined, undefined - defined


def parse_regions(script):
    """MEMORY regions of a linker script: name -> (origin, length)."""
    scale = {"": 1, "K": 1024, "M": 1024 * 1024}
    return {name: (int(origin, 0), int(length) * scale[unit]) for name, origin, length, unit in
            re.findall(r"(\w+)\s*\([rwx]+\)\s*:\s*ORIGIN = (\w+), LENGTH = (\d+)([KM]?)", script)}


def parse_segments(readelf_output):
    """(virtual address, load address, bytes in the file, bytes in memory) of each LOAD segment."""
    rows = re.findall(r"^\s*LOAD\s+\S+\s+(0x\w+)\s+(0x\w+)\s+(0x\w+)\s+(0x\w+)", readelf_output, re.MULTILINE)
    return [tuple(int(value, 16) for value in row) for row in rows]


def region_use(regions, segments):
    """Bytes used per region: the file's bytes where they are loaded, memory where it is used."""
    use = dict.fromkeys(regions, 0)

    def add(address, size):
        for name, (origin, length) in regions.items():
            if origin <= address < origin + length:
                use[name] = max(use[name], address + size - origin)

    for virtual, load, file_bytes, memory_bytes in segments:
        add(virtual, memory_bytes)
        if file_bytes:
            add(load, file_bytes)
    return use


def check_image(target, build, image, report):
    prefix = PREFIX[target]
    defined, _ = parse_symbols(run(f"{prefix}nm", image))
    report.extend(f"{image.name}: {symbol} is in the image ({reason})" for symbol, reason in forbidden(sorted(defined))
                  if symbol != "__aeabi_unwind_cpp_pr0")
    headers = run(f"{prefix}readelf", "-SW", image)
    report.extend(f"{image.name}: section {name} is in the image" for name in FORBIDDEN_SECTIONS if f" {name} " in headers)

    folder = pathlib.Path(__file__).parent / "linker"
    regions = parse_regions((folder / f"{target}.ld").read_text(encoding="utf-8"))
    use = region_use(regions, parse_segments(run(f"{prefix}readelf", "-lW", image)))
    for name, (_, length) in regions.items():
        if name == "STACK":
            continue
        print(f"  {image.name}: {name:8s}{use[name]:8d} bytes used, {length - use[name]:8d} free of {length}")

    functions = stack_depth.parse(stack_depth.disassemble(f"{prefix}objdump", image))
    depth, recursive = stack_depth.deepest(functions)
    report.extend(f"{image.name}: {name} calls itself, directly or not" for name in sorted(recursive))
    report.extend(f"{image.name}: the frame of {name} depends on a value" for name, entry in functions.items() if entry[3])
    # A tick may come at the deepest point, and a device or the timer at the deepest point of that: their own paths and
    # what the core saves for them are added.
    control, device = (max(depth.get(name, 0) for name in names) for names in INTERRUPTS)
    deepest = depth["reset_handler"] + sum(path + EXCEPTION_FRAME_BYTES for path in (control, device) if path)
    stack = regions["STACK"][1]
    if deepest > stack:
        report.append(f"{image.name}: the deepest path needs {deepest} of {stack} bytes of stack")
    print(f"  {image.name}: STACK   {deepest:8d} bytes used, {stack - deepest:8d} free of {stack}, deepest direct path: "
          + " > ".join(f"{short(name)} {functions[name][0]}"
                       for name in stack_depth.path_from(functions, depth, "reset_handler") if functions[name][0] >= 64))
    indirect = sorted({short(name) for name, entry in functions.items() if entry[2]})
    print(f"  {image.name}: indirect calls, not followed: {', '.join(indirect) or 'none'}")


def short(name):
    """A function's name without namespaces and parameters."""
    return re.sub(r"\(.*", "", name.replace("(anonymous namespace)::", "")).replace("s4tp::", "")


def check_archives(target, build, report):
    prefix = PREFIX[target]
    archives = [build / name for name in CORE_ARCHIVES]
    listing = run(f"{prefix}nm", *archives)
    defined, undefined = parse_symbols(listing)
    report.extend(f"core: asks for {symbol} from outside" for symbol in unwanted(undefined))
    report.extend(f"core: {symbol} ({reason})" for symbol, reason in forbidden(sorted(defined)))
    sizes = [line.split() for line in run(f"{prefix}size", "-t", *archives).splitlines()][-1]
    print(f"  core archives: code and constants {sizes[0]} bytes, data {sizes[1]}, zeroed {sizes[2]}")


def check_planner_size(target, build, report):
    for library in (build / "firmware/targets").rglob("sizes.cpp.o*"):
        match = re.search(rf"^\w+ (\w+) \w {SIZE_SYMBOL}$", run(f"{PREFIX[target]}nm", "-S", library), re.MULTILINE)
        if match:
            size = int(match[1], 16)
            print(f"  Planner object: {size} bytes used, {PLANNER_BUDGET_BYTES - size} free of {PLANNER_BUDGET_BYTES}")
            if size > PLANNER_BUDGET_BYTES:
                report.append("the Planner object has outgrown its budget")
            return
    report.append("the size of the Planner object is not known: sizes.cpp was not built")


def check_frames(build, report):
    """-fstack-usage: every frame of the core is static."""
    frames = []
    for folder in ("algo", "firmware", "hal"):
        for file in (build / folder).rglob("*.su"):
            for line in file.read_text(encoding="utf-8").splitlines():
                place, size, kind = line.rsplit("\t", 2)
                frames.append((int(size), place))
                if kind.startswith("dynamic") and "bounded" not in kind:
                    report.append(f"dynamic frame: {place}")
    if not frames:
        report.append("no -fstack-usage output found")
        return
    size, place = max(frames)
    print(f"  frames: {len(frames)}, none dynamic, largest {size} bytes: {place.split(':', 3)[-1]}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--target", required=True, choices=sorted(PREFIX))
    parser.add_argument("--build", required=True, type=pathlib.Path)
    parser.add_argument("--image", action="append", default=[], help="path below the build folder")
    arguments = parser.parse_args()
    if not (arguments.build / "algo/libs4tp_core.a").exists():
        print(f"symbols: {arguments.build} is not built; cmake --preset {arguments.target} && cmake --build --preset {arguments.target} does that")
        return 1
    report = []
    print(f"{arguments.target}:")
    check_archives(arguments.target, arguments.build, report)
    if arguments.target in BARE_METAL:
        for image in arguments.image:
            check_image(arguments.target, arguments.build, arguments.build / image, report)
    check_planner_size(arguments.target, arguments.build, report)
    check_frames(arguments.build, report)
    print("\n".join(report) if report else "  heap, exceptions, RTTI, double, libm, DDS: none")
    return 1 if report else 0


if __name__ == "__main__":
    sys.exit(main())
