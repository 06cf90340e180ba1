#!/usr/bin/env python3
"""Writes the pages of docs/ that are generated.

    docs/generate.py cli VOXDAG    cli.md and cli/: from the help texts of the program VOXDAG
    docs/generate.py api           the list of headers in api.md: from cmake/public_headers.txt
    docs/generate.py house         images/house.svg, the picture in design.md: from src/voxdag/rooms.txt
    docs/generate.py man VOXDAG    the man page, on standard output: from the help texts of the program VOXDAG

With --check it writes nothing, and fails if a page differs from what it would write.
"""

import argparse
import difflib
import os
import pathlib
import re
import subprocess
import sys
import textwrap

DOCS = pathlib.Path(__file__).resolve().parent
WIDTH = 125

# Headings of `voxdag --help`, and how their pages begin. The first word of a heading names its page.
PAGES = {
    "Build": """After reading this page you can make meshes, DAGs and ESVOs, and convert DAGs from one form to another.""",
    "Edit": """After reading this page you can combine, carve, paint, move, grow, fill and clean DAGs.

All of these commands read both forms of a DAG, and write that of the first input unless `--compact` or `--plain` names one.
The result is the file that a build of these voxels would make, except for the metadata: `build.edits` of `voxdag info --json`
tells how the voxels were made. `diff` compares voxels only. The other commands keep colours,
normals and material ids ([algebra.md](../algebra.md#colours-normals-and-materials)). A command that needs more than `--memory` is
refused and writes nothing.
[algebra.md](../algebra.md) tells how the commands work and what they cost.""",
    "Inspect": """After reading this page you can tell what a file contains, check it, and export its voxels.""",
    "Render and view": """After reading this page you can render pictures and films, and show a DAG in the browser.""",
    "Trace and query": """After reading this page you can cast rays at a file, and ask questions about the voxels of a DAG.
[arrays.md](../arrays.md) has the types and shapes of the arrays, and [json.md](../json.md) has the keys of `--json`.""",
    "Benchmark": """After reading this page you can list the benchmarks. `voxdag bench NAME --help` prints the options of one.
[lab/README.md](../../lab/README.md) says how to measure with them, and what their tables and JSON mean.""",
    "Shell": """After reading this page you can complete command lines of voxdag with the Tab key.""",
}

# Pages that say more about a command.
MORE = {
    "scene": ["scenes.md"],
    "build": ["meshes.md", "attributes.md", "esvo.md", "solid.md", "compact.md", "cluster.md", "json.md#build", "security.md"],
    "import": ["import.md", "splats.md", "json.md#import"],
    "convert": ["compact.md", "attributes.md#coarser-grids"],
    "coarsen": ["attributes.md#coarser-grids"],
    "carve": ["splats.md"],
    "combine": ["algebra.md"],
    "edit": ["editing.md"],
    "diff": ["json.md#diff"],
    "components": ["json.md#components"],
    "materials": ["import.md#labels", "viewer.md#materials-and-labels", "json.md#materials"],
    "info": ["json.md#info"],
    "verify": ["attributes.md#checks", "json.md#verify"],
    "export": ["export.md", "interop.md", "viewer.md#sending-a-scene", "arrays.md#voxels"],
    "render": ["rendering.md", "esvo.md#streaming", "json.md#camera-paths", "viewer.md#settings-and-pictures",
               "cluster.md#pictures-and-benchmarks"],
    "view": ["viewer.md", "security.md#the-server-of-voxdag-view"],
    "trace": ["arrays.md#rays-and-hits", "compact.md#what-it-costs", "rendering.md#devices"],
    "query": ["contacts.md", "arrays.md#answers", "json.md#query"],
}


