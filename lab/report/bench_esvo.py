"""`voxdag bench esvo`: the tables of Laine and Karras 2010, and the silhouette errors of cubes and contours. Builds both
forms of every scene in processes of their own; `bench esvo-rays` then casts rays at them."""

import json
import math
import os
from dataclasses import dataclass

import published
from charts import axis, line, panel
from child import ScratchFolder, cpu_seconds, machine_json, run_child
from commands import Output, Parser, add_run_options, device, image_sizes, levels, not_negative, refuse, whole
from document import Error
from esvo_runs import FORMS, Silhouettes, cast_seconds, levels_saved, rate
from scenes import ESVO, label_of, match_scene, prepare_mesh
from text import NAN, human_bytes, human_count, number, with_commas

ALL_FORMS = FORMS + ["coarse_contours", "coarse_contours_beams"]


@dataclass
class BenchScene:
    """A scene from the command line."""
    name: str
    mesh: str
    options: list  # more options of `build`

    @property
    def is_plain(self):
        """Whether the built surface is the mesh itself, without displacement."""
        return not any(option.startswith("--displace") for option in self.options)


def scene_of(text):
    """Parses "NAME=MESH --option ..."."""
    name, equals, rest = text.partition("=")
    if not name or not equals:
        refuse(f'"{text}": must be NAME=MESH, then options of build')
    mesh, dashes, options = rest.partition(" --")
    return BenchScene(name, mesh, (dashes + options).split()) if mesh else refuse(f'"{text}": has no mesh after the \'=\'')


# Work.

class Bench:
    """Records a build that fails, and skips higher resolutions of its scene."""

    def __init__(self, options, program, progress, scratch):
        self.options, self.program, self.progress, self.scratch = options, program, progress, scratch
        self.threads = options.threads or os.cpu_count()
        self.builds, self.rays, self.silhouettes = [], [], []
        self.cuda_device = self.device_failure = ""

    def run(self):
        work = []
        for scene in self.options.scenes:
            path, identity = prepare_mesh(scene.mesh, self.scratch, self.program)
            identity.is_displaced = not scene.is_plain
            work.append((scene, path, match_scene(ESVO, identity), self._build_all(scene, path, identity)))
        for scene, path, match, pairs in work:
            if pairs and not self.device_failure:
                self._cast(scene, path, match, pairs)

    def _build_all(self, scene, path, identity):
        """Returns the files of contours and cubes for each level that has both."""
        pairs, match = {}, match_scene(ESVO, identity)
        for level in self.options.resolution:
            files = [os.path.join(self.scratch, f"{len(self.builds) + i}.esvo") for i in range(2)]
            for file, with_contours in zip(files, (True, False)):
                self.progress.show(f"building {scene.name} {1 << level}")
                self.builds.append(self._build(scene, path, match, level, with_contours, file))
                if "failure" in self.builds[-1]:
                    return pairs
            pairs[level] = files
        return pairs

    def _build(self, scene, path, match, level, with_contours, file):
        run = {"scene": scene.name, "resolution": 1 << level, "levels": level, "contours": with_contours,
               "load_before": os.getloadavg()[0], **({"paper_scene": match.json()} if match else {})}
        child = run_child([self.program.path, "build", path, "-r", str(1 << level), "--as", "esvo", "-o", file, "--json",
                           "--threads", str(self.threads), *([] if with_contours else ["--no-contours"]),
                           *scene.options], os.getcwd())
        if child.failure(0):
            return {**run, "failure": child.failure(0)}
        printed = json.loads(child.out)
        voxels, size, seconds, cpu = (printed["voxels"], printed["bytes"]["esvo"], printed["seconds"]["build"],
                                      cpu_seconds(child.cost))
        run.update({
            "voxels": voxels, "bytes": size, "bytes_per_voxel": size / voxels if voxels else 0,
            "contour_count": printed["contours"], "far_pointers": printed["far_pointers"],
            "read_seconds": printed["seconds"]["total"] - seconds, "build_seconds": seconds,
            "wall_seconds": child.cost["wall_seconds"], "cpu_seconds": cpu, "voxels_per_second": voxels / seconds,
            "voxels_per_cpu_second": voxels / cpu, "peak_memory_bytes": child.cost["peak_memory_bytes"]})
        paper = published.esvo_scene(match)
        if paper and with_contours:
            run["paper"] = {"megabytes": published.at_levels(paper["megabytes"], level, published.ESVO_FIRST_LEVELS),
                            "build_seconds": published.at_levels(paper["seconds"], level, published.ESVO_FIRST_LEVELS),
                            "bytes_per_voxel": paper["bytes_per_voxel"],
                            "voxels_per_core_second": published.esvo_voxels_per_core_second(paper, level)}
        return run

    def _cast(self, scene, path, match, pairs):
        options = self.options
        self.progress.show(f"casting at {scene.name}")
        child = run_child([
            self.program.path, "bench", "esvo-rays",
            *(f"{1 << level}={contours},{cubes}" for level, (contours, cubes) in pairs.items()),
            *(["--mesh", path] if scene.is_plain else []), "--size", ",".join(f"{w}x{h}" for w, h in options.size),
            "--views", str(options.views), "--repeat", str(options.repeat), "--lod", f"{options.lod:g}",
            *(["--no-silhouettes"] if options.no_silhouettes else []), "--device", options.device,
            "--threads", str(self.threads)], os.getcwd())
        if child.failure(0):
            self.device_failure = child.failure(0)
            return
        printed = json.loads(child.out)
        paper = published.esvo_scene(match)
        for row in printed["rays"]:
            level, size = row["resolution"].bit_length() - 1, (row["width"], row["height"])
            for form, theirs in zip(ALL_FORMS, published.esvo_mrays(paper, level, size) + [NAN, NAN]):
                row[form]["paper_mrays_per_s"] = theirs
            self.cuda_device = row["device_name"] if row["device"] == "cuda" else self.cuda_device
            self.rays.append({"scene": scene.name, **row})
        rows = [Silhouettes(row["resolution"].bit_length() - 1, row["cubes_wrong"], row["contours_wrong"])
                for row in printed["silhouettes"]]
        for row, of_row in zip(rows, printed["silhouettes"]):
            saved, is_least = levels_saved(rows, row)
            self.silhouettes.append({"scene": scene.name, **of_row, "levels_saved": saved,
                                     "levels_saved_is_least": is_least})


