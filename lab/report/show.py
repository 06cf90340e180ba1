"""Prints the tables and draws the plots of the benchmarks that voxdag-lab measures. It runs

    python3 lab/report show trace|compact|compact-rays|attributes FILE.json [PLOT.svg]

and prints the tables itself; `show plots` only checks that plots can be drawn."""

import json
import math
import os
from itertools import groupby

from charts import axis, draw_charts, is_installed, line, panel
from document import Error
from text import human_bytes, human_count, number, with_commas

NO_MATPLOTLIB = "matplotlib draws the plots, and it is not installed (apt install python3-matplotlib)"


def _grid(resolution):
    return with_commas(resolution) + "³"


# Rays.

def _trace_rows(results):
    """Returns the rows of each scene, grid and layout, each with its rivals' rates by name, and the names of all rivals."""
    rows, rivals = {}, []
    for row in results:
        if row["rays"] == "soft_lamp":
            continue
        of_dag = rows.setdefault((row["scene"], row["resolution"], row["layout"]), {})
        first = of_dag.setdefault(row["rays"], {**row, "rates": {}})
        if row["rival"]:
            first["rates"][row["rival"]] = row["rival_mrays_per_s"]
            rivals += [row["rival"]] if row["rival"] not in rivals else []
    return [list(of_dag.values()) for of_dag in rows.values()], rivals


def trace_table(results):
    text = ""
    tables, rivals = _trace_rows(results)
    has_device = any(row["device"] == "cuda" for rows in tables for row in rows)
    for rows in tables:
        first = rows[0]
        text += "\n" if text else ""
        text += (f"{first['scene']} {_grid(first['resolution'])}, layout {first['layout']}, "
                 f"{human_bytes(first['layout_bytes'])}{', on the CPU' if has_device and first['device'] == 'cpu' else ''}\n")
        text += f"  {'rays':<14}{'count':>12}{'hit':>8}{'cells/ray':>11}{'bytes/ray':>11}{'Mrays/s':>10}"
        text += "".join(f"{rival:>24}" for rival in rivals) + "\n"
        for row in rows:
            rate = row["mrays_per_s"]
            text += (f"  {row['rays']:<14}{with_commas(row['ray_count']):>12}{row['hit_part']:>8.2f}"
                     f"{row['cells_per_ray']:>11.1f}{row['bytes_per_ray']:>11.0f}{rate:>10.2f}")
            for rival in rivals:
                theirs = row["rates"].get(rival)
                text += f"{'-':>24}" if theirs is None else f"{theirs:>15.2f} ({rate / theirs:>5.2f}x)"
            text += "\n"
    text += _trace_means(tables, rivals)
    lamps = [row for row in results if row["rays"] == "soft_lamp"]
    if lamps:
        text += ("\n  soft shadows of a lamp; its radius in parts of its distance\n"
                 f"  {'radius':<14}{'rays':>12}{'Mrays/s with beams':>20}{'without beams':>20}\n")
    for row in lamps:
        text += (f"  {row['light_size']:<14g}{with_commas(row['ray_count']):>12}{row['mrays_per_s']:>20.2f}"
                 f"{row['rival_mrays_per_s']:>20.2f}\n")
    return text


def _trace_means(tables, rivals):
    """Returns, by grid, layout and kind of rays, the geometric mean over the scenes of voxdag's rate / the rival's, and the worst."""
    ratios = {}
    for row in (row for rows in tables for row in rows):
        for rival, theirs in row["rates"].items():
            for rays in (row["rays"], "all")[:1 if row["rays"] == "primary_beams" else 2]:  # rivals have no beams
                of_rival = ratios.setdefault((_grid(row["resolution"]), row["layout"]), {}).setdefault(rays, {})
                of_rival.setdefault(rival, []).append((row["mrays_per_s"] / theirs, row["scene"]))
    text = ""
    for (grid, layout), kinds in ratios.items():
        if max(len(found) for found in next(iter(kinds.values())).values()) < 2:
            continue
        text += f"\nvoxdag / rival at {grid}, layout {layout}: geometric mean (worst, scene)\n"
        text += f"  {'rays':<14}" + "".join(f"{rival:>40}" for rival in rivals) + "\n"
        for rays in sorted(kinds, key=lambda rays: rays == "all"):
            text += f"  {rays:<14}"
            for rival in rivals:
                found = kinds[rays].get(rival)
                mean = found and math.exp(sum(math.log(ratio) for ratio, _ in found) / len(found))
                text += f"{f'{mean:.2f} ({min(found)[0]:.2f}, {min(found)[1]})' if found else '-':>40}"
            text += "\n"
    return text


