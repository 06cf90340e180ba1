"""Draws charts with matplotlib (Debian's python3-matplotlib), if it is installed.

A chart is {"file", "panels"}; its panels stand side by side. panel(), axis() and line() say what
they hold. NaN leaves a gap in a line.
"""

import importlib.util
import math
import os

from document import Error

# Okabe and Ito's colours, which colour-blind readers can tell apart.
PALETTE = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#999999"]
MARKERS = "osD^vP*X"

STYLE = {
    "svg.hashsalt": "voxdag",
    "font.family": "sans-serif",
    "font.size": 9,
    "axes.grid": True,
    "axes.grid.which": "major",
    "grid.color": "#dddddd",
    "grid.linewidth": 0.6,
    "axes.axisbelow": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "legend.frameon": False,
    "legend.fontsize": 8,
    "lines.linewidth": 1.4,
    "lines.markersize": 4,
}


def axis(label, scale="linear", from_zero=True):
    """`scale`: linear, log2 (resolutions) or log10. A linear y axis begins at 0 if `from_zero`."""
    return {"label": label, "scale": scale, "from_zero": from_zero}


def line(label, x, y, color=0, style="solid", markers=False):
    """`label`: empty: not in the legend. Lines of one colour belong together; the palette has 8.
    `style`: solid, dashed (published figures and bounds) or dotted."""
    return {"label": label, "x": list(x), "y": list(y), "color": color, "style": style, "markers": markers}


def panel(title, x, y, lines, groups=()):
    """`groups` are the names of groups of bars: each line then has a y for each group, and no x."""
    return {"title": title, "x": x, "y": y, "lines": lines, "groups": list(groups)}


def is_installed():
    return importlib.util.find_spec("matplotlib") is not None


def draw_charts(charts, folder):
    """Draws the charts as SVG files in the folder; returns whether matplotlib is installed. Equal
    charts give equal bytes with the same version of matplotlib. Raises Error."""
    if not is_installed():
        return False
    for chart in charts:
        path = os.path.join(folder, chart["file"])
        try:
            draw(chart, path)
        except OSError as error:
            raise Error(f"{path}: {error.strerror}") from error
    return True


def resolution_name(value, _position=None):
    """Returns "4K" for 4096."""
    return f"{value / 1024:g}K" if value >= 1024 else f"{value:g}"


def set_scale(axis, set_axis_scale, scale):
    from matplotlib import ticker
    if scale == "log2":
        set_axis_scale("log", base=2)
        axis.set_major_formatter(ticker.FuncFormatter(resolution_name))
        axis.set_minor_locator(ticker.NullLocator())
    elif scale == "log10":
        set_axis_scale("log")
    else:
        axis.set_major_formatter(ticker.StrMethodFormatter("{x:g}"))


def numbers(values):
    return [math.nan if value is None else value for value in values]


def draw_lines(axes, panel):
    for line in panel["lines"]:
        color = line["color"] % len(PALETTE)
        axes.plot(line["x"], numbers(line["y"]), color=PALETTE[color], label=line["label"] or None,
                  linestyle=line["style"], marker=MARKERS[color] if line["markers"] else None)


def are_long(groups):
    """Returns whether the names of groups of bars do not fit beside each other."""
    return sum(len(group) + 1 for group in groups) > 60


def draw_bars(axes, panel):
    width = 0.8 / len(panel["lines"])
    for i, line in enumerate(panel["lines"]):
        left = (i - (len(panel["lines"]) - 1) / 2) * width
        axes.bar([group + left for group in range(len(panel["groups"]))], numbers(line["y"]),
                 0.92 * width, color=PALETTE[line["color"] % len(PALETTE)], label=line["label"])
    axes.set_xticks(range(len(panel["groups"])), panel["groups"])
    if are_long(panel["groups"]):
        axes.set_xticks(range(len(panel["groups"])), panel["groups"], rotation=30, ha="right",
                        rotation_mode="anchor")
    axes.tick_params(axis="x", length=0)
    axes.grid(axis="x", visible=False)


def draw_panel(axes, panel):
    if panel["groups"]:
        draw_bars(axes, panel)
    else:
        draw_lines(axes, panel)
    axes.set_title(panel["title"], fontsize=9, fontweight="bold")
    axes.set_xlabel(panel["x"]["label"])
    axes.set_ylabel(panel["y"]["label"])
    if not panel["groups"]:
        set_scale(axes.xaxis, axes.set_xscale, panel["x"]["scale"])
    set_scale(axes.yaxis, axes.set_yscale, panel["y"]["scale"])
    if panel["y"]["scale"] == "linear" and panel["y"]["from_zero"]:
        axes.set_ylim(bottom=0)
    if panel["groups"]:
        # Below the bars, where it hides none of them.
        below = -0.3 if are_long(panel["groups"]) else -0.08
        axes.legend(loc="upper center", bbox_to_anchor=(0.5, below), ncols=4)
    elif any(line["label"] for line in panel["lines"]):
        axes.legend()


def draw(chart, file):
    import matplotlib
    matplotlib.use("svg")
    from matplotlib import pyplot
    matplotlib.rcParams.update(STYLE)
    panels = chart["panels"]
    # Two panels beside each other have the width of a page.
    columns = min(len(panels), 2)
    rows = -(-len(panels) // columns)
    figure, all_axes = pyplot.subplots(rows, columns, squeeze=False, layout="constrained",
                                       figsize=(4.6 * columns if columns > 1 else 6.4, 3.4 * rows))
    for axes in all_axes.flat[len(panels):]:
        axes.set_axis_off()
    for axes, panel in zip(all_axes.flat, panels):
        draw_panel(axes, panel)
    figure.savefig(file, format="svg", metadata={"Date": None})
    pyplot.close(figure)
