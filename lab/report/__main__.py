"""The benchmarks that are written in Python. voxdag-lab runs this folder: python3 lab/report NAME ARGUMENT..."""

import importlib
import importlib.util
import os
import signal
import sys

COMMANDS = {"build": "bench_build", "conformance": "conformance", "esvo": "bench_esvo", "papers": "papers", "show": "show"}


class Cancelled(BaseException):
    """A signal that ends the work."""


def _cancel(number, _frame):
    raise Cancelled(number)


def main():
    name, *arguments = sys.argv[1:]
    assert name in COMMANDS
    # Debian's packages belong to /usr/bin/python3, which may not be the first in PATH.
    if importlib.util.find_spec("matplotlib") is None and sys.executable != "/usr/bin/python3" and os.path.exists(
            "/usr/bin/python3"):
        os.execv("/usr/bin/python3", ["/usr/bin/python3", *sys.argv])
    from child import Program
    from document import Error
    # If one rank fails, mpirun ends the others; only the first says that it was cancelled.
    is_first = os.environ.get("OMPI_COMM_WORLD_RANK", os.environ.get("PMI_RANK", "0")) == "0"
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, _cancel)
    try:
        importlib.import_module(COMMANDS[name]).run(arguments, Program())
        sys.stdout.flush()
    except Error as error:
        print(f"voxdag: {error}", file=sys.stderr)
        return 1
    except OSError as error:
        sys.stdout = None  # it may be what failed
        print(f"voxdag: {error.filename or 'standard output'}: {error.strerror}", file=sys.stderr)
        return 1
    except Cancelled as cancelled:
        if is_first:
            print("voxdag: cancelled", file=sys.stderr)
        return 128 + cancelled.args[0]
    return 0


sys.exit(main())
