"""A report of text, tables and pictures, as Markdown and as one HTML page that needs no other file.

A document is a title and sections; a section is a title, a depth (1: a chapter; 2: a section of it)
and parts. Words in `backquotes` are code.
"""

import base64
import html
import os
import re
from dataclasses import dataclass, field

MEDIA_TYPES = {".svg": "image/svg+xml", ".png": "image/png", ".jpg": "image/jpeg"}
STYLE = """
body { font: 16px/1.5 system-ui, sans-serif; max-width: 72rem; margin: 2rem auto; padding: 0 1rem; color: #1a1a1a; }
h1, h2, h3 { line-height: 1.2; }
h2 { margin-top: 3rem; border-bottom: 1px solid #ccc; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: 0.875rem; }
.scroll { overflow-x: auto; margin: 1rem 0; }
caption { text-align: left; font-weight: 600; padding-bottom: 0.4rem; }
th, td { padding: 0.2rem 0.6rem; text-align: right; border-bottom: 1px solid #e3e3e3; white-space: nowrap; }
th { border-bottom: 2px solid #888; vertical-align: bottom; }
.text { text-align: left; white-space: normal; }
figure { margin: 1.5rem 0; }
figure img { max-width: 100%; height: auto; }
.row { display: flex; gap: 0.75rem; }
.row figure { margin: 0.5rem 0; }
figcaption { color: #444; font-size: 0.9rem; }
pre { background: #f4f4f4; padding: 0.6rem 0.8rem; overflow-x: auto; font-size: 0.8125rem; }
"""


class Error(Exception):
    """A failure that the user reads as one line."""


def escaped(text):
    return html.escape(text, quote=True).replace("&#x27;", "'")


@dataclass
class Paragraph:
    text: str

    def markdown(self):
        return self.text + "\n\n"

    def html(self, _folder):
        return "<p>" + re.sub("`([^`]*)`", r"<code>\1</code>", escaped(self.text)) + "</p>\n"


@dataclass
class CommandLine:
    """The command that made what stands above it."""
    text: str

    def markdown(self):
        return f"```\n{self.text}\n```\n\n"

    def html(self, _folder):
        return f"<pre>{escaped(self.text)}</pre>\n"


def _markdown_row(cells):
    return "|" + "".join(" " + cell.replace("|", "\\|") + " |" for cell in cells) + "\n"


@dataclass
class Table:
    """So many columns from the left hold text, the others numbers. A table without rows says that
    nothing was measured."""
    caption: str
    header: list
    rows: list = field(default_factory=list)
    text_columns: int = 1

    def _nothing(self):
        return Paragraph(self.caption + ": nothing was measured.")

    def markdown(self):
        if not self.rows:
            return self._nothing().markdown()
        rule = "".join("---|" if i < self.text_columns else "---:|" for i in range(len(self.header)))
        return (f"**{self.caption}**\n\n" + _markdown_row(self.header) + f"|{rule}\n" +
                "".join(map(_markdown_row, self.rows)) + "\n")

    def _html_row(self, cells, tag):
        return "<tr>" + "".join(
            f"<{tag}{' class=' + chr(34) + 'text' + chr(34) if i < self.text_columns else ''}>"
            f"{escaped(cell)}</{tag}>" for i, cell in enumerate(cells)) + "</tr>\n"

    def html(self, folder):
        if not self.rows:
            return self._nothing().html(folder)
        return (f'<div class="scroll"><table>\n<caption>{escaped(self.caption)}</caption>\n'
                f"<thead>{self._html_row(self.header, 'th')}</thead>\n" +
                "".join(self._html_row(row, "td") for row in self.rows) + "</table></div>\n")


@dataclass
class Picture:
    """A PNG, JPEG or SVG in the folder of the report."""
    caption: str
    file: str

    def image(self):
        return f"![{self.caption}]({self.file})"

    def markdown(self):
        return f"{self.image()}\n\n*{self.caption}*\n\n"

    def html(self, folder):
        path = os.path.join(folder, self.file)
        media = MEDIA_TYPES.get(os.path.splitext(path)[1])
        if media is None:
            raise Error(f"{path}: is neither .svg, .png nor .jpg")
        try:
            with open(path, "rb") as file:
                data = base64.b64encode(file.read()).decode()
        except OSError as error:
            raise Error(f"{path}: {error.strerror}") from error
        caption = escaped(self.caption)
        return (f'<figure><img src="data:{media};base64,{data}" alt="{caption}">\n'
                f"<figcaption>{caption}</figcaption></figure>\n")


@dataclass
class PictureRow:
    """Pictures of equal size side by side, for comparison."""
    pictures: list

    def markdown(self):
        return (_markdown_row([picture.image() for picture in self.pictures]) +
                _markdown_row(["---"] * len(self.pictures)) +
                _markdown_row([picture.caption for picture in self.pictures]) + "\n")

    def html(self, folder):
        return ('<div class="row">\n' + "".join(picture.html(folder) for picture in self.pictures) +
                "</div>\n")


@dataclass
class Section:
    title: str
    depth: int = 1
    parts: list = field(default_factory=list)


def markdown_of(title, sections):
    """Returns Markdown. Its pictures are links to the files."""
    return f"# {title}\n\n" + "".join(
        "#" * (section.depth + 1) + f" {section.title}\n\n" +
        "".join(part.markdown() for part in section.parts) for section in sections)


def html_of(title, sections, folder):
    """Returns an HTML page that contains its pictures, which are read from `folder`. Raises Error
    if one cannot be read or is of another kind."""
    body = "".join(
        f"<h{section.depth + 1}>{escaped(section.title)}</h{section.depth + 1}>\n" +
        "".join(part.html(folder) for part in section.parts) for section in sections)
    return ('<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">\n'
            '<meta name="viewport" content="width=device-width">\n'
            f"<title>{escaped(title)}</title>\n<style>{STYLE}</style></head>\n"
            f"<body>\n<h1>{escaped(title)}</h1>\n{body}</body></html>\n")
