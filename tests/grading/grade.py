#!/usr/bin/env python3
"""Grades a lab of the course: compiles a submission, examines it in a process of its own, prints points per item."""
import argparse
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

import labs
import page

DEFAULT_BUILD = labs.SOURCE / "build" / "release"
JUDGE_SECONDS = 600


def judge_of(lab_id, build):
    """The examiner's program of a lab; it is built where it is missing."""
    program = build / "lessons" / "bin" / f"judge-{lab_id}"
    if not program.exists():
        if not (build / "build.ninja").exists():
            raise labs.Unusable(f"{build} is no build folder yet; run: cmake --preset release")
        subprocess.run(["cmake", "--build", str(build), "--target", f"judge-{lab_id}"], check=True, stdout=sys.stderr)
    return program


def not_compiled(lab_id, program, text):
    """The result of a submission that is no program: every item failed. The titles come from a run of the examiner."""
    with tempfile.TemporaryDirectory() as out:
        subprocess.run([program, "--worker", "/bin/false", "--out", out], check=True, timeout=JUDGE_SECONDS)
        result = json.loads(pathlib.Path(out, "result.json").read_text())
    for item in result["items"]:
        for key in ("expected", "found", "map", "printed", "images"):
            item.pop(key, None)
        item.update(status="failed", earned=0, message="Not examined: the submission isn't a program.")
    result.update(earned=0, error=text, lab=lab_id)
    return result


def grade(lab_id, path, build=DEFAULT_BUILD, seed=1, page_folder=None, trusted=False):
    """The result of one submission as a dictionary (tests/grading/README.md lists its keys)."""
    labs.folder_of(lab_id)
    program = judge_of(lab_id, build)
    with tempfile.TemporaryDirectory(prefix="duet-grade-") as name:
        out = pathlib.Path(name)
        try:
            worker = labs.build_worker(lab_id, pathlib.Path(path), build, out, trusted)
            command = [program, "--worker", worker, "--out", out, "--seed", str(seed)] + (["--trusted"] if trusted else [])
            subprocess.run(command, check=True, timeout=JUDGE_SECONDS)
            result = json.loads((out / "result.json").read_text())
        except labs.Refused as refused:
            result = not_compiled(lab_id, program, str(refused))
        result["submission"] = str(path)
        if page_folder is not None:
            page.write(result, out, pathlib.Path(page_folder))
    return result


def indent(text):
    return "\n".join("      " + line for line in text.rstrip("\n").split("\n"))


def print_result(result):
    """Points per item, and for those that were lost: what was expected, what was found, and why that may be."""
    print(f"{result['lab']} · {result['title']}\n")
    if "error" in result:
        print(indent(result["error"]) + "\n")
    marks = {"passed": "ok", "failed": "WRONG", "not_attempted": "not attempted"}
    for item in result["items"]:
        if item["points"] == 0 and item["status"] == "passed":
            continue
        print(f"{item['earned']:4d} / {item['points']:<3d} {item['title']}: {marks[item['status']]}")
        if "error" in result:
            continue
        if item["status"] != "passed" and "message" in item:
            print(indent(item["message"]))
        for key in ("expected", "found"):
            if key in item:
                print(indent(f"{key + ':':10}{item[key]}"))
        if "map" in item:
            print(indent(item["map"]))
        if item.get("printed"):
            print(indent("Your program printed:\n" + item["printed"][:500]))
    print(f"\n{result['earned']} of {result['points']} points")


def start(lab_id):
    """The student's own file: lab.cpp beside the starter, which it is copied from the first time."""
    folder = labs.folder_of(lab_id)
    path = folder / "lab.cpp"
    if not path.exists():
        shutil.copyfile(folder / "lab_starter.cpp", path)
        print(f"{path.relative_to(labs.SOURCE)} was made from lab_starter.cpp: it is yours to edit.\n")
    return path


def main():
    parser = argparse.ArgumentParser(description=__doc__, epilog="example: grade raytrace-05 lab.cpp --page report")
    parser.add_argument("lab", help="the lab's id, such as raytrace-05 or assignment-2")
    parser.add_argument("submission", nargs="?", help="a .cpp file, or a folder of .cpp and .h files")
    parser.add_argument("--start", action="store_true", help="grade lab.cpp beside the starter, which it is made from")
    parser.add_argument("--seed", type=int, default=1, help="another number gives other test values (default: 1)")
    parser.add_argument("--json", metavar="FILE", help="write the result as JSON (-: standard output, nothing else)")
    parser.add_argument("--page", metavar="FOLDER", help="write a page with expected, found and difference")
    parser.add_argument("--build", type=pathlib.Path, default=DEFAULT_BUILD, help="build folder (default: build/release)")
    arguments = parser.parse_args()
    try:
        path = start(arguments.lab) if arguments.start else arguments.submission
        if path is None:
            raise labs.Unusable("no submission was named; expected a .cpp file or a folder, or --start")
        folder = arguments.page or (arguments.build / "lessons" / f"{arguments.lab}-lab" if arguments.start else None)
        result = grade(arguments.lab, path, arguments.build.resolve(), arguments.seed, folder)
    except labs.Unusable as error:
        print(f"grade: {error}", file=sys.stderr)
        sys.exit(2)
    if arguments.json == "-":
        print(json.dumps(result, indent=1))
        return
    print_result(result)
    if arguments.json:
        pathlib.Path(arguments.json).write_text(json.dumps(result, indent=1))
    if folder:
        print(f"The page: {pathlib.Path(folder) / 'index.html'} (open it in a browser)")


if __name__ == "__main__":
    main()
