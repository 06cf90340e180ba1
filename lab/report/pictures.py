"""Renders the pictures of a report."""

import os
from dataclasses import dataclass

from cells import Cell, Result, build_cell
from document import CommandLine, Paragraph, Picture, PictureRow


@dataclass
class Lab:
    """A plan, the store of its measurements, and the program that is measured."""
    plan: object
    cells: object
    program: object

    def scratch(self, name):
        """Returns the path of a file that is removed after the item of work."""
        return os.path.join(self.cells.directory, name)

    def cast(self, cell):
        """Returns the cell, which runs on the plan's device. Its result counts only for this device."""
        if self.plan.device_name:
            cell.device = self.plan.device_name
            cell.arguments += ["--device", self.plan.device]
        return cell


@dataclass
class Voxels:
    scene: object
    path: str
    built: Result


@dataclass
class ScenePicture:
    """A rendered picture, or the reason why there is none."""
    scene: object
    cell: Cell
    result: Result

    @property
    def file(self):
        return os.path.basename(self.cell.output)


def show(lab, scene, levels, is_esvo=False, options=()):
    """Builds voxels for pictures, which replace those that were shown before. Pictures that are kept from an earlier
    run of the report need none."""
    path = lab.scratch("picture.esvo" if is_esvo else "picture.vdag")
    if os.path.exists(path):
        os.remove(path)
    as_esvo = scene.options if is_esvo else []
    return Voxels(scene, path, lab.cells.run(build_cell(lab.plan, scene, levels, path, [*options, *as_esvo])))


def paint(lab, voxels, file, options, size=None, of_pass=""):
    """Renders a picture, or a pass of it, to `file` in the report's folder. `options`: more options of `render`."""
    width, height = size or lab.plan.picture_size
    output = os.path.join(lab.plan.folder, file)
    outputs = ["--pass", f"{of_pass}={output}", "-o", "picture.png"] if of_pass else ["-o", output]
    cell = lab.cast(Cell(["render", voxels.path, "-q", "--size", f"{width}x{height}", *outputs, *options],
                         [voxels.path, voxels.scene.mesh], output, prints_json=False, keeps_output=True))
    return ScenePicture(voxels.scene, cell, voxels.built if voxels.built.failure else lab.cells.run(cell))


def picture_parts(picture, caption):
    """Returns the picture, or the reason why there is none, and its command."""
    first = (Paragraph(f"{caption} No picture: {picture.result.failure}.") if picture.result.failure else
             Picture(caption, picture.file))
    return [first, CommandLine(picture.cell.command())]


def row_parts(pictures, captions):
    """Returns the pictures side by side, and the command of the last; if one is not there, the reason instead."""
    for picture, caption in zip(pictures, captions):
        if picture.result.failure:
            return picture_parts(picture, caption)
    return [PictureRow([Picture(caption, picture.file) for picture, caption in zip(pictures, captions)]),
            CommandLine(pictures[-1].cell.command())]


def chart_parts(charts, caption, is_drawn):
    """Returns the charts, or a note that they were not drawn."""
    return [Picture(caption, chart["file"]) if is_drawn else
            Paragraph("No chart was drawn, because matplotlib (python3-matplotlib) is not installed. report.json has "
                      "its points.") for chart in charts]
