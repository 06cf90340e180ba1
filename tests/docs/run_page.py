#!/usr/bin/env python3
"""Runs a page of docs/ as its reader would, in a temporary folder.

    run_page.py VOXDAG PAGE.md

The blocks of the page run in order:
- ```sh is a bash script. Each `voxdag view` in it must serve its page; the script then goes on.
- ```text is what the block before it prints, up to seconds. Lines that are missing in the page stand as "...".
- ```python is a part of one Python program, whose variables last from block to block.
Other blocks do not run. Exit status: 0 if all of this holds, 1 if not, 77 if a module of Python is missing.
"""

import contextlib
import io
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import traceback
import urllib.request

SKIPPED = 77


def blocks(text):
    """Yields the language, the first line and the text of each fenced block."""
    for block in re.finditer(r"^```(\w*)\n(.*?)^```$", text, re.MULTILINE | re.DOTALL):
        yield block[1], text.count("\n", 0, block.start()) + 2, block[2]


def serve(words):
    """Starts `voxdag view`, reads the page that it serves, and ends it."""
    server = subprocess.Popen([*words, "--no-open"], stdout=subprocess.PIPE, text=True)
    try:
        address = server.stdout.readline().strip()
        with urllib.request.urlopen(address, timeout=60) as page:
            assert b"<html" in page.read(), f"{address} is no page"
    finally:
        server.send_signal(signal.SIGINT)
        server.wait(60)
    return address + "\n"


def run_shell(script):
    """Returns what the script prints. Raises CalledProcessError if a command fails."""
    output = ""
    for part in re.split(r"^(voxdag view .*)$", script, flags=re.MULTILINE):
        if part.startswith("voxdag view "):
            output += serve(part.split("#")[0].split())
        elif part.strip():
            run = subprocess.run(["bash", "-euo", "pipefail", "-c", part], text=True, check=False, stdin=subprocess.DEVNULL,
                                 stdout=subprocess.PIPE)
            output += run.stdout
            if run.returncode != 0:
                print(output)
                raise RuntimeError(f"exit status {run.returncode}")
    return output


def run_python(code, variables):
    """Returns what the code prints."""
    with contextlib.redirect_stdout(io.StringIO()) as output:
        exec(compile(code, "the page", "exec"), variables)
    return output.getvalue()


def compare(shown, printed):
    """Raises RuntimeError unless the shown lines were printed in this order, with gaps only at "...". Times may differ."""
    shown, printed = (re.sub(r"\b\d+\.\d\d s\b", "N s", text) for text in (shown, printed))
    lines = iter(line.rstrip() for line in printed.splitlines())
    may_skip = False
    for want in (line.rstrip() for line in shown.splitlines()):
        if want == "...":
            may_skip = True
            continue
        for line in lines:
            if line == want:
                break
            if not may_skip:
                raise RuntimeError(f"the page shows:\n{want}\nbut the program prints:\n{line}\n\nin:\n{printed}")
        else:
            raise RuntimeError(f"the page shows:\n{want}\nwhich the program does not print:\n{printed}")
        may_skip = False


def run_page(page):
    """Returns the exit status."""
    variables, printed = {"__name__": "__main__"}, ""
    for language, line, text in blocks(page.read_text(encoding="utf-8")):
        try:
            if language == "sh":
                printed = run_shell(text)
            elif language == "python":
                printed = run_python(text, variables)
            elif language == "text":
                compare(text, printed)
        except ModuleNotFoundError as error:
            print(f"{page}:{line}: skipped: {error}")
            return SKIPPED
        except Exception:  # whatever the page's code raises
            traceback.print_exc()
            print(f"{page}:{line}: this block failed:\n{text}")
            return 1
    return 0


def main():
    program, page = (pathlib.Path(argument).resolve() for argument in sys.argv[1:])
    os.environ["PATH"] = f"{program.parent}:{os.environ['PATH']}"
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        status = run_page(page)
        os.chdir("/")
    sys.exit(status)


if __name__ == "__main__":
    main()
