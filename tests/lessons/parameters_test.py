"""Each lesson's program declares two to four parameters, takes them from its command line, draws with the least value
of each, and refuses what is none.

usage: parameters_test.py LESSONS_OUT
"""
import json
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "compare" / "lessons"))
import course  # noqa: E402


def run(program, *options):
    with tempfile.TemporaryDirectory() as folder:
        result = subprocess.run([program, *options], cwd=folder, capture_output=True, text=True, timeout=60,
                                check=False)
        return result, list(pathlib.Path(folder).iterdir())


def refused(program, *options):
    """What is wrong with how the program refuses options, as a list: exit code 2, one line, no images."""
    result, files = run(program, *options)
    fine = result.returncode == 2 and result.stderr.count("\n") == 1 and options[0] in result.stderr and not files
    found = f"exit code {result.returncode}, '{result.stderr}', {len(files)} files"
    return [] if fine else [f"{' '.join(options)}: {found}; expected exit code 2, one line and no files"]


def faults_of(program):
    result, _ = run(program, "--parameters")
    if result.returncode != 0:
        return [f"--parameters ends with exit code {result.returncode}: {result.stderr}"]
    parameters = json.loads(result.stdout)
    faults = [] if 2 <= len(parameters) <= 4 else [f"{len(parameters)} parameters, expected 2 to 4"]
    text = run(program, "--help")[0].stdout
    for p in parameters:
        if not p["least"] <= p["value"] <= p["greatest"] or p["least"] == p["greatest"]:
            faults.append(f"{p['name']}: the default {p['value']} is not from {p['least']} to {p['greatest']}")
        if p["option"] not in text:
            faults.append(f"--help does not name {p['option']}")
        faults += refused(program, p["option"], str(p["greatest"] + 1))
    least = [word for p in parameters for word in (p["option"], str(p["least"]))]
    result, files = run(program, *least)
    if result.returncode != 0 or not files:
        faults.append(f"{' '.join(least)}: exit code {result.returncode}, '{result.stderr}', {len(files)} files")
    return faults + refused(program, "--no-such-parameter", "1")


def main():
    programs, lessons = pathlib.Path(sys.argv[1]).resolve() / "bin", course.lessons()
    faults = [f"{lesson.id}: {fault}" for lesson in lessons
              for fault in faults_of(programs / f"lesson_{lesson.id}_program")]
    print("\n".join(faults) or f"the parameters of {len(lessons)} lessons are as they should be")
    sys.exit(1 if faults or not lessons else 0)


main()
