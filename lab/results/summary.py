#!/usr/bin/env python3
"""Prints the table of the README, from the JSON files beside this script."""

import json
import math
import pathlib

HERE = pathlib.Path(__file__).resolve().parent


def load(path):
    return json.loads((HERE / path).read_text(encoding="utf-8"))


def row(name, ratios):
    """Returns a row of the table. `ratios` maps a case to rival / voxdag: above 1, voxdag is better."""
    mean = math.exp(sum(map(math.log, ratios.values())) / len(ratios))
    best = max(ratios, key=ratios.get)
    worst = min(ratios, key=ratios.get)
    return "| {} | {} | {} ({}) | {} ({}) |".format(
        name, factor(mean), factor(ratios[best]), best, factor(ratios[worst]), worst)


def factor(ratio):
    """Returns three digits for small ratios and whole numbers for large ones, such as "0.52 ×"."""
    return f"{ratio:.0f} ×" if ratio >= 10 else f"{ratio:.1f} ×" if ratio >= 2 else f"{ratio:.2f} ×"


def builds(measure):
    """Returns rival / voxdag by rival and grid for Crytek Sponza: `measure` of rivals.json."""
    runs = load("epyc-2-cores/rivals.json")
    ours = {run["resolution"]: run[measure] for run in runs["builds"]}
    ratios = {}
    for run in runs["rivals"]:
        size = run["resolution"]
        ratios.setdefault(run["name"], {})[f"{size}³"] = run[measure] / ours[size]
    return ratios


def rays(rival, kind):
    """Returns voxdag's rate / the rival's by scene, at 4096³."""
    return {run["scene"].replace("crytek_", "").replace("_core", ""): run["ratio"]
            for run in load("xeon-2-cores/rays_4k.json")
            if run["rival"] == rival and run["rays"] == kind}


def compact(form):
    """Returns the bytes of a form / those of voxdag's compact form, by scene and grid."""
    return {f"{run['scene'].split('.')[0]}, {run['resolution']}³":
            run["forms"][form]["bytes"] / run["forms"]["voxdag"]["bytes"]
            for run in load("epyc-2-cores/compact-8192.json")["runs"]}


def main():
    print("| voxdag is better by this factor | geometric mean | best case | worst case |")
    print("|---|--:|--:|--:|")
    names = {"OpenVDB": "OpenVDB", "ooc_svo_builder": "out-of-core SVO builder",
             "SVDAG-Compression": "SVDAG-Compression"}
    for measure, label in (("wall_seconds", "time"), ("peak_memory_bytes", "peak memory")):
        for name, ratios in builds(measure).items():
            print(row(f"build, {label}: {names[name]}", ratios))
    for form, label in (("svdag", "the DAG of the paper"), ("ssvdag", "SSVDAG")):
        print(row(f"bytes of the compact form: {label}", compact(form)))
    for rival, label in (("embree_single", "Embree's single rays"),
                         ("embree_packet16", "Embree's packets of 16")):
        for kind, rays_name in (("primary", "primary"), ("ao", "occlusion")):
            print(row(f"{rays_name} rays per second: {label}", rays(rival, kind)))


if __name__ == "__main__":
    main()