def trace_chart(results):
    """Returns bars of rays per second by class, a panel per scene, resolution and layout."""
    tables, rivals = _trace_rows(results)
    return [panel(f"{rows[0]['scene']} {_grid(rows[0]['resolution'])}, layout {rows[0]['layout']}", axis(""),
                  axis("million rays per second"),
                  [line("voxdag", [], [row["mrays_per_s"] for row in rows])] +
                  [line(rival, [], [number(row["rates"].get(rival)) for row in rows], color)
                   for color, rival in enumerate(rivals, 1)], [row["rays"] for row in rows]) for rows in tables]


# Compact forms. The SVO cannot be walked at random.

FORM_TITLES = {"svo": "SVO", "svdag": "SVDAG", "ssvdag": "SSVDAG", "tsvdag": "TSVDAG", "voxdag": "voxdag"}


def compact_table(results):
    width = max([14] + [len(run["scene"]) for run in results["runs"]])

    def cells(scene, grid, voxels, form, size, part, bits, seconds):
        return f"{scene:<{width}} {grid:>9} {voxels:>17}  {form:<8} {size:>15} {part:>9} {bits:>11} {seconds:>9}\n"
    text = cells("scene", "grid", "voxels", "form", "bytes", "of SVDAG", "bits/voxel", "seconds")
    for run in results["runs"]:
        if "failure" in run:
            grid = with_commas(run["resolution"]) if run["resolution"] > 1 else ""
            text += f"{run['scene']:<{width}} {grid:>9}  failed: {run['failure']}\n"
            continue
        start = run["scene"], with_commas(run["resolution"]), with_commas(run["voxels"])
        for key, form in run["forms"].items():
            text += cells(*start, FORM_TITLES[key], with_commas(form["bytes"]), f"{form['of_svdag']:.3f}",
                          f"{form['bits_per_voxel']:.4f}", f"{form['seconds']:.2f}")
            start = "", "", ""
    means = results["geometric_means"]
    if not means or next(iter(means.values()))["runs"] < 2:
        return text
    start = "geometric mean", "", f"of {next(iter(means.values()))['runs']} rows"
    for key, mean in means.items():
        text += ("\n" if start[0] else "") + cells(*start, FORM_TITLES[key], "", f"{mean['of_svdag']:.3f}",
                                                   f"{mean['bits_per_voxel']:.4f}", "")
        start = "", "", ""
    return text


def compact_chart(results):
    """Returns bars of bits per voxel for the forms that rays can walk, a panel for each resolution."""
    runs = sorted((run for run in results["runs"] if "failure" not in run), key=lambda run: run["resolution"])
    panels = []
    for resolution, group in groupby(runs, lambda run: run["resolution"]):
        group = list(group)
        lines = [line(FORM_TITLES[key], [], [run["forms"][key]["bits_per_voxel"] for run in group], list(FORM_TITLES).index(key))
                 for key in group[0]["forms"] if key != "svo"]
        if lines:
            panels.append(panel(_grid(resolution), axis(""), axis("bits per voxel"), lines,
                                [os.path.splitext(run["scene"])[0] for run in group]))
    return panels


# Rays at the compact form.

CLASSES = {"primary": "primary", "shadow": "shadow", "ao": "occlusion"}


def compact_rays_table(results):
    text = (f"{results['scene']}, {_grid(1 << results['levels'])}: {human_bytes(results['plain_bytes'])} in the plain form, "
            f"{with_commas(results['dag_nodes'])} nodes\n\n"
            "Million rays/s, and the time as a ratio to single rays at the plain form in the same turns:\n\n"
            f"  {'':<14}{'size':>10}{'part':>8}{'encode s':>10}{'decode s':>10}{'open s':>8}"
            f"{'primary':>16}{'shadow':>16}{'occlusion':>16}\n")
    points = results["compact"]
    if not points:
        return text

    def row(name, left, point, seconds):
        cells = [f"{results['rays'][kind] / point[kind][seconds] / 1e6:.2f} "
                 f"({point[kind][seconds] / point[kind]['plain_seconds']:.2f})" for kind in CLASSES]
        return f"  {name:<14}{left:<46}" + "".join(f"{cell:>16}" for cell in cells) + "\n"
    fastest = {kind: {key: min(point[kind][key] for point in points) for key in ("plain_seconds", "plain_packet_seconds")}
               for kind in CLASSES}
    text += row("plain", f"{human_bytes(results['plain_bytes']):>10}{1:>8.3f}", fastest, "plain_seconds")
    text += row("  in packets", "", fastest, "plain_packet_seconds")
    for point in points:
        text += row(f"{point['tables']} tables",
                    f"{human_bytes(point['bytes']):>10}{point['part_of_plain']:>8.3f}{point['encode_seconds']:>10.2f}"
                    f"{point['decode_seconds']:>10.2f}{point['open_seconds']:>8.2f}", point, "seconds")
        text += row("  in packets", "", point, "packet_seconds")
    last = points[-1]
    text += (f"\n  rays at the compact form also need {human_bytes(last['open_bytes'])}, and "
             f"{human_bytes(results['cache_bytes_per_thread'])} of cache per thread\n"
             "  units decoded per ray, single and in packets:" + ";".join(
                 f" {last[kind]['decoded_per_ray']:.3f} {last[kind]['packet_decoded_per_ray']:.3f}" for kind in CLASSES) +
             "\n\nBytes, cache lines and symbols per ray that starts with empty caches:\n\n"
             f"  {'':<14}{'primary':>27}{'shadow':>27}{'occlusion':>27}\n")
    reads = [("plain", results["plain_reads_per_ray"])]
    reads += [(f"{point['tables']} tables", {kind: point[kind]["reads_per_ray"] for kind in CLASSES}) for point in points]
    for name, of_kind in reads:
        text += f"  {name:<14}" + "".join(f"{of_kind[kind]['bytes']:>10.0f}{of_kind[kind]['lines']:>8.1f}"
                                          f"{of_kind[kind]['symbols']:>9.0f}" for kind in CLASSES) + "\n"
    return text


