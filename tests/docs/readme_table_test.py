#!/usr/bin/env python3
"""Checks that the README shows the table that lab/results/summary.py prints."""

import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]

table = subprocess.check_output([sys.executable, ROOT / "lab/results/summary.py"], encoding="utf-8")
if table not in (ROOT / "README.md").read_text(encoding="utf-8"):
    sys.exit(f"README.md lacks this table:\n{table}")
