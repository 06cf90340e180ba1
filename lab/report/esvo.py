"""The report's chapter about the ESVO paper: tables, figures and claims."""

import math

import published
from cells import commands_of, finest_of, levels_of, value_at
from charts import axis, line, panel
from document import Paragraph, Section, Table
from esvo_runs import (FORMS, build_seconds, bytes_per_voxel, cast_seconds, levels_saved, megabytes, rate, rate_on_cpu,
                       rays_of_size, silhouettes_of, sizes_of)
from pictures import chart_parts, picture_parts, row_parts
from scenes import scenes_section
from tables import ClaimsTable, ClaimValue, ResolutionTable
from text import NAN, human_count, number, number_text, seconds_text, short_resolution


# Sections.

def _published_of(scene):
    return published.ESVO_SCENES.get(scene.name) if scene.shows_published else None


def table1_section(all_runs, threads):
    """Table 1: memory and construction time. `threads`: of our builds."""
    levels = levels_of([runs.builds for runs in all_runs])
    memory = ResolutionTable("Memory in MB (2^20 bytes)", levels)
    time = ResolutionTable(f"Construction time. Ours: {threads} threads. Published: four cores", levels)
    density = Table("Bytes per voxel of the finest octree",
                    ["scene", "resolution", "voxels", "bytes per voxel", "published: resolution", "bytes per voxel"])
    for runs in all_runs:
        paper, title, finest = _published_of(runs.scene), runs.scene.title, finest_of(runs.builds)
        for table, what, read, key, text in ((memory, "MB", megabytes, "megabytes", number_text),
                                             (time, "time", build_seconds, "seconds", seconds_text)):
            if not runs.scene.is_absent:
                table.add(title, what, lambda level: text(value_at(runs.builds, level, read)))
            if paper:
                table.add(title, what + ", published",
                          lambda level: text(published.at_levels(paper[key], level, published.ESVO_FIRST_LEVELS)))
        ours = [short_resolution(finest.levels), human_count(finest.result.json["voxels"]),
                f"{bytes_per_voxel(finest.result):.2f}"] if finest else 3 * ["–"]
        theirs = [short_resolution(published.esvo_levels_of_rates(paper)),
                  f"{paper['bytes_per_voxel']:.2f}"] if paper else 2 * ["–"]
        density.rows.append([title, *ours, *theirs])
    return Section("Table 1: memory and construction time", 2, [
        Paragraph(f"Published: {published.ESVO_SOURCE}. Octrees have contours, colours and normals. The time covers "
                  "building and writing, from the mesh in memory. voxdag ends a voxel where its shape, colours and normals "
                  "are within the error bounds of `build`, by default half a voxel, 0.03 and 3 degrees. The paper does "
                  "not state the bounds of its octrees."),
        memory.table, time.table, density, *commands_of([(runs.scene, runs.builds) for runs in all_runs])])


def table1_charts(all_runs):
    """Returns a chart of memory and time over the resolution; or nothing."""
    def panel_of(title, unit, read, key):
        lines = []
        for color, runs in enumerate(all_runs):
            if not runs.scene.is_absent:
                lines.append(line(runs.scene.title, [2 ** run.levels for run in runs.builds],
                                  [NAN if run.result.failure else read(run.result) for run in runs.builds], color,
                                  markers=True))
            paper = _published_of(runs.scene)
            if paper:
                lines.append(line(f"{runs.scene.name}, published",
                                  [2 ** (published.ESVO_FIRST_LEVELS + i) for i in range(len(paper[key]))], paper[key],
                                  color, "dashed"))
        return panel(title, axis("resolution", "log2"), axis(unit, "log10"), lines)
    panels = [panel_of("Memory", "MB", megabytes, "megabytes"),
              panel_of("Construction time", "seconds", build_seconds, "seconds")]
    return [{"file": "esvo-table1.svg", "panels": panels}] if panels[0]["lines"] else []


