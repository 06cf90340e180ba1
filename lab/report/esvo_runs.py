"""What the chapter about the ESVO paper runs, and what the runs printed."""

import math
from dataclasses import dataclass, field

from cells import Cell, build_series, run_series, series_json
from pictures import paint, show
from scenes import LUCY, camera_of, view_of
from text import NAN, number

FORMS = ["triangles", "cubes", "contours", "contours_beams"]  # of the paper's Table 2
AS_IN_THE_PAPER = ["--no-shadows", "--ao", "0"]  # and no ambient occlusion but what was baked


@dataclass
class SceneRuns:
    """The runs for one scene of the paper; none if the scene is absent."""
    scene: object
    builds: list = field(default_factory=list)  # for Table 1: with contours, colours and normals
    rays: list = field(default_factory=list)  # for Table 2: `voxdag bench esvo` at each resolution


# Work.

def _rays_cell(lab, scene, levels):
    plan = lab.plan
    options = scene.options + (["--memory", str(plan.memory)] if plan.memory else [])
    return lab.cast(Cell(
        ["bench", "esvo", " ".join([f"{scene.name}={scene.mesh}", *options]), "-r", str(1 << levels), "--size",
         ",".join(f"{width}x{height}" for width, height in plan.esvo_sizes), "--json",
         *(["--threads", str(plan.threads)] if plan.threads else [])], [scene.mesh]))


def _cast_rays(lab, scene):
    runs = run_series(lab.plan, lab.plan.esvo_levels, lambda levels: _rays_cell(lab, scene, levels), lab.cells)
    for run in runs:  # an octree that the benchmark could not build is the run's failure
        for build in [] if run.result.failure else run.result.json["builds"]:
            run.result.failure = build.get("failure", run.result.failure)
    return runs


def _hand_of(lab, scene):
    """Returns options of `render` that show a hand of the scan as closely as Figure 10 of the paper shows that of its
    fairy; of another scene, those that show it well."""
    if scene.identity.check != LUCY:
        return view_of(scene, lab.program)
    return ["--eye", "2230,-2234,1380", "--target", "912,-30,288", "--up", "0,0,1", "--fov", "3.2", "--sun", "1,-0.2,0.6"]


