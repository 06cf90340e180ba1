"""`voxdag bench papers`: measures the tables and figures of both papers again, and writes a report with the published
figures beside ours.

Under mpirun or srun, the ranks share the items of work: rank r of n takes every n-th. Rank 0 then waits for the results
of the others, which appear as files, and writes the report.
"""

import json
import os
import re
import sys
import time
from dataclasses import dataclass, field

from cells import CellStore, json_text, write_whole
from charts import draw_charts
from child import ProgressLine, ScratchFolder, machine_json, run_child
from commands import Parser, add_run_options, device, image_size, level, levels, memory, one_of, seconds, whole
from document import Error, Paragraph, Section, html_of, markdown_of
from esvo import esvo_chapter, esvo_charts
from esvo_runs import EsvoResults, esvo_items
from pictures import Lab
from scenes import ESVO, PAPER_SCENES, SVDAG, FoundScene, SceneFinder, scene_of
from svdag import svdag_chapter, svdag_charts
from svdag_runs import SvdagResults, svdag_items
from text import human_duration


@dataclass
class Plan:
    """Scenes, resolutions (as levels), and limits of time and memory."""
    folder: str = ""  # where the report and its results go
    scenes: str = ""  # folder of meshes; "": procedural stand-ins only
    small_stand_ins: bool = False  # procedural stand-ins of about half a million triangles
    only: list = field(default_factory=list)  # names of paper scenes; empty: all
    table1: list = field(default_factory=lambda: [9, 10, 11, 12, 13])
    table2: list = field(default_factory=lambda: [11, 12, 13, 14, 15, 16])
    figure1: int = 17  # of Figure 1 of the SVDAG paper; the paper's 131072³
    flight_esvo: int = 12  # of the DAG and the ESVO that are compared; the paper's 4096³
    flight_triangles: int = 15  # of the DAG that is compared with triangles; the paper's 32768³
    frames: int = 30
    frame_size: tuple = (1024, 768)
    lamps: tuple = (0.02, 0.05, 0.1, 0.2, 0.4, 0.8)  # radius / distance, in Figure 7b
    picture_levels: int = 13  # of Figures 4 and 8b of the SVDAG paper
    picture_size: tuple = (960, 540)
    esvo_levels: list = field(default_factory=lambda: [10, 11, 12, 13, 14, 15, 16])  # of the ESVO paper's tables
    esvo_sizes: list = field(default_factory=lambda: [(512, 384), (1024, 768), (2048, 1536)])
    esvo_picture_levels: int = 11
    coarse_levels: tuple = (6, 7, 8)  # of Figures 4 and 5 of the ESVO paper
    filter_levels: int = 9  # of Figures 10 and 11
    cell_seconds: float = 600  # time limit of one run for the tables
    memory: int = 0  # `--memory` of every build, in bytes; 0: its default
    threads: int = 0  # 0: one per processor
    device: str = "cpu"  # casts rays and renders pictures
    device_name: str = ""  # of the CUDA device; "": the CPU


# A plan that finishes within minutes: coarse grids and procedural stand-ins alone.
QUICK = {"small_stand_ins": True, "table1": [9, 10, 11], "table2": [9, 10, 11], "figure1": 13, "cell_seconds": 20,
         "flight_esvo": 10, "flight_triangles": 12, "frames": 6, "frame_size": (512, 384), "lamps": (0.05, 0.4),
         "picture_levels": 11, "picture_size": (640, 360), "esvo_levels": [7, 8], "esvo_sizes": [(512, 384)],
         "esvo_picture_levels": 8, "coarse_levels": (6, 7), "filter_levels": 8}