def table2_section(all_runs):
    """Table 2: primary rays at triangles, cubes and contours."""
    rates = Table("Million primary rays per second; in brackets: the paper's, for octrees of its depth",
                  ["scene", "octree", "picture", "triangles", "cubes", "contours", "contours with beams"], [], 3)
    costs = Table("Pictures of all views, without shadows and occlusion, as in the paper",
                  ["scene", "octree", "picture", "casts with beams", "casts and shading", "filter", "casts / filter"], [], 3)
    for runs in all_runs:
        paper, finest = published.esvo_scene(runs.scene.match), finest_of(runs.rays)
        for run in runs.rays:
            # The finest, and the one with the depth of the paper's octree.
            if run.result.failure or not (run is finest or paper and run.levels == published.esvo_levels_of_rates(paper)):
                continue
            for size in sizes_of(run.result):
                row = rays_of_size(run.result, size)
                start = [runs.scene.title, short_resolution(run.levels), f"{size[0]} × {size[1]}"]
                theirs = published.esvo_mrays(paper, run.levels, size)
                rates.rows.append(start + [number_text(rate(row, form)) +
                                           ("" if math.isnan(of_paper) else f" ({number_text(of_paper)})")
                                           for form, of_paper in zip(FORMS, theirs)])
                casts, filtering = cast_seconds(row), number(row["filter_seconds"])
                costs.rows.append(start + [seconds_text(casts), seconds_text(row["picture_seconds"]),
                                           seconds_text(filtering), number_text(casts / filtering)])
    return Section("Table 2: primary rays", 2, [
        Paragraph("Four views of each scene. Rays end at cells of one pixel, as in the paper. Triangles are those of Embree "
                  "on the processor: single rays or packets of 16, whichever is faster; a displaced surface has none. The "
                  "time of beams counts. The paper's rates are those of a Quadro FX 5800, of the largest octree that "
                  "fitted into its 4 GB; ours are those of the device named above, of the finest octree that the time "
                  "limit allows. The two stand beside each other only for octrees of equal depth."),
        rates,
        Paragraph("In the paper, shading costs little, and the filter takes one to two orders of magnitude less than the "
                  "casts."),
        costs, *commands_of([(runs.scene, runs.rays) for runs in all_runs])])


def table2_charts(all_runs):
    """Returns a chart of the rates over the resolution, a panel for each scene; or nothing."""
    panels = []
    for runs in all_runs:
        done = [run for run in runs.rays if not run.result.failure]
        if not done or not sizes_of(done[-1].result):
            continue
        size = sizes_of(done[-1].result)[-1]
        lines = [line(label, [2 ** run.levels for run in done],
                      [rate(rays_of_size(run.result, size), form) for run in done], color, markers=True)
                 for form, label, color in zip(FORMS, ("triangles (Embree)", "cubes", "contours", "contours with beams"),
                                               (1, 3, 2, 0))]
        panels.append(panel(f"{runs.scene.title}, {size[0]} × {size[1]}", axis("resolution", "log2"),
                            axis("million rays per second"), [one for one in lines if not math.isnan(one["y"][-1])]))
    return [{"file": "esvo-table2.svg", "panels": panels}] if panels else []


def silhouettes_section(all_runs):
    """How well silhouettes of cubes and of contours agree with those of the triangles."""
    table = Table("Rays on the wrong side of a silhouette, per million",
                  ["scene", "octree", "cubes", "contours", "levels of cubes saved"], [], 2)
    for runs in all_runs:
        rows = silhouettes_of(runs.rays)
        for row in rows:
            saved, is_least = levels_saved(rows, row)
            # The finest octree of a scene has no finer cubes to compare with.
            text = "–" if is_least and saved == 0 else f"{'> ' if is_least else ''}{saved:.1f}"
            table.rows.append([runs.scene.title, short_resolution(row.levels), number_text(1e6 * row.cubes),
                               number_text(1e6 * row.contours), text])
    return Section("Contours and silhouettes", 2, [
        Paragraph("The paper says that contours save several levels, and shows it in pictures. Here, primary rays of "
                  "1024 × 768 pixels that end at the finest voxels count: those that hit a voxel but no triangle, or a "
                  "triangle but no voxel. \"Levels saved\": so many levels finer cubes must be to be as good; > means that "
                  "no measured cubes were as good."), table])


def silhouettes_charts(all_runs):
    """Returns a chart of the errors over the resolution; or nothing."""
    lines = []
    for runs in all_runs:
        rows, color = silhouettes_of(runs.rays), len(lines) // 2
        for name, style in (("contours", "solid"), ("cubes", "dashed")) if rows else ():
            lines.append(line(f"{runs.scene.name}, {name}", [2 ** row.levels for row in rows],
                              [1e6 * getattr(row, name) or NAN for row in rows], color, style, True))
    return [{"file": "esvo-silhouettes.svg", "panels": [panel("Silhouettes", axis("resolution", "log2"),
                                                             axis("wrong rays per million", "log10"), lines)]}] if lines else []


