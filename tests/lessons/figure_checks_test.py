"""The comparison of figures (compare/lessons/figures.py) finds what differs, and lets pass what may.

usage: figure_checks_test.py FIGURES_FOLDER COMPARE_PROGRAM, where FIGURES_FOLDER has two PNG files of one size that
show different pictures: evidence.png and another.
"""
import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "compare" / "lessons"))
import figures  # noqa: E402

PLOT = ('<svg data-timing="false"><g data-series="a" data-x="1 2 3 " data-y="1 0.5 0.0001 "></g>'
        '<g data-series="b &lt;8>" data-x="1 2 " data-y="5 6 "></g></svg>')
# What is changed in the plot, and what must be said of it; None: nothing.
CASES = [
    (("0.5", "0.504"), None),
    (("0.5", "0.51"), "line 'a' is 0.51 at 2.0, expected 0.5"),
    (("0.0001", "0.0009"), None),
    (("0.0001", "0.01"), "line 'a' is 0.01 at 3.0"),
    (("0.5", "nan"), "line 'a' is nan at 2.0"),
    (("b &lt;8>", "c"), "the lines are a, c; expected a, b <8>"),
    (('data-x="1 2 "', 'data-x="1 3 "'), "has the x values [1.0, 3.0], expected [1.0, 2.0]"),
    (("false", "true"), "timing is True, expected False"),
    ((PLOT, "<svg/>"), "the lines are ; expected a, b <8>"),
]
TIMING = PLOT.replace("false", "true")
TIMING_CASES = [(("0.5", "0.9"), None), (("0.5", "0"), "takes the time 0.0 at 2.0"),
                (("0.5", "inf"), "takes the time inf")]


def main():
    failures = []
    for plot, cases in ((PLOT, CASES), (TIMING, TIMING_CASES)):
        for (old, new), expected in cases:
            said = figures.plot_difference(plot.replace(old, new, 1), plot)
            if (said is None) != (expected is None) or (expected or "") not in (said or ""):
                failures.append(f"'{new}' for '{old}': expected {expected!r}, found {said!r}")
    pictures = sorted(pathlib.Path(sys.argv[1]).glob("*.png"))
    evidence = next(path for path in pictures if path.stem == "evidence")
    if all(figures.difference(path, evidence, sys.argv[2]) is None for path in pictures):
        failures.append(f"no other picture in {sys.argv[1]} differs from {evidence.name}")
    with tempfile.TemporaryDirectory() as folder:
        broken = pathlib.Path(folder, "evidence.png")
        broken.write_bytes(evidence.read_bytes()[:-30])
        if figures.difference(broken, evidence, sys.argv[2]) is None:
            failures.append("a truncated picture passes")
    print("\n".join(failures) or "the comparison finds what differs")
    sys.exit(1 if failures else 0)


main()
