"""`voxdag bench build`: time and memory of builds, also of other programs. Every run is a process of its own."""

import json
import os
import shlex

import published
from charts import axis, line, panel
from child import ScratchFolder, cpu_seconds, machine_json, machine_line, run_child
from commands import Output, Parser, add_mesh_access, add_run_options, levels, one_of, positive, refuse, whole
from document import Error
from scenes import SVDAG, label_of, match_scene, prepare_mesh, procedural_scenes
from text import human_bytes, human_count, human_ratio, row, with_commas

STAGES = ["read", "quantize", "voxelize", "merge", "canonical", "solid", "write"]


def _key_of(run):
    return run["scene"], run["method"]


def _figures(printed, cost):
    """Returns what the JSON of a run has of the JSON that `voxdag build` printed."""
    source, dag_bytes = printed["source"], printed["bytes"]["svdag_paper"]
    mesh_bytes = 12 * (source["triangles"] + source["vertices"])
    allowance = 3 * dag_bytes + mesh_bytes + (256 << 20)  # the peak memory that counts as acceptable
    return {"stage_seconds": printed["seconds"], "triangles": source["triangles"], "vertices": source["vertices"],
            "mesh_bytes": mesh_bytes, "voxels": printed["voxels"],
            "voxels_per_second": printed["voxels"] / cost["wall_seconds"], "svo_nodes": printed["svo_nodes"],
            "dag_nodes": printed["dag_nodes"], "dag_bytes": dag_bytes, "file_bytes": printed["bytes"]["file"],
            "memory_allowance_bytes": allowance, "memory_ratio": cost["peak_memory_bytes"] / allowance}


def _cost_json(cost):
    return {"wall_seconds": cost["wall_seconds"], "cpu_seconds": cpu_seconds(cost), "user_seconds": cost["user_seconds"],
            "system_seconds": cost["system_seconds"], "peak_memory_bytes": cost["peak_memory_bytes"]}


