#!/usr/bin/env python3
"""Checks that the files and folders of the sources that the documentation names exist."""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Paths are those of the repository, of the library, of the programs or of the page that names them.
BASES = [ROOT / base for base in ("", "src/voxdag", "src", "apps", "apps/viewer", "apps/viewer/page", "apps/voxdag", "lab", "docs")]

FILE = r"`((?:[\w-]+/)+[\w.-]+\.(?:hpp|cpp|cu|py|sh|mjs|js|glsl|txt|cmake|md))`"
FOLDER = r"`((?:src/voxdag|apps|lab|cmake|docs|examples|python|scripts|tests)/[\w/-]*)`"
PLACEHOLDER = r"\b(NAME|FAMILY|PART)"


def main():
    pages = [ROOT / "README.md", ROOT / "HACKING.md", *(ROOT / "lab").glob("**/*.md"), *(ROOT / "docs").glob("**/*.md")]
    missing, found = [], 0
    for page in pages:
        text = page.read_text(encoding="utf-8")
        for path in re.findall(FILE, text) + re.findall(FOLDER, text):
            if re.search(PLACEHOLDER, path):
                continue
            if any((base / path).exists() for base in [*BASES, page.parent]):
                found += 1
            else:
                missing.append(f"{page.relative_to(ROOT)}: {path} does not exist")
    if missing or found < 100:
        sys.exit("\n".join([*missing, f"{found} paths exist"]))


if __name__ == "__main__":
    main()
