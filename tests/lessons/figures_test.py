"""Holds every figure of the course's pages to what the lesson's program wrote: the same files, the same pictures, the
same values in plots. Says how long each program ran.

usage: figures_test.py LESSONS_OUT COMPARE_PROGRAM
"""
import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "compare" / "lessons"))
import course  # noqa: E402
import figures  # noqa: E402


def faults_of(lesson, out, compare):
    written = {path.name: path for path in out.iterdir() if path.suffix in (".png", ".svg")}
    committed = {path.name: path for path in lesson.figures()}
    faults = [f"{name} is written but not committed in figures/" for name in sorted(written.keys() - committed.keys())]
    faults += [f"figures/{name} is not written by the program" for name in sorted(committed.keys() - written.keys())]
    for name in sorted(written.keys() & committed.keys()):
        difference = figures.difference(written[name], committed[name], compare)
        if difference:
            faults.append(f"{name} differs from the committed one: {difference}")
    return [f"{lesson.id}: {fault}" for fault in faults]


def main():
    out, compare = pathlib.Path(sys.argv[1]), sys.argv[2]
    faults, count, total = [], 0, 0.0
    for lesson in course.lessons():
        folder = out / lesson.id
        if not (folder / "lesson.json").exists():
            sys.exit(f"{folder}: the lesson's program has not run; build the target lessons first")
        facts = json.loads((folder / "lesson.json").read_text())
        total += facts["seconds"]
        count += len(lesson.figures())
        faults += faults_of(lesson, folder, compare)
        print(f"{lesson.id:<12} {facts['seconds']:6.2f} s {facts['lines']:4} lines {len(lesson.figures()):3} figures")
    print(f"{'all':<12} {total:6.2f} s")
    print("\n".join(faults) or f"{count} figures are those of their programs")
    sys.exit(1 if faults or count == 0 else 0)


if __name__ == "__main__":
    main()
