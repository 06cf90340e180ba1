"""The report's chapter about the SVDAG paper: tables, figures and claims."""

import math
import os

import published
from cells import commands_of, levels_of, value_at
from charts import axis, line, panel
from document import CommandLine, Paragraph, Picture, Section, Table
from flight import flight_charts, flight_sections, rates_of, speed_ratio
from pictures import chart_parts, picture_parts, row_parts
from png import read_first_channel, write_grey
from scenes import scenes_section
from svdag_runs import (dag_bytes, dag_nodes, esvo_bytes, esvo_nodes, MEBIBYTE, stage, svo_nodes, wall_seconds)
from tables import ClaimsTable, ClaimValue, ResolutionTable, range_text, verdict
from text import NAN, human_count, number_text, seconds_text, short_resolution


# Tables.

def _series_of(builds, name):
    return [(scene, series[name]) for scene, series in builds]


def table1_section(builds, threads):
    """Table 1: time to reduce the octree to the DAG. `builds`: scenes and their series; `threads`: of our builds."""
    levels = levels_of([series["paper_method"] for _, series in builds])
    reduction = ResolutionTable(
        f"Wall-clock time to reduce the octree to the DAG. Ours: {threads} threads. Published: {published.SVDAG_SOURCE}",
        levels)
    whole = ResolutionTable("Wall-clock time of whole builds, from the start of the process to its end", levels)
    for scene, series in builds:
        def add(table, what, name, read):
            if not scene.is_absent:
                table.add(scene.title, what, lambda level: seconds_text(value_at(series[name], level, read)))
        add(reduction, "reduction", "paper_method", stage("reduce"))
        add(reduction, "of it sorting", "paper_method", stage("sort"))
        for row, what in enumerate(("published, reduction", "published, of it sorting")) if scene.shows_published else ():
            reduction.add(scene.title, what,
                          lambda level: seconds_text(published.reduction_at(scene.name, level)[row]))
        add(whole, "the paper's method", "paper_method", wall_seconds)
        add(whole, "voxdag's method", "voxdag_method", wall_seconds)
    return Section("Table 1: time of the reduction", 2, [
        Paragraph(
            "The paper reduces sub-volumes of 1024³ one after the other, sorts each level with tbb::parallel_sort on six "
            "cores, and does the rest on one core. --method paper does the same in the same order. Its reduction includes "
            "joining the sub-volumes under the top tree and the final reduction of the whole. The paper's algorithm also "
            "reduces trees whose leaves have different depths. voxdag's never do: a mesh has voxels at the finest level "
            "only."),
        reduction.table, *commands_of(_series_of(builds, "paper_method")),
        Paragraph("voxdag's own method never makes the octree, so its time to reduce one cannot be stated. Whole builds "
                  "compare the two methods."),
        whole.table, *commands_of(_series_of(builds, "voxdag_method"))])


# The structures that Table 2 compares: name, series, nodes, bytes, whether the paper has it. An ESVO without contours
# has the nodes of the SVO. A node of the SVO, which has no pointers, is one byte.
STRUCTURES = [("DAG", "dags", dag_nodes, dag_bytes, True), ("ESVO", "esvos", esvo_nodes, esvo_bytes, True),
              ("ESVO, shape only", "esvo_shapes", esvo_nodes, esvo_bytes, False),
              ("ESVO without contours", "dags", svo_nodes, lambda build: 8 * svo_nodes(build), False),
              ("SVO", "dags", svo_nodes, svo_nodes, True)]


def _density_row(scene, dags):
    """Returns the bits per voxel at the highest resolution that was built."""
    row = [scene.title] + 7 * ["–"]
    highest = next((run for run in reversed(dags) if not run.result.failure), None)
    if highest is not None:
        json_, bits = highest.result.json, highest.result.json["bits_per_voxel"]
        row[1:5] = [short_resolution(highest.levels), human_count(json_["voxels"]), f"{bits['svdag_paper']:.2f}",
                    f"{bits['svo_pointerless']:.2f}"]
    if scene.shows_published and scene.name in published.BITS_PER_VOXEL:
        resolution, dag, svo = published.BITS_PER_VOXEL[scene.name]
        row[5:8] = [resolution, f"{dag:.2f}", f"{svo:.2f}"]
    return row