class Help:
    """The parts of a help text: `sections` maps a heading to rows of name and meaning."""

    def __init__(self, program, words):
        command = [program, *words, "--help"]
        run = subprocess.run(command, capture_output=True, text=True, check=False)
        if run.returncode != 0:
            raise RuntimeError(f"{' '.join(command)}: {run.stderr.strip()}")
        lines = run.stdout.rstrip("\n").split("\n")
        self.purpose = lines[0].rstrip(".")
        self.sections = {}
        self.examples = []
        self.notes = []
        i = 1
        while i < len(lines):
            line = lines[i]
            if re.match(r"\S.*:$", line) and i + 1 < len(lines) and lines[i + 1].startswith("  ") and line != "Example:":
                rows = self.sections.setdefault(line[:-1], [])
                i += 1
                while i < len(lines) and lines[i].startswith("  "):
                    add_row(rows, lines[i])
                    i += 1
            elif line == "Example:":
                i += 1
                while i < len(lines) and lines[i].startswith("  "):
                    self.examples.append(lines[i].strip())
                    i += 1
            elif line and not line.startswith("Usage:"):
                paragraph = []
                while i < len(lines) and lines[i]:
                    paragraph.append(lines[i])
                    i += 1
                self.notes.append(" ".join(paragraph))
            else:
                i += 1

    def options(self):
        """Yields the sections that list arguments and options."""
        for heading, rows in self.sections.items():
            rows = [(name, meaning) for name, meaning in rows if name != "-h,--help"]
            if rows and (heading == "Positionals" or heading.startswith("Options")):
                yield heading, rows

    def commands(self):
        """Yields the sections that list subcommands."""
        for heading, rows in self.sections.items():
            if heading != "Positionals" and not heading.startswith("Options"):
                yield heading, rows


def add_row(rows, line):
    """Adds a line of a help text to the rows that it continues or begins."""
    column = 30
    if line.startswith(" " * column):
        name, meaning = rows.pop()
        rows.append((name, f"{meaning} {line.strip()}".strip()))
    elif line[column - 2:column] == "  ":
        rows.append((line[:column].strip(), line[column:]))
    else:
        rows.append((line.strip(), ""))


def wrapped(text):
    return textwrap.fill(text, WIDTH, break_long_words=False, break_on_hyphens=False)


def marked(text):
    """Returns the text with options in backquotes."""
    parts = text.split("`")
    parts[::2] = [re.sub(r"(?<![\w-])(--[a-z][a-z-]*|-[roq]\b)", r"`\1`", part) for part in parts[::2]]
    return "`".join(parts)


def table(head, rows):
    lines = [f"| {head} | meaning |", "|---|---|"]
    for name, meaning in rows:
        # The help of an argument shows its name in the program, too.
        name = name.split(" ", 1)[-1] if head == "argument" else name.replace(",-", ", -")
        name, meaning = name.replace("|", "\\|"), marked(meaning).replace("|", "\\|")
        lines.append(f"| `{name}` | {meaning} |")
    return "\n".join(lines)


def link(page):
    file, _, heading = page.partition("#")
    return f"[{heading.replace('-', ' ') + ' in ' if heading else ''}{file}](../{page})"


def command_text(program, words, level):
    """Returns the section of a command, and the sections of its subcommands."""
    text = Help(program, words)
    parts = ["#" * level + " " + " ".join(words), wrapped(marked(text.purpose) + ".")]
    if text.examples:
        parts.append("```\n" + "\n".join(text.examples) + "\n```")
    parts += [wrapped(marked(note)) for note in text.notes]
    for heading, rows in text.options():
        if heading not in ("Positionals", "Options"):
            parts.append(heading + ":")
        parts.append(table("argument" if heading == "Positionals" else "option", rows))
    if words[-1] in MORE and len(words) == 1:
        parts.append(wrapped("More: " + ", ".join(map(link, MORE[words[-1]])) + "."))
    for _, rows in text.commands():
        if words == ["bench"]:  # Their own --help describes the benchmarks.
            parts.append(table("benchmark", rows))
        else:
            parts += [command_text(program, [*words, name], level + 1) for name, _ in rows]
    return "\n\n".join(parts)


def page_name(heading):
    return heading.split()[0].lower() + ".md"


def note(source):
    return f"<!-- docs/generate.py writes this page from {source}. -->"


