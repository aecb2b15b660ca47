"""Holds a figure that a lesson's program wrote to the one that its page shows: pictures by their error, plots by the
values of their lines (common/image/plot.h)."""
import html
import math
import re
import subprocess

MAX_RMSE = 0.01  # of linear color: other processors round differently, and a path may then take another turn
MAX_RELATIVE = 0.01
NOISE = 0.002     # of a line's largest value: its values near zero may differ by more than a hundredth of themselves
SERIES = re.compile(r'data-series="([^"]*)" data-x="([^"]*)" data-y="([^"]*)"')


def difference(found, expected, compare):
    """In what two files differ, None where they do not. `compare` is the path of that program."""
    if found.read_bytes() == expected.read_bytes():
        return None
    if found.suffix == ".svg":
        return plot_difference(found.read_text(encoding="utf-8"), expected.read_text(encoding="utf-8"))
    result = subprocess.run([compare, "images", found, expected, "--fail-above", f"rmse={MAX_RMSE}"], text=True,
                            capture_output=True, check=False)
    return None if result.returncode == 0 else (result.stderr or result.stdout).strip().split("\n")[-1]


def lines_of(svg):
    """{name: (x values, y values)} of a plot."""
    return {html.unescape(name): ([float(x) for x in xs.split()], [float(y) for y in ys.split()])
            for name, xs, ys in SERIES.findall(svg)}


def plot_difference(found, expected):
    """In what two plots differ, given as SVG. Measured times need only be there, finite and positive."""
    ours, theirs = lines_of(found), lines_of(expected)
    timing = ['data-timing="true"' in svg for svg in (found, expected)]
    if not theirs:
        return "the files differ, and the page's has no values to compare"
    if timing[0] != timing[1]:
        return f"timing is {timing[0]}, expected {timing[1]}"
    if list(ours) != list(theirs):
        return f"the lines are {', '.join(ours)}; expected {', '.join(theirs)}"
    for name, (xs, ys) in ours.items():
        expected_xs, expected_ys = theirs[name]
        if xs != expected_xs:
            return f"line '{name}' has the x values {xs}, expected {expected_xs}"
        slack = NOISE * max(abs(y) for y in expected_ys) if expected_ys else 0
        for x, y, wanted in zip(xs, ys, expected_ys):
            if timing[0] and not (math.isfinite(y) and y > 0):
                return f"line '{name}' takes the time {y} at {x}, expected a positive one"
            if not timing[0] and not abs(y - wanted) <= max(MAX_RELATIVE * abs(wanted), slack):
                return f"line '{name}' is {y} at {x}, expected {wanted}"
    return None
