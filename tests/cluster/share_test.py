#!/usr/bin/env python3
"""Compares what ranks make together with what one process makes alone.

usage: share_test.py VOXDAG MPIRUN films|failures|papers
"""
import csv
import json
import os
import re
import subprocess
import sys
import tempfile

VOXDAG, MPIRUN, TEST = sys.argv[1:4]


def run(ranks, *arguments):
    """Runs voxdag, with ranks > 0 under mpirun. Returns the status, the output and voxdag's errors."""
    command = [VOXDAG, *map(str, arguments)]
    if ranks > 0:
        command = [MPIRUN, "-n", str(ranks), *command]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    return done.returncode, done.stdout, [line for line in done.stderr.split("\n") if line.startswith("voxdag:")]


def succeed(ranks, *arguments):
    """Runs voxdag, which must succeed, and returns its output."""
    status, out, errors = run(ranks, *arguments)
    assert status == 0, f"{ranks} ranks, {arguments}: status {status}: {out} {errors}"
    return out


def files_of(folder):
    """Returns the bytes of the files of a folder, by name."""
    contents = {}
    for name in sorted(os.listdir(folder)):
        if os.path.isfile(os.path.join(folder, name)):
            with open(os.path.join(folder, name), "rb") as file:
                contents[name] = file.read()
    return contents


def make_scene():
    succeed(0, "scene", "sponge", "--size", 2, "-o", "sponge.ply", "-q")
    succeed(0, "build", "sponge.ply", "-r", 128, "-o", "sponge.vdag", "-q")
    keys = [{"time": 0, "eye": [2, 1, 2], "target": [0.3, 0.3, 0.3], "fov": 50},
            {"time": 2, "eye": [2, 1.5, -2], "target": [0.3, 0.3, 0.3]}]
    with open("keys.json", "w") as file:
        json.dump({"keys": keys}, file)


def film_arguments(scene, folder, more=()):
    return ["render", scene, "--path", "keys.json", "--fps", 4, "--size", "48x32", "--ao", 4, "-o",
            f"{folder}/f_%02d.png", "--pass", f"depth={folder}/z_%d.exr", *more]


def films():
    """All frames of a film are those of one process, byte for byte."""
    make_scene()
    succeed(0, "build", "sponge.ply", "-r", 512, "--as", "esvo", "--no-contours", "-o", "sponge.esvo", "-q")
    for scene, more, all_ranks in (("sponge.vdag", [], (1, 2, 3)), ("sponge.vdag", ["--exposure", "0.5"], (2,)),
                                   ("sponge.esvo", ["--memory", "1M"], (3,))):
        def film(ranks):
            folder = tempfile.mkdtemp(dir=".")
            out = succeed(ranks, *film_arguments(scene, folder, [*more, "--timings", folder + ".csv"]))
            with open(folder + ".csv") as file:
                rows = list(csv.DictReader(file))
            return files_of(folder), [(row["frame"], row["time"], row["rays"]) for row in rows], out

        plain_frames, plain_rows, _ = film(0)
        assert len(plain_frames) == 18 and len(plain_rows) == 9
        assert plain_frames["f_00.png"] != plain_frames["f_08.png"]
        for ranks in all_ranks:
            frames, rows, out = film(ranks)
            assert list(frames) == list(plain_frames), f"{scene}, {ranks} ranks: {list(frames)}"
            for name in frames:
                assert frames[name] == plain_frames[name], f"{scene}, {ranks} ranks: {name} differs"
            assert [row[:2] for row in rows] == [row[:2] for row in plain_rows], f"{ranks} ranks: {rows}"
            if "--memory" not in more:  # whose rays depend on the blocks that are loaded
                assert rows == plain_rows, f"{ranks} ranks: {rows}"
            assert out.count("9 frames of 48 x 32 pixels") == 1, out