@dataclass
class Sharing:
    """The ranks of this job, as mpirun or srun tells them."""
    rank: int = 0
    ranks: int = 1
    on_a_machine: int = 1  # the most
    job: str = ""  # its name

    @classmethod
    def of(cls, environment):
        job = "-".join(environment[name] for name in ("PMIX_NAMESPACE", "PMI_JOBID", "SLURM_JOB_ID", "SLURM_STEP_ID")
                       if name in environment)
        for rank, ranks, local in (("OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_LOCAL_SIZE"),
                                   ("PMI_RANK", "PMI_SIZE", "MPI_LOCALNRANKS"),
                                   ("SLURM_PROCID", "SLURM_STEP_NUM_TASKS", "SLURM_STEP_TASKS_PER_NODE")):
            if rank in environment and ranks in environment:
                counts = map(int, re.findall(r"(?<![\dx])\d+(?!\d)", environment.get(local, "1")))  # "2(x3),1"
                return cls(int(environment[rank]), int(environment[ranks]), max(counts, default=1),
                           re.sub(r"\W", "-", job))
        return cls()

    def text(self):
        if self.on_a_machine == 1:
            return f"{self.ranks} processes, each on a machine of its own, shared the runs."
        return (f"{self.ranks} processes shared the runs, up to {self.on_a_machine} on one machine at one time: their runs "
                "disturbed one another, so times are longer, and rates lower, than those of a machine with one process.")


def typical_seconds(plan):
    """Returns about the seconds that the plan takes if nothing is kept, on two cores. Measured with Crytek Sponza, and
    with pictures of 1024 x 768 pixels."""
    def builds(seconds, growth, levels):
        """`seconds` at 2048³, and the factor from one level to the next."""
        return sum(cost for cost in (seconds * growth ** (level - 11) for level in levels) if cost <= plan.cell_seconds)
    esvo = (20, 4)
    width, height = plan.frame_size
    per_scene = (builds(0.9, 3, plan.table1) + builds(0.4, 2.4, plan.table1 + plan.table2) + builds(*esvo, plan.table2) +
                 builds(4, 3.5, plan.table2) + 5 * builds(*esvo, plan.esvo_levels) + 20)
    # Each frame of the lamps' run costs as much as two others for each lamp.
    return 5 * per_scene + plan.frames * (4 + 2 * len(plan.lamps)) * 5 * width * height / (1024 * 768)


def find_device(plan, program, scratch):
    """Sets the plan's device. A run of voxdag looks for it. Raises Error if there is no such device."""
    if plan.device == "cpu":
        return
    found = run_child([program.path, "bench", "esvo", "device=sponge:2", "-r", "8", "--size", "8x8", "--views", "1",
                       "--repeat", "1", "--no-silhouettes", "--json", "--device", plan.device], scratch)
    if found.status:
        raise Error(found.failure(0))
    rays = json.loads(found.out)["rays"][0]
    plan.device_name = rays["device_name"] if rays["device"] == "cuda" else ""


def machine_section(plan, program, machine, threads, sharing):
    and_auto = (" It also does what needs more memory than the device has; the results in the file report.json name the "
                "device of each run." if plan.device == "auto" else "")
    parts = [
        Paragraph(f"{machine['processor']}, {threads} threads, {machine['memory_bytes'] / 2**30:.0f} GiB of memory, "
                  f"{machine['system']}. Measured by {program.name} until {machine['time']}."),
        Paragraph(f"{plan.device_name} casts the rays at voxels and renders the pictures. The processor builds, casts rays "
                  "at triangles (Embree), and measures silhouettes and Figure 7b of the SVDAG paper." + and_auto
                  if plan.device_name else "The processor casts all rays and renders the pictures.")]
    return Section("The machine", 2, parts + ([Paragraph(sharing.text())] if sharing.ranks > 1 else []))


class RankFile:
    """A file beside the results that names the machine of a rank, or says why it failed. By these files rank 0 knows that
    it does not wait in vain."""

    def __init__(self, sharing, cells, device_name):
        self.sharing, self.folder, self.machine = sharing, cells.folder, f"{cells.machine}\n{device_name}"
        if sharing.ranks > 1:
            write_whole(self._path(sharing.rank), self.machine)
            cells.check_others = self.check_others

    def _path(self, rank):
        return os.path.join(self.folder, f"job-{self.sharing.job}.{rank}")

    def check_others(self):
        """Raises Error if another rank failed, or if its times do not belong beside those of this rank's machine."""
        for rank in range(self.sharing.ranks):
            try:
                with open(self._path(rank), encoding="utf-8") as file:
                    other = file.read()
            except OSError:
                continue  # not started yet, or done
            if other != self.machine:
                raise Error(f"a report needs machines of one kind, and all ranks: rank {rank} has \"{other}\", rank "
                            f"{self.sharing.rank} has \"{self.machine}\"".replace("\n", "; "))

    def __enter__(self):
        return self

    def __exit__(self, _kind, error, _trace):
        if self.sharing.ranks > 1 and self.sharing.rank > 0 and error is not None:
            write_whole(self._path(self.sharing.rank), f"failed: {error}")
        elif os.path.exists(self._path(self.sharing.rank)):
            os.remove(self._path(self.sharing.rank))