# Tables.

def _fixed(value, digits):
    value = number(value)
    return "-" if math.isnan(value) else f"{value:.{digits}f}"


def _grid(resolution):
    return with_commas(resolution) + "³"


def _size(row):
    return f"{row['width']}x{row['height']}"


def _builds_table(builds):
    text, last = "", None
    for run in builds:
        match, paper = run.get("paper_scene"), None
        if match and match["state"] != "stand-in":
            paper = published.ESVO_SCENES[match["name"]]
        if run["scene"] != last:
            text += "\n" if last else ""
            text += run["scene"] + (f" ({label_of(match)})" if match else "")
            text += (f"; the paper: {paper['bytes_per_voxel']:.2f} bytes per voxel" if paper else "") + "\n"
            text += "  {:>10}  {:<9}{:>15}{:>10}{:>8}{:>10}{:>10}{:>14}{:>9}{:>12}{:>10}{:>9}\n".format(
                "grid", "form", "voxels", "MB", "B/voxel", "build s", "CPU s", "voxels/CPU s", "x paper", "peak mem",
                "paper MB", "paper s")
            last = run["scene"]
        name = f"{_grid(run['resolution']):>10}  {'contours' if run['contours'] else 'cubes':<9}"
        if "failure" in run:
            text += f"  {name} failed: {run['failure']}\n"
            continue
        times = run["voxels_per_cpu_second"] / published.esvo_voxels_per_core_second(paper, run["levels"])
        theirs = run.get("paper", {"megabytes": None, "build_seconds": None})
        text += (f"  {name}{with_commas(run['voxels']):>15}{run['bytes'] / 2**20:>10.1f}{run['bytes_per_voxel']:>8.2f}"
                 f"{run['build_seconds']:>10.2f}{run['cpu_seconds']:>10.2f}{human_count(run['voxels_per_cpu_second']):>14}"
                 f"{_fixed(times, 1):>9}{human_bytes(run['peak_memory_bytes']):>12}{_fixed(theirs['megabytes'], 0):>10}"
                 f"{_fixed(theirs['build_seconds'], 0):>9}\n")
    return text


def _rays_table(title, rows, columns):
    """Returns a table of rows of `bench esvo`; `columns`: names, widths, and functions that return the text."""
    if not rows:
        return ""
    text = f"\n{title}\n  {'scene':<16}{'grid':>10}{'size':>12}" + "".join(f"{name:>{w}}" for name, w, _ in columns) + "\n"
    for row in rows:
        text += f"  {row['scene']:<16}{_grid(row['resolution']):>11}{_size(row):>12}"
        text += "".join(f"{text_of(row):>{w}}" for _, w, text_of in columns) + "\n"
    return text