def esvo_items(lab, scenes, scan):
    """Returns the runs of the chapter as items of work, about the longest first: functions by key. `scan`: a smooth
    model for close-ups; if it is absent, the first scene serves."""
    plan, items = lab.plan, {}
    width, height = plan.picture_size
    half = (width // 2, height)
    present = [scene for scene in scenes if not scene.is_absent]
    close_up = next((scene for scene in [scan] + present if not scene.is_absent and not scene.identity.is_displaced), None)

    def cathedral(scene):
        """Figures 1 and 9."""
        voxels = show(lab, scene, plan.esvo_picture_levels, True, ["--bake-ao"])
        options = camera_of(scene, lab.program) + AS_IN_THE_PAPER
        return [paint(lab, voxels, "esvo-figure1.png", options),
                paint(lab, voxels, "esvo-figure9-plain.png", options + ["--no-beams"], half, "steps64"),
                paint(lab, voxels, "esvo-figure9-beams.png", options, half, "steps64")]

    def contours():
        return [(levels, [paint(lab, show(lab, close_up, levels, True, options), f"esvo-figure4-{1 << levels}-{form}.png",
                                view_of(close_up, lab.program) + ["--no-filter"], half)
                          for form, options in (("cubes", ["--no-contours"]), ("contours", []))])
                for levels in plan.coarse_levels]

    def filters(scene, figure, options, kinds):
        """Shows few levels with wide error bounds, so that neighbouring voxels differ in size."""
        voxels = show(lab, scene, plan.filter_levels, True,
                      ["--max-error", "1", "--normal-error", "12", "--color-error", "0.1"])
        return [paint(lab, voxels, f"esvo-figure{figure}-{name}.png", options + ["--filter-kind", kind], half)
                for name, kind in kinds]

    def scenery(scene):
        voxels = show(lab, scene, plan.esvo_picture_levels, True)
        return paint(lab, voxels, f"esvo-figure12-{scene.name}.png", view_of(scene, lab.program))

    for scene in present:
        items["esvo rays", scene.name] = lambda scene=scene: _cast_rays(lab, scene)
        items["esvo builds", scene.name] = lambda scene=scene: build_series(plan, "esvo", scene, plan.esvo_levels, lab.cells)
    for scene in present:
        if scene.identity.is_displaced:
            items["cathedral"] = lambda scene=scene: cathedral(scene)
        items["esvo picture", scene.name] = lambda scene=scene: scenery(scene)
        if scene.name == "Sibenik":
            # The paper's pictures do not have these shadows.
            items["guides"] = lambda scene=scene: filters(scene, 11, view_of(scene, lab.program),
                                                          [("plain", "plain"), ("guided", "guided")])
    if close_up is not None:
        items["contours"] = contours
        items["filters"] = lambda: filters(close_up, 10, _hand_of(lab, close_up) + AS_IN_THE_PAPER,
                                           [("naive", "naive"), ("adaptive", "plain")])
    return items


class EsvoResults:
    """What the items returned."""

    def __init__(self, scenes, results):
        self.scenes, self.pictures = scenes, results
        self.runs = [SceneRuns(scene, results.get(("esvo builds", scene.name), []), results.get(("esvo rays", scene.name), []))
                     for scene in scenes]

    def json(self):
        return {"scenes": [{**runs.scene.json(), "builds": series_json(runs.builds), "rays": series_json(runs.rays)}
                           for runs in self.runs]}


# What a run printed.

def megabytes(build):
    return build.json["bytes"]["esvo"] / 2**20


def bytes_per_voxel(build):
    return build.json["bytes"]["esvo"] / build.json["voxels"]


def build_seconds(build):
    return build.json["seconds"]["build"]


def rays_of_size(result, size):
    return next((row for row in result.json["rays"] if (row["width"], row["height"]) == size), None)


def sizes_of(result):
    return [(row["width"], row["height"]) for row in result.json["rays"]]


def rate(row, form):
    """Returns million rays per second; NaN if the form was not measured."""
    return number(row[form]["mrays_per_s"]) if row else NAN


def rate_on_cpu(row, form):
    on_cpu = number(row[form]["cpu_mrays_per_s"])
    return rate(row, form) if math.isnan(on_cpu) else on_cpu


def cast_seconds(row):
    return row["ray_count"] * 1e-6 / rate(row, "contours_beams")


@dataclass
class Silhouettes:
    """The fraction of the rays to the finest voxels for which a form and the triangles disagree on a hit."""
    levels: int
    cubes: float
    contours: float


def silhouettes_of(rays):
    return [Silhouettes(run.levels, row["cubes_wrong"], row["contours_wrong"])
            for run in rays if not run.result.failure for row in run.result.json["silhouettes"]]


def levels_saved(rows, row):
    """Returns the number of levels by which cubes must be finer to be as good as the contours of a row, and whether
    that is a lower bound, because no measured cubes are as good. Compares with cubes of the row's grid and finer ones,
    or with coarser ones if contours are worse than cubes."""
    if row.cubes == 0:
        return 0, True  # without wrong rays there is nothing to save
    before = None
    for other in rows:
        if row.contours < row.cubes and other.levels < row.levels:
            continue
        if other.cubes <= row.contours:
            if before is None:
                return other.levels - row.levels, False
            part = 1
            if other.cubes > 0:
                whole = math.log(before.cubes / other.cubes)
                part = math.log(before.cubes / row.contours) / whole if whole > 0 else 0
            return before.levels + part * (other.levels - before.levels) - row.levels, False
        before = other
    return before.levels - row.levels if before else 0, True
