"""Tables of a report: one with a column for each resolution, and one with a line for each claim of a paper."""

import math
from dataclasses import dataclass

from document import Table
from text import number_text, short_resolution


class ResolutionTable:
    def __init__(self, caption, levels):
        self.levels = levels
        self.table = Table(caption, ["scene", ""] + [short_resolution(level) for level in levels], [], 2)
        self.last_scene = None

    def add(self, scene, what, text):
        """Adds a row with the cell text(levels) for each resolution."""
        self.table.rows.append(["" if scene == self.last_scene else scene, what] + [text(level) for level in self.levels])
        self.last_scene = scene


@dataclass
class ClaimValue:
    """A value of one scene."""
    where: str  # "Lucy at 4K³"
    levels: int
    value: float

    def text(self):
        return f"{number_text(self.value)} ({self.where})"


def range_text(values):
    """Returns "3.1 (Lucy at 2K³) to 109 (Crysponza at 4K³)"."""
    least = min(values, key=lambda value: value.value)
    most = max(values, key=lambda value: value.value)
    return least.text() if least is most else f"{least.text()} to {most.text()}"


def verdict(is_reproduced):
    return "reproduced" if is_reproduced else "not reproduced"


class ClaimsTable:
    def __init__(self):
        self.table = Table("Claims of the paper", ["claim", "published", "measured here", "verdict"], [], 4)

    def add(self, claim, published, values, judge, text=range_text):
        """Adds a claim about `values`, of which text(values) is shown. judge(values) returns the verdict."""
        self.table.rows.append([claim, published, text(values), judge(values)] if values else
                               [claim, published, "–", "not measured"])

    def add_range(self, claim, published, values, holds):
        """Adds a claim that is reproduced if holds(value) for each of `values`."""
        self.add(claim, published, values, lambda values: verdict(all(holds(value.value) for value in values)))

    def add_ratio(self, claim, published, ratio, least):
        """Adds a claim about how many times as fast something is; NaN: not measured."""
        self.add(claim, published, [] if math.isnan(ratio) else [ratio], lambda _: verdict(ratio >= least),
                 lambda _: f"{ratio:.2f} times as fast")