def least_agreement(row):
    """Returns the least agreement of all forms with the CPU; 1 on the CPU."""
    return min([1] + [row[form]["agreement_with_cpu"] for form in ALL_FORMS if row[form]["agreement_with_cpu"] is not None])


def _rate_column(form):
    def text(row):
        theirs = number(row[form]["paper_mrays_per_s"])
        return _fixed(row[form]["mrays_per_s"], 2) + ("" if math.isnan(theirs) else f" ({theirs:.1f})")
    return form, 20, text


def table(results, cuda_device):
    rows, coarse = results["rays"], [row for row in results["rays"] if row["coarse_resolution"]]
    text = _builds_table(results["builds"])
    on_device = f", octrees on {cuda_device}" if cuda_device else ""
    text += _rays_table(f"Million primary rays per second{on_device} (in brackets: the paper, for octrees of its depth)",
                        rows, [_rate_column(form) for form in FORMS])
    text += _rays_table(
        "Million primary rays per second of the CPU, with the same rays", [row for row in rows if row["device"] == "cuda"],
        [(form, 20, lambda row, form=form: _fixed(row[form]["cpu_mrays_per_s"], 2)) for form in FORMS[1:]] +
        [("equal hits", 16, lambda row: _fixed(least_agreement(row), 6))])

    def times_cubes(row):
        return ", ".join(_fixed(rate(row, form) / rate(row, "cubes"), 2) for form in ALL_FORMS[4:])
    if coarse:
        text += ("\nMillion primary rays per second, on the coarsest grid of contours whose silhouettes are as good as those "
                 "of the cubes; x cubes: multiples of the cubes' rate\n" +
                 "  {:<16}{:>16}{:>12}{:>12}{:>18}{:>18}{:>14}\n".format(
                     "scene", "grid of cubes", "contours", "size", "contours", "with beams", "x cubes"))
        for row in coarse:
            text += (f"  {row['scene']:<16}{_grid(row['resolution']):>17}{_grid(row['coarse_resolution']):>13}"
                     f"{_size(row):>12}{_fixed(row['coarse_contours']['mrays_per_s'], 2):>18}"
                     f"{_fixed(row['coarse_contours_beams']['mrays_per_s'], 2):>18}{times_cubes(row):>14}\n")
    text += _rays_table("Seconds of the pictures of all views, without shadows and occlusion", rows, [
        ("casts with beams", 20, lambda row: _fixed(cast_seconds(row), 3)),
        ("casts and shading", 20, lambda row: _fixed(row["picture_seconds"], 3)),
        ("filter", 12, lambda row: _fixed(row["filter_seconds"], 3))])
    if results["silhouettes"]:
        text += (f"\nRays on the wrong side of a silhouette, per million\n  {'scene':<16}{'grid':>10}{'cubes':>12}"
                 f"{'contours':>12}{'levels of cubes saved':>26}\n")
        for row in results["silhouettes"]:
            saved = ("> " if row["levels_saved_is_least"] else "") + f"{row['levels_saved']:.1f}"
            text += (f"  {row['scene']:<16}{_grid(row['resolution']):>11}{row['cubes_wrong'] * 1e6:>12.0f}"
                     f"{row['contours_wrong'] * 1e6:>12.0f}{saved:>26}\n")
    return text


# Charts.

def _by_scene(rows):
    scenes = {}
    for row in rows:
        scenes.setdefault(row["scene"], []).append(row)
    return scenes.items()


def chart(results):
    """Returns a chart of megabytes, seconds and silhouettes over the resolution, beside the paper's figures; None without
    any build."""
    def points(label, rows, key, scale, color, style):
        rows = [row for row in rows if row.get(key)]
        return [line(label, [row["resolution"] for row in rows], [row[key] * scale for row in rows], color, style,
                     style == "solid")] if rows else []

    def panel_of(title, unit, key, scale, of_paper):
        lines = []
        for color, (scene, rows) in enumerate(_by_scene(results["builds"])):
            lines += points(scene, [row for row in rows if row["contours"]], key, scale, color, "solid")
            lines += points("", [row for row in rows if not row["contours"]], key, scale, color, "dotted")
            match = rows[0].get("paper_scene")
            if match and match["state"] != "stand-in":
                values = published.ESVO_SCENES[match["name"]][of_paper]
                lines.append(line("", [2 ** (published.ESVO_FIRST_LEVELS + i) for i in range(len(values))], values, color,
                                  "dashed"))
        return panel(title, axis("resolution", "log2"), axis(unit, "log10"), lines)
    panels = [panel_of("Memory; dotted: cubes, dashed: the paper", "MB (2^20 bytes)", "bytes", 2**-20, "megabytes"),
              panel_of("Construction; dotted: cubes, dashed: the paper", "seconds", "build_seconds", 1, "seconds")]
    wrong = [one for color, (scene, rows) in enumerate(_by_scene(results["silhouettes"]))
             for one in points(scene, rows, "contours_wrong", 1e6, color, "solid") +
             points("", rows, "cubes_wrong", 1e6, color, "dotted")]
    if wrong:
        panels.append(panel("Rays on the wrong side of a silhouette; dotted: cubes", axis("resolution", "log2"),
                            axis("per million", "log10"), wrong))
    return {"panels": panels} if panels[0]["lines"] else None


