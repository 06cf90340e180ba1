"""The measurements of a report. Each is a run of voxdag in a process of its own. Finished runs are kept, so that an
interrupted report continues where it stopped, and so that several processes can share the runs."""

import hashlib
import json
import math
import os
import time
from dataclasses import dataclass, field

from child import cpu_seconds, machine_json, run_child
from document import CommandLine, Error, Paragraph
from text import NAN, human_duration, short_resolution


@dataclass
class Cell:
    """A run of voxdag."""
    arguments: list  # without the program: "build", "a.obj", "--json"
    inputs: list = field(default_factory=list)  # files that it reads: each is an argument or a part of one
    output: str = ""  # the file that it writes
    device: str = ""  # name of the CUDA device that it uses
    limit: float = 0  # seconds; 0: none
    prints_json: bool = True
    keeps_output: bool = False  # a kept result counts only if the output is still the same

    def _replaced(self, argument, name_of_input, name_of_output):
        for path in self.inputs:
            if path in argument:  # the input may follow "NAME=", and options may follow the input
                argument = argument.replace(path, name_of_input(path), 1)
                break
        if self.output and not self.output.startswith("/dev/") and argument.endswith(self.output):
            argument = argument[:-len(self.output)] + name_of_output
        return argument

    def command(self):
        """Returns one line for a reader, with files without their folders: "voxdag build sponza.obj -r 1024"."""
        words = [self._replaced(word, os.path.basename, os.path.basename(self.output)) for word in self.arguments]
        return " ".join(["voxdag"] + [f"'{word}'" if " " in word else word for word in words])

    def key_lines(self, contents):
        ending = os.path.splitext(self.output)[1]
        return [self._replaced(word, lambda path: "content " + contents[path], ending) for word in self.arguments]


@dataclass
class Result:
    failure: str = ""  # why there is no JSON
    json: object = None  # what the command printed; None if it prints no JSON
    cost: dict = field(default_factory=lambda: {"wall_seconds": 0, "user_seconds": 0, "system_seconds": 0,
                                                "peak_memory_bytes": 0})


def write_whole(path, text):
    """Writes a file by renaming a finished one. Raises Error."""
    is_device = os.path.exists(path) and not os.path.isfile(path)
    part = path if is_device else f"{path}.{os.getpid()}.part"
    try:
        with open(part, "w", encoding="utf-8") as file:
            file.write(text)
        if not is_device:
            os.replace(part, path)
    except OSError as error:
        raise Error(f"{path}: {error.strerror}") from error


def json_text(value):
    """Returns JSON in which NaN is null."""
    def clean(value):
        if isinstance(value, float) and not math.isfinite(value):
            return None
        if isinstance(value, dict):
            return {key: clean(of_key) for key, of_key in value.items()}
        return [clean(element) for element in value] if isinstance(value, (list, tuple)) else value
    return json.dumps(clean(value), indent=2, ensure_ascii=False) + "\n"


class CellStore:
    """Runs cells, and keeps their results as JSON files in a folder, which several ranks may share. A result is used
    again only for the same arguments, contents of the inputs, program (version and commit), processor, number of
    cores, number of ranks on a machine, and CUDA device. Textures and material files that a mesh names do not count.

    A rank runs a cell only while `is_mine` is set; else it waits until another rank has run it."""

    def __init__(self, folder, directory, program, at_once=1, progress=None, rank=0):
        self.folder, self.directory, self.program, self.at_once, self.rank = folder, directory, program, at_once, rank
        self.progress = progress
        self.is_mine = True
        self.check_others = lambda: None  # called while this rank waits; may raise Error
        self.contents = {}  # by input: its checksum, or the key of the cell that writes it
        self.writers = {}  # cells, by output
        self.used, self.ran = set(), set()  # keys
        self.rank_of = {}  # by key: the rank that ran the command
        os.makedirs(folder, exist_ok=True)
        self.kept_before = {name[:-5] for name in os.listdir(folder) if name.endswith(".json")}
        machine = machine_json()
        self.machine = f"{program.name}\n{machine['processor']}\n{machine['cores']}"

    @property
    def measured(self):
        """The number of commands that were run for this report, also by other ranks."""
        return len(self.used - self.kept_before | self.ran)

    def measured_by(self, rank):
        """The number of those commands that a rank ran."""
        return sum(self.rank_of[key] == rank for key in self.used - self.kept_before | self.ran)

    @property
    def kept(self):
        return len(self.used) - self.measured

    def _key_of(self, cell):
        lines = [self.machine, f"{cell.limit:g}", f"{self.at_once} at once", cell.device] + cell.key_lines(self.contents)
        return hashlib.sha256("\n".join(lines).encode()).hexdigest()[:32]

    def _file_of(self, key):
        return os.path.join(self.folder, key + ".json")

    @staticmethod
    def _output_check(cell):
        if not cell.keeps_output or not os.path.exists(cell.output):
            return ""
        with open(cell.output, "rb") as file:
            return hashlib.sha256(file.read()).hexdigest()

    def _read(self, key, cell):
        """Returns the kept result; None if there is none, or if it is damaged or belongs to another output."""
        try:
            with open(self._file_of(key), encoding="utf-8") as file:
                kept = json.load(file)
            if kept["output_check"] == self._output_check(cell):
                self.rank_of[key] = kept["rank"]
                return Result(kept["failure"], kept["result"], kept["cost"])
        except (OSError, ValueError, KeyError, TypeError):
            pass
        return None

    def run(self, cell):
        """Returns the kept result, or runs the command and keeps its result, also if it fails. Before a run, makes
        those inputs that are outputs of earlier cells and were removed. Raises Error."""
        key = self._key_of(cell)
        if cell.output:
            self.contents[cell.output] = key
            self.writers[cell.output] = cell
        self.used.add(key)
        result = self._read(key, cell)
        while result is None and not self.is_mine:
            self.check_others()
            time.sleep(0.1)
            result = self._read(key, cell)
        if result is not None:
            return result
        self._make_inputs(cell)
        self.ran.add(key)
        self.rank_of[key] = self.rank
        result = self._measure(cell)
        write_whole(self._file_of(key), json_text({
            "command": cell.command(), "program": self.program.name, "machine": machine_json(),
            "at_once": self.at_once, "rank": self.rank, "cost": result.cost, "failure": result.failure,
            "output_check": self._output_check(cell), "result": result.json}))
        return result

    def _measure(self, cell):
        if self.progress is not None:
            self.progress.show(cell.command())
        child = run_child([self.program.path, *cell.arguments], self.directory, cell.limit)
        result = Result(child.failure(cell.limit), None, child.cost)
        if not result.failure and cell.prints_json:
            try:
                result.json = json.loads(child.out)
            except ValueError:
                result.failure = "printed no JSON"
        return result

    def _make_inputs(self, cell):
        for path in cell.inputs:
            maker = self.writers.get(path)
            if maker is None or os.path.exists(path):
                continue
            self._make_inputs(maker)
            made = self._measure(maker)
            if made.failure:
                raise Error(f"{path}: {made.failure}")


