#!/usr/bin/env python3
"""Grades a lab of the course: compiles a submission, examines it in a process of its own, prints points per item.

examples:
  grade raytrace-05 lab.cpp
  grade raytrace-05 lab.cpp --page report --seed 7
  grade raytrace-05 --class submissions -o results
  grade --all
"""
import argparse
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

import compiling
import labs
import page
import report

DEFAULT_BUILD = labs.SOURCE / "build" / "release"
JUDGE_SECONDS = 1800


def judge_of(lab_id, build):
    """The examiner's program of a lab; it is built where it is missing."""
    program = build / "lessons" / "bin" / f"judge-{lab_id}"
    if not program.exists():
        if not (labs.folder_of(lab_id) / "lab_test.cpp").exists():
            raise labs.Unusable(f"{lab_id} has no lab_test.cpp here: your instructor grades it")
        if not (build / "build.ninja").exists():
            raise labs.Unusable(f"{build} is no build folder yet; run: cmake --preset release")
        command = ["cmake", "--build", str(build), "--target", f"judge-{lab_id}"]
        if subprocess.run(command, stdout=sys.stderr, check=False).returncode != 0:
            raise labs.Unusable(f"the examiner of {lab_id} could not be built: {' '.join(command)}")
    return program


def examine(program, out, *arguments):
    """Runs the examiner; its result, and the images that it names, are in the folder `out`."""
    subprocess.run([program, "--out", out, *arguments], check=True, timeout=JUDGE_SECONDS)
    return json.loads((out / "result.json").read_text(encoding="utf-8"))


def not_examined(program, out, reason):
    """The result of a submission that is no program, or never ends: every item failed. The titles come from the
    examiner."""
    result = examine(program, out)
    for item in result["items"]:
        item["message"] = "Not examined, for the reason above."
    return {**result, "error": reason}


def grade(lab_id, path, build=DEFAULT_BUILD, seed=1, page_folder=None, images_folder=None, trusted=False, options=()):
    """The result of one submission as a dictionary (tests/grading/README.md lists its keys)."""
    program = judge_of(lab_id, build)
    path = pathlib.Path(path)
    with tempfile.TemporaryDirectory(prefix="duet-grade-") as name:
        out = pathlib.Path(name)
        try:
            make = compiling.build_trusted_worker if trusted else compiling.build_worker
            worker = make(lab_id, path, build, out)
            result = examine(program, out, "--worker", worker, "--seed", str(seed), *(["--trusted"] if trusted else []),
                             *options)
        except compiling.Refused as refused:
            result = not_examined(program, out, str(refused))
        except subprocess.TimeoutExpired:
            result = not_examined(program, out, f"The submission was not done after {JUDGE_SECONDS // 60} minutes.")
        result["seed"] = seed
        result["submission"] = str(path)
        result = report.printable(result)
        if page_folder is not None:
            page.write(result, out, pathlib.Path(page_folder))
        if images_folder is not None:
            page.write_images(result, out, pathlib.Path(images_folder))
    for item in result["items"]:  # their files are gone
        item["images"] = [image["name"] for image in item.get("images", [])]
    return result


def start(lab_id):
    """The student's own file: lab.cpp beside the starter, which it is copied from the first time."""
    folder = labs.folder_of(lab_id)
    path = folder / "lab.cpp"
    if not path.exists():
        shutil.copyfile(folder / "lab_starter.cpp", path)
        print(f"{path.relative_to(labs.SOURCE)} was made from lab_starter.cpp: it is yours to edit.\n")
    return path


def grade_one(arguments):
    """Grades one submission and writes what was asked for."""
    path = start(arguments.lab) if arguments.start else arguments.submission
    if path is None:
        raise labs.Unusable("no submission was named; expected a .cpp file, a folder, or --start")
    if not path.exists():
        raise labs.Unusable(f"{path} does not exist; expected a .cpp file or a folder of them")
    folder = arguments.page
    if folder is None and arguments.start:
        folder = arguments.build / "lessons" / f"{arguments.lab}-lab"
    result = grade(arguments.lab, path, arguments.build, arguments.seed, folder, arguments.images)
    report.write_files(result, arguments)
    if arguments.json == "-":
        return
    print(report.as_text(result))
    if folder:
        print(f"The page: {folder / 'index.html'} (open it in a browser)")
    if arguments.autolab == "-":
        print(json.dumps(report.as_autolab(result), ensure_ascii=False))


def grade_all(arguments):
    """A line for each lab: the points of the lab.cpp beside its starter."""
    for lab_id, folder in labs.all_folders().items():
        if (folder / "lab.cpp").exists():
            result = grade(lab_id, folder / "lab.cpp", arguments.build, arguments.seed)
            points = f"{result['earned']:3d} of {result['points']}"
        else:
            points = "not begun"
        print(f"{lab_id:13} {points:>10}  {labs.title_of(lab_id)}")


def parse_arguments():
    parser = argparse.ArgumentParser(prog="grade", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("lab", nargs="?", help="the lab's id, such as raytrace-05 or assignment-2")
    parser.add_argument("submission", nargs="?", type=pathlib.Path,
                        help="a .cpp file, or a folder of .cpp and .h files")
    parser.add_argument("--start", action="store_true", help="grade lab.cpp beside the starter, which it is made from")
    parser.add_argument("--all", action="store_true", help="grade every lab.cpp beside a starter, a line each")
    parser.add_argument("--class", dest="class_folder", metavar="FOLDER", type=pathlib.Path,
                        help="grade a whole class: a file or folder for each student")
    parser.add_argument("-o", "--out", metavar="FOLDER", type=pathlib.Path, default=pathlib.Path("grades"),
                        help="where --class writes the CSV, the histogram and a page for each student (default: "
                             "grades)")
    parser.add_argument("--seed", type=int, default=1, help="another number gives other test values (default: 1)")
    parser.add_argument("--json", metavar="FILE",
                        help="write the result as JSON (-: to standard output, and nothing else)")
    parser.add_argument("--page", metavar="FOLDER", type=pathlib.Path,
                        help="write a page with expected, found and difference")
    parser.add_argument("--images", metavar="FOLDER", type=pathlib.Path,
                        help="write the images of that page as PNG files, named by what they show")
    parser.add_argument("--gradescope", metavar="FILE", help="write the result as Gradescope's results.json")
    parser.add_argument("--autolab", metavar="FILE",
                        help="write the points as the line of JSON that Autolab reads (-: print it as the last line)")
    parser.add_argument("--build", metavar="FOLDER", type=lambda path: pathlib.Path(path).resolve(),
                        default=DEFAULT_BUILD,
                        help="the build folder (default: build/release)")
    arguments = parser.parse_args()
    if arguments.lab is None and not arguments.all:
        parser.error("no lab was named; expected an id such as raytrace-05, or --all")
    if not 0 <= arguments.seed < 1 << 63:
        parser.error(f"--seed {arguments.seed}: expected a whole number from 0 to {(1 << 63) - 1}")
    return arguments


def main():
    arguments = parse_arguments()
    try:
        if arguments.all:
            grade_all(arguments)
        elif arguments.class_folder:
            import classes # it imports this file
            classes.grade_class(arguments)
        else:
            grade_one(arguments)
        sys.stdout.flush()
    except labs.Unusable as error:
        print(f"grade: {error}", file=sys.stderr)
        return 2
    except BrokenPipeError:  # `grade … | head` wants no more lines
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    except KeyboardInterrupt:
        return 130
    except (subprocess.SubprocessError, OSError) as error:
        print(f"grade: the grader itself failed, this is no fault of the submission: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