def failures():
    """A failure on any rank is one line and status 1, and leaves whole frames only."""
    make_scene()

    def expect(text, *arguments):
        for ranks in (1, 3):
            status, out, errors = run(ranks, *arguments)
            assert status == 1, f"{ranks} ranks, {arguments}: status {status}: {errors}"
            assert len(errors) == 1 and text in errors[0], f"{ranks} ranks, {arguments}: {errors}"
            assert out == "", out

    expect("absent", *film_arguments("sponge.vdag", "absent"))
    expect("none.vdag", *film_arguments("none.vdag", "."))
    expect("lone.json", "render", "sponge.vdag", "--path", "lone.json", "-o", "f_%02d.png")
    os.mkdir("plain")
    succeed(0, *film_arguments("sponge.vdag", "plain"))
    plain = files_of("plain")
    for frame in (1, 8):
        folder = f"late{frame}"
        os.makedirs(f"{folder}/f_{frame:02}.png")  # a folder stands where the frame belongs
        expect(f"f_{frame:02}.png", *film_arguments("sponge.vdag", folder))
        for name, content in files_of(folder).items():
            assert content == plain[name], f"{name} is not whole"
    expect("report", "bench", "papers", "--quick", "-q", "-o", "keys.json/report")


# Times, rates and memory, which depend on the load of the machine, and their ratios.
MEASURED = re.compile(r"second|per_s$|memory|^ratio$|^time$|load|^machine$|^ranks")


def without_measured(value):
    if isinstance(value, dict):
        return {key: without_measured(inner) for key, inner in value.items() if not MEASURED.search(key)}
    if isinstance(value, list):
        return [without_measured(inner) for inner in value]
    return value


def papers():
    """A report of two ranks is that of one, but for times."""
    arguments = ["bench", "papers", "--quick", "--only", "Hairball", "--table1", "32,64", "--table2", "32,64",
                 "--esvo-tables", "16,32", "--figure1", 64, "--flight-esvo", 32, "--flight-triangles", 64,
                 "--pictures", 32, "--esvo-pictures", 32, "--frames", 2, "--size", "40x32", "--cell-seconds", 600]
    reports = {}
    for ranks in (0, 2):
        out = succeed(ranks, *arguments, "-o", f"report{ranks}")
        with open(f"report{ranks}/report.json") as file:
            reports[ranks] = json.load(file)
        measured, kept = re.search(r": (\d+) measured.*?, (\d+) kept", out).groups()
        reports[ranks]["counts"] = measured, kept
        if ranks == 2:
            of_ranks = re.search(r"by 2 processes \((\d+) \+ (\d+)\)", out).groups()
            assert min(map(int, of_ranks)) > 0, out
            assert sum(map(int, of_ranks)) >= int(measured), out
    one, two = reports[0], reports[2]
    assert (one["ranks"], two["ranks"], two["ranks_on_a_machine"]) == (1, 2, 2)
    assert one["counts"] == two["counts"], f"{one['counts']} {two['counts']}"
    assert without_measured(one) == without_measured(two)
    assert one["svdag"]["flight"] and one["esvo"]["scenes"]
    files = [{name: content for name, content in files_of(f"report{ranks}").items()} for ranks in (0, 2)]
    assert list(files[0]) == list(files[1])
    pictures = [name for name in files[0] if name.endswith(".png")]
    assert len(pictures) > 3
    for name in pictures:
        assert files[0][name] == files[1][name], f"{name} differs"

    def lines(ranks):
        """Returns the text without tables and figures, and without the paragraphs about the machine."""
        text = files[ranks != 0]["report.md"].decode()
        text = re.sub(r"## The machine.*?\n#", "#", text, flags=re.S)
        return [re.sub(r"\d", "", line) for line in text.split("\n") if not line.startswith("|")]

    assert lines(0) == lines(2)
    assert "up to 2 on one machine" in files[1]["report.md"].decode()
    folders = {name for name in os.listdir("report2") if os.path.isdir(f"report2/{name}")}
    assert folders == {"cells"}, folders
    commands = []
    for ranks in (0, 2):
        cells = [json.loads(content) for content in files_of(f"report{ranks}/cells").values()]
        # One result may stand for several builds, whose files have different names.
        commands.append(sorted(re.sub(r"-o \S+\.vdag", "", cell["command"]) for cell in cells))
    assert commands[0] == commands[1]
    out = succeed(2, *arguments, "-o", "report2")
    assert ": 0 measured by 2 processes (0 + 0), " in out, out


with tempfile.TemporaryDirectory(prefix="voxdag-share-") as home:
    os.chdir(home)
    {"films": films, "failures": failures, "papers": papers}[TEST]()
    os.chdir("/")
print(f"{TEST}: passed")