def table2_section(builds):
    """Table 2: nodes, memory and bits per voxel of DAG, ESVO and SVO."""
    levels = levels_of([series["dags"] for _, series in builds])
    nodes, memory = ResolutionTable("Nodes in millions", levels), ResolutionTable("Memory in MB (2^20 bytes)", levels)
    for scene, series in builds:
        for name, kind, read_nodes, read_bytes, is_published in STRUCTURES:
            for table, read, unit, column in ((nodes, read_nodes, 1e-6, 0), (memory, read_bytes, 1 / MEBIBYTE, 1)):
                if not scene.is_absent:
                    table.add(scene.title, name, lambda level: number_text(value_at(series[kind], level, read) * unit))
                if is_published and scene.shows_published:
                    values = published.SIZES[scene.name][name][column]
                    table.add(scene.title, name + ", published", lambda level: number_text(
                        published.at_levels(values, level, published.TABLE2_FIRST_LEVELS)))
    density = Table("Bits per voxel at the highest resolution that was built",
                    ["scene", "resolution", "voxels", "DAG", "SVO", "published: resolution", "DAG", "SVO"],
                    [_density_row(scene, series["dags"]) for scene, series in builds])
    return Section("Table 2: nodes and memory", 2, [
        Paragraph(
            f"Published: {published.TABLE2_SOURCE}. As in the paper, an ESVO node counts 8 bytes (child mask, contour and "
            "pointer) without its colours and normals, and a node of the SVO, which has no pointers, one byte. The "
            "paper's ESVOs come from the program of Laine and Karras with its default settings, ours from voxdag with its "
            "own: a leaf's colours and normals must be uniform, so textures keep the octree deep. An ESVO of the shape "
            "only ends where the contours are close enough to the surface; without contours, it ends at voxels and has "
            "the nodes of the SVO. A node of our DAG has 4 bytes of child mask and 4 bytes per child; the two lowest "
            "levels are 8 bytes for 4³ voxels."),
        nodes.table, memory.table, density,
        *(part for name in ("dags", "esvos", "esvo_shapes") for part in commands_of(_series_of(builds, name)))])


# Figures.

def figure5_charts(builds):
    """Returns the chart of nodes per level for the paper's two scenes, or for others that were built; or nothing."""
    svo_color = 6  # black
    panels = []
    for scene, series in sorted(builds, key=lambda of: of[0].name not in ("Crysponza", "SanMiguel")):
        built = [run for run in series["dags"] if not run.result.failure]
        lines = [line("DAG " + short_resolution(run.levels), range(len(run.result.json["dag_nodes_per_level"])),
                      run.result.json["dag_nodes_per_level"], color, markers=True) for color, run in enumerate(built)]
        if not built:
            continue
        nodes = built[-1].result.json["svo_nodes_per_level"]
        lines.append(line("SVO", range(len(nodes)), nodes, svo_color, "dashed"))
        panels.append(panel(scene.title, axis("level (0: the root)"), axis("nodes", "log10"), lines))
    return [{"file": "svdag-figure5.svg", "panels": panels[:2]}] if panels else []


def _figure1_section(build, picture, rays):
    paper, scene = published.FIGURE1, picture.scene

    def rate(kind):
        mrays = rates_of(rays, kind).mrays
        return "–" if math.isnan(mrays) else human_count(1e6 * mrays)
    rows = []
    if not build.failure:
        sizes = build.json["bytes"]
        rows = [["resolution", short_resolution(rays.levels), short_resolution(paper["levels"])],
                ["voxels", human_count(build.json["voxels"]), human_count(paper["voxels"])],
                ["DAG (MB)", number_text(sizes["svdag_paper"] / MEBIBYTE), number_text(paper["dag_megabytes"])],
                ["octree without pointers (MB)", number_text(sizes["svo_pointerless"] / MEBIBYTE),
                 number_text(paper["svo_megabytes"])],
                ["build", seconds_text(wall_seconds(build)), "–"],
                ["memory of the build (MB)", number_text(build.cost["peak_memory_bytes"] / MEBIBYTE), "–"]]
    rows += [["shadow rays per second", rate("shadow"), human_count(paper["shadow_rays_per_second"])],
             ["occlusion rays per second", rate("ao"), human_count(paper["occlusion_rays_per_second"])]]
    return Section("Figure 1: the finest grid", 2, [
        Paragraph(f"The triangles are shaded, and rays through the DAG find shadows and ambient occlusion. The paper's "
                  f"picture shows {paper['scene']}, and its rates are those of a {paper['device']}: they say what the "
                  "paper did, and do not compare with ours."),
        Table("The scene of Figure 1 and the rays of its picture", ["", scene.title, f"published: {paper['scene']}"], rows),
        *picture_parts(picture, scene.title + ", lit through its DAG."), CommandLine(rays.cell.command())])