def _growth(before, run):
    """Returns the factors per level from a run to the next of its series; None if there are none."""
    if before is None or "failure" in run or _key_of(before) != _key_of(run) or run["resolution"] <= before["resolution"]:
        return None
    steps = (run["resolution"] // before["resolution"]).bit_length() - 1
    return {name: (run[key] / before[key]) ** (1 / steps)
            for name, key in (("wall", "wall_seconds"), ("cpu", "cpu_seconds"), ("voxels", "voxels"),
                              ("dag_bytes", "dag_bytes"))}


class Bench:
    """Runs the plan: reads each mesh once beforehand, so that no run waits for the disk. Records a run that fails, and
    skips higher resolutions of its series."""

    def __init__(self, options, program, progress, scratch):
        self.options, self.program, self.progress, self.scratch = options, program, progress, scratch
        self.builds, self.rivals = [], []

    def run(self):
        for mesh in self.options.meshes:
            path, identity = prepare_mesh(mesh, self.scratch, self.program)
            scene = mesh if identity.is_procedural else os.path.basename(mesh)
            for method in self.options.method:
                self._series(lambda level: self._fastest(scene, path, identity, method, level), self.builds)
            for name, command in self.options.rival:
                self._series(lambda level: self._rival(scene, path, name, command, level), self.rivals)
        for before, run in zip([None] + self.builds, self.builds):
            growth, paper = _growth(before, run), run.pop("paper", None)
            if growth:
                run["growth_per_level"] = growth
            if paper:
                run["paper_scene"] = paper.json()
            level = run["resolution"].bit_length() - 1
            total, sorting = published.reduction_at(paper.scene.name if paper and paper.has_figures else "", level)
            if run["method"] == "paper" and total == total:
                run["published"] = {"source": published.SVDAG_SOURCE, "scene": paper.scene.name, "reduce_seconds": total,
                                    "sort_seconds": sorting, "cores": published.SVDAG_CORES}

    def _series(self, measure, runs):
        for level in self.options.resolution:
            runs.append(measure(level))
            if "failure" in runs[-1]:
                return

    def _fastest(self, scene, path, identity, method, level):
        runs = []
        for _ in range(self.options.repeat):
            runs.append(self._build(scene, path, identity, method, level))
            if "failure" in runs[-1]:
                return runs[-1]
        return min(runs, key=lambda run: run["wall_seconds"])

    def _build(self, scene, path, identity, method, level):
        options = self.options
        self.progress.show(f"{scene} {1 << level}")
        threads = options.threads or os.cpu_count()
        run = {"scene": scene, "resolution": 1 << level, "method": method, "threads": threads,
               "load_before": os.getloadavg()[0]}
        with ScratchFolder() as folder:
            child = run_child([self.program.path, "build", path, "-r", str(1 << level), "-o", "out.vdag", "--json",
                               "--method", method, "--threads", str(threads), *options.build_options], folder.path)
        if child.failure(0):
            return {**run, "failure": child.failure(0), **_cost_json(child.cost)}
        printed = json.loads(child.out)
        identity.triangles = printed["source"]["triangles"]
        return {**run, **_cost_json(child.cost), **_figures(printed, child.cost), "paper": match_scene(SVDAG, identity)}

    def _rival(self, scene, path, name, command, level):
        self.progress.show(f"{name}: {scene} {1 << level}")
        load = os.getloadavg()[0]
        with ScratchFolder() as folder:
            filled = command
            for text, value in (("{mesh}", shlex.quote(path)), ("{out}", shlex.quote(os.path.join(folder.path, "out"))),
                                ("{resolution}", str(1 << level)), ("{levels}", str(level))):
                filled = filled.replace(text, value)
            child = run_child(["/bin/sh", "-c", filled], folder.path, self.options.rival_seconds)
            left = [os.path.join(where, file) for where, _, files in os.walk(folder.path) for file in files]
            size = sum(os.path.getsize(file) for file in left if os.path.isfile(file) and not os.path.islink(file))
        failure = child.failure(self.options.rival_seconds)
        run = {"name": name, "command": command, "scene": scene, "resolution": 1 << level, "load_before": load,
               **({"failure": failure} if failure else {}), **_cost_json(child.cost), "output_bytes": size}
        try:
            reported = json.loads(child.out.rstrip("\n").split("\n")[-1])
            return {**run, "reported": reported} if isinstance(reported, dict) else run
        except ValueError:
            return run


# Tables.

def _failed(name, run):
    return f"  {name} failed: {run['failure']}\n"


def _build_rows(builds):
    widths = [9, 15, 12, 9, 9, 9, 9, 9, 8, 9, 6, 6]
    text = row(8 * [""] + ["of its", "growth", "", ""], widths)
    text += row(["grid", "voxels", "DAG nodes", "DAG", "wall s", "CPU s", "voxels/s", "peak mem", "limit", "wall", "DAG",
                 "voxels"], widths)
    for run in builds:
        grid = with_commas(run["resolution"])
        if "failure" in run:
            text += _failed(f"{grid:>9} ", run)
            continue
        growth = run.get("growth_per_level")
        text += row([grid, with_commas(run["voxels"]), with_commas(run["dag_nodes"]), human_bytes(run["dag_bytes"]),
                     f"{run['wall_seconds']:.2f}", f"{run['cpu_seconds']:.2f}", human_count(run["voxels_per_second"]),
                     human_bytes(run["peak_memory_bytes"]), f"{100 * run['memory_ratio']:.0f}%"] +
                    [f"{growth[name]:.2f}" if growth else "" for name in ("wall", "dag_bytes", "voxels")], widths)
    return text + "\n"


def _stage_rows(builds):
    widths = 9 * [9]
    text = row(["wall s", "read", "quantize", "voxelize", "merge", "number", "fill the", "count and", "start and"], widths)
    text += row(["", "mesh", "and bin", "", "", "nodes", "inside", "write", "end"], widths)
    for run in builds:
        if "failure" not in run:
            seconds = run["stage_seconds"]
            text += row([with_commas(run["resolution"])] + [f"{seconds.get(stage, 0):.2f}" for stage in STAGES] +
                        [f"{run['wall_seconds'] - seconds['total']:.2f}"], widths)
    return text + "\n"


def _sorting_rows(builds):
    """Returns the table of reduction and sorting, for the paper's method with the paper's Table 1; "" if the builds do not
    sort."""
    first = builds[0]
    is_paper = first["method"] == "paper"
    if not is_paper and first["method"] != "sort":
        return ""
    widths = [9, 11, 11, 11, 11]
    text = (f"  Wall-clock seconds of reduction: ours on {first['threads']} threads; published: {published.SVDAG_SOURCE}\n"
            if is_paper else "  Seconds of reduction, summed over all threads\n")
    text += f"  This mesh: {label_of(first['paper_scene'])}\n" if "paper_scene" in first else ""
    text += row(["grid", "reduction", "sorting"] + (["published", "sorting"] if is_paper else []), widths)
    for run in builds:
        if "failure" not in run:
            paper = run.get("published")
            text += row([with_commas(run["resolution"])] +
                        [f"{run['stage_seconds'][stage]:.3f}" for stage in ("reduce", "sort")] +
                        ([f"{paper['reduce_seconds']:.4g}", f"{paper['sort_seconds']:.4g}"] if paper else []), widths)
    return text + "\n"


def _rival_rows(results, scene):
    widths, text = [9, 18, 9, 9, 9, 9, 8, 8, 8], ""
    for run in results["rivals"]:
        if run["scene"] != scene:
            continue
        grid = with_commas(run["resolution"])
        if "failure" in run:
            text += _failed(f"{grid:>9} {run['name']:>18} ", run)
            continue
        ours = next((own for own in results["builds"] if own["scene"] == scene and "failure" not in own and
                     own["resolution"] == run["resolution"]), None)
        text += row([grid, run["name"], f"{run['wall_seconds']:.2f}", f"{run['cpu_seconds']:.2f}",
                     human_bytes(run["peak_memory_bytes"]), human_bytes(run["output_bytes"])] +
                    ([human_ratio(run[key] / ours[key]) for key in ("wall_seconds", "cpu_seconds", "peak_memory_bytes")]
                     if ours else []), widths)
    if not text:
        return ""
    return (row(6 * [""] + ["times", "voxdag's", ""], widths) +
            row(["grid", "other program", "wall s", "CPU s", "peak mem", "output", "wall", "CPU", "memory"], widths) +
            text + "\n")


def _series_of(builds):
    """Returns the builds of each scene and method."""
    series = {}
    for run in builds:
        series.setdefault(_key_of(run), []).append(run)
    return list(series.values())


def table(results):
    """Returns the builds of each scene, their stages, sorting with the paper's figures, and rivals."""
    text, all_series = "", _series_of(results["builds"])
    for builds, following in zip(all_series, all_series[1:] + [None]):
        first = builds[0]
        text += (f"{first['scene']}: {with_commas(first.get('triangles', 0))} triangles, --method {first['method']}, "
                 f"{first['threads']} threads\n")
        text += _build_rows(builds) + _stage_rows(builds) + _sorting_rows(builds)
        if following is None or following[0]["scene"] != first["scene"]:
            text += _rival_rows(results, first["scene"])
    return text + "of its limit: peak mem / (3 x DAG + mesh + 256 MiB); growth: factor per level\n"


def chart(results):
    """Returns a chart of seconds and bytes over the resolution; None without any build."""
    def mebibytes(key):
        return lambda run, _: run[key] / 2**20

    def panel_of(title, unit, value, bound):
        lines = []
        for color, builds in enumerate(_series_of(results["builds"])):
            done = [run for run in builds if "failure" not in run]
            label = done and done[0]["scene"] + ("" if done[0]["method"] == "hash" else ", " + done[0]["method"])
            for name, read, style in ((label, value, "solid"), ("", bound, "dashed")) if done else ():
                lines.append(line(name, [run["resolution"] for run in done], [read(run, done[-1]) for run in done], color,
                                  style, style == "solid"))
        return panel(title, axis("resolution", "log2"), axis(unit, "log10"), lines)
    time = panel_of("Time; dashed: growth of the DAG", "seconds of the whole process", lambda run, _: run["wall_seconds"],
                    lambda run, finest: finest["wall_seconds"] * run["dag_bytes"] / finest["dag_bytes"])
    memory = panel_of("The DAG; dashed: peak memory of the build", "MiB", mebibytes("dag_bytes"),
                      mebibytes("peak_memory_bytes"))
    return {"panels": [time, memory]} if time["lines"] else None


def rival(text):
    name, equals, command = text.partition("=")
    return (name, command) if name and equals and command else refuse("is not NAME=COMMAND")


def run(arguments, program):
    """Runs the command with these arguments."""
    parser = Parser("build", "Measure time, memory and growth of builds, each in a process of its own",
                    "sponza.obj hairball -r 2048,4096,8192 --plot growth.svg\n\n"
                    "Other programs: --rival 'other=other-program {mesh} {resolution} {out}'\n\nScratch files go to TMPDIR.")
    add = parser.add_argument
    add("meshes", metavar="MESH", nargs="*",
        help="Mesh files, or procedural scenes as NAME or NAME:SIZE (default: all procedural scenes)")
    add("-r", "--resolution", metavar="N,N...", type=levels, default=[9, 10, 11],
        help="Voxels per side (default: 512,1024,2048)")
    add("--method", metavar="METHOD,METHOD", type=one_of(["hash", "sort", "paper"]), default=["hash"],
        help="Any of hash, sort and paper, as in voxdag build (default: hash)")
    add("--solid", metavar="parity|winding|flood", nargs="?", const="parity", choices=["parity", "winding", "flood"],
        help="Also set the voxels inside, as voxdag build does")
    add("--rival", metavar="NAME=COMMAND", type=rival, action="append", default=[],
        help="Run another program for comparison: a shell command with {mesh}, {out}, {resolution} and {levels}; repeatable")
    add("--rival-seconds", metavar="S", type=positive, help="Time limit for a rival, in seconds (default: 3600)")
    add("--repeat", metavar="N", type=whole(1, 1000), default=1, help="Number of runs; the fastest counts (default: 1)")
    add_mesh_access(parser)
    output = Output(parser, {"--plot": "Plot seconds and bytes over the resolution"})
    add_run_options(parser)
    options = parser.parse_args(arguments)
    if options.rival_seconds and not options.rival:
        parser.error("--rival-seconds has no effect without --rival")
    options.rival_seconds = options.rival_seconds or 3600
    options.meshes = options.meshes or procedural_scenes(program)
    options.build_options = (["--solid", options.solid] if options.solid else []) + options.mesh_access
    output.check(options, options.meshes)
    machine = machine_json()
    with ScratchFolder() as scratch:
        bench = Bench(options, program, output.progress, scratch.path)
        bench.run()
    results = {"program": program.name, "machine": machine, "builds": bench.builds, "rivals": bench.rivals}
    output.write(results, lambda: machine_line(machine) + table(results), {"--plot": chart})
    for build in bench.builds:
        if "failure" in build:
            raise Error(f"{build['scene']}: {build['resolution']}: {build['failure']}")
