#!/usr/bin/env python3
"""Kills builds in parts at random moments and runs them again, until the output is complete.

usage: kill_test.py VOXDAG RANKS ROUNDS [MPIRUN]

Each round begins with an empty work folder, kills a process of the job (SIGKILL, seldom SIGTERM)
after a random time, and runs the same command again; every second time it kills that run, too.
At the end the output must equal a plain build's, byte for byte.
"""
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

VOXDAG, RANKS, ROUNDS = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
MPIRUN = sys.argv[4] if len(sys.argv) > 4 else "mpirun"


def children(pid):
    """Returns the processes below a process."""
    try:
        with open(f"/proc/{pid}/task/{pid}/children") as file:
            direct = [int(child) for child in file.read().split()]
    except OSError:
        return []
    return direct + [below for child in direct for below in children(child)]


def is_voxdag(pid):
    try:
        return os.path.samefile(f"/proc/{pid}/exe", VOXDAG)
    except OSError:
        return False


def main():
    folder = tempfile.mkdtemp(prefix="voxdag-kill-")
    os.chdir(folder)
    draw = random.Random(1)
    subprocess.run([VOXDAG, "scene", "hairball", "--size", "20", "-o", "mesh.ply", "-q"], check=True)
    options = ["mesh.ply", "-r", "512", "--threads", "1"]
    subprocess.run([VOXDAG, "build", *options, "-o", "plain.vdag", "-q"], check=True)
    with open("plain.vdag", "rb") as file:
        plain = file.read()
    command = [VOXDAG, "build", *options, "--work", "work", "--parts", "12", "-o", "parts.vdag", "-q"]
    if RANKS > 1:
        command = [MPIRUN, "-n", str(RANKS), *command]

    def run(kill_after=None):
        """Runs the command; kills a process of it after a time. Returns the status and the output."""
        job = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
        victims = []
        if kill_after is not None:
            time.sleep(kill_after)
            victims = [pid for pid in [job.pid, *children(job.pid)] if is_voxdag(pid)]
            if victims:
                os.kill(draw.choice(victims), draw.choice([signal.SIGKILL] * 3 + [signal.SIGTERM]))
        _, errors = job.communicate(timeout=120)
        # mpirun can end before the system has forgotten its ranks, whose temporary files stay so long.
        for _ in range(100):
            if not any(os.path.exists(f"/proc/{pid}") for pid in victims):
                break
            time.sleep(0.05)
        return job.returncode, errors

    begin = time.monotonic()
    status, errors = run()
    assert status == 0, errors
    whole = time.monotonic() - begin
    killed = 0
    for number in range(ROUNDS):
        for path in ("work", "parts.vdag"):
            if os.path.isdir(path):
                shutil.rmtree(path)
            elif os.path.exists(path):
                os.remove(path)
        status, errors = run(draw.uniform(0, whole))
        killed += status != 0
        if status != 0 and number % 2 == 0:
            if os.path.exists("parts.vdag"):  # killed after the output was complete
                with open("parts.vdag", "rb") as file:
                    assert file.read() == plain, f"round {number}: a killed build left a wrong output"
            status, errors = run(draw.uniform(0, whole))
        if status != 0:
            status, errors = run()
        assert status == 0, f"round {number}: status {status}: {errors}"
        with open("parts.vdag", "rb") as file:
            assert file.read() == plain, f"round {number}: the output differs"
        left = set(os.listdir("."))
        assert left <= {"mesh.ply", "plain.vdag", "work", "parts.vdag"}, f"round {number}: {left}"
        assert os.listdir("work") == ["log"], f"round {number}: {os.listdir('work')}"
    print(f"{ROUNDS} rounds with {RANKS} rank(s), {killed} of them killed: all outputs are equal")
    os.chdir("/")
    shutil.rmtree(folder)


main()
