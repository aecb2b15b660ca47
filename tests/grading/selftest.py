#!/usr/bin/env python3
"""Tests a lab itself: its starter gets few points and helpful messages, the answer and the library's version get all,
with other seeds, too, and each typical mistake is caught by a message that names it.

usage: selftest.py [--build FOLDER] ID…
"""
import argparse
import pathlib
import sys
import tempfile

import compiling
import grade
import labs
import variants

ANSWERS = labs.SOURCE / "tests" / "grading" / "answers"
MAX_STARTER_POINTS = 20
OTHER_SEEDS = (2, 3)  # beside 1, with which all else is examined
NEVER = "no message has these words"


def read_mistakes(path):
    """The mistakes of a file: {name, edits: [(old, new)], says}."""
    mistakes = []
    for number, line in enumerate(path.read_text().splitlines(), 1):
        where = f"{path.name}:{number}"
        if line.startswith("# "):
            mistakes.append({"name": line[2:].strip(), "edits": [], "says": ""})
        elif line.startswith("- "):
            mistakes[-1]["edits"].append((line[2:], ""))
        elif line.startswith("+"):
            old, _ = mistakes[-1]["edits"].pop()
            mistakes[-1]["edits"].append((old, line[2:]))
        elif line.startswith("says: "):
            mistakes[-1]["says"] = line[6:].strip()
        elif line.strip():
            raise labs.Unusable(f"{where}: found '{line}'; expected a line that begins with '# ', '- ', '+ ' or "
                                f"'says: '")
    return mistakes


def apply(text, mistake):
    for old, new in mistake["edits"]:
        if text.count(old) != 1:
            raise labs.Unusable(f"mistake {mistake['name']}: '{old}' occurs {text.count(old)} times in answer.cpp; "
                                f"expected 1")
        text = text.replace(old, new)
    return text


def failures(result):
    return [item for item in result["items"] if item["status"] != "passed" and item["points"] > 0]


def check_starter(lab_id, build):
    result = grade.grade(lab_id, labs.folder_of(lab_id) / "lab_starter.cpp", build)
    if "error" in result:
        return [f"the starter doesn't compile: {result['error']}"]
    faults = [f"the item '{item['title']}' fails without a message"
              for item in failures(result) if not item.get("message")]
    if result["earned"] > MAX_STARTER_POINTS:
        faults.append(f"the starter gets {result['earned']} points; expected at most {MAX_STARTER_POINTS}")
    if not any(item["status"] == "not_attempted" for item in result["items"]):
        faults.append("the starter isn't told apart as not attempted")
    if not any(item.get("images") for item in result["items"]):
        faults.append("the starter shows no picture")
    if result["points"] != 100:
        faults.append(f"the items sum to {result['points']} points; expected 100")
    return faults


def check_full(lab_id, path, build, trusted):
    """All items are passed, also those of 0 points, which show an image."""
    result = grade.grade(lab_id, path, build, trusted=trusted)
    faults = [f"{path.name}: {result['error']}"] if "error" in result else []
    for item in (item for item in result["items"] if item["status"] != "passed"):
        faults.append(f"{path.name} fails '{item['title']}': {item.get('message')} expected {item.get('expected')}, "
                      f"found {item.get('found')}\n{item.get('map', '')}")
    return faults


def faults_of_mistake(mistake, result):
    messages = [item.get("message", "") for item in failures(result)]
    if "error" in result:
        return [f"mistake {mistake['name']}: {result['error']}"]
    if not messages:
        return [f"mistake {mistake['name']} gets all points"]
    if not mistake["says"] or not any(mistake["says"] in message for message in messages):
        return [f"mistake {mistake['name']}: no message says '{mistake['says']}', but: {' | '.join(messages)}"]
    return []


def check_seeds(lab_id, worker, build, scratch):
    """The answer has all points whatever the random values are."""
    faults = []
    for seed in OTHER_SEEDS:
        result = grade.examine(grade.judge_of(lab_id, build), scratch, "--worker", worker, "--seed", str(seed),
                               "--until", NEVER)
        faults += [f"with seed {seed} answer.cpp fails '{item['title']}': {item.get('message')}"
                   for item in failures(result)]
    return faults


def check_mistakes(lab_id, mistakes, build, scratch):
    """Each is examined until an item fails with the message that names it. They are compiled together, which takes a
    tenth of the time; where that fails, one by one, which says whose fault it is."""
    answer = (ANSWERS / lab_id / "answer.cpp").read_text(encoding="utf-8")
    texts = [apply(answer, mistake) for mistake in mistakes]
    try:
        answer_worker, *workers = variants.build_workers(lab_id, [answer, *texts], build, scratch)
        faults = check_seeds(lab_id, answer_worker, build, scratch)
    except compiling.Refused as refused:
        workers = [None] * len(texts)
        faults = [f"answer and mistakes can't be compiled together: {refused}"]
    for mistake, text, worker in zip(mistakes, texts, workers):
        if worker is None:
            path = scratch / f"{mistake['name']}.cpp"
            path.write_text(text, encoding="utf-8")
            result = grade.grade(lab_id, path, build)
        else:
            result = grade.examine(grade.judge_of(lab_id, build), scratch, "--worker", worker, "--until",
                                   mistake["says"])
        faults += faults_of_mistake(mistake, result)
    return faults


def check(lab_id, build):
    """All that is not as it should be with a lab, a line each."""
    answers = ANSWERS / lab_id
    faults = check_starter(lab_id, build) + check_full(lab_id, answers / "answer.cpp", build, False)
    if (answers / "library.cpp").exists():  # not where no function of the library has the lab's contract
        faults += check_full(lab_id, answers / "library.cpp", build, True)
    mistakes = read_mistakes(answers / "mistakes.txt")
    if len(mistakes) < 3:
        faults.append(f"there are {len(mistakes)} typical mistakes; expected at least 3")
    with tempfile.TemporaryDirectory() as scratch:
        faults += check_mistakes(lab_id, mistakes, build, pathlib.Path(scratch))
    return faults


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--build", type=pathlib.Path, default=grade.DEFAULT_BUILD)
    parser.add_argument("ids", nargs="+")
    arguments = parser.parse_args()
    faults = []
    try:
        for lab_id in arguments.ids:
            found = check(lab_id, arguments.build.resolve())
            faults += [f"{lab_id}: {fault}" for fault in found]
            print(f"{lab_id}: {'as it should be' if not found else str(len(found)) + ' faults'}")
    except labs.Unusable as error:
        print(f"selftest: {error}", file=sys.stderr)
        sys.exit(2)
    print("\n".join(faults))
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