def rays_chart(results):
    """Returns a chart of rays per second as bars, a panel per scene; None without any rays."""
    panels = []
    for scene, rows in _by_scene(results["rays"]):
        coarse = rows[0]["coarse_resolution"]
        lines = [line(form, [], [rate(row, form) for row in rows], color) for color, form in enumerate(ALL_FORMS)]
        panels.append(panel(f"{scene} {_grid(rows[0]['resolution'])}" + (f", coarse: {_grid(coarse)}" if coarse else ""),
                            axis(""), axis("million primary rays per second"),
                            [one for one in lines if not all(map(math.isnan, one["y"]))],
                            [f"{row['width']} × {row['height']}" for row in rows]))
    return {"panels": panels} if panels else None


def run(arguments, program):
    """Runs the command with these arguments."""
    parser = Parser("esvo", "Measure size, build time, rays per second and silhouettes of ESVOs, with and without contours",
                    "Sibenik=sibenik.obj 'Sponza=sponza.obj --max-error 0.5' -r 1K,2K,4K\n\n"
                    "For scenes of the paper, the tables also show the paper's figures (lab/README.md). Scratch files go to\n"
                    "TMPDIR.")
    add = parser.add_argument
    add("scenes", metavar="NAME=MESH", nargs="+", type=scene_of,
        help="Scenes. Each is one argument: NAME=MESH, then options of `build`. MESH is a file or a procedural scene (NAME or "
        "NAME:SIZE)")
    add("-r", "--resolution", metavar="N,N...", type=levels, default=[10, 11, 12],
        help="Voxels per side (default: 1K,2K,4K)")
    add("--size", metavar="WxH,WxH...", type=image_sizes, default=[(512, 384), (1024, 768), (2048, 1536)],
        help="Sizes of the pictures whose rays are cast, in pixels (default: 512x384,1024x768,2048x1536)")
    add("--views", metavar="N", type=whole(1, 64), default=4, help="Number of cameras (1 to 64; default: 4)")
    add("--repeat", metavar="N", type=whole(1, 1000), default=3, help="Number of casts; the fastest counts (default: 3)")
    add("--lod", metavar="PIXELS", type=not_negative(1000), default=1,
        help="End rays at cells of this size in the picture; 0: always at voxels (default: 1)")
    add("--no-silhouettes", action="store_true", help="Do not compare silhouettes with those of the mesh")
    output = Output(parser, {"--plot": "Plot megabytes, seconds and silhouettes over the resolution",
                             "--rays-plot": "Plot bars of rays per second"})
    add("--device", metavar="cpu|cuda|auto", type=device, default="cpu", help="Device that casts the rays (default: cpu)")
    add_run_options(parser)
    options = parser.parse_args(arguments)
    output.check(options, [scene.mesh for scene in options.scenes])
    machine = machine_json()
    with ScratchFolder() as scratch:
        bench = Bench(options, program, output.progress, scratch.path)
        bench.run()
    results = {"program": program.name, "machine": machine, "threads": bench.threads, "published": published.ESVO_SOURCE,
               "builds": bench.builds, "rays": bench.rays, "silhouettes": bench.silhouettes}
    start = (f"{bench.cuda_device + '; ' if bench.cuda_device else ''}{machine['processor']}, {bench.threads} threads, load "
             f"average {machine['load_average']:.2f} before\n\n")
    output.write(results, lambda: start + table(results, bench.cuda_device), {"--plot": chart, "--rays-plot": rays_chart})
    for build in bench.builds:
        if "failure" in build:
            raise Error(f"{build['scene']}: {build['resolution']}: {build['failure']}")
    if bench.device_failure:
        raise Error(bench.device_failure)
    for row in bench.rays:
        if least_agreement(row) < 1:
            raise Error(f"{row['scene']}: {row['width']} x {row['height']} pixels: hits of {bench.cuda_device} differ from "
                        "the CPU's")
