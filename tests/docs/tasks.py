#!/usr/bin/env python3
"""Counts and times the commands of docs/cookbook/tasks.md, and prints the page's table.

    tasks.py PAGE.md --check                                        exit status 1 if the page's table has other counts
    tasks.py PAGE.md VOXDAG BEFORE PYTHON BEFORE_PYTHON             runs all, prints the table

VOXDAG and BEFORE are the program and its forerunner; PYTHON and BEFORE_PYTHON are the folders of their Python modules. Each section
with a block "before" is a task. A command is a line of a shell block, or a statement of a Python block that neither imports nor
asserts. Seconds are those of processors, of the commands and all that they start.
"""

import ast
import os
import pathlib
import re
import resource
import subprocess
import sys
import tempfile

from run_page import blocks


def commands_of(language, text):
    """Returns the commands of a block, as text."""
    if language == "sh":
        return [line for line in text.splitlines() if line.strip()]
    return [ast.unparse(node) for node in ast.parse(text).body if not isinstance(node, (ast.Import, ast.ImportFrom, ast.Assert))]


def tasks_of(text):
    """Yields the title, the language, and the blocks of now and before of each task."""
    for section in re.split(r"^## ", text, flags=re.MULTILINE)[1:]:
        found = [(language, block) for language, _, block in blocks(section)]
        if found[-1][0] == "before":
            (language, now), (_, before) = found
            yield section.partition("\n")[0], language, now, before


def run(language, text, program, module):
    """Runs a block in the working folder. Returns whether it succeeds."""
    words = ["bash", "-euo", "pipefail", "-c", text] if language == "sh" else [sys.executable, "-c", text]
    environment = dict(os.environ, PATH=f"{program}:{os.path.dirname(sys.executable)}:{os.environ['PATH']}", PYTHONPATH=str(module))
    return subprocess.run(words, env=environment, check=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                          stdin=subprocess.DEVNULL).returncode == 0


def fails(command, *forerunner):
    """Returns whether a command of the shell fails, or writes a DAG under another name."""
    name = re.search(r"-o (\S+)", command)
    return not run("sh", command, *forerunner) or (
        name is not None and not name[1].endswith(".vdag") and pathlib.Path(name[1]).read_bytes()[:5] == b"\x89VDAG")


def seconds(*arguments):
    """Returns the processor seconds of a block, which must succeed."""
    start = resource.getrusage(resource.RUSAGE_CHILDREN)
    if not run(*arguments):
        sys.exit(f"this block fails:\n{arguments[1]}")
    end = resource.getrusage(resource.RUSAGE_CHILDREN)
    return end.ru_utime + end.ru_stime - start.ru_utime - start.ru_stime


def table(page, now, before):
    """Yields the rows. `now` and `before` are folders of a program named voxdag and of its module."""
    text = page.read_text(encoding="utf-8")
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        run("sh", next(block for language, _, block in blocks(text) if language == "sh"), *now)
        for title, language, shown, old in tasks_of(text):
            counts = [len(commands_of(language, block)) for block in (old, shown)]
            times = [seconds(language, old, *before), seconds(language, shown, *now)]
            if language == "sh":
                failed = sum(fails(command, *before) for command in commands_of(language, shown))
            else:  # one program: all from the first statement that fails
                lines = commands_of(language, shown)
                head = "import numpy as np\nimport voxdag\n"
                failed = sum(not run(language, head + "\n".join(lines[:i + 1]), *before) for i in range(len(lines)))
            yield f"| {title} | {counts[0]} | {counts[1]} | {times[0]:.1f} | {times[1]:.1f} | {failed} |"
        os.chdir("/")


def main():
    page = pathlib.Path(sys.argv[1]).resolve()
    if sys.argv[2:] == ["--check"]:
        text = page.read_text(encoding="utf-8")
        for title, language, shown, old in tasks_of(text):
            row = f"| {title} | {len(commands_of(language, old))} | {len(commands_of(language, shown))} |"
            if f"\n{row}" not in text:
                sys.exit(f"{page}: the table has no row\n{row}")
        return
    program, forerunner, module, old_module = (pathlib.Path(name).resolve() for name in sys.argv[2:])
    with tempfile.TemporaryDirectory() as folder:
        for name, target in (("now", program), ("before", forerunner)):
            (pathlib.Path(folder) / name).mkdir()
            (pathlib.Path(folder) / name / "voxdag").symlink_to(target)
        for row in table(page, (f"{folder}/now", module), (f"{folder}/before", old_module)):
            print(row)


if __name__ == "__main__":
    main()
