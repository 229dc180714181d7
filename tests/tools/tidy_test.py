"""The clang-tidy check passes clean code and finds a planted fault."""

import contextlib
import io
import json
import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "toolchain"))
import check_tidy  # noqa: E402


def code_for(source):
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "half.cpp"
        file.write_text(source, encoding="utf-8")
        commands = [{"directory": folder, "command": f"c++ -std=c++17 -c {file}", "file": str(file)}]
        (pathlib.Path(folder) / "compile_commands.json").write_text(json.dumps(commands), encoding="utf-8")
        with contextlib.redirect_stdout(io.StringIO()):
            return check_tidy.main(["--build", folder, str(file)])


class Tidy(unittest.TestCase):
    def test_clean_code_passes(self):
        self.assertEqual(code_for("float half(float whole) { return 0.5F * whole; }\n"), 0)

    # 1 / 2 is 0.
    def test_integer_division_is_found(self):
        self.assertEqual(code_for("float half(float whole) { return (1 / 2) * whole; }\n"), 1)

    def test_a_build_without_our_files_is_no_pass(self):
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()):
            (pathlib.Path(folder) / "compile_commands.json").write_text("[]", encoding="utf-8")
            self.assertEqual(check_tidy.main(["--build", folder]), 1)


if __name__ == "__main__":
    unittest.main()
