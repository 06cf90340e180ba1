"""The command lines of the benchmarks that are written in Python, as apps/voxdag/cli makes them: every error of usage is
one line on standard error, and the exit status is 2."""

import argparse
import os
import re
import sys

from cells import json_text, write_whole
from charts import draw_charts, is_installed
from child import ProgressLine
from document import Error

MIN_LEVELS, MAX_LEVELS = 2, 20


class Parser(argparse.ArgumentParser):
    """The parser of `voxdag bench NAME`. `example`: the arguments of an example, and more lines below."""

    def __init__(self, name, purpose, example):
        super().__init__(prog=f"voxdag bench {name}", description=purpose, allow_abbrev=False,
                         epilog=f"Example:\n  voxdag bench {name} {example}",
                         formatter_class=argparse.RawDescriptionHelpFormatter)

    def error(self, message):
        message = re.sub(r"^argument (?:-\w/)?(-[-\w]+): ", r"\1: ", message)
        print(f"voxdag: {message} (usage: {self.prog} --help)", file=sys.stderr)
        sys.exit(2)


def add_run_options(parser, has_json=True):
    parser.add_argument("--threads", metavar="N", type=whole(1, 1024), help="Number of threads (default: one per processor)")
    parser.add_argument("-q", "--quiet", action="store_true", help="Print no progress")
    if has_json:
        parser.add_argument("--json", action="store_true", help="Print JSON")


def refuse(message):
    """Refuses the text of an option for this reason."""
    raise argparse.ArgumentTypeError(message)


def level(text):
    """Returns the levels of a resolution: 12 for "4K"."""
    found = re.fullmatch(r"(\d+)([kK]?)", text) or refuse(f'"{text}" is not a whole number')
    n = int(found[1]) * (1024 if found[2] else 1)
    lowest, highest = 1 << MIN_LEVELS, 1 << MAX_LEVELS
    if not lowest <= n <= highest or n & (n - 1):
        floor = min(max(1 << max(n.bit_length() - 1, 0), lowest), highest)
        ceil = min(max(floor * 2, lowest), highest) if n > lowest else lowest
        near = f"the nearest is {floor}" if not lowest < n < highest else f"the nearest are {floor} and {ceil}"
        refuse(f"{text} is not a power of two from {lowest} to {highest}; {near}")
    return n.bit_length() - 1


def levels(text):
    """Returns the levels of resolutions that are separated by commas, ascending, each once."""
    return sorted({level(part) for part in text.split(",")})


def one_of(names):
    """Returns a parser of names that are separated by commas."""
    def parse(text):
        parts = text.split(",")
        for part in parts:
            if part not in names:
                refuse(f'"{part}" must be one of {", ".join(names)}')
        return parts
    return parse


def _number(text, lowest, highest, kind):
    try:
        value = kind(text)
    except ValueError:
        refuse(f'"{text}" is not a {"whole " if kind is int else ""}number')
    if not lowest <= value <= highest:
        refuse(f"must be from {lowest:g} to {highest:g}")
    return value


def whole(lowest, highest):
    return lambda text: _number(text, lowest, highest, int)


def seconds(text):
    return _number(text, 1, 1e6, float)


def positive(text):
    return _number(text, sys.float_info.min, sys.float_info.max, float)


def memory(text):
    """Returns bytes: 512 * 2**20 for "512M"."""
    found = (re.fullmatch(r"(\d+\.?\d*|\.\d+)(?:([kKmMgGtT])(?:i?B)?|B)?", text) or
             refuse(f'"{text}" is not an amount of memory such as 512M or 16GiB'))
    size = int(float(found[1]) * 1024 ** (" KMGT".index(found[2].upper()) if found[2] else 0))
    return size if size >= 1 else refuse("must be at least one byte")


def image_size(text):
    found = re.fullmatch(r"(\d+)x(\d+)", text) or refuse("must be WIDTHxHEIGHT, such as 1920x1080")
    size = int(found[1]), int(found[2])
    return size if all(1 <= side <= 1 << 15 for side in size) else refuse("each side must be 1 to 32768 pixels")


def image_sizes(text):
    return [image_size(part) for part in text.split(",")]


def not_negative(highest):
    return lambda text: _number(text, 0, highest, float)


def device(text):
    return text if re.fullmatch(r"cpu|cuda|cuda:\d+|auto", text) else refuse(
        f'"{text}" is not cpu, cuda, cuda:NUMBER or auto')


class _MeshAccess(argparse.Action):
    """Collects options that children get, too."""

    def __call__(self, parser, options, value, name):
        words = [name] if not value else [name, value] if value == "any" else []
        options.mesh_access = options.mesh_access + words


def add_mesh_access(parser):
    parser.set_defaults(mesh_access=[])
    parser.add_argument("--allow-outside", action=_MeshAccess, nargs=0, dest="mesh_access",
                        help="Let the mesh name textures, buffers and material libraries outside its own folder")
    parser.add_argument("--assimp", action=_MeshAccess, dest="mesh_access", metavar="safe|any", choices=["safe", "any"],
                        help="Formats that assimp may read. safe: those whose importers survived fuzzing; any: all "
                        "(default: safe)")


class Output:
    """The output files of a benchmark: JSON, and plots by option."""

    def __init__(self, parser, plots):
        self.parser = parser
        parser.add_argument("-o", "--output", metavar="FILE.json", help="Also write the JSON to a file")
        for option, help_text in plots.items():
            parser.add_argument(option, metavar="FILE.svg", help=help_text)
        self.plots = list(plots)

    def check(self, options, inputs):
        """Call it before the work: refuses files that would overwrite one another, that cannot be written, or that cannot
        be drawn. Raises Error."""
        self.as_json, self.json_file = options.json, options.output
        self.files = {option: getattr(options, option[2:].replace("-", "_")) for option in self.plots}
        self.progress = ProgressLine(options.quiet)
        writers = {}
        for option, file in [("--output", options.output), *self.files.items()]:
            if not file or os.path.exists(file) and not os.path.isfile(file):
                continue
            for path in inputs:
                if os.path.exists(path) and os.path.exists(file) and os.path.samefile(path, file):
                    self.parser.error(f"{option}: would overwrite {path}, an input file")
            writer = writers.setdefault(os.path.realpath(file), option)
            if writer != option:
                self.parser.error(f"{option}: would overwrite {file}, which {writer} writes")
            if not os.access(os.path.dirname(os.path.realpath(file)), os.W_OK):
                raise Error(f"{file}: cannot be created: no such folder, or it cannot be written")
        if any(self.files.values()) and not is_installed():
            raise Error("matplotlib draws the plots, and it is not installed (apt install python3-matplotlib)")

    def write(self, results, text, charts):
        """Writes the files, and prints JSON or text(). `charts`: by option, functions that return a chart of the results,
        or None if there is nothing to plot. Raises Error."""
        self.progress.clear()
        in_json = json_text(results)
        if self.json_file:
            write_whole(self.json_file, in_json)
        for option, file in self.files.items():
            if file:
                chart = charts[option](results)
                if chart is None:
                    raise Error("there is nothing to plot")
                draw_charts([{**chart, "file": os.path.abspath(file)}], "/")
        print(in_json if self.as_json else text(), end="")
