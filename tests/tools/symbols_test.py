"""The symbol, memory and stack gate sees planted faults, each linked into a small image for Cortex-M7."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "toolchain"))
import check_symbols  # noqa: E402
import stack_depth  # noqa: E402

CPU = ["-mcpu=cortex-m7", "-mthumb", "-mfloat-abi=hard", "-mfpu=fpv5-sp-d16"]
LINKER = ROOT / "toolchain/linker"


def link(folder, body, libraries=("-lc", "-lgcc")):
    """A small image for Cortex-M7 made from `body`, which defines what reset_handler() calls: work()."""
    source, image = pathlib.Path(folder) / "x.cpp", pathlib.Path(folder) / "x"
    source.write_text(body + '\nextern "C" void reset_handler() { work(); }\n', encoding="utf-8")
    subprocess.run(["arm-none-eabi-g++", *CPU, "-O2", "-fno-exceptions", "-fno-rtti", "-nostartfiles", "-nodefaultlibs",
                    "-Wl,--gc-sections", f"-L{LINKER}", f"-T{LINKER}/m7.ld", source, "-o", image, *libraries],
                   check=True, capture_output=True)
    return image


def report(body, **options):
    with tempfile.TemporaryDirectory() as folder:
        found = []
        check_symbols.check_image("m7", pathlib.Path(folder), link(folder, body, **options), found)
        return found


class Symbols(unittest.TestCase):
    def test_plain_code_passes(self):
        self.assertEqual(report("volatile int x; void work() { x = x + 1; }"), [])

    # With a dummy _sbrk newlib's allocator links; the gate names it.
    def test_malloc_is_found(self):
        found = report('#include <cstdlib>\nextern "C" void* _sbrk(int) { return nullptr; }\n'
                       "void* volatile p; void work() { p = std::malloc(8); }")
        self.assertTrue(any(" malloc is in the image (allocator)" in line for line in found), found)

    # Without _sbrk it does not even link: what protects every real image.
    def test_malloc_does_not_link_without_sbrk(self):
        with tempfile.TemporaryDirectory() as folder, self.assertRaises(subprocess.CalledProcessError):
            link(folder, "#include <cstdlib>\nvoid* volatile p; void work() { p = std::malloc(8); }")

    # A float literal without its F makes double arithmetic: a library call on a single-precision FPU.
    def test_double_arithmetic_is_found(self):
        found = report("volatile float x; void work() { x = x * 1.1; }")
        self.assertTrue(any("__aeabi_dmul" in line for line in found), found)

    def test_recursion_is_found(self):
        found = report("volatile int n; __attribute__((noinline)) int down(int i) { return i < n ? down(i - 1) * i + n : 0; }"
                       "void work() { n = down(n); }")
        self.assertTrue(any("calls itself" in line for line in found), found)

    # 9000 bytes of locals do not fit into a stack of 8 KiB.
    def test_too_deep_a_stack_is_found(self):
        found = report("volatile int n; void work() { volatile char big[9000]; big[n] = 1; n = big[n / 2]; }")
        self.assertTrue(any("bytes of stack" in line for line in found), found)

    # 140 KiB of zeroed data: the linker script's region is the budget.
    def test_too_much_static_memory_does_not_link(self):
        with tempfile.TemporaryDirectory() as folder, self.assertRaises(subprocess.CalledProcessError):
            link(folder, "volatile char big[140 * 1024]; void work() { big[big[0]] = 1; }")

    # What a hosted core asks for from outside is on a list; anything else is named.
    def test_core_asking_for_an_allocator_is_found(self):
        self.assertEqual(check_symbols.unwanted(["memcpy", "_ZN4s4tp16assertion_failedEPKcS1_i"]), [])
        self.assertEqual(check_symbols.unwanted(["memcpy", "malloc", "_Znwm", "expf"]), ["_Znwm", "expf", "malloc"])

    def test_exception_and_type_information_are_found(self):
        names = ["_ZTIN4s4tp3CanE", "_ZTSN4s4tp3CanE", "__cxa_throw", "_Unwind_Resume", "_ZdlPvj"]
        self.assertEqual({name for name, _ in check_symbols.forbidden(names + ["_ZTVN4s4tp3CanE"])}, set(names))

    # Cyclone's functions, what idlc makes of a message, another vendor's; asked for by the core: named, too.
    def test_dds_is_found(self):
        names = ["dds_write", "ddsi_serdata_ref", "ddsrt_malloc", "std_msgs_msg_dds__String__desc", "_ZN8eprosima7fastcdr3CdrE"]
        self.assertEqual([reason for _, reason in check_symbols.forbidden(names)], ["DDS"] * len(names))
        self.assertEqual(check_symbols.unwanted(names), sorted(names))
        self.assertEqual(check_symbols.forbidden(["_ZN4s4tp7address", "add_stage"]), [])

    # push {r4-r7, lr}: 5 registers; vpush {d8-d9}: 16 bytes; sub sp, #24.
    def test_frame_is_read_from_the_prologue(self):
        text = ("00000040 <f>:\n  40:\tpush\t{r4, r5, r6, r7, lr}\n  42:\tvpush\t{d8-d9}\n  46:\tsub\tsp, #24\n"
                "  48:\tbl\t60 <g>\n\n00000060 <g>:\n  60:\tsub.w\tsp, sp, #1024\n  64:\tbx\tlr\n")
        functions = stack_depth.parse(text)
        self.assertEqual(functions["f"][0], 20 + 16 + 24)
        self.assertEqual(stack_depth.deepest(functions)[0]["f"], 60 + 1024)

    # 8 bytes of the caller, which calls by a register, and 16 of the one known to be called there.
    def test_known_indirect_call_is_followed(self):
        caller, callee = (f"{beginning}int)" for beginning in stack_depth.KNOWN_CALLS[0])
        text = (f"00000000 <{caller}>:\n   0:\tpush\t{{r4, lr}}\n   2:\tblx\tr3\n"
                f"00000010 <{callee}>:\n  10:\tpush\t{{r4, r5, r6, lr}}\n")
        self.assertEqual(stack_depth.deepest(stack_depth.parse(text))[0][caller], 8 + 16)


if __name__ == "__main__":
    unittest.main()