def run_items(items, cells, sharing):
    """Runs this rank's items. On rank 0, returns the results of all items by key."""
    def run(item):
        result = item()
        for name in os.listdir(cells.directory):
            os.remove(os.path.join(cells.directory, name))
        return result
    for i, item in enumerate(items.values()):
        if i % sharing.ranks == sharing.rank and sharing.ranks > 1:
            run(item)
    if sharing.rank != 0:
        return {}
    results = {}
    for i, (key, item) in enumerate(items.items()):
        cells.is_mine = i % sharing.ranks == 0
        results[key] = run(item)
    return results


def bench_papers(plan, program, sharing, progress):
    """Runs the plan. Writes report.html, report.md, report.json, the charts, and one file per run in cells/ to the plan's
    folder. An interrupted run keeps its finished measurements. Returns a line about it; "" on ranks above 0. Raises
    Error, also if the chosen device is missing."""
    try:
        os.makedirs(plan.folder, exist_ok=True)
    except OSError as error:
        if sharing.rank > 0:
            time.sleep(60)  # rank 0 has the same error: it says so, and mpirun then ends this rank
        raise Error(f"{plan.folder}: cannot make the folder: {error.strerror}") from error
    with ScratchFolder() as made, ScratchFolder(plan.folder) as scratch:
        find_device(plan, program, made.path)
        cells = CellStore(os.path.join(plan.folder, "cells"), scratch.path, program, sharing.on_a_machine, progress,
                          sharing.rank)
        with RankFile(sharing, cells, plan.device_name):
            cells.is_mine = sharing.rank == 0
            finder = SceneFinder(plan, made.path, cells, program)
            svdag_scenes, esvo_scenes = finder.scenes_of(SVDAG), finder.scenes_of(ESVO)
            scan = next((scene for scene in svdag_scenes if scene.name == "Lucy"), FoundScene(scene_of(SVDAG, "Lucy")))
            cells.is_mine = True
            lab = Lab(plan, cells, program)
            items = {**svdag_items(lab, svdag_scenes), **esvo_items(lab, esvo_scenes, scan)}
            results = run_items(items, cells, sharing)
    if sharing.rank != 0:
        return ""
    return write_report(plan, program, sharing, cells, SvdagResults(plan, svdag_scenes, results),
                        EsvoResults(esvo_scenes, results))


def write_report(plan, program, sharing, cells, svdag, esvo):
    """Writes the report of SvdagResults and EsvoResults; returns a line about it."""
    threads = plan.threads or os.cpu_count()
    machine = machine_json()
    is_drawn = draw_charts(svdag_charts(svdag) + esvo_charts(esvo), plan.folder)
    title = "The papers, measured again"
    sections = [machine_section(plan, program, machine, threads, sharing), *svdag_chapter(svdag, threads, is_drawn),
                *esvo_chapter(esvo, threads, is_drawn)]
    files = {name: os.path.join(plan.folder, "report." + name) for name in ("json", "md", "html")}
    write_whole(files["json"], json_text({
        "program": program.name, "machine": machine, "ranks": sharing.ranks, "ranks_on_a_machine": sharing.on_a_machine,
        "device": "cuda" if plan.device_name else "cpu", "device_name": plan.device_name or machine["processor"],
        "svdag": svdag.json(), "esvo": esvo.json()}))
    write_whole(files["md"], markdown_of(title, sections))
    write_whole(files["html"], html_of(title, sections, plan.folder))
    counts = " + ".join(str(cells.measured_by(rank)) for rank in range(sharing.ranks))
    by = f" by {sharing.ranks} processes ({counts})" if sharing.ranks > 1 else ""
    return (f"{files['html']}: {cells.measured} measured{by}, "
            f"{cells.kept} kept from earlier runs{'' if is_drawn else '; no charts, because matplotlib is not installed'}")