def cli_pages(program):
    """Returns the text of each page of the command line by its name."""
    root = Help(program, [])
    pages = {}
    index = ["# The command line", note("the help texts"),
             "After reading this page you know all commands of `voxdag`, and where each of them is described. "
             "[scripting.md](scripting.md) has the rules that all of them share: exit status, errors and output files."]
    for heading, rows in root.commands():
        page = page_name(heading)
        index.append(f"## {heading}")
        index.append("\n".join(["| command | purpose |", "|---|---|"] + [
            f"| [`{name}`](cli/{page}#{name}) | {marked(purpose)} |" for name, purpose in rows]))
        try:
            commands = [command_text(program, [name], 2) for name, _ in rows]
        except RuntimeError as error:  # a program that was not built
            print(f"skipped: {page}: {error}")
            continue
        pages["cli/" + page] = "\n\n".join([f"# {heading}", note("the help texts"), PAGES[heading], *commands]) + "\n"
    index.append("## Without a command")
    index.append(table("option", [row for _, rows in root.options() for row in rows]))
    index += [wrapped(text) for text in root.notes]
    index.append("[json.md](json.md) has the keys of `--json`, [arrays.md](arrays.md) has the NumPy arrays that commands "
                 "read and write.")
    index[2] = wrapped(index[2])
    pages["cli.md"] = "\n\n".join(index[:-1] + [wrapped(index[-1])]) + "\n"
    return pages


def roff(text):
    """Returns the text for a man page."""
    text = text.replace("\\", "\\e").replace("-", "\\-").replace("`", "")
    return "\\&" + text if text.startswith((".", "'")) else text


def man_section(program, words, heading):
    """Returns the part of the man page about a command and its subcommands."""
    text = Help(program, words)
    lines = [f".{heading} {' '.join(words)}", roff(text.purpose + ".")]
    for note_text in text.notes:
        lines += [".PP", roff(note_text)]
    if text.examples:
        lines += [".PP", ".nf", ".RS", *map(roff, text.examples), ".RE", ".fi"]
    for _, rows in text.options():
        for name, meaning in rows:
            lines += [".TP", f".B {roff(name)}", roff(meaning)]
    for _, rows in text.commands():
        if words != ["bench"]:
            lines += [line for name, _ in rows for line in man_section(program, [*words, name], heading)]
    return lines


def man_page(program):
    """Returns the man page, in roff."""
    root = Help(program, [])
    version = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout.split("\n")[0]
    lines = [f'.TH VOXDAG 1 "" "{version}" "User Commands"', ".SH NAME", f"voxdag \\- {roff(root.purpose)}",
             ".SH SYNOPSIS", ".B voxdag", "COMMAND [ARGUMENT...]", ".SH COMMANDS"]
    for _, rows in root.commands():
        for name, _ in rows:
            if name != "bench":  # Another program has the benchmarks.
                lines += man_section(program, [name], "SS")
    lines += [".SH NOTES", *(line for text in root.notes for line in (roff(text), ".PP"))]
    return "\n".join(lines) + "\n"


MARK = "<!-- docs/generate.py writes the list below from cmake/public_headers.txt. -->\n"


def summary(header):
    """Returns the first sentence of the comment that a header begins with."""
    words = []
    for line in header.read_text(encoding="utf-8").splitlines():
        if line.startswith("///"):
            words.append(line[3:].strip())
        elif words:
            break
    sentence = re.match(r"(.*?)(\.(?= |$)|$)", " ".join(words).strip()).group(1)
    return sentence.rstrip(".:").replace("|", "\\|")


def follow_moved(text, public):
    """Returns the text with the new paths of headers that have moved, where the name tells which one it is."""
    def moved(match):
        same_end = [header for header in public if header.endswith("/" + match[1])]
        same_name = [header for header in public if header.split("/")[-1] == match[1].split("/")[-1]]
        candidates = same_end or same_name
        return f"`{candidates[0]}`" if match[1] not in public and len(candidates) == 1 else match[0]

    return re.sub(r"`([a-z_/]+\.hpp)`", moved, text)


def check_start(text, public, source):
    """Exits unless the headers that the page says to start with are public and declare the names beside them."""
    for names, headers in re.findall(r"^\| [^|]* \| (`[^|]*) \| ([^|]*\.hpp[^|]*) \|$", text, re.MULTILINE):
        paths = re.findall(r"`([^`]*)`", headers)
        for path in paths:
            if path not in public:
                sys.exit(f"docs/api.md: {path} is not a public header")
        declared = "".join((source / path).read_text(encoding="utf-8") for path in paths)
        for name in re.findall(r"`(\w+)`", names):
            if not re.search(rf"\b{name}\b", declared):
                sys.exit(f"docs/api.md: {headers} has no {name}")


