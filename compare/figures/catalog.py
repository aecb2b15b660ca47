"""Defines what all figures use: their list, numbers, tables, names of scenes."""
import math
import pathlib

FIGURES = {}  # maps each name to (function, minutes)


def figure(name, minutes):
    """Registers a function of a measure.Runner that returns a figure: Markdown, or Markdown and {path: text of a plot}.
    Paths are relative to the repository. The first line of its comment is shown by --list; `minutes` is how long it
    takes on two cores that do nothing else."""
    def register(function):
        FIGURES[name] = (function, minutes)
        return function
    return register


def number(value, digits=2):
    """Returns the value with so many significant digits: 1,234 is 1,234, 0.00012345 is 1.2e-4."""
    if value is None or not math.isfinite(value):
        return "–"
    if value == 0:
        return "0"
    mantissa, exponent = f"{value:.{digits - 1}e}".split("e")  # rounded: 9.99 has the exponent of 10
    if abs(value) < 1e-3:
        return f"{mantissa}e{int(exponent)}"
    return f"{value:,.{max(0, digits - 1 - int(exponent))}f}"


def ms(seconds, digits=3):
    return number(1000 * seconds, digits)


def table(heads, rows):
    lines = [heads, ["---"] * len(heads), *rows]
    return "\n".join("| " + " | ".join(str(cell) for cell in line) + " |" for line in lines)


def stem(path):
    return pathlib.PurePath(path).stem


def scene(name):
    return f"models/{name}.json"
