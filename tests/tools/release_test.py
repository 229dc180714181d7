"""The release archive is what is committed, the same bytes each time."""

import os
import pathlib
import shutil
import subprocess
import tarfile
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]


def git(tree, *words, **environment):
    identity = {f"GIT_{role}_{what}": text for role in ("AUTHOR", "COMMITTER") for what, text in (("NAME", "a"), ("EMAIL", "a@localhost"))}
    subprocess.run(["git", "-C", tree, *words], check=True, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                   env={**os.environ, "GIT_CONFIG_GLOBAL": "/dev/null", **identity, **environment})


def release(tree, umask, zone):
    subprocess.run(["bash", "-c", f"umask {umask}; exec toolchain/release.sh ../out_{tree.name}"], cwd=tree, check=True, stdout=subprocess.DEVNULL,
                   env={**os.environ, "TZ": zone})
    archive, = (tree.parent / f"out_{tree.name}").iterdir()
    return archive


class Release(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="s4tp_release_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.tree = self.folder / "tree"
        for path in ("CMakeLists.txt", "s4tp", "toolchain/release.sh", "docs/view.png"):
            (self.tree / path).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / path, self.tree / path)
        git(self.tree, "init", "--quiet")
        git(self.tree, "add", ".")
        git(self.tree, "commit", "--quiet", "-m", "all")

    # Made here, and from a clone with other file times, another umask, another time zone.
    def test_twice_is_the_same_to_the_byte(self):
        git(self.folder, "clone", "--quiet", "tree", "clone", TZ="Asia/Tokyo")
        for file in (self.folder / "clone").iterdir():
            os.utime(file, (1e9, 1e9))
        first, second = release(self.tree, "022", "UTC"), release(self.folder / "clone", "077", "Asia/Tokyo")
        self.assertEqual(first.name, second.name)
        self.assertEqual(first.read_bytes(), second.read_bytes())

    # Other contents are other bytes; what is not committed is not in it; the folder in it bears the version.
    def test_it_is_what_is_committed(self):
        before = release(self.tree, "022", "UTC").read_bytes()
        (self.tree / "new").write_text("not committed", encoding="utf-8")
        archive = release(self.tree, "022", "UTC")
        self.assertEqual(archive.read_bytes(), before)
        git(self.tree, "add", "new")
        git(self.tree, "commit", "--quiet", "-m", "new")
        archive = release(self.tree, "022", "UTC")
        self.assertNotEqual(archive.read_bytes(), before)
        version = subprocess.run([self.tree / "s4tp", "--version"], check=True, stdout=subprocess.PIPE, text=True).stdout.split()[1]
        with tarfile.open(archive) as files:
            names = files.getnames()
        self.assertIn(f"s4tp-{version}/new", names)
        self.assertEqual({name.split("/")[0] for name in names}, {f"s4tp-{version}"})


if __name__ == "__main__":
    unittest.main()
