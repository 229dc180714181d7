"""The Debian package installs and runs on a Debian 12 that has nothing but its essential packages: a chroot made for it.

    S4TP_BUILD=BUILD bare_debian_test.py      fails, not skips, where it cannot run
    bare_debian_test.py --possible            exit code 1, and why, where it cannot
"""

import os
import pathlib
import shutil
import socket
import subprocess
import sys
import tempfile
import unittest

# What a new user does; it ends at the first command that does not answer 0. No package but ours was asked for.
JOB = """set -ex
cd "$(mktemp -d)"
s4tp --version
s4tp --help
s4tp run --scenario cruise --seed 0 --record drive.log
s4tp replay drive.log
s4tp run --scenario cruise --seed 0 --bus slcan:tcp:127.0.0.1:PORT --out two_processes
s4tp record --out reference.log
s4tp eval --scenarios cruise,left_turn --episodes 2 --out campaign
s4tp eval report campaign --out page
s4tp risk field
s4tp traffic --scenarios cruise --episodes 1
s4tp view --help
s4tp telemetry --help
test -s /usr/share/man/man1/s4tp.1
echo the package works
"""


def reason():
    """Why it cannot run here; empty: it can."""
    if not shutil.which("mmdebstrap"):
        return "mmdebstrap is missing: apt-get install mmdebstrap"
    namespace = ["unshare", "--mount"] if os.geteuid() == 0 else ["unshare", "--user", "--map-root-user", "--mount"]
    if subprocess.run([*namespace, "true"], stderr=subprocess.DEVNULL, check=False).returncode != 0:
        return "no rights to mount anything, which a chroot needs"
    return ""


class BareDebian(unittest.TestCase):
    def test_package_installs_and_runs(self):
        self.assertEqual(reason(), "")
        with tempfile.TemporaryDirectory(prefix="s4tp_bare_") as name:
            folder = pathlib.Path(name)
            folder.chmod(0o755)  # in a user namespace the caller is another one
            config = pathlib.Path(os.environ["S4TP_BUILD"]) / "CPackConfig.cmake"
            subprocess.run(["cpack", "--config", config, "-B", folder], check=True, stdout=subprocess.DEVNULL, cwd=folder)
            package, = folder.glob("s4tp_*.deb")
            with socket.socket() as probe:  # the chroot has the host's network
                probe.bind(("127.0.0.1", 0))
                port = probe.getsockname()[1]
            (folder / "job").write_text(JOB.replace("PORT", str(port)), encoding="utf-8")
            hooks = [f"copy-in {package} {folder}/job /tmp",
                     f'chroot "$1" apt-get install --yes --no-install-recommends /tmp/{package.name}',
                     'chroot "$1" runuser -u nobody -- sh /tmp/job']
            done = subprocess.run(["mmdebstrap", "--variant=minbase", *(f"--customize-hook={hook}" for hook in hooks), "bookworm", "/dev/null"],
                                  check=False, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            self.assertEqual(done.returncode, 0, done.stdout)
            self.assertIn("\nthe package works\n", done.stdout)


if __name__ == "__main__":
    if sys.argv[1:] == ["--possible"]:
        print(reason())
        sys.exit(1 if reason() else 0)
    unittest.main()
