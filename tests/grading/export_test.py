#!/usr/bin/env python3
"""Tests what students get: handouts compile and hold no answer; the template builds a lab's examiner and grades with
it,
with an instructor's hidden item, which a second export keeps back.

usage: export_test.py [--build FOLDER]
"""
import argparse
import json
import pathlib
import re
import subprocess
import sys
import tempfile

import labs

LAB = "raytrace-02"
HIDDEN = """#include "raytrace/lessons/02-sphere/lab.h"
#include "tests/grading/judge.h"

LAB_ITEM(30, "a hidden item") {
    item.equal("the color of (0, 0, 1)", STUDENT(normal_color)(duet::Vec3{0, 0, 1}), duet::Rgb(0.5f, 0.5f, 1));
}
"""
HIDDEN_FILE = "raytrace/lessons/02-sphere/lab_test_hidden.cpp"
GIT = ["git", "-c", "user.name=Course", "-c", "user.email=course@localhost"]


def run(*command, cwd=None):
    done = subprocess.run([str(word) for word in command], cwd=cwd, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))} ends with "
                 f"{done.returncode}:\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.stdout


def export(source, *arguments):
    return run(sys.executable, "-B", source / "tests" / "grading" / "export.py", *arguments)


def own_headers(folder):
    """The headers of a lesson's program: they hold the answers of its lab."""
    return {path.name for path in folder.glob("*.h") if not path.name.startswith("lab")}


def handout_faults(out):
    """Each lab's folder has all that its lab.cpp includes, and neither examiner nor answer. That a starter compiles
    against these headers is tested with its lab; here one compiles by the command of its page."""
    export(labs.SOURCE, "handout", out)
    faults = []
    for lab_id, folder in labs.all_folders().items():
        handout = out / lab_id
        run("g++", "-std=c++20", "-I", "include", "-E", "lab.cpp", "-o", "/dev/null", cwd=handout)
        names = {path.name for path in handout.rglob("*") if path.parent.name == folder.name or path.parent == handout}
        if names - {"lab.cpp", "lab.h", "README.md", "include"}:
            faults.append(f"the handout of {lab_id} has {sorted(names)}")
        if {path.name for path in handout.rglob("*.h") if path.parent.name == folder.name} & own_headers(folder):
            faults.append(f"the handout of {lab_id} has a header of its lesson's program")
    run(*re.search(r"^g\+\+ .*$", (out / LAB / "README.md").read_text(), re.MULTILINE)[0].split(), cwd=out / LAB)
    if list(out.rglob("lab_test*")) or list(out.rglob("answer*")):
        faults.append("the handouts have an examiner or an answer")
    return faults


def template_faults(out, again):
    """A student's repository builds an examiner and grades; an instructor's hidden item counts, and isn't exported."""
    export(labs.SOURCE, "template", out)
    faults = []
    if (list(out.rglob("answers")) or list(out.rglob("mistakes.txt"))
            or list((out / "tests" / "grading").glob("*_test.py"))):
        faults.append("the template has answers, mistakes or the grader's own tests")
    if "lab.cpp" not in run("git", "ls-files", "raytrace/lessons/02-sphere", cwd=out):
        faults.append("the template does not track lab.cpp")
    (out / HIDDEN_FILE).write_text(HIDDEN)
    run("cmake", "--preset", "release", "-DCMAKE_CXX_FLAGS_RELEASE=-O0", cwd=out)  # compiles in half the time
    grade = [sys.executable, "-B", out / "tests" / "grading" / "grade.py"]
    result = json.loads(run(*grade, "raytrace-02", out / "raytrace/lessons/02-sphere/lab.cpp", "--json", "-", cwd=out))
    hidden = [item for item in result["items"] if item["title"] == "a hidden item"]
    if result["points"] != 130 or len(hidden) != 1 or hidden[0]["status"] != "not_attempted":
        faults.append(f"with a hidden item of 30 points the lab has {result['points']} points, and the item is "
                      f"{hidden}")
    if "lab:raytrace-02" in run("ctest", "--preset", "release", "-N", cwd=out):
        faults.append("the template tests answers that it doesn't have")
    run(*GIT, "add", "-A", cwd=out)
    run(*GIT, "commit", "-q", "-m", "Add a hidden item", cwd=out)
    export(out, "template", again)
    if (again / HIDDEN_FILE).exists() or not (again / "raytrace/lessons/02-sphere/lab.cpp").exists():
        faults.append("the second export has the hidden item, or lacks lab.cpp")
    return faults


def refusal_faults(folder):
    (folder / "full").mkdir()
    (folder / "full" / "grades.csv").write_text("")
    command = [sys.executable, "-B", labs.SOURCE / "tests" / "grading" / "export.py", "handout", folder / "full"]
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False)
    kept = (folder / "full" / "grades.csv").exists()
    return [] if done.returncode == 2 and "is not empty" in done.stderr and kept else [f"a full folder: {done.stderr}"]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--build", type=pathlib.Path)
    parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        faults = handout_faults(folder / "handout") + template_faults(folder / "template",
                                                                      folder / "again") + refusal_faults(folder)
    print("\n".join(faults) or "handouts and the template are as they should be")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
