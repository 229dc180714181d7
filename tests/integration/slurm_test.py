#!/usr/bin/env python3
"""The Slurm array script on a real slurmctld, slurmd and munged on loopback: its parts join to the bytes of one run.

    slurm_test.py S4TP_TOOL          needs Debian's slurm-wlm and munge; says what is missing and fails without them
"""

import os
import pathlib
import pwd
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "sinfo")
START_S = 60
JOB_S = 200
CAMPAIGN = ["--planner", "constant_speed,blind", "--scenarios", "cruise,overtake", "--guard", "on,off",
            "--episodes", "2"]
PARTS = 3

# As root in a container: no cgroups, no accounting, nothing outside the folder.
SLURM_CONF = """
ClusterName=s4tp
SlurmctldHost={host}({address})
SlurmctldPort={controller_port}
SlurmdPort={daemon_port}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CredType=cred/munge
SlurmUser={user}
SlurmdUser={user}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
MpiDefault=none
ReturnToService=2
MailProg=/bin/true
NodeName={host} NodeAddr={address} CPUs={cpus} State=UNKNOWN
PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


def find(program):
    return shutil.which(program, path=os.environ.get("PATH", "") + ":/usr/sbin:/sbin")


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Cluster:
    """One node that is also the controller. Everything it writes lies in `folder`."""

    def __init__(self, folder):
        self.folder = folder
        self.daemons = []
        self.environment = {**os.environ, "SLURM_CONF": str(folder / "slurm.conf")}
        self.log = open(folder / "daemons.log", "w")

    def __enter__(self):
        for name in ("state", "spool"):
            (self.folder / name).mkdir()
        key = self.folder / "munge.key"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o400)
        host = socket.gethostname().split(".")[0]
        (self.folder / "slurm.conf").write_text(SLURM_CONF.format(
            host=host, address="127.0.0.1", folder=self.folder, user=pwd.getpwuid(os.geteuid()).pw_name,
            controller_port=free_port(), daemon_port=free_port(), cpus=os.cpu_count()))
        self.start("munged", "--foreground", "--force", f"--key-file={key}", f"--socket={self.folder}/munge.socket",
                   f"--pid-file={self.folder}/munged.pid", f"--seed-file={self.folder}/munged.seed",
                   f"--log-file={self.folder}/munged.log")
        self.wait_for("munged", lambda: (self.folder / "munge.socket").exists())
        self.start("slurmctld", "-D", "-i")
        self.start("slurmd", "-D", "-N", host)
        self.wait_for("an idle node", lambda: "idle" in self.run("sinfo", "--noheader", "--format=%T", check=False))
        return self

    def __exit__(self, *_):
        for daemon in reversed(self.daemons):
            daemon.terminate()
        for daemon in reversed(self.daemons):
            try:
                daemon.wait(20)
            except subprocess.TimeoutExpired:
                os.killpg(daemon.pid, signal.SIGKILL)
                daemon.wait()
        self.log.close()

    def start(self, program, *arguments):
        self.daemons.append(subprocess.Popen([find(program), *arguments], env=self.environment, stdout=self.log,
                                             stderr=self.log, stdin=subprocess.DEVNULL, start_new_session=True))

    def run(self, program, *arguments, check=True):
        done = subprocess.run([find(program), *arguments], env=self.environment, capture_output=True, text=True,
                              timeout=60)
        if check and done.returncode:
            sys.exit(f"{program} {' '.join(arguments)}: {done.stderr}")
        return done.stdout

    def wait_for(self, what, holds, limit_s=START_S):
        end = time.monotonic() + limit_s
        while not holds():
            for daemon in self.daemons:
                if daemon.poll() is not None:
                    self.give_up(f"{daemon.args[0]} ended with {daemon.returncode}")
            if time.monotonic() > end:
                self.give_up(f"no {what} after {limit_s} s")
            time.sleep(0.2)

    def give_up(self, reason):
        for log in sorted(self.folder.glob("*.log")):
            print(f"--- {log.name}\n" + "\n".join(log.read_text(errors="replace").splitlines()[-25:]))
        sys.exit(f"slurm_test: {reason}")


def check(holds, what):
    if not holds:
        sys.exit(f"slurm_test: {what}")


def main():
    tool = str(pathlib.Path(sys.argv[1]).resolve())
    missing = [program for program in PROGRAMS if find(program) is None]
    check(not missing, f"{', '.join(missing)} not found: apt-get install --no-install-recommends slurm-wlm munge")
    folder = pathlib.Path(tempfile.mkdtemp(prefix="s4tp_slurm_"))
    folder.chmod(0o755)  # munge looks at the way to its socket
    try:
        subprocess.run([tool, "eval", *CAMPAIGN, "--out", folder / "whole", "--jobs", "2"], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        with Cluster(folder) as cluster:
            cluster.environment["S4TP_TOOL"] = tool
            parts = folder / "parts"
            cluster.run("sbatch", f"--array=1-{PARTS}", "--cpus-per-task=1", f"--chdir={ROOT}",
                        f"--output={folder}/task-%a.txt", str(ROOT / "sim_host/campaign/slurm_array.sh"), *CAMPAIGN,
                        "--out", str(parts))
            cluster.wait_for("end of the array", lambda: cluster.run("squeue", "--noheader").strip() == "", JOB_S)
        said = "".join(task.read_text() for task in sorted(folder.glob("task-*.txt")))
        files = sorted(parts.glob("part-*.jsonl"))
        check(len(files) == PARTS, f"{len(files)} parts instead of {PARTS}; the tasks said:\n{said}")
        merged = subprocess.run([tool, "eval", "merge", *files, "--json", folder / "merged.json"],
                                capture_output=True, text=True)
        check(merged.returncode == 0, f"merge ended with {merged.returncode}: {merged.stdout}{merged.stderr}\n{said}")
        check("16 of 16 episodes done" in merged.stdout, merged.stdout)
        check((folder / "merged.json").read_bytes() == (folder / "whole/results.json").read_bytes(),
              "the parts do not join to the bytes of one run")
        print(f"{PARTS} array tasks joined to the bytes of one run")
    finally:
        shutil.rmtree(folder, ignore_errors=True)


if __name__ == "__main__":
    main()