def _figure8b_section(plan, pictures):
    title = "Figure 8b: ambient occlusion that ends at a solid angle"
    exact, cones = next(((of[1], of[2]) for of in pictures if len(of) == 3), (None, None))
    if exact is None or exact.result.failure or cones.result.failure:
        return Section(title, 2, [Paragraph("Not measured: no scene has a picture.")])
    rows = [read_first_channel(picture.cell.output) for picture in (exact, cones)]
    differences = [[(b - a) / 255 for a, b in zip(*pair)] for pair in zip(*rows)]
    count = sum(map(len, differences))
    mean = sum(map(sum, differences)) / count
    square = math.sqrt(sum(d * d for row in differences for d in row) / count)
    file = "svdag-figure8b-difference.png"
    write_grey(os.path.join(plan.folder, file),
               [[int(255 * min(max(0.75 + d, 0), 1) + 0.5) for d in row] for row in differences])
    return Section(title, 2, [
        Paragraph(f"64 rays per pixel in {exact.scene.name}, once to voxels and once to the first cell of 0.07 "
                  "steradians. The paper says that this darkens the picture but keeps occlusion near contacts. With "
                  f"cones, {-100 * mean:.1f} % less of the sky's light arrives on average; the root mean square of the "
                  f"difference is {100 * square:.1f} % of the sky's light."),
        *row_parts([exact, cones], ["Rays to voxels.", "Rays to cells of 0.07 steradians (the command's)."]),
        Picture("The difference: light grey where both are equal, darker where cones are darker.", file)])


# Claims.

NOT_SO_HIGH = "not measured at 64K³"


def _ratios(builds, name_a, a, name_b, b):
    """Returns a / b for all builds of the paper's scenes and their variants that have both."""
    values = []
    for scene, series in builds:
        for run in series[name_a] if scene.has_figures else ():
            ratio = value_at(series[name_a], run.levels, a) / value_at(series[name_b], run.levels, b)
            if not math.isnan(ratio):
                values.append(ClaimValue(f"{scene.name} at {short_resolution(run.levels)}", run.levels, ratio))
    return values


def _at_highest(values):
    """Returns the values at the highest resolution of each scene."""
    return [value for value, following in zip(values, values[1:] + [None])
            if following is None or following.levels <= value.levels]


def _has_paper_levels(values):
    return any(value.levels >= 16 for value in values)


def _growth(builds):
    """Returns the growth of the reduction from each resolution above 1024³, which has sub-volumes, to the next."""
    values, read = [], stage("reduce")
    for scene, series in builds:
        runs = series["paper_method"]
        for levels in [run.levels for run in runs if run.levels >= 11] if scene.has_figures else ():
            factor = value_at(runs, levels + 1, read) / value_at(runs, levels, read)
            if not math.isnan(factor):
                values.append(ClaimValue(f"{scene.name}, {short_resolution(levels)} to {short_resolution(levels + 1)}",
                                         levels, factor))
    return values


