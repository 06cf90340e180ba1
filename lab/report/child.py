"""Runs programs and measures their time and memory; describes the machine."""

import ctypes
import os
import platform
import select
import signal
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, field

from document import Error


@dataclass
class Program:
    """The voxdag that is measured. lab/main.cpp sets the variables."""
    path: str = field(default_factory=lambda: os.environ.get("VOXDAG_LAB_VOXDAG", "voxdag"))
    name: str = field(default_factory=lambda: os.environ.get("VOXDAG_LAB_NAME", "voxdag"))


def machine_json():
    """Returns processor, cores, memory, system, time and load as JSON."""
    processor = "unknown"
    with open("/proc/cpuinfo", encoding="utf-8") as info:
        for line in info:
            if line.startswith("model name"):
                processor = line.split(":", 1)[1].strip()
                break
    system = platform.uname()
    return {"processor": processor, "cores": os.cpu_count(),
            "memory_bytes": os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"),
            "system": f"{system.system} {system.release} {system.machine}",
            "time": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime()),
            "load_average": os.getloadavg()[0]}


def machine_line(machine):
    """Returns the line above a table."""
    return f"{machine['processor']} ({machine['cores']} cores), load average {machine['load_average']:.2f} before\n\n"


class ScratchFolder:
    """A folder for temporary files. A shell removes it when this object is closed or when this
    process ends, even by SIGKILL: then the shell's standard input ends."""

    KEEPER = "trap '' PIPE; d=$(mktemp -d -- \"$1\") || exit 1; echo \"$d\"; read -r _; rm -rf -- \"$d\""

    def __init__(self, parent=None):
        pattern = os.path.join(parent or tempfile.gettempdir(), "voxdag-bench-XXXXXX")
        self._keeper = subprocess.Popen(
            ["sh", "-c", self.KEEPER, "sh", pattern], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL, start_new_session=True)  # Ctrl-C does not end it
        self.path = self._keeper.stdout.readline().decode().rstrip("\n")
        if not self.path:
            self.close()
            raise Error(f"{pattern}: cannot create the folder")

    def close(self):
        self._keeper.stdin.close()
        self._keeper.stdout.close()
        self._keeper.wait()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


@dataclass
class Child:
    status: int  # the exit status, or 128 + the signal that ended it
    timed_out: bool
    cost: dict  # wall_seconds, user_seconds, system_seconds, peak_memory_bytes of the largest process
    out: str
    err: str

    def failure(self, limit):
        """Returns why the child failed, such as the first line of its errors; or ""."""
        if self.timed_out:
            return f"stopped at the time limit of {limit:g} s"
        if self.status == 0:
            return ""
        line = self.err.split("\n", 1)[0].removeprefix("voxdag: ")
        if line:
            return line
        return f"killed by signal {self.status - 128}" if self.status > 128 else f"exit status {self.status}"


_LIBC = ctypes.CDLL(None)
_SET_PDEATHSIG = 1  # ends the child if this process is killed


def _begin_child():
    os.setpgid(0, 0)
    _LIBC.prctl(_SET_PDEATHSIG, signal.SIGTERM)


def _wait(child, limit):
    """Waits for the child until the time limit; returns whether it ended."""
    handle = os.pidfd_open(child.pid)
    try:
        return bool(select.select([handle], [], [], limit if limit > 0 else None)[0])
    finally:
        os.close(handle)


def _stop(child):
    """Ends the child and its children: first with SIGTERM, then with SIGKILL."""
    os.killpg(child.pid, signal.SIGTERM)
    _wait(child, 5)
    os.killpg(child.pid, signal.SIGKILL)


def run_child(command, directory, limit=0):
    """Runs the command in a folder, for at most `limit` seconds if that is above 0. The peak memory
    that Linux reports is at least that of this process, which should use little. Raises Error if
    the program cannot be started."""
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        start = time.monotonic()
        try:
            child = subprocess.Popen(command, cwd=directory, stdin=subprocess.DEVNULL, stdout=out, stderr=err,
                                     preexec_fn=_begin_child)
        except OSError as error:
            raise Error(f"{command[0]}: {error.strerror}") from error
        try:
            timed_out = not _wait(child, limit)
        except BaseException:  # a signal ends this program
            _stop(child)
            child.wait()
            raise
        if timed_out:
            _stop(child)
        seconds = time.monotonic() - start
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = status
        try:
            os.killpg(child.pid, signal.SIGKILL)  # processes that the child left running
        except ProcessLookupError:
            pass
        texts = []
        for stream in (out, err):
            stream.seek(0)
            texts.append(stream.read().decode(errors="replace"))
    cost = {"wall_seconds": seconds, "user_seconds": usage.ru_utime, "system_seconds": usage.ru_stime,
            "peak_memory_bytes": usage.ru_maxrss * 1024}
    code = os.WEXITSTATUS(status) if os.WIFEXITED(status) else 128 + os.WTERMSIG(status)
    return Child(code, timed_out, cost, *texts)


def cpu_seconds(cost):
    return cost["user_seconds"] + cost["system_seconds"]


class ProgressLine:
    """A line on standard error that says what runs, if that is a terminal."""

    def __init__(self, quiet):
        self.shown = not quiet and sys.stderr.isatty()

    def show(self, text):
        if self.shown:
            width = os.get_terminal_size(sys.stderr.fileno()).columns - 1
            print(f"\r\x1b[K{text[:width]}", end="", file=sys.stderr, flush=True)

    def clear(self):
        self.show("")


