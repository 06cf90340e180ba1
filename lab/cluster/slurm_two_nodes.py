#!/usr/bin/env python3
"""Builds a DAG under Slurm on two virtual nodes of this machine, each of which fails once.

usage: slurm_two_nodes.py VOXDAG [MESH] [-r N] [--size N] [--keep]

Starts a private Slurm in a temporary folder: munged, slurmctld, and a slurmd for each node. Each
node has a host name and a /dev/shm of its own. Then:

  1. submits examples/cluster/build.slurm, four ranks; kills all processes of node2 while parts are
     built; mpirun ends the job,
  2. submits the job again; freezes all processes of node1, where the job's script runs; Slurm
     notices, and puts the job back into its queue,
  3. restarts node1; the job starts again by itself and completes the output,
  4. compares the output with that of a plain build, byte for byte.

Prints what happens when, and the parts that each run built. Ends its daemons and removes its folder
in any case. Needs Linux with Debian's slurm-wlm, munge and openmpi-bin (their services need not
run), and root or user namespaces. Changes nothing outside its folder.
"""
import argparse
import contextlib
import ctypes
import filecmp
import os
import pathlib
import pwd
import re
import shlex
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

EXAMPLE = pathlib.Path(__file__).resolve().parents[2] / "examples" / "cluster" / "build.slurm"
PACKAGES = {"slurmctld": "slurm-wlm", "slurmd": "slurm-wlm", "sbatch": "slurm-wlm",
            "munged": "munge", "mpirun": "openmpi-bin", "unshare": "util-linux"}
PATH = os.environ["PATH"] + ":/usr/sbin"  # where Debian keeps the daemons
NODES = ("node1", "node2")
FAILURES = ("FAILED", "NODE_FAIL", "TIMEOUT", "CANCELLED")
CONFIG = """\
ClusterName=voxdag
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ports[0]}
SlurmUser={user}
SlurmdUser={user}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool/%n
TmpFS={folder}/tmp/%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd-%n.pid
SlurmctldLogFile={folder}/log/slurmctld
SlurmdLogFile={folder}/log/slurmd-%n

# Looks for jobs to start every 2 seconds. A job that lost its node waits until its credentials
# expire: 5 seconds instead of 2 minutes.
SchedulerParameters=sched_interval=2,bf_interval=2
AuthInfo=socket={folder}/munge.socket,cred_expire=5

# Nothing needs cgroups.
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory

# A node that does not answer for some seconds is down, and comes back only by hand.
SlurmdTimeout=5
MessageTimeout=3
KillWait=2
ReturnToService=0

# The nodes may have more processors and memory than the machine.
SlurmdParameters=config_overrides
NodeName=node1 NodeAddr=127.0.0.1 Port={ports[1]} CPUs=16 RealMemory=65536
NodeName=node2 NodeAddr=127.0.0.1 Port={ports[2]} CPUs=16 RealMemory=65536
PartitionName=all Nodes=node1,node2 Default=YES State=UP
"""


def below(pid):
    """Returns the processes below a process."""
    try:
        with open(f"/proc/{pid}/task/{pid}/children", encoding="utf-8") as file:
            direct = [int(child) for child in file.read().split()]
    except OSError:
        return []
    return direct + [lower for child in direct for lower in below(child)]


def send(number, pids):
    for pid in pids:
        with contextlib.suppress(ProcessLookupError):
            os.kill(pid, number)


def adopt_orphans():
    """Makes this process the parent of those below it that lose their own, so that below() sees
    them: Slurm's daemons detach what they start."""
    set_child_subreaper = 36
    if ctypes.CDLL(None).prctl(set_child_subreaper, 1, 0, 0, 0) != 0:
        raise OSError("prctl cannot make this process a subreaper")


def kill_until_none(pids):
    """Kills the processes that a function returns, until it returns none."""
    while some := pids():
        send(signal.SIGKILL, some)
        with contextlib.suppress(ChildProcessError):
            os.waitpid(-1, os.WNOHANG)
        time.sleep(0.01)


def wait_for(what, seconds, condition):
    """Returns the first true value of a condition. Exits after so many seconds."""
    end = time.monotonic() + seconds
    while not (value := condition()):
        if time.monotonic() > end:
            sys.exit(f"waited {seconds} s in vain: {what}; --keep keeps the logs")
        time.sleep(0.1)
    return value


