#!/usr/bin/env python3
"""Makes the figures of an assignment's page from what the grader shows: images of the answer, and of typical mistakes,
made by making them. figures.txt beside the answer lists them. Without --write it compares them with the committed ones.

usage: page_figures.py [--write] [--build FOLDER] ID
"""
import argparse
import pathlib
import shutil
import sys
import tempfile

import compiling
import grade
import labs
import page
import selftest
import variants

sys.path.insert(0, str(labs.SOURCE / "compare" / "lessons"))
import figures  # noqa: E402


def read_list(path):
    """{answer or name of a mistake: [(figure, image)]}"""
    makers = {}
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if line.startswith("#"):
            continue
        words = line.split()
        if len(words) != 3:
            raise labs.Unusable(f"{path.name}:{number}: found '{line}'; expected a figure, a maker and an image")
        makers.setdefault(words[1], []).append((words[0], words[2] + ".png"))
    return makers


def text_of(lab_id, maker):
    """The source of the answer, or of a mistake."""
    answers = selftest.ANSWERS / lab_id
    text = (answers / "answer.cpp").read_text(encoding="utf-8")
    if maker == "answer":
        return text
    mistakes = {mistake["name"]: mistake for mistake in selftest.read_mistakes(answers / "mistakes.txt")}
    if maker not in mistakes:
        raise labs.Unusable(f"figures.txt: {maker} is no mistake of {lab_id}; expected one of {', '.join(mistakes)}")
    return selftest.apply(text, mistakes[maker])


def draw(lab_id, worker, build, folder):
    """Leaves the images that the grader shows of a worker in the folder."""
    folder.mkdir()
    page.write_images(grade.examine(grade.judge_of(lab_id, build), folder, "--worker", worker, "--shown"), folder,
                      folder)


def faults_of(lab_id, build, write):
    """Figures that are not those of the page, a line each; where `write`, makes them so."""
    committed = labs.folder_of(lab_id) / "figures"
    makers = read_list(selftest.ANSWERS / lab_id / "figures.txt")
    listed = [figure for made in makers.values() for figure, _ in made]
    faults = [f"figures/{path.name} is not in figures.txt"
              for path in sorted(committed.glob("*")) if path.name not in listed]
    with tempfile.TemporaryDirectory() as name:
        scratch = pathlib.Path(name)
        workers = variants.build_workers(lab_id, [text_of(lab_id, maker) for maker in makers], build, scratch)
        for (maker, made), worker in zip(makers.items(), workers):
            folder = scratch / maker
            draw(lab_id, worker, build, folder)
            for figure, image in made:
                if not (folder / image).exists():
                    faults.append(f"{figure}: {maker} shows no {image}; it shows "
                                  f"{', '.join(sorted(path.name for path in folder.glob('*.png')))}")
                elif write:
                    committed.mkdir(exist_ok=True)
                    shutil.copyfile(folder / image, committed / figure)
                elif not (committed / figure).exists():
                    faults.append(f"{figure} is not in figures/")
                elif difference := figures.difference(folder / image, committed / figure, build / "bin" / "compare"):
                    faults.append(f"{figure} differs from the committed one: {difference}")
    return faults


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("id", metavar="ID", help="an assignment with a figures.txt, such as assignment-5")
    parser.add_argument("--write", action="store_true", help="replace the committed figures")
    parser.add_argument("--build", type=pathlib.Path, default=grade.DEFAULT_BUILD)
    arguments = parser.parse_args()
    try:
        faults = faults_of(arguments.id, arguments.build.resolve(), arguments.write)
    except (labs.Unusable, compiling.Refused) as error:
        print(f"page_figures: {error}", file=sys.stderr)
        sys.exit(2)
    print("\n".join(faults) or f"{arguments.id}: the figures are those of its page")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
