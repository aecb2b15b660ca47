"""Holds every figure of the pages to what the lesson's program writes: the same files, the same pictures, and the same
values in plots (but for times).

usage: figures_test.py LESSONS_OUT COMPARE_PROGRAM
"""
import pathlib
import re
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "compare" / "lessons"))
import course  # noqa: E402

MOST_RMSE = 0.01  # of linear color: other processors round differently, and a path may then take another turn


def pictures_differ(compare, found, expected):
    """What `compare images` says where the two pictures are further apart than MOST_RMSE; nothing where they are not."""
    if found.read_bytes() == expected.read_bytes():
        return None
    done = subprocess.run([compare, "images", found, expected, "--fail-above", f"rmse={MOST_RMSE}"], text=True,
                          capture_output=True, check=False)
    return None if done.returncode == 0 else (done.stderr or done.stdout).strip().split("\n")[-1]


def values(path):
    """The series of a plot: name, x values, y values, and whether they are times."""
    text = path.read_text()
    series = re.findall(r'data-series="([^"]*)" data-x="([^"]*)" data-y="([^"]*)"', text)
    numbers = [(name, [float(x) for x in xs.split()], [float(y) for y in ys.split()]) for name, xs, ys in series]
    return numbers, 'data-timing="true"' in text


def plots_differ(found, expected):
    """In what two plots differ; nothing where they do not."""
    (ours, timing), (theirs, _) = values(found), values(expected)
    if not theirs or [(n, x) for n, x, _ in ours] != [(n, x) for n, x, _ in theirs]:
        return "other series or other x values"
    for (name, _, ys), (_, _, expected_ys) in zip(ours, theirs):
        for y, wanted in zip(ys, expected_ys):
            if (timing and not y > 0) or (not timing and abs(y - wanted) > 0.01 * abs(wanted)):
                return f"series {name}: {y}, expected {wanted}"
    return None


def faults_of(lesson, out, compare):
    written = {path.name: path for path in out.iterdir() if path.suffix in (".png", ".svg")}
    committed = {path.name: path for path in lesson.figures()}
    faults = [f"{name} is written but not committed in figures/" for name in sorted(written.keys() - committed.keys())]
    faults += [f"figures/{name} is not written by the program" for name in sorted(committed.keys() - written.keys())]
    for name in sorted(written.keys() & committed.keys()):
        pair = written[name], committed[name]
        found = plots_differ(*pair) if name.endswith(".svg") else pictures_differ(compare, *pair)
        faults += [f"{name}: {found}"] if found else []
    return [f"{lesson.id}: {fault}" for fault in faults]


def main():
    out, compare = pathlib.Path(sys.argv[1]), sys.argv[2]
    faults, count = [], 0
    for lesson in course.lessons():
        folder = out / lesson.id
        if not (folder / "lesson.json").exists():
            sys.exit(f"{folder}: the lesson's program has not run; build the target lessons first")
        faults += faults_of(lesson, folder, compare)
        count += len(lesson.figures())
    print("\n".join(faults) or f"{count} figures are those of their programs")
    sys.exit(1 if faults or count == 0 else 0)


if __name__ == "__main__":
    main()