def claims_section(builds, flight):
    """Returns a table with a line for each claim: reproduced, exceeded, not reproduced, or not measured. Claims about
    sizes and times look at the paper's scenes and their variants only. `flight`: FlightRuns by name, or None."""
    merging = _ratios(builds, "dags", svo_nodes, "dags", dag_nodes)
    against_svo = _ratios(builds, "dags", svo_nodes, "dags", dag_bytes)
    against_esvo = _ratios(builds, "esvos", esvo_bytes, "dags", dag_bytes)
    claims = ClaimsTable()

    def add_most(claim, published_factor, values):
        """Adds a claim about the largest value, which the paper found at 64K³."""
        def most(values):
            return max(values, key=lambda value: value.value)

        def judge(values):
            factor = most(values).value
            is_there = factor > 0.95 * published_factor
            return ("exceeded" if factor > published_factor else
                    verdict(is_there) if is_there or _has_paper_levels(values) else NOT_SO_HIGH)
        claims.add(claim, f"{number_text(published_factor)} at 64K³", values, judge, lambda values: most(values).text())

    def judge_svo(values):
        # In the paper, too, the SVO of Lucy is smaller than its DAG up to 16K³.
        holds = all(value.value > 1 for value in values)
        return verdict(holds) if holds or _has_paper_levels(values) else NOT_SO_HIGH

    def speed(run, rays, rival):
        return speed_ratio(flight[run], rays, rival) if flight else NAN
    claims.add_range("Merging reduces the nodes by one to three orders of magnitude (SVO / DAG)",
                     "28 to 576 at the highest resolutions", _at_highest(merging), lambda factor: factor >= 10)
    add_most("Largest reduction of nodes (SVO / DAG)", 576, merging)
    add_most("Largest saving against the SVO without pointers (SVO / DAG)", 26, against_svo)
    claims.add("The DAG is smaller than the SVO without pointers (SVO / DAG)", "above 1 in every scene at 64K³",
               _at_highest(against_svo), judge_svo, range_text)
    claims.add_range("The DAG is smaller than the ESVO at every resolution (ESVO / DAG)", "above 1 everywhere",
                     against_esvo, lambda factor: factor > 1)
    add_most("Largest saving against the ESVO (ESVO / DAG)", 38, against_esvo)
    claims.add_range("The time of the reduction scales with the surface: about 4 per level", "3.3 to 5", _growth(builds),
                     lambda factor: factor <= 5)
    claims.add_ratio("Primary rays with beams: slightly faster than the ESVO", "above 1 on average",
                     speed("with_esvo", "primary_beams", "esvo"), 1)
    claims.add_ratio("Primary rays: as fast as triangles even at high resolutions", "about 1",
                     speed("with_triangles", "primary_beams", "embree"), 0.9)
    claims.add_ratio("Occlusion rays: at least as fast as triangles", "above 1",
                     speed("with_triangles", "ao", "embree"), 1)
    return Section("Claims", 2, [
        Paragraph("Sizes and times are those of the paper's scenes and their variants. Ratios of speeds are those of the "
                  "fly-through below, on the device named above. Ratios to triangles are those of the processor, with "
                  "Embree as the tracer of triangles. The paper measured GPUs."), claims.table])


# The chapter.

def svdag_charts(results):
    return figure5_charts(results.builds) + (flight_charts(results.flying, results.flight) if results.flight else [])


def svdag_chapter(results, threads, is_drawn):
    """Returns the sections of the chapter. `threads`: of our builds. `is_drawn`: whether the charts are there."""
    figure4 = [part for pictures in results.pictures
               for part in picture_parts(pictures[0], pictures[0].scene.title + ".")]
    return [
        Section("High Resolution Sparse Voxel DAGs (Kämpe, Sintorn, Assarsson 2013)"),
        scenes_section(results.scenes),
        claims_section(results.builds, results.flight),
        table1_section(results.builds, threads),
        table2_section(results.builds),
        Section("Figure 5: nodes per level", 2, [
            Paragraph("Merging opportunities grow with the resolution. The SVO has about four times as many nodes at each "
                      "level as at the level above; the lowest levels of a DAG have few different nodes."),
            *chart_parts(figure5_charts(results.builds), "Figure 5: nodes per level of DAGs of several resolutions, and of "
                         "the SVO of the highest one.", is_drawn)]),
        *([_figure1_section(*results.figure1)] if results.figure1 else []),
        Section("Figure 4: the scenes", 2, [
            Paragraph("As in the paper, the triangles are shaded, and rays through the DAG find soft shadows and ambient "
                      "occlusion."), *figure4]),
        *(flight_sections(results.plan, results.flying, results.flight, is_drawn) if results.flight else []),
        _figure8b_section(results.plan, results.pictures)]
