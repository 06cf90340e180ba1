"""The fly-through of the SVDAG paper (Figures 6, 7 and 8a): rays per second of every frame, for the DAG, the ESVO and
the triangles, with the same rays."""

import os
from dataclasses import dataclass, field

from cells import Cell, Result, build_cell, outcome, write_whole
from charts import axis, line, panel
from document import CommandLine, Paragraph, Picture, Section, Table
from scenes import flight_through
from text import NAN, number_text, short_resolution

# The runs at the resolution of the triangles, by name: more options of `bench trace`.
FINE_RUNS = {"with_triangles": [],  # DAG and triangles
             "with_voxels": ["--lod", "0"],  # rays that end only at voxels
             "with_lamps": ["--light-sizes"],  # soft shadows of lamps of several sizes, which the plan names
             "with_cones": ["--ao-cone", "0.07"]}  # occlusion rays that end at cells of 0.07 sr
BEAMS, CPU_CHECK = "primary_beams", "voxdag_cpu"
DAG, TRIANGLES, ESVO, VOXELS, CONES = range(5)  # colours
TRIANGLES_NAME = "triangles (Embree, on the processor)"
TO_VOXELS, TO_CONES = "DAG, to voxels", "DAG, to 0.07 sr"


@dataclass
class FlightRun:
    """A run of `voxdag bench trace` along the path."""
    levels: int = 0
    cell: Cell = field(default_factory=lambda: Cell([]))
    result: Result = field(default_factory=Result)

    def json(self):
        return {"command": self.cell.command(), "resolution": 1 << self.levels, **outcome(self.result, "rows")}


@dataclass
class Rates:
    """The rates of one caster along the path."""
    mrays: float = NAN  # million rays per second, all frames together
    per_frame: list = field(default_factory=list)
    agreement: float = NAN  # with the DAG


def write_path(lab, name, text):
    """Writes a camera path to the report's folder, as an input of cells; returns its file."""
    path = os.path.join(lab.plan.folder, name)
    write_whole(path, text)
    lab.cells.contents[path] = text
    return path


def trace_path(lab, scene, dag, levels, path, frames, options=(), inputs=(), failure=""):
    """Casts rays along a path at a DAG. A hit of a CUDA device that differs from the CPU's is a failure. `failure`: why
    there is no DAG."""
    width, height = lab.plan.frame_size
    run = FlightRun(levels, lab.cast(Cell(
        ["bench", "trace", dag, "--mesh", scene.mesh, "--path", path, "--frames", str(frames), "--size",
         f"{width}x{height}", "--repeat", "2", "--json", *options], [dag, scene.mesh, path, *inputs])))
    run.result = Result(failure) if failure else lab.cells.run(run.cell)
    for row in [] if run.result.failure else run.result.json:
        if row["rival"] == CPU_CHECK and row["rival_agreement"] != 1:
            run.result.failure = f"hits of {row['device_name']} differ from the CPU's"
    return run


def flight_scene(lab, scenes):
    """Returns the scene to fly through and its camera path: Crysponza, else San Miguel, else the first with a path."""
    order = ["SanMiguel", "Crysponza"]
    for scene in sorted(scenes, key=lambda scene: -1 - order.index(scene.name) if scene.name in order else 0):
        path = flight_through(scene, lab.program)
        if path:
            return scene, path
    return None, ""


def flight_items(lab, scene, path_text):
    """Returns the runs as items of work: functions, which return the scene and
    FlightRuns by name."""
    plan = lab.plan

    def built(levels, name, options=()):
        cell = build_cell(plan, scene, levels, lab.scratch(name), options)
        return cell.output, lab.cells.run(cell).failure

    def with_esvo():
        path = write_path(lab, "flight.json", path_text)
        dag, no_dag = built(plan.flight_esvo, "dag.vdag")
        esvo, no_esvo = built(plan.flight_esvo, "shape.esvo", ["--as", "esvo", "--no-attributes"])
        return scene, {"with_esvo": trace_path(lab, scene, dag, plan.flight_esvo, path, plan.frames, ["--esvo", esvo],
                                               [esvo], no_dag or no_esvo)}

    def fine():
        path = write_path(lab, "flight.json", path_text)
        dag, no_dag = built(plan.flight_triangles, "fine.vdag")
        lamps = {"with_lamps": [",".join(f"{lamp:g}" for lamp in plan.lamps)]}
        return scene, {name: trace_path(lab, scene, dag, plan.flight_triangles, path, plan.frames,
                                        options + lamps.get(name, []), failure=no_dag)
                       for name, options in FINE_RUNS.items()}

    return {"flight": fine, "flight_esvo": with_esvo}