@dataclass
class Run:
    """A cell at one resolution and its result, or the reason why there is none."""
    levels: int
    cell: Cell = None
    result: Result = field(default_factory=Result)


def build_cell(plan, scene, levels, output, options=()):
    """Returns the build of the scene at 2^levels with the plan's memory and threads, and more options."""
    limits = ["--memory", str(plan.memory)] if plan.memory else []
    limits += ["--threads", str(plan.threads)] if plan.threads else []
    return Cell(["build", scene.mesh, "-r", str(1 << levels), "-o", output, "--json", *options, *limits],
                [scene.mesh], output)


def _reason_to_stop(plan, last, levels):
    """Returns why the run after `last` is not worth a try; or ""."""
    resolution = f"{1 << last.levels}³"
    if last.result.failure:
        return f"not run, because {resolution} failed: {last.result.failure}"
    # The seconds of reading the mesh do not grow; the others grow by four at most, as surfaces do.
    seconds = last.result.cost["wall_seconds"]
    if plan.cell_seconds > 0 and seconds * 2 ** (levels - last.levels) > plan.cell_seconds:
        return (f"not run, because {resolution} took {human_duration(seconds)}, and the limit is "
                f"{human_duration(plan.cell_seconds)}")
    return ""


def run_series(plan, levels, make_cell, cells):
    """Runs make_cell(levels) for each of the ascending `levels`, with the plan's time limit. After a run that fails,
    or that predicts that the next one exceeds the limit, records the reason for the others."""
    runs, reason = [], ""
    for level in levels:
        run = Run(level, make_cell(level))
        run.cell.limit = plan.cell_seconds
        if runs and not reason:
            reason = _reason_to_stop(plan, runs[-1], level)
        run.result = Result(reason) if reason else cells.run(run.cell)
        runs.append(run)
    return runs


# How to build: the DAG by the paper's method and by voxdag's; the ESVO with colours and normals, which must be uniform
# in a leaf; the ESVO's shape alone.
BUILD_OPTIONS = {"paper": ["--method", "paper"], "hash": ["--method", "hash"], "esvo": ["--as", "esvo"],
                 "shape": ["--as", "esvo", "--no-attributes"]}


def build_series(plan, kind, scene, levels, cells):
    """Builds the scene at each of the ascending `levels`."""
    is_esvo = kind in ("esvo", "shape")
    output = os.path.join(cells.directory, "build.esvo") if is_esvo else "/dev/null"  # an ESVO needs a file
    options = BUILD_OPTIONS[kind] + (scene.options if is_esvo else [])
    return run_series(plan, levels, lambda level: build_cell(plan, scene, level, output, options), cells)


def value_at(runs, levels, read):
    """Returns read(result) of the run at `levels`; NaN if there is none."""
    return next((read(run.result) for run in runs if run.levels == levels and not run.result.failure), NAN)


def finest_of(runs):
    """Returns the finest run that did not fail, or None."""
    return next((run for run in reversed(runs) if not run.result.failure), None)


def levels_of(all_runs):
    """Returns the levels of all runs, ascending."""
    return sorted({run.levels for runs in all_runs for run in runs})


def commands_of(series):
    """Returns parts of a section: an example of the commands of (scene, runs) pairs, and for each scene the reason
    why its finest runs were not made."""
    parts = [CommandLine(runs[-1].cell.command()) for _, runs in series if runs][:1]
    for scene, runs in series:
        failed = next((run for run in runs if run.result.failure), None)
        if failed is not None:
            parts.append(Paragraph(f"{scene.name} at {short_resolution(failed.levels)}: {failed.result.failure}."))
    return parts


def outcome(result, key="result"):
    return {"failure": result.failure} if result.failure else {key: result.json}


def series_json(runs):
    """Returns the runs as JSON: their commands, costs and results."""
    return [{"resolution": 1 << run.levels, "command": run.cell.command(),
             "wall_seconds": run.result.cost["wall_seconds"], "cpu_seconds": cpu_seconds(run.result.cost),
             "peak_memory_bytes": run.result.cost["peak_memory_bytes"], **outcome(run.result)} for run in runs]
