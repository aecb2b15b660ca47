"""Checks all Markdown pages of the repository, and fills in the source files that lessons quote (quotes.py says how).

Every check that a page can fail is here. On each page, links lead somewhere, images have an alternative text, commands
name what exists, formulas parse, and words are spelled right. On the page of a lesson, quotes equal their sources, the
whole program is quoted and short enough, and the sections and figures are there.
"""
import argparse
import os
import pathlib
import re
import sys

import commands
import course
import formulas
import links
import markdown
import quotes
import spelling

SECTIONS = ["The mathematics", "The program", "What to look at", "What goes wrong", "Exercises", "In the library",
            "Sources"]
MAX_LINES, MAX_COLUMNS, MAX_FIGURES = 150, 120, 400_000


def program_faults(lesson, text):
    """(file, line, what): the program is short and the page quotes all of it. The page's text has its quotes filled."""
    faults = []
    quoted = quotes.fill(lesson.page, text)[1]
    if lesson.program_lines() > MAX_LINES:
        sizes = ", ".join(f"{path.name} {course.code_lines(path)}" for path in lesson.program_files())
        faults.append((lesson.folder, 0,
                       f"the program has {lesson.program_lines()} lines of code ({sizes}), at most {MAX_LINES}"))
    for path in lesson.program_files():
        for i, line in enumerate(path.read_text(encoding="utf-8").split("\n")):
            if len(line) > MAX_COLUMNS:
                faults.append((path, i + 1, f"{len(line)} columns, at most {MAX_COLUMNS}"))
        missing = quotes.unquoted(path, quoted.get(path.resolve(), set()))
        if missing:
            numbers = ", ".join(str(i + 1) for i, _ in missing[:12]) + (" …" if len(missing) > 12 else "")
            faults.append((path, missing[0][0] + 1, f"the page quotes no line {numbers}: '{missing[0][1].strip()}'"))
    faults += [(lesson.page, line, "this C++ in 'The program' is not quoted by a marker")
               for line in quotes.handmade(text)]
    return faults


def outline_faults(lesson, text):
    """(line, what): the headings are those that every lesson has."""
    headings = markdown.headings(markdown.blocks(text)[1])
    faults = []
    first = headings[0] if headings else (1, 0, "")
    if first[1] != 1 or not re.match(rf"{lesson.number} · \S", first[2]):
        faults.append((first[0], f"the page begins with '{first[2]}', expected '# {lesson.number} · …'"))
    titles = [(line, title) for line, level, title in headings if level == 2]
    place = -1
    for section in SECTIONS:
        at = [i for i, (_, title) in enumerate(titles) if title == section]
        if not at:
            faults.append((1, f"the page has no section '## {section}'"))
        elif at[0] < place:
            faults.append((titles[at[0]][0],
                           f"the section '{section}' comes too early; expected {', '.join(SECTIONS)}"))
        else:
            place = at[0]
    return faults


def figure_faults(lesson, text):
    """(line, what): the evidence comes first, with the command that makes it; all figures are shown; they are small."""
    faults = []
    lines = markdown.blocks(text)[1]
    shown = [(line, target) for line, picture, _, target in markdown.links(lines)
             if picture and target.startswith("figures/")]
    start = next((i for i, line in enumerate(lines, 1) if line.startswith("## ")), len(lines))
    if not any(re.match(r"figures/evidence\.\w+$", target) and line < start for line, target in shown):
        faults.append((1, "figures/evidence.png is not shown before the first section"))
    if f"--target lesson-{lesson.id}" not in "\n".join(text.split("\n")[:start]):
        faults.append((1, f"the command with --target lesson-{lesson.id} does not stand before the first section"))
    if len({target for _, target in shown}) < 2:
        faults.append((1, f"the page shows {len({target for _, target in shown})} figures, expected at least two"))
    for figure in lesson.figures():
        if f"figures/{figure.name}" not in [target for _, target in shown]:
            faults.append((1, f"figures/{figure.name} is not shown"))
    size = sum(figure.stat().st_size for figure in lesson.figures())
    if size > MAX_FIGURES:
        faults.append((1, f"the figures have {size // 1000} kB together, at most {MAX_FIGURES // 1000}"))
    return faults


def end_faults(lesson, text):
    """(line, what): the page names the lab and leads on to the next lesson."""
    faults = []
    if lesson.has_lab() and f"--target lab-{lesson.id}" not in text:
        faults.append((1, f"the exercises don't say how to grade the lab: --target lab-{lesson.id}"))
    if lesson.room != "compare" and not re.search(r"^Next: \[.+\]\(.+\)", text.rstrip().split("\n")[-1]):
        faults.append((len(text.split("\n")), "the page does not end with 'Next: [title](link)'"))
    return faults