def rates_of(run, rays, rival=""):
    """Returns the rates of voxdag, or of those rivals whose names start with `rival`: the fastest."""
    best = Rates()
    for row in [] if run.result.failure else run.result.json:
        if row["rays"] != rays:
            continue
        if not rival:
            return Rates(row["mrays_per_s"], row["view_mrays_per_s"], 1)
        if (row["rival"] or "").startswith(rival) and not row["rival_mrays_per_s"] <= best.mrays:
            best = Rates(row["rival_mrays_per_s"], row["rival_view_mrays_per_s"], row["rival_agreement"])
    return best


def rates_on_cpu(run, rays):
    """Returns the rates of the DAG on the processor, with which Embree compares."""
    check = rates_of(run, rays, CPU_CHECK)
    return check if check.per_frame else rates_of(run, rays)


def speed_ratio(run, rays, rival):
    """Returns how many times as fast as a rival voxdag casts a kind of rays; NaN if it was not measured. The rival's
    name starts with `rival`. Embree compares with voxdag on the CPU."""
    dag = rates_on_cpu(run, rays) if rival == "embree" else rates_of(run, rays)
    return dag.mrays / rates_of(run, rays, rival).mrays


def _row(name, rates, dag):
    """A row of a table: a caster's rate, its ratio to the DAG's, and how often they agree."""
    return [name, number_text(rates.mrays), number_text(dag.mrays / rates.mrays),
            f"{100 * rates.agreement:.1f} %" if rates.agreement == rates.agreement else "–"]


def _rate_table(caption, run, rays, rivals=(), others=()):
    """Returns a table of the DAG, then of `rivals` (name, prefix of the rival), of `others` (name, run) whose rays end
    elsewhere, so that agreement says nothing, and of Embree, whose ratio is to the DAG on the processor."""
    dag = rates_of(run, rays)
    rows = [_row("DAG", dag, dag)] + [_row(name, rates_of(run, rays, rival), dag) for name, rival in rivals]
    rows += [_row(name, rates_of(other, rays), dag)[:3] + ["other rays"] for name, other in others]
    cpu = rates_on_cpu(run, rays)
    if rates_of(run, rays, CPU_CHECK).per_frame:
        rows.append(_row("DAG, on the processor", cpu, dag))
    rows.append(_row(TRIANGLES_NAME, rates_of(run, rays, "embree"), cpu))
    return Table(caption, ["cast at", "million rays per second", "DAG is faster by", "rays that agree with the DAG"], rows)


def _run_parts(*runs):
    parts = []
    for run in runs:
        parts.append(CommandLine(run.cell.command()))
        if run.result.failure:
            parts.append(Paragraph(f"Not measured: {run.result.failure}."))
    return parts


def _where(scene, run):
    return f"{scene.title} at {short_resolution(run.levels)}"


def flight_charts(scene, runs):
    """Returns the charts of Figures 6, 7a, 7b and 8a. `runs`: FlightRuns by name."""
    coarse, fine, voxels, cones = (runs[name] for name in ("with_esvo", "with_triangles", "with_voxels", "with_cones"))

    def frames(label, color, run, rays, rival="", scale=lambda rate: rate):
        values = [scale(rate) for rate in rates_of(run, rays, rival).per_frame]
        return line(label, range(len(values)), values, color)

    def rates(run, lines, unit="million rays per second"):
        return panel(_where(scene, run), axis("frame"), axis(unit), lines)

    def milliseconds(rate):
        return 1000 / rate
    lamps = runs["with_lamps"]
    rows = [] if lamps.result.failure else [row for row in lamps.result.json if row["rays"] == "soft_lamp"]
    sizes = [row["light_size"] for row in rows]
    return [
        {"file": "svdag-figure6.svg", "panels": [
            rates(coarse, [frames("DAG", DAG, coarse, BEAMS), frames("ESVO", ESVO, coarse, BEAMS, "esvo")]),
            rates(fine, [frames("DAG", DAG, fine, BEAMS), frames(TRIANGLES_NAME, TRIANGLES, fine, BEAMS, "embree")])]},
        {"file": "svdag-figure7a.svg", "panels": [rates(fine, [
            frames("DAG", DAG, fine, "shadow", "", milliseconds),
            frames(TO_VOXELS, VOXELS, voxels, "shadow", "", milliseconds),
            frames(TRIANGLES_NAME, TRIANGLES, fine, "shadow", "embree", milliseconds)], "ms for a million shadow rays")]},
        {"file": "svdag-figure7b.svg", "panels": [panel(
            _where(scene, lamps), axis("radius of the lamp / its distance"), axis("million rays per second"),
            [line("with beams", sizes, [row["mrays_per_s"] for row in rows], DAG, markers=True),
             line("without beams", sizes, [row["rival_mrays_per_s"] for row in rows], TRIANGLES, markers=True)])]},
        {"file": "svdag-figure8a.svg", "panels": [rates(fine, [
            frames("DAG", DAG, fine, "ao"), frames(TO_VOXELS, VOXELS, voxels, "ao"), frames(TO_CONES, CONES, cones, "ao"),
            frames(TRIANGLES_NAME, TRIANGLES, fine, "ao", "embree")])]}]


