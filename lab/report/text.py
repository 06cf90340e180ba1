"""Formats numbers for tables, as the library's report/human.hpp does."""

import math

NAN = math.nan


def number(value):
    """Returns a JSON number; NaN for null."""
    return NAN if value is None else float(value)


def with_commas(value):
    return f"{int(value):,}"


def _scaled(value, step, units):
    unit = 0
    while unit < len(units) - 1 and value >= step * 0.9995:  # 999.5 would become 1000
        value /= step
        unit += 1
    decimals = 0 if unit == 0 or value >= 99.95 else 1 if value >= 9.995 else 2
    return f"{value:.{decimals}f}{units[unit]}"


def human_bytes(size):
    """Returns "12.3 MiB"."""
    return _scaled(size, 1024, [" B", " KiB", " MiB", " GiB", " TiB", " PiB"])


def human_count(count):
    """Returns "12.3 M"."""
    return _scaled(count, 1000, ["", " k", " M", " G", " T", " P"])


def human_duration(seconds):
    """Returns "40 s", "12 min", "3 h 20 min"."""
    if seconds < 59.5:
        return f"{seconds:.0f} s"
    minutes, hours = seconds / 60, seconds / 3600
    if minutes < 59.5:
        return f"{minutes:.0f} min"
    if hours < 10:
        return "{} h {:02} min".format(*divmod(math.floor(minutes + 0.5), 60))
    return f"{hours:.0f} h" if hours < 47.5 else f"{math.floor(hours / 24 + 0.5):,} days"


def human_ratio(ratio):
    """Returns "33.4", "1,234"."""
    return f"{ratio:.1f}" if ratio < 99.95 else with_commas(ratio + 0.5)


def seconds_text(seconds):
    """Returns "–" for NaN, else "8.4 ms", "1.20 s", "95 s"."""
    if math.isnan(seconds):
        return "–"
    if seconds < 0.0995:
        return f"{1e3 * seconds:.2g} ms"
    return f"{seconds:.2f} s" if seconds < 9.95 else f"{seconds:.0f} s"


def number_text(value):
    """Returns "–" for NaN, else "0.034", "1.2", "27", "13,169"."""
    if math.isnan(value):
        return "–"
    if math.isinf(value):
        return f"{value}"
    if value >= 99.5:
        return with_commas(value + 0.5)
    return f"{value:.0f}" if value >= 9.95 else f"{value:.2g}"


def short_resolution(levels):
    """Returns "512³", "4K³"."""
    return f"{1 << levels}³" if levels < 10 else f"{1 << (levels - 10)}K³"


def row(cells, widths):
    """Returns a line of cells that are aligned to the right."""
    return (" " + "".join(f" {cell:>{width}}" for cell, width in zip(cells, widths))).rstrip() + "\n"