def fill_quotes(page, write):
    """The page's text with its quotes filled in, on disk too where `write`, and (file, line, what) of their faults."""
    text = page.read_text(encoding="utf-8")
    filled, _, marker_faults = quotes.fill(page, text)
    faults = [(page, *fault) for fault in marker_faults]
    if filled != text and write:
        page.write_text(filled, encoding="utf-8")
    elif filled != text:
        line = next((i for i, (a, b) in enumerate(zip(filled.split("\n"), text.split("\n"))) if a != b), 0)
        faults.append((page, line + 1, "a quote differs from its source: run python3 compare/lessons/pages.py --write"))
    return filled, faults


def lesson_faults(lesson, write):
    """(file, line, what) of all that concerns one lesson's own page; its quotes are filled in where `write`."""
    if not lesson.page.exists():
        return [(lesson.page, 0, "the lesson has no page")]
    filled, faults = fill_quotes(lesson.page, write)
    faults += program_faults(lesson, filled)
    for check in (outline_faults, figure_faults, end_faults):
        faults += [(lesson.page, *fault) for fault in check(lesson, filled)]
    return faults


def text_faults(pages, source, programs):
    """(file, line, what) of links, commands, formulas and spelling; and which checks could not be made."""
    texts = {page: page.read_text(encoding="utf-8") for page in pages if page.exists()}
    check = commands.Commands(source, programs)
    faults, skipped = [], []
    for page, text in texts.items():
        for found in (links.faults(page, text, source), check.faults(text), formulas.faults_on_github(text)):
            faults += [(page, *fault) for fault in found]
    for batch in (formulas.faults_of_syntax, spelling.faults):
        try:
            faults += batch(texts)
        except formulas.Missing as missing:
            skipped.append(str(missing))
    return faults, skipped


def table(lessons):
    """One line a page: what it is called and how long it is."""
    rows = [f"{'lesson':<12} {'lines':>5} {'words':>5} {'figures':>7} {'kB':>4}  title"]
    for lesson in lessons:
        if lesson.page.exists():
            words = sum(len(line.split()) for line in markdown.prose(lesson.page.read_text(encoding="utf-8")))
            size = sum(figure.stat().st_size for figure in lesson.figures()) // 1000
            rows.append(f"{lesson.id:<12} {lesson.program_lines():>5} {words:>5} {len(lesson.figures()):>7} {size:>4}  "
                        f"{lesson.title()}")
    return "\n".join(rows)


def main():
    parser = argparse.ArgumentParser(description="Checks the pages of the repository: those of lessons, and all "
                                                 "others.")
    parser.add_argument("ids", nargs="*", metavar="ID",
                        help="lessons such as raytrace-02 (default: all, and the other pages)")
    parser.add_argument("--write", action="store_true", help="fill in the quotes first")
    parser.add_argument("--strict", action="store_true", default=os.environ.get("CI") == "1",
                        help="fail where a check cannot be made, rather than say so (default: if CI=1 is set)")
    parser.add_argument("--programs", type=pathlib.Path, default=course.SOURCE / "build" / "release" / "bin",
                        metavar="FOLDER",
                        help="where the built programs are, to check options (default: build/release/bin)")
    parser.add_argument("--source", type=pathlib.Path, default=course.SOURCE, metavar="FOLDER",
                        help="the repository whose pages are checked (default: that of this script)")
    options = parser.parse_args()
    source = options.source.resolve()
    lessons = course.pick(options.ids, source)
    faults = [fault for lesson in lessons for fault in lesson_faults(lesson, options.write)]
    others = [] if options.ids else course.other_pages(source)
    faults += [fault for page in others for fault in fill_quotes(page, options.write)[1]]
    pages = [lesson.page for lesson in lessons] + others
    more, skipped = text_faults(pages, source, options.programs)
    faults = sorted(faults + more, key=lambda fault: (str(fault[0]), fault[1]))
    print(table(lessons))
    for path, line, what in faults:
        print(f"{path.relative_to(source)}:{line}: {what}")
    for missing in skipped:
        print(("failed: " if options.strict else "skipped: ") + missing)
    sys.exit(1 if faults or (skipped and options.strict) else 0)


if __name__ == "__main__":
    main()
