#!/usr/bin/env python3
"""Measures `voxdag build` in parts beside a plain build of the same mesh, and what ranks exchange.

  parts.py VOXDAG MESH -r N [--ranks 1,2,4,8] [--memory LIMIT] [--no-plain] [--work DIR] [-o OUT]

Writes OUT.json and OUT.txt (default: parts). Compares the bytes of all outputs. With more ranks
than processors, times say little: read the bytes and the numbers of parts instead. As root, set
OMPI_ALLOW_RUN_AS_ROOT=1 and OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1.
"""
import argparse
import hashlib
import json
import os
import platform
import shutil
import subprocess
import sys
import tempfile


def run(command, memory):
    """Runs a build with --json and returns its report."""
    if memory:
        command = [*command, "--memory", memory]
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}\nended with {done.returncode}")
    return json.loads(done.stdout)


def digest(path):
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def log_of(folder):
    """Returns the lines of a job's log."""
    lines = []
    for name in os.listdir(os.path.join(folder, "log")):
        with open(os.path.join(folder, "log", name), encoding="utf-8") as file:
            lines += [json.loads(line) for line in file]
    return lines


def machine():
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        model = next((line.split(":")[1].strip() for line in file if line.startswith("model name")),
                     platform.machine())
    return {"cpu": model, "processors": os.cpu_count()}


def row(name, seconds, steps, memory, sent):
    cells = [f"{seconds[step]:11.1f}" if step in seconds else " " * 11 for step in steps]
    return f"{name:<10}{seconds['total']:9.1f}{''.join(cells)}{memory / 2**20:10.0f}{sent / 1e6:10.1f}"


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("voxdag")
    parser.add_argument("mesh")
    parser.add_argument("-r", "--resolution", required=True)
    parser.add_argument("--ranks", default="1,2,4,8")
    parser.add_argument("--memory", help="limit of each rank")
    parser.add_argument("--parts", help="least number of parts (default: that of voxdag)")
    parser.add_argument("--no-plain", action="store_true", help="leave the plain build out")
    parser.add_argument("--work", help="folder for the work (default: a temporary one)")
    parser.add_argument("-o", "--output", default="parts")
    arguments = parser.parse_args()

    folder = tempfile.mkdtemp(prefix="voxdag-parts-", dir=arguments.work)
    build = [arguments.voxdag, "build", arguments.mesh, "-r", arguments.resolution, "--json", "-q",
             "--allow-outside"]
    steps = ["triangles", "parts", "merge", "number", "write"]
    result = {"machine": machine(), "mesh": os.path.basename(arguments.mesh),
              "mesh_bytes": os.path.getsize(arguments.mesh), "resolution": arguments.resolution,
              "memory_per_rank": arguments.memory, "runs": []}
    text = [f"{result['mesh']} at {arguments.resolution}, {result['mesh_bytes'] / 1e6:.0f} MB; "
            f"{result['machine']['cpu']}, {result['machine']['processors']} processors; memory per rank: "
            f"{arguments.memory or 'default'}", "",
            f"{'':<10}{'seconds':>9}" + "".join(f"{step:>11}" for step in steps) +
            f"{'MiB/rank':>10}{'MB sent':>10}"]
    digests = set()
    if not arguments.no_plain:
        output = os.path.join(folder, "plain.vdag")
        report = run([*build, "-o", output], None)
        digests.add(digest(output))
        os.remove(output)
        result["runs"].append({"ranks": 0, "report": report})
        text.append(row("plain", {"total": report["seconds"]["total"]}, steps, report["peak_memory_bytes"], 0))
    for ranks in [int(count) for count in arguments.ranks.split(",")]:
        work, output = os.path.join(folder, "work"), os.path.join(folder, "parts.vdag")
        command = [*build, "--work", work, "-o", output]
        if arguments.parts:
            command += ["--parts", arguments.parts]
        if ranks > 1:
            command = ["mpirun", "--oversubscribe", "--bind-to", "none", "-n", str(ranks), *command]
        report = run(command, arguments.memory)
        digests.add(digest(output))
        log = log_of(work)
        shutil.rmtree(work)
        os.remove(output)
        result["runs"].append({"ranks": ranks, "report": report, "log": log})
        text.append(row(f"{ranks} rank(s)", report["seconds"], steps, report["peak_memory_bytes"],
                        sum(report["bytes_sent"].values())) +
                    f"   {report['parts']} parts, {report['mailboxes']} mailboxes")
    shutil.rmtree(folder)
    in_parts = [run for run in result["runs"] if run["ranks"] > 0]
    for title, key, unit in (("processor seconds of all ranks", "cpu_seconds", 1), ("MB sent", "bytes_sent", 1e6)):
        text += ["", f"{title:<30}" + "".join(f"{step:>11}" for step in steps)]
        for of_ranks in in_parts:
            values = of_ranks["report"][key]
            text.append(f"{of_ranks['ranks']} rank(s)".ljust(30) +
                        "".join(f"{values[step] / unit:11.1f}" for step in steps))
    text += ["", f"The outputs are {'equal' if len(digests) == 1 else 'NOT EQUAL'}: "
             f"{result['runs'][0]['report']['voxels']:,} voxels, "
             f"{result['runs'][0]['report']['bytes']['svdag_paper'] / 2**20:.1f} MiB"]
    result["outputs_are_equal"] = len(digests) == 1
    with open(arguments.output + ".json", "w", encoding="utf-8") as file:
        json.dump(result, file, indent=1)
    with open(arguments.output + ".txt", "w", encoding="utf-8") as file:
        file.write("\n".join(text) + "\n")
    print("\n".join(text))
    sys.exit(0 if len(digests) == 1 else 1)


main()
