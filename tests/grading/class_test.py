#!/usr/bin/env python3
"""Tests what an instructor does with the grader: a whole class, files for gradebooks, other seeds.

usage: class_test.py [--build FOLDER]
"""
import argparse
import csv
import json
import pathlib
import subprocess
import sys
import tempfile

import grade
import labs

LAB = "raytrace-02"
ANSWER = labs.SOURCE / "tests" / "grading" / "answers" / LAB / "answer.cpp"
STARTER = labs.folder_of(LAB) / "lab_starter.cpp"


class Failures(list):
    def check(self, holds, text):
        if not holds:
            self.append(text)


def run(build, *arguments):
    command = [sys.executable, "-B", str(pathlib.Path(__file__).with_name("grade.py")), "--build", str(build),
               *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def make_class(folder):
    """Seven students: full points, a mistake, not begun, not compiled, two files, nothing."""
    for name in ("dora", "empty"):
        (folder / name).mkdir(parents=True)
    answer = ANSWER.read_text()
    (folder / "anna.cpp").write_text(answer)
    (folder / "Zoë, $1%.cpp").write_text(answer)
    (folder / "bert.cpp").write_text(answer.replace("(p - center) / radius", "p - center").replace("(n.x + 1) / 2",
                                                                                                   "n.x"))
    (folder / "=cmd.cpp").write_text(STARTER.read_text())
    (folder / "carl.cpp").write_text("int main( {\n")
    (folder / "dora" / "lab.cpp").write_text('#include "mine.h"\n' + answer)
    (folder / "dora" / "mine.h").write_text("#pragma once\n")
    (folder / "empty" / "notes.txt").write_text("I was ill.\n")


def test_class(build, scratch, failures):
    make_class(scratch / "class")
    out = scratch / "grades"
    done = run(build, LAB, "--class", scratch / "class", "-o", out)
    failures.check(done.returncode == 0, f"--class ends with {done.returncode}: {done.stderr}")
    with open(out / "grades.csv", encoding="utf-8", newline="") as file:
        rows = {row["student"]: row for row in csv.DictReader(file)}
    failures.check(list(rows) == ["'=cmd", "Zoë, $1%", "anna", "bert", "carl", "dora", "empty"],
                   f"the students are {list(rows)}")
    points = {student: row["points"] for student, row in rows.items()}
    failures.check(points["anna"] == points["dora"] == points["Zoë, $1%"] == "100", f"the points are {points}")
    failures.check(0 < int(points["bert"]) < 100, f"a mistake gets {points['bert']} points")
    failures.check(points["carl"] == points["'=cmd"] == "0",
                   f"carl gets {points['carl']}, the starter {points[chr(39) + '=cmd']}")
    failures.check("doesn't compile" in rows["carl"]["note"], f"of carl's file it says '{rows['carl']['note']}'")
    failures.check("no .cpp file" in rows["empty"]["note"], f"of the empty folder it says '{rows['empty']['note']}'")
    items = [key for key in rows["bert"] if key.endswith(")")]
    total = sum(int(rows["bert"][key]) for key in items)
    failures.check(str(total) == points["bert"], f"bert's items sum to {total}, not {points['bert']}")
    page = (out / "index.html").read_text()
    for student in ("anna", "bert", "carl", "dora"):
        failures.check((out / student / "index.html").exists() and f"{student}/index.html" in page,
                       f"{student} has no page")
    failures.check("<svg" in page and (out / "histogram.svg").exists(), "there is no histogram")
    last = next(line for line in done.stdout.splitlines() if line.startswith("90 to 100"))
    failures.check(last.endswith(" 3"), f"three students have full points, but the histogram says: {last}")


def test_class_refusals(build, scratch, failures):
    (scratch / "none").mkdir()
    (scratch / "twice" / "anna").mkdir(parents=True)
    (scratch / "twice" / "anna.cpp").write_text("")
    (scratch / "clash").mkdir()
    (scratch / "clash" / "index.html.cpp").write_text("")
    for folder, out, said in (("clash", "o", "rename it"), ("none", "o", "found no submission"),
                              ("absent", "o", "no such folder"),
                              ("twice", "o", "of the same name"), ("class", "class/o", "lies among the submissions")):
        done = run(build, LAB, "--class", scratch / folder, "-o", scratch / out)
        failures.check(done.returncode == 2 and said in done.stderr,
                       f"{folder}: {done.returncode}, '{done.stderr}', expected '{said}'")


def test_gradebooks(build, scratch, failures):
    wrong = scratch / "class" / "bert.cpp"
    done = run(build, LAB, wrong, "--json", "-", "--gradescope", scratch / "results.json", "--autolab",
               scratch / "autolab.json")
    result = json.loads(done.stdout)
    gradescope = json.loads((scratch / "results.json").read_text())
    autolab = json.loads((scratch / "autolab.json").read_text())
    last = run(build, LAB, wrong, "--autolab", "-").stdout.splitlines()[-1]
    failures.check(json.loads(last) == autolab, f"--autolab - prints as its last line: {last}")
    tests = gradescope["tests"]
    failures.check(gradescope["score"] == result["earned"] == sum(test["score"] for test in tests) ==
                   sum(autolab["scores"].values()), "the three files differ in the points")
    failures.check(sum(test["max_score"] for test in tests) == 100, "Gradescope's items do not sum to 100 points")
    failures.check(any(test["status"] == "failed" and "is wrong" in test["output"] for test in tests),
                   "no item of Gradescope's says what is wrong")


def test_pipe(build, scratch, failures):
    """`grade … | head` ends without a complaint."""
    command = [sys.executable, "-B", pathlib.Path(grade.__file__), "--build", build, LAB,
               scratch / "class" / "bert.cpp"]
    grader = subprocess.Popen(list(map(str, command)), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    grader.stdout.close()
    said = grader.stderr.read()
    failures.check(grader.wait() == 0 and not said,
                   f"with a closed pipe it ends with {grader.returncode} and says: {said}")


def found_values(build, path, seed):
    items = grade.grade(LAB, path, build, seed)["items"]
    return [item.get("found") for item in items if item["title"] == "directions of any length"]


def test_seed(build, scratch, failures):
    path = scratch / "seed.cpp"
    # Right for the fixed values of the item, wrong for its random ones: what is found then depends on the seed.
    path.write_text(ANSWER.read_text().replace("const float discriminant = ", "const float discriminant = "
                                               "std::abs(center.x) > 1e-6f && center.y != 0 && center.x != 0 ? 1.0f + "
                                               "center.x : "))
    first, again, other = (found_values(build, path, seed) for seed in (7, 7, 8))
    failures.check(first == again and first[0] is not None, f"the same seed finds {first} and {again}")
    failures.check(first != other, f"another seed finds {other}, too")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--build", type=pathlib.Path, default=grade.DEFAULT_BUILD)
    build, failures = parser.parse_args().build.resolve(), Failures()
    with tempfile.TemporaryDirectory() as folder:
        for test in (test_class, test_class_refusals, test_gradebooks, test_pipe, test_seed):
            test(build, pathlib.Path(folder), failures)
    print("\n".join(failures) or "a class, gradebooks and seeds are as they should be")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
