"""Stack depth of an Arm image from its disassembly: frame of each function, who calls whom, recursion.

Works on Thumb code as GCC emits it: frames come from push, vpush and sub sp. Of indirect calls only those in KNOWN_CALLS
can be followed; the functions making them are listed.
"""

import re
import subprocess

FUNCTION = re.compile(r"^[0-9a-f]+ <(.+)>:$")
INSTRUCTION = re.compile(r"^\s*[0-9a-f]+:\t(\S+)(?:\t(.*))?$")
# Virtual calls of ours: the beginnings of the caller's and of the callee's name.
KNOWN_CALLS = [("s4tp::trajectory::generate_candidates(", "s4tp::planner::Planner::Ranking::visit(")]


def registers(operand):
    """How many registers {r4, r5-r7, lr} names."""
    count = 0
    for part in operand[operand.index("{") + 1:operand.index("}")].split(","):
        ends = [int(re.sub(r"\D", "", end) or 0) for end in part.strip().split("-")]
        count += ends[1] - ends[0] + 1 if len(ends) == 2 else 1
    return count


def pushed(mnemonic, operands):
    """Bytes by which an instruction lowers the stack pointer; None where it cannot be known."""
    base = mnemonic.split(".")[0]
    if base in ("push", "stmdb") and (base == "push" or operands.startswith("sp!")):
        return 4 * registers(operands)
    if base == "vpush" or (base == "vstmdb" and operands.startswith("sp!")):
        return (8 if "d" in operands.split("{")[1] else 4) * registers(operands)
    if base == "str" and (match := re.search(r"\[sp, #-(\d+)\]!", operands)):
        return int(match[1])
    if base == "strd" and (match := re.search(r"\[sp, #-(\d+)\]!", operands)):
        return int(match[1])
    if base in ("sub", "subw") and re.match(r"sp(, sp)?, ", operands):
        match = re.search(r"#(\d+)", operands)
        return int(match[1]) if match else None
    return 0


def parse(disassembly):
    """function -> (frame bytes, callees, makes indirect calls, frame unknown)"""
    functions, name = {}, None
    for line in disassembly.splitlines():
        if match := FUNCTION.match(line):
            name = match[1]
            functions[name] = [0, set(), False, False]
            continue
        match = INSTRUCTION.match(line)
        if name is None or not match:
            continue
        mnemonic, operands = match[1], (match[2] or "").split(";")[0].split("@")[0].strip()
        size = pushed(mnemonic, operands)
        entry = functions[name]
        if size is None:
            entry[3] = True
        else:
            entry[0] += size
        if re.match(r"(bl|b)(x|\.w|\.n|eq|ne|cs|cc|mi|pl|vs|vc|hi|ls|ge|lt|gt|le|lx)*(\.w|\.n)?$", mnemonic):
            target = re.search(r"<(.+)>\s*$", operands)
            if target:
                callee = re.sub(r"\+0x[0-9a-f]+$", "", target[1])
                if callee != name:
                    entry[1].add(callee)
                elif mnemonic.startswith("bl") and "+0x" not in target[1]:
                    entry[1].add(callee)  # calls itself
            elif mnemonic.startswith("blx") or (mnemonic.startswith("bx") and operands != "lr"):
                entry[2] = True
    for caller, callee in KNOWN_CALLS:
        for name in functions:
            if name.startswith(caller) and functions[name][2]:
                functions[name][1].update(other for other in functions if other.startswith(callee))
    return functions


def deepest(functions):
    """function -> bytes of its deepest path; and the functions found to be recursive."""
    depth, recursive = {}, set()

    def visit(name, path):
        if name in path:
            recursive.update(path[path.index(name):])
            return 0
        if name not in functions:
            return 0
        if name not in depth:
            frame, callees, _, _ = functions[name]
            depth[name] = frame + max((visit(callee, path + [name]) for callee in sorted(callees)), default=0)
        return depth[name]

    for name in sorted(functions):
        visit(name, [])
    return depth, recursive


def path_from(functions, depth, root):
    path = [root]
    while callees := [callee for callee in functions[path[-1]][1] if callee in depth and callee not in path]:
        path.append(max(callees, key=lambda callee: depth[callee]))
    return path


def disassemble(objdump, image):
    return subprocess.run([objdump, "-d", "-C", "--no-show-raw-insn", str(image)], check=True, capture_output=True,
                          text=True).stdout