def claims_section(all_runs):
    """Returns a table with a line for each claim: reproduced, not reproduced, or not measured."""
    known = [runs for runs in all_runs if runs.scene.has_figures]

    def per_size(read):
        """Returns read(row) for each size of the pictures, at the finest resolution of each scene."""
        values = []
        for runs in known:
            finest = finest_of(runs.rays)
            for row in finest.result.json["rays"] if finest else ():
                value = read(row)
                if not math.isnan(value):
                    values.append(ClaimValue(f"{runs.scene.name} at {short_resolution(finest.levels)}, {row['width']} × "
                                             f"{row['height']}", finest.levels, value))
        return values

    def ratio(form, rival):
        return per_size(lambda row: rate(row, form) / rate(row, rival))

    densities = [ClaimValue(f"{runs.scene.name} at {short_resolution(finest.levels)}", finest.levels,
                            bytes_per_voxel(finest.result))
                 for runs in known for finest in [finest_of(runs.builds)] if finest]
    # The coarsest resolution of each scene has the most finer ones to compare with.
    silhouettes = [(runs.scene.name, silhouettes_of(runs.rays)) for runs in known]
    saved = [ClaimValue(f"{name} at {short_resolution(rows[0].levels)}", rows[0].levels, levels_saved(rows, rows[0])[0])
             for name, rows in silhouettes if len(rows) >= 2]
    claims = ClaimsTable()
    claims.add_range("A voxel takes few bytes more than the optimum of 5 (bytes per voxel)", "5.2 to 8.1", densities,
                     lambda size: size <= 8.1)
    claims.add_range("Contours save several levels of cubes (levels saved, at least)", "shown in pictures", saved,
                     lambda levels: levels >= 2)
    for claim, range_, values in (
            ("Rays at contours are faster than at cubes (rate / rate)", "1.1 to 2.7", ratio("contours", "cubes")),
            ("Beams make them faster (rate / rate)", "1.0 to 1.4", ratio("contours_beams", "contours")),
            ("Contours with beams are faster than triangles (rate / rate)", "1.05 to 2.1",
             per_size(lambda row: rate_on_cpu(row, "contours_beams") / rate(row, "triangles")))):
        claims.add_range(claim, range_, values, lambda ratio: ratio >= 1)
    claims.add_range("The filter is one to two orders of magnitude faster than the casts (casts / filter)", "10 to 100",
                     per_size(lambda row: cast_seconds(row) / number(row["filter_seconds"])), lambda ratio: ratio >= 10)
    return Section("Claims", 2, [
        Paragraph("Figures are those of the paper's scenes and their variants, at the finest resolution that was measured. "
                  "Ratios of speeds are those of the device named above, and those to triangles of the processor; the "
                  "paper measured a GPU."), claims.table])


def picture_sections(pictures):
    """Returns a section for each figure. `pictures`: what the items of esvo_items() returned."""
    sections = []

    def add(title, text, parts):
        sections.append(Section(title, 2, [Paragraph(text), *parts]))
    if "cathedral" in pictures:
        first, *steps = pictures["cathedral"]
        add("Figure 1: a displaced cathedral", "As in the paper, the surface is displaced, and ambient occlusion is baked into "
            "the colours: all geometry and shading data is that of the voxels. The picture has no other shadows.",
            picture_parts(first, first.scene.title + "."))
    if "contours" in pictures:
        add("Figures 4 and 5: contours", "The same grids as cubes and with contours. They are coarse on purpose, and the "
            "filter is off.", [part for levels, both in pictures["contours"] for part in row_parts(both, [
                f"Cubes at {short_resolution(levels)}.", f"Contours at {short_resolution(levels)} (the command's)."])])
    if "cathedral" in pictures:
        add("Figure 9: steps of the primary rays", "As in the paper, white is 64 steps. The steps of the beams count, spread "
            "over their pixels.", row_parts(steps, ["Without beams.", "With beams (the command's)."]))
    if "filters" in pictures:
        add("Figure 10: the filter", "An octree with few levels and wide error bounds, so that neighbouring voxels differ in "
            "size. The naive filter averages a disc of the pixel's own voxel: seams show where the size changes, and the "
            "background bleeds into outlines. The paper's filter shrinks the disc to the voxels that it covers.",
            row_parts(pictures["filters"], ["The naive filter.", "The paper's filter (the command's)."]))
    if "guides" in pictures:
        add("Figure 11: the paper's filter and guides", "Figure 11 of the paper is the algorithm of its filter. It also "
            "averages across the edges of large voxels and across shadows; the paper's pictures have no shadows. By default "
            "`render` leaves out pixels of other surfaces and in other light.",
            row_parts(pictures["guides"], ["The paper's filter.", "With guides (the command's)."]))
    scenery = [picture for key, picture in pictures.items() if key[0] == "esvo picture"]
    if scenery:
        add("Figure 12: the scenes", "Octrees with contours, colours and normals, lit as `render` does by default.",
            [part for picture in scenery for part in picture_parts(picture, picture.scene.title + ".")])
    return sections


# The chapter.

def esvo_charts(results):
    return [chart for make in (table1_charts, table2_charts, silhouettes_charts) for chart in make(results.runs)]


def esvo_chapter(results, threads, is_drawn):
    """Returns the sections of the chapter. `threads`: of our builds. `is_drawn`: whether the charts are there."""
    runs = results.runs

    def with_charts(section, charts, caption):
        section.parts += chart_parts(charts, caption, is_drawn)
        return section
    return [
        Section("Efficient Sparse Voxel Octrees (Laine, Karras 2010)"),
        scenes_section(results.scenes),
        claims_section(runs),
        with_charts(table1_section(runs, threads), table1_charts(runs),
                    "Table 1: memory and construction time over the resolution; dashed: published."),
        with_charts(table2_section(runs), table2_charts(runs), "Table 2: primary rays over the resolution."),
        with_charts(silhouettes_section(runs), silhouettes_charts(runs),
                    "Rays on the wrong side of a silhouette; dashed: cubes."),
        *picture_sections(results.pictures)]