def run(arguments, program):
    """Runs the command with these arguments."""
    parser = Parser("papers", "Measure the tables and figures of both papers again, and write a report",
                    "--scenes DIR -o report\n\n"
                    "With --quick instead of --scenes it takes a few minutes. An interrupted run continues where it stopped\n"
                    "if it is started again with the same folder. Under mpirun or srun, the processes share the runs; those\n"
                    "on one machine disturb one another's times.")
    names = sorted({scene.name for scene in PAPER_SCENES})
    add = parser.add_argument
    add("-o", "--output", metavar="DIR", dest="folder", required=True, help="The folder for the report")
    add("--scenes", metavar="DIR", help="The folder of the meshes (default: the variable VOXDAG_SCENES; without it, "
        "procedural scenes alone)")
    add("--quick", action="store_true", help="Coarse resolutions and procedural scenes only")
    add("--only", metavar="SCENE,SCENE...", type=one_of(names), action="extend",
        help="Only these scenes, as the papers name them (default: all)")
    for name, of_plan, of_what, default in (
            ("--table1", "table1", "the SVDAG paper's Table 1", "512,1K,2K,4K,8K"),
            ("--table2", "table2", "the SVDAG paper's Table 2", "2K,4K,8K,16K,32K,64K"),
            ("--esvo-tables", "esvo_levels", "the ESVO paper's tables", "1K,2K,4K,8K,16K,32K,64K")):
        add(name, metavar="N,N...", dest=of_plan, type=levels, help=f"Resolutions of {of_what} (default: {default})")
    for name, of_plan, of_what, default in (
            ("--flight-esvo", "flight_esvo", "the fly-through with DAG and ESVO", "4K"),
            ("--flight-triangles", "flight_triangles", "the fly-through with DAG and triangles", "32K"),
            ("--figure1", "figure1", "the SVDAG paper's Figure 1", "128K"),
            ("--pictures", "picture_levels", "the SVDAG paper's pictures", "8K"),
            ("--esvo-pictures", "esvo_picture_levels", "the ESVO paper's pictures", "2K")):
        add(name, metavar="N", dest=of_plan, type=level, help=f"Resolution of {of_what} (default: {default})")
    add("--frames", metavar="N", type=whole(1, 10_000), help="Frames of the fly-through (default: 30)")
    add("--size", metavar="WxH", type=image_size, help="Size of frames and pictures in pixels (default: the papers' sizes "
        "for frames, 960x540 for pictures)")
    add("--cell-seconds", metavar="SECONDS", type=seconds, help="Time limit of one run; the report names the runs that it "
        "excludes (default: 600, with --quick 20)")
    add("--memory", metavar="LIMIT", type=memory, help="Maximum memory of one build: 512M, 16GiB (default: three quarters "
        "of the available memory)")
    add("--device", metavar="cpu|cuda|auto", type=device, help="Device that casts the rays. cuda:1 is the second CUDA "
        "device; auto is a CUDA device if there is one with enough memory (default: cpu)")
    add_run_options(parser, has_json=False)
    given = vars(parser.parse_args(arguments))
    quick, quiet, size = given.pop("quick"), given.pop("quiet"), given.pop("size")
    if quick and given["scenes"]:
        parser.error("--quick has no effect with --scenes")
    values = {**(QUICK if quick else {"scenes": os.environ.get("VOXDAG_SCENES", "")}),
              **({"frame_size": size, "picture_size": size, "esvo_sizes": [size]} if size else {}),
              **{name: value for name, value in given.items() if value is not None}}
    plan = Plan(**{**values, "folder": os.path.abspath(given["folder"])})
    if not quiet:
        print(f"voxdag: takes about {human_duration(typical_seconds(plan))} on two cores; finished measurements are kept in "
              f"{given['folder']}", file=sys.stderr)
    progress, sharing = ProgressLine(quiet), Sharing.of(os.environ)
    for name in [name for name in os.environ if re.match("OMPI_COMM|PMI|SLURM_STEP", name)]:
        del os.environ[name]  # the runs are programs of their own, not ranks
    try:
        line = bench_papers(plan, program, sharing, progress)
    finally:
        progress.clear()
    if line:
        print(line)
