#!/usr/bin/env python3
"""Tests run_page.py: a page passes only if its blocks run and print what it shows."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

RUN_PAGE = pathlib.Path(__file__).resolve().with_name("run_page.py")
FENCE = "`" * 3


def block(language, text):
    return f"{FENCE}{language}\n{text}\n{FENCE}\n"


class RunPage(unittest.TestCase):
    def status(self, *blocks):
        with tempfile.TemporaryDirectory() as folder:
            page = pathlib.Path(folder, "page.md")
            page.write_text("# A page\n\n" + "\n".join(blocks), encoding="utf-8")
            run = subprocess.run([sys.executable, RUN_PAGE, "/nowhere/voxdag", page], capture_output=True, check=False)
            return run.returncode

    def test_blocks_run_in_order_in_one_folder(self):
        self.assertEqual(self.status(block("sh", "echo 1 > a"), block("python", "b = open('a').read()"),
                                     block("python", "print(b)"), block("text", "1")), 0)

    def test_other_blocks_do_not_run(self):
        self.assertEqual(self.status(block("", "false"), block("json", "{")), 0)

    def test_a_command_that_fails_fails_the_page(self):
        self.assertEqual(self.status(block("sh", "false\ntrue")), 1)

    def test_an_exception_fails_the_page(self):
        self.assertEqual(self.status(block("python", "assert 1 == 2")), 1)

    def test_output_that_is_not_shown_fails_the_page(self):
        self.assertEqual(self.status(block("sh", "echo 1; echo 2"), block("text", "2")), 1)

    def test_output_that_is_not_printed_fails_the_page(self):
        self.assertEqual(self.status(block("sh", "echo 1"), block("text", "1\n2")), 1)

    def test_dots_stand_for_lines(self):
        self.assertEqual(self.status(block("sh", "seq 5"), block("text", "1\n...\n4\n...")), 0)

    def test_times_may_differ_and_other_numbers_not(self):
        self.assertEqual(self.status(block("sh", "echo 3 voxels, 0.25 s"), block("text", "3 voxels, 11.07 s")), 0)
        self.assertEqual(self.status(block("sh", "echo 3 voxels, 0.25 s"), block("text", "4 voxels, 0.25 s")), 1)

    def test_a_missing_module_skips_the_page(self):
        self.assertEqual(self.status(block("python", "import no_such_module")), 77)


if __name__ == "__main__":
    unittest.main()
