#!/usr/bin/env python3
"""Tests documents and charts."""

import pathlib
import tempfile
import unittest

import report_path  # noqa: F401

import charts
from document import (Error, Paragraph, Picture, PictureRow, Section, Table, html_of, markdown_of)
from text import NAN


def markdown_with(part):
    return markdown_of("Title", [Section("Section", 1, [part])])


def html_with(part, folder="."):
    return html_of("Title", [Section("Section", 1, [part])], folder)


class Document(unittest.TestCase):
    def test_markdown_has_headings_by_depth(self):
        self.assertEqual(markdown_of("A", [Section("B", 1, [Paragraph("text")]), Section("C", 2)]),
                         "# A\n\n## B\n\ntext\n\n### C\n\n")

    def test_markdown_tables_align_numbers_to_the_right(self):
        self.assertEqual(markdown_with(Table("Sizes", ["scene", "MB"], [["a|b", "1.5"]])),
                         "# Title\n\n## Section\n\n**Sizes**\n\n| scene | MB |\n|---|---:|\n| a\\|b | 1.5 |\n\n")

    def test_a_table_without_rows_says_so(self):
        table = Table("Sizes", ["scene", "MB"])
        self.assertEqual(markdown_with(table), "# Title\n\n## Section\n\nSizes: nothing was measured.\n\n")
        self.assertIn("<p>Sizes: nothing was measured.</p>", html_with(table))

    def test_html_escapes_text(self):
        self.assertIn("<p>a &lt; b &amp; &quot;c&quot;</p>", html_with(Paragraph('a < b & "c"')))

    def test_words_in_backquotes_are_code(self):
        paragraph = Paragraph("Run `build` and `a < b`.")
        self.assertIn("Run <code>build</code> and <code>a &lt; b</code>.", html_with(paragraph))
        self.assertIn("Run `build` and `a < b`.", markdown_with(paragraph))

    def test_html_contains_its_pictures(self):
        with tempfile.TemporaryDirectory() as folder:
            for text, base64 in (("M", "TQ=="), ("Ma", "TWE="), ("Man", "TWFu")):
                pathlib.Path(folder, "a.svg").write_text(text, encoding="utf-8")
                html = html_with(Picture("A chart.", "a.svg"), folder)
                self.assertIn(f'src="data:image/svg+xml;base64,{base64}"', html)
                self.assertIn("<figcaption>A chart.</figcaption>", html)

    def test_pictures_side_by_side_are_a_row(self):
        row = PictureRow([Picture("Cubes.", "a.svg"), Picture("Contours.", "b.svg")])
        self.assertIn("| ![Cubes.](a.svg) | ![Contours.](b.svg) |\n| --- | --- |\n| Cubes. | Contours. |\n\n",
                      markdown_with(row))
        with tempfile.TemporaryDirectory() as folder:
            for name in ("a.svg", "b.svg"):
                pathlib.Path(folder, name).write_text("a", encoding="utf-8")
            html = html_with(row, folder)
        self.assertLess(html.index('<div class="row">'), html.index("<figcaption>Cubes.</figcaption>"))
        self.assertIn("<figcaption>Contours.</figcaption>", html)

    def test_a_missing_picture_is_an_error(self):
        with tempfile.TemporaryDirectory() as folder, self.assertRaises(Error) as caught:
            html_with(Picture("", "none.png"), folder)
        self.assertTrue(str(caught.exception).startswith(f"{folder}/none.png"), caught.exception)

    def test_other_kinds_of_files_are_no_pictures(self):
        with self.assertRaisesRegex(Error, "is neither .svg, .png nor .jpg"):
            html_with(Picture("", "a.txt"))


def example(file):
    panel = charts.panel("Sponza", charts.axis("resolution", "log2"), charts.axis("time (s)", "log10"), [
        charts.line("ours", [512, 1024, 2048], [0.1, NAN, 1.2], 0, markers=True),
        charts.line("published", [512, 2048], [0.2, 2.4], 1, "dashed")])
    return {"file": file, "panels": [panel, panel]}


@unittest.skipUnless(charts.is_installed(), "matplotlib is not installed")
class Charts(unittest.TestCase):
    def test_are_drawn_the_same_each_time(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertTrue(charts.draw_charts([example("a.svg"), example("b.svg")], folder))
            svg = pathlib.Path(folder, "a.svg").read_text(encoding="utf-8")
            self.assertIn("<svg", svg)
            self.assertEqual(svg, pathlib.Path(folder, "b.svg").read_text(encoding="utf-8"))

    def test_a_folder_that_cannot_be_written_is_an_error(self):
        with tempfile.TemporaryDirectory() as folder, self.assertRaises(Error):
            charts.draw_charts([example("a.svg")], folder + "/none")


if __name__ == "__main__":
    unittest.main()