def compact_rays_chart(results):
    """Returns the time of each class of rays over the bytes, as ratios to single rays at the plain form and to its bytes."""
    points = results["compact"]
    return [panel(f"{results['scene']}, {1 << results['levels']}³: {name}", axis("bytes, as part of the plain form"),
                  axis("time / time of single rays at the plain form"),
                  [line(title, [point["part_of_plain"] for point in points], [point[kind][key] for point in points], color,
                        markers=True) for color, (kind, title) in enumerate(CLASSES.items())])
            for name, key in (("single rays", "time_ratio"), ("packets", "packet_time_ratio"))]


# Colours.

CODEC_TITLES = {"voxdag": "voxdag", "dolonius": "Dolonius 2017", "esvo": "ESVO blocks"}


def attributes_table(results):
    text = ""
    for run in results["runs"]:
        text += ("\n" if text else "") + run["scene"] + (f" {_grid(run['resolution'])}" if run["resolution"] > 1 else "")
        if "failure" in run:
            text += f" failed: {run['failure']}\n"
            continue
        text += (f": {with_commas(run['voxels'])} voxels, {with_commas(run['cells'])} cells, numbers "
                 f"{8 * run['index_bytes'] / run['voxels']:.3f} bits/voxel, filtered in {run['filter_seconds']:.2f} s "
                 f"({human_count(run['filter_cells_per_second'])} cells/s)\n")
        text += "  {:<13} {:>6} {:>15} {:>13} {:>11} {:>10} {:>9} {:>8} {:>8} {:>9} {:>10}\n".format(
            "colours", "bound", "bytes", "wire bytes", "bits/voxel", "bits/cell", "PSNR", "MS-SSIM", "worst", "seconds",
            "cells/s")
        for colors in run["results"]:
            bound = "" if colors["bound"] is None else f"{colors['bound']:g}"
            psnr = float("inf") if colors["psnr_db"] is None else colors["psnr_db"]
            text += (f"  {CODEC_TITLES[colors['codec']]:<13} {bound:>6} {with_commas(colors['bytes']):>15} "
                     f"{with_commas(colors['wire_bytes']) if colors['wire_bytes'] else '':>13} "
                     f"{colors['bits_per_voxel']:>11.3f} {colors['bits_per_cell']:>10.3f} {psnr:>6.2f} dB "
                     f"{colors['mean_ms_ssim']:>8.4f} {min(colors['ms_ssim']):>8.4f} {colors['seconds']:>9.2f} "
                     f"{human_count(colors['cells_per_second']):>10}\n")
    return text


def attributes_chart(results):
    """Returns MS-SSIM against bits per voxel, a panel for each scene and resolution."""
    panels = []
    for run in results["runs"]:
        lines = []
        for color, (codec, title) in enumerate(CODEC_TITLES.items()):
            rows = [colors for colors in run.get("results", []) if colors["codec"] == codec]
            if rows:
                lines.append(line(title, [colors["bits_per_voxel"] for colors in rows],
                                  [colors["mean_ms_ssim"] for colors in rows], color, markers=True))
        if lines:
            panels.append(panel(f"{run['scene']} {_grid(run['resolution'])}", axis("bits per voxel"),
                                axis("mean MS-SSIM", from_zero=False), lines))
    return panels


SHOWN = {"trace": (trace_table, trace_chart), "compact": (compact_table, compact_chart),
         "compact-rays": (compact_rays_table, compact_rays_chart), "attributes": (attributes_table, attributes_chart)}


def run(arguments, _program):
    if arguments == ["plots"]:
        if not is_installed():
            raise Error(NO_MATPLOTLIB)
        return
    name, file, *plots = arguments
    with open(file, encoding="utf-8") as stream:
        results = json.load(stream)
    table, chart = SHOWN[name]
    for plot in plots:
        panels = chart(results)
        if not panels:
            raise Error("there is nothing to plot")
        draw_charts([{"file": plot, "panels": panels}], ".")
    print(table(results), end="")