def api_page():
    source = DOCS.parent / "src/voxdag"
    rooms = {}
    for line in (DOCS.parent / "cmake/public_headers.txt").read_text(encoding="utf-8").splitlines():
        if line and not line.startswith("#"):
            rooms.setdefault(line.split("/")[0], []).append(line)
    text = (DOCS / "api.md").read_text(encoding="utf-8").split(MARK)[0] + MARK
    text = follow_moved(text, [header for headers in rooms.values() for header in headers])
    check_start(text, [header for headers in rooms.values() for header in headers], source)
    for room, headers in rooms.items():
        text += f"\n### {room}\n\n| header | content |\n|---|---|\n"
        for header in sorted(headers):
            text += f"| `{header}` | {summary(source / header)} |\n"
    return {"api.md": text}


def house_picture():
    """Draws the rooms of the library: each stands above the rooms that it may include, to which lines lead."""
    uses = {}
    for line in (DOCS.parent / "src/voxdag/rooms.txt").read_text(encoding="utf-8").splitlines():
        if line and not line.startswith("#"):
            room, others = line.split("|")[0].split(":")
            uses[room] = others.split()
    floor = {}
    for room, others in uses.items():  # A room stands below all rooms that it uses.
        floor[room] = 1 + max((floor[other] for other in others), default=-1)
    width, height, box = 760, 90, (108, 40)
    top = max(floor.values())
    place = {}
    for level in range(top + 1):
        rooms = [room for room in uses if floor[room] == level]
        for i, room in enumerate(rooms):
            # Every second floor is shifted, so that lines pass between rooms.
            shift = 0.5 if len(rooms) == 1 and 0 < level < top else (i + 0.5) / len(rooms)
            place[room] = (width * (shift + (0.06 if level % 2 else -0.03)), 40 + (top - level) * height)
    lines, boxes = [], []
    for room, others in uses.items():
        x, y = place[room]
        # A line to a room that another of its rooms also uses would say nothing new.
        seen = {far for other in others for far in uses[other]}
        for other in others:
            if other not in seen:
                lines.append(f'<line x1="{x:.0f}" y1="{y + box[1] / 2:.0f}" x2="{place[other][0]:.0f}" y2="{place[other][1] - box[1] / 2:.0f}"/>')
        boxes.append(f'<rect x="{x - box[0] / 2:.0f}" y="{y - box[1] / 2:.0f}" width="{box[0]}" height="{box[1]}" rx="8"/>'
                     f'<text x="{x:.0f}" y="{y + 5:.0f}">{room}</text>')
    style = ("rect{fill:#e8eef7;stroke:#4a6a9a}text{font:15px sans-serif;text-anchor:middle;fill:#1b2a41}"
             "line{stroke:#8a9bb5;stroke-width:1.5}.paper{fill:#fff;stroke:none}")
    total = 40 + top * height + 40
    return {"images/house.svg": "\n".join([
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="-30 0 {width + 80} {total}" width="{width + 80}" height="{total}">',
        f"<style>{style}</style>", f'<rect class="paper" x="-30" width="{width + 80}" height="{total}"/>', *lines, *boxes, "</svg>", ""])}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("cli", "api", "house", "man"))
    parser.add_argument("program", nargs="?", help="the program whose help texts are read")
    parser.add_argument("--check", action="store_true", help="write nothing; fail if a page differs")
    arguments = parser.parse_args()
    if arguments.what in ("cli", "man") and not arguments.program:
        parser.error(f"{arguments.what} needs the program")
    if arguments.what == "man":
        sys.stdout.write(man_page(os.path.abspath(arguments.program)))
        return
    if arguments.what == "cli":
        pages = cli_pages(os.path.abspath(arguments.program))
    elif arguments.what == "api":
        pages = api_page()
    else:
        pages = house_picture()
    differing = 0
    for name, text in sorted(pages.items()):
        path = DOCS / name
        old = path.read_text(encoding="utf-8") if path.exists() else ""
        if old == text:
            continue
        differing += 1
        if arguments.check:
            sys.stdout.writelines(difflib.unified_diff(old.splitlines(True), text.splitlines(True), f"docs/{name}", "generated"))
        else:
            path.parent.mkdir(exist_ok=True)
            path.write_text(text, encoding="utf-8")
            print(f"written: docs/{name}")
    if arguments.check and differing:
        sys.exit(f"{differing} pages differ: run docs/generate.py {arguments.what}")


if __name__ == "__main__":
    main()