def flight_sections(plan, scene, runs, is_drawn):
    """Returns the sections of Figures 6, 7a, 7b and 8a. `is_drawn`: whether their charts are there."""
    coarse, fine, voxels, cones = (runs[name] for name in ("with_esvo", "with_triangles", "with_voxels", "with_cones"))

    def chart(name, caption):
        return [Picture(f"Figure {name}: {caption}", f"svdag-figure{name}.svg")] if is_drawn else []
    lamps = flight_charts(scene, runs)[2]["panels"][0]
    with_beams, without = lamps["lines"]
    lamp_rows = [[f"{size:g}", number_text(a), number_text(b), number_text(a / b)]
                 for size, a, b in zip(with_beams["x"], with_beams["y"], without["y"])]
    return [
        Section("Figure 6: primary rays in a fly-through", 2, [
            Paragraph(
                f"{plan.frames} frames of {plan.frame_size[0]} × {plan.frame_size[1]} pixels along a camera path. The DAG "
                "and the ESVO use beams, whose time counts. All cast the same recorded rays; rays end at cells of one "
                "pixel, as in pictures. Embree casts them on the processor, from the eye: single rays or packets of 16, "
                "whichever is faster; its ratio is to the DAG on the processor. The paper measured a GPU (GTX480 and "
                "GTX680), so its figures do not stand beside ours."),
            _rate_table("Primary rays, " + _where(scene, coarse), coarse, BEAMS, [("ESVO", "esvo")]),
            _rate_table("Primary rays, " + _where(scene, fine), fine, BEAMS),
            *chart("6", "primary rays per second in each frame, with beams; left DAG and ESVO, right DAG and triangles."),
            *_run_parts(coarse, fine)]),
        Section("Figure 7a: hard shadows in a fly-through", 2, [
            Paragraph(
                "A shadow ray per pixel towards the sun. Milliseconds are those of a million rays, about the paper's "
                "picture. The paper compares with shadow volumes per triangle (Sintorn and others 2011) on a GPU; the "
                "rival here is Embree with the same rays. A shadow map needs a rasterizer, and one of ours on a CPU would "
                "be a rival that nobody uses. By default, voxdag's rays end at cells of one pixel; \"to voxels\" is the "
                "paper's way."),
            _rate_table("Shadow rays, " + _where(scene, fine), fine, "shadow", others=[(TO_VOXELS, voxels)]),
            *chart("7a", "time for a million shadow rays in each frame.")]),
        Section("Figure 7b: soft shadows and the size of the light", 2, [
            Paragraph(
                "16 rays per pixel towards a sphere, over all frames, on the processor. With beams, a beam from each pixel "
                "to the light shortens its rays or makes them unnecessary. The rate counts the rays that are needed "
                "without beams, and the time includes the beams."),
            Table("Soft shadow rays, " + lamps["title"],
                  ["radius / distance", "with beams (Mrays/s)", "without beams (Mrays/s)", "beams are faster by"], lamp_rows),
            *chart("7b", "soft shadow rays per second over the lamp's size."), *_run_parts(runs["with_lamps"])]),
        Section("Figure 8a: ambient occlusion in a fly-through", 2, [
            Paragraph(
                "64 rays per pixel; a part of the pixels is measured. By default, voxdag's occlusion rays end at cells as "
                "large as the surface's cell, which is one pixel. The paper's end at voxels, or at the first cell that "
                "subtends 0.07 steradians (9 degrees) from the surface: both are beside the default."),
            _rate_table("Occlusion rays, " + _where(scene, fine), fine, "ao",
                        others=[(TO_VOXELS, voxels), (TO_CONES, cones)]),
            *chart("8a", "occlusion rays per second in each frame."), *_run_parts(voxels, cones)])]