class Cluster:
    """A private Slurm with two nodes. All of it is below this process and in one folder."""

    def __init__(self, folder, voxdag):
        self.folder, self.daemons, self.begin = folder, {}, time.monotonic()
        self.environment = {name: value for name, value in os.environ.items()
                            if not re.match("SLURM|SBATCH|SRUN|PMI|OMPI_COMM", name)}
        self.environment |= {"SLURM_CONF": f"{folder}/slurm.conf", "TMPDIR": f"{folder}/tmp",
                             "PATH": f"{voxdag.parent}:{PATH}"}
        if os.getuid() == 0:
            self.environment |= {"OMPI_ALLOW_RUN_AS_ROOT": "1",
                                 "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}

    def say(self, text):
        print(f"{time.monotonic() - self.begin:6.1f} s  {text}", flush=True)

    def run(self, *command, check=True):
        """Returns what a command prints. Exits if it fails, unless `check` is false."""
        done = subprocess.run(command, env=self.environment, cwd=self.folder, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        if check and done.returncode != 0:
            sys.exit(f"{shlex.join(command)}\n{done.stdout}ended with {done.returncode}")
        return done.stdout.strip()

    def start(self):
        for name in ("log", "state", *(f"{kind}/{node}" for kind in ("spool", "tmp") for node in NODES)):
            (self.folder / name).mkdir(parents=True)
        with contextlib.ExitStack() as stack:
            sockets = [stack.enter_context(socket.socket()) for _ in range(3)]
            for one in sockets:
                one.bind(("127.0.0.1", 0))
            ports = [one.getsockname()[1] for one in sockets]
        (self.folder / "slurm.conf").write_text(CONFIG.format(
            folder=self.folder, ports=ports, user=pwd.getpwuid(os.getuid()).pw_name,
            host=socket.gethostname()))
        (self.folder / "munge.key").touch(mode=0o600)
        (self.folder / "munge.key").write_bytes(os.urandom(128))
        self.start_daemon("munged", "munged", "--foreground",
                          "--force",  # although other users cannot reach the socket
                          f"--socket={self.folder}/munge.socket",
                          f"--key-file={self.folder}/munge.key",
                          f"--pid-file={self.folder}/munged.pid",
                          f"--log-file={self.folder}/log/munged",
                          f"--seed-file={self.folder}/munged.seed")
        wait_for("munged runs", 10, (self.folder / "munge.socket").exists)
        self.start_daemon("slurmctld", "slurmctld", "-D")
        wait_for("slurmctld answers", 20, lambda: " UP" in self.run("scontrol", "ping", check=False))
        for node in NODES:
            self.start_node(node)
        for node in NODES:
            self.wait_for_node(node, "idle")

    def start_daemon(self, name, *command):
        with open(self.folder / "log" / f"{name}.out", "ab") as output:
            self.daemons[name] = subprocess.Popen(
                command, env=self.environment, cwd=self.folder, stdin=subprocess.DEVNULL,
                stdout=output, stderr=output, start_new_session=True, preexec_fn=adopt_orphans)

    def start_node(self, node):
        """Starts a slurmd in namespaces with another host name and another /dev/shm: Open MPI names
        its shared memory after the host, and ranks of two nodes must not meet there."""
        slurmd = ["slurmd", "-D", "-N", node]
        unshare = ["unshare", "--uts", "--mount"]
        if os.getuid() != 0:  # becomes root in a user namespace, and itself again in another one
            slurmd = ["unshare", f"--map-user={os.getuid()}", f"--map-group={os.getgid()}", *slurmd]
            unshare.append("--map-root-user")
        self.start_daemon(
            node, *unshare, "sh", "-c",
            f"hostname {node} && mount -t tmpfs tmpfs /dev/shm && exec {shlex.join(slurmd)}")

    def processes(self, name):
        """Returns a daemon and all processes that it started."""
        pid = self.daemons[name].pid
        return [pid, *below(pid)]

    def freeze_node(self, node):
        send(signal.SIGSTOP, self.processes(node))

    def kill_node(self, node):
        others = [name for name in self.daemons if name != node]
        kill_until_none(lambda: set(below(os.getpid())).difference(*map(self.processes, others)))

    def restart_node(self, node):
        """Starts a node that Slurm has taken out of service."""
        self.start_node(node)
        wait_for(f"{node} answers", 60, lambda: "*" not in self.node_state(node))
        self.run("scontrol", "update", f"NodeName={node}", "State=RESUME")
        self.say(f"{node} is back: scontrol update NodeName={node} State=RESUME")

    def node_state(self, node):
        """Returns the state; a * behind it says that the node does not answer."""
        return self.run("sinfo", "-h", "-n", node, "-o", "%T")

    def wait_for_node(self, node, state):
        wait_for(f"{node} is {state}", 60, lambda: self.node_state(node).startswith(state))

    def submit(self, *arguments):
        """Submits the example and returns the number of the job. Each rank gets one thread, because
        the nodes share one machine."""
        job = self.run("sbatch", "--parsable", "--output=job-%j.out", "--open-mode=append",
                       "--cpus-per-task=1", "--mem-per-cpu=512M", str(EXAMPLE), *arguments)
        self.say(f"job {job}: sbatch build.slurm {' '.join(arguments)}")
        return job

    def job(self, job):
        """Returns what Slurm says about a job."""
        shown = self.run("scontrol", "-o", "show", "job", job)
        return dict(word.partition("=")[::2] for word in shown.split())

    def wait_for_state(self, job, *states):
        """Waits until a job is in one of some states, and returns the state."""
        wait_for(f"job {job} is {' or '.join(states)}", 600,
                 lambda: self.job(job)["JobState"] in states)
        return self.job(job)["JobState"]

    def wait_for_parts(self, job, log, parts):
        """Waits until a job has built so many parts. Exits if the job ends before."""
        wait_for(f"job {job} builds {parts} parts", 600, lambda: log.count() >= parts or
                 self.job(job)["JobState"] in ("COMPLETED", *FAILURES))
        if log.count() < parts:
            sys.exit(f"job {job} ended before it had built {parts} parts; it printed:\n"
                     f"{self.output_of(job)}")

    def output_of(self, job):
        return (self.folder / f"job-{job}.out").read_text()

    def end(self):
        kill_until_none(lambda: below(os.getpid()))


class PartsLog:
    """The logs of all ranks, which grow by a line for each part."""

    def __init__(self, work):
        self.folder, self.before = work / "log", {}

    def built(self):
        """Returns how many parts each rank has built since mark()."""
        lines = {path.stem: path.read_text().count("\n") for path in self.folder.glob("*.jsonl")}
        return {rank: lines[rank] - self.before.get(rank, 0) for rank in sorted(lines)}

    def count(self):
        return sum(self.built().values())

    def mark(self):
        """Returns built() as text, and counts from now on."""
        built = self.built()
        for rank, count in built.items():
            self.before[rank] = self.before.get(rank, 0) + count
        return f"{sum(built.values())} parts (" + ", ".join(
            f"{rank}: {count}" for rank, count in built.items()) + ")"


def build_with_failures(cluster, mesh, resolution):
    """Returns the output of the build."""
    output = cluster.folder / "slurm.vdag"
    arguments = [str(mesh), str(output), resolution]
    log = PartsLog(pathlib.Path(f"{output}.work"))

    job = cluster.submit(*arguments)
    cluster.wait_for_parts(job, log, 6)
    cluster.kill_node("node2")
    cluster.say("node2 is killed")
    state = cluster.wait_for_state(job, "PENDING", "COMPLETED", *FAILURES)
    cluster.say(f"job {job} is {state}; it built {log.mark()}")
    cluster.wait_for_node("node2", "down")
    cluster.say("Slurm has noticed that node2 is down")
    cluster.restart_node("node2")

    job = cluster.submit(*arguments)
    cluster.wait_for_parts(job, log, 6)
    cluster.freeze_node("node1")
    cluster.say("node1 is frozen")
    cluster.wait_for_node("node1", "down")
    cluster.say("Slurm has noticed that node1 is down")
    state = cluster.wait_for_state(job, "PENDING", "COMPLETED", *FAILURES)
    cluster.say(f"job {job} is {state}; it built {log.mark()}")
    cluster.kill_node("node1")
    cluster.restart_node("node1")
    state = cluster.wait_for_state(job, "COMPLETED", *FAILURES)
    cluster.say(f"job {job} is {state}, restarts: {cluster.job(job)['Restarts']}; it built {log.mark()}")
    print(cluster.output_of(job), end="")
    if state != "COMPLETED":
        sys.exit(1)
    return output


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("voxdag", type=pathlib.Path)
    parser.add_argument("mesh", type=pathlib.Path, nargs="?", help="default: the scene hairball")
    parser.add_argument("-r", "--resolution", default="4K")
    parser.add_argument("--size", default="1000", help="hairs of the hairball")
    parser.add_argument("--keep", action="store_true", help="keep the folder, to read its logs")
    arguments = parser.parse_args()
    missing = [name for name in PACKAGES if shutil.which(name, path=PATH) is None]
    if missing:
        sys.exit(f"{', '.join(missing)}: not found; on Debian: apt-get install "
                 f"{' '.join(sorted({PACKAGES[name] for name in missing}))}")

    adopt_orphans()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))
    folder = pathlib.Path(tempfile.mkdtemp(prefix="voxdag-slurm-"))
    cluster = Cluster(folder, arguments.voxdag.resolve())
    try:
        mesh = arguments.mesh.resolve() if arguments.mesh else folder / "mesh.ply"
        if not arguments.mesh:
            cluster.run("voxdag", "scene", "hairball", "--size", arguments.size, "-o", str(mesh))
        cluster.start()
        cluster.say(f"{cluster.run('slurmd', '-V')}, {cluster.run('mpirun', '--version').splitlines()[0]}: "
                    "two nodes are idle")
        output = build_with_failures(cluster, mesh, arguments.resolution)
        begin = time.monotonic()
        cluster.run("voxdag", "build", str(mesh), "-r", arguments.resolution, "-o", "plain.vdag")
        cluster.say(f"a plain build took {time.monotonic() - begin:.1f} s")
        is_equal = filecmp.cmp(output, folder / "plain.vdag", shallow=False)
        print(f"The outputs are {'equal' if is_equal else 'NOT EQUAL'}: {output.stat().st_size:,} bytes")
        return 0 if is_equal else 1
    finally:
        cluster.end()
        if not arguments.keep:
            shutil.rmtree(folder)


sys.exit(main())
