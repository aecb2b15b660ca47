"""Measures the figures of all pages, or those named, and writes them into the pages between their markers."""
import argparse
import pathlib
import sys
import time

import blocks
import catalog
import compare_figures  # registers its figures, as three of the next do
import measure
import memory_figures
import raster_figures
import raytrace_figures

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.append(str(SOURCE / "compare" / "lessons"))
import course  # noqa: E402

MOST_COMMANDS = 3  # maximum number of commands shown with a block
MOST_OTHERS = 0.1  # fraction of the processors' time that other programs may take


def read_pages(source):
    """Returns {path: text} of all pages except those of the course, whose figures lesson:figures checks."""
    return {page: page.read_text(encoding="utf-8") for page in course.other_pages(source)
            if source / "compare" / "lessons" not in page.parents}


def provenance(used):
    """Returns a line that says how a block was measured, and the commands."""
    dates, commits, processors = ({getattr(each, key) for each in used} for key in ("date", "commit", "processor"))
    line = f"*Measured {'/'.join(sorted(dates))}, code of {'/'.join(sorted(commits))}, " \
           f"{'/'.join(sorted(processors))}.*"
    others = others_of(used)
    return line if others <= MOST_OTHERS else \
        f"{line} **Other programs took up to {100 * others:.0f} % of the processors' time: these times are too long.**"


def others_of(used):
    return max(each.others for each in used)


def commands(name, used):
    lines = []
    for each in used[:MOST_COMMANDS] if len(used) <= MOST_COMMANDS else used[:1]:
        line = ""
        output = ["-o", "image.pfm"] if each.command[0] in ("raster", "raytrace") else []
        for word in each.command + output:
            if line and len(line.split("\n")[-1]) + len(word) > 110:
                line += " \\\n   "
            line += (" " if line else "") + word
        lines.append(line)
    if len(used) > MOST_COMMANDS:
        lines.append(f"# and {len(used) - 1} more; all: sh compare/figures.sh {name}")
    return "```sh\n" + "\n".join(lines) + "\n```"


def renew(name, run, busy):
    """Measures a figure and writes it into every page that shows it. With `busy`, other programs may run meanwhile."""
    run.used = []
    result = catalog.FIGURES[name][0](run)
    if not busy and others_of(run.used) > MOST_OTHERS:
        raise measure.Failed(f"other programs took up to {100 * others_of(run.used):.0f} % of the processors' time; "
                             "--busy writes such figures, with a note")
    body, plots = result if isinstance(result, tuple) else (result, {})
    for path, svg in plots.items():
        (SOURCE / path).write_text(svg, encoding="utf-8")
    body += "\n\n" + provenance(run.used)
    for page, text in read_pages(SOURCE).items():
        shown = body if page == SOURCE / "README.md" else f"{body}\n\n{commands(name, run.used)}"
        filled = blocks.fill(page, text, name, shown, SOURCE)
        if filled != text:
            page.write_text(filled, encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(prog="sh compare/figures.sh", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help="figures (default: all)")
    parser.add_argument("--list", action="store_true", help="list the figures, and the minutes that each takes")
    parser.add_argument("--kept", action="store_true",
                        help="write what out/figures still has from earlier runs, and measure only what is missing")
    parser.add_argument("--busy", action="store_true",
                        help="write figures, with a note, though other programs took part of the processors' time")
    parser.add_argument("--check", action="store_true",
                        help="measure nothing: fail where a page shows a measured figure that is not from here")
    parser.add_argument("--programs", type=pathlib.Path, default=SOURCE / "build" / "release" / "bin", metavar="FOLDER",
                        help="where the built programs are (default: build/release/bin)")
    parser.add_argument("--commit", help="what the programs were built from (default: the last change of this tree)")
    parser.add_argument("--source", type=pathlib.Path, default=SOURCE, metavar="FOLDER",
                        help="with --check: the repository whose pages are checked (default: that of this script)")
    options = parser.parse_args()
    if options.list:
        for name, (function, minutes) in catalog.FIGURES.items():
            print(f"{name:<20} {minutes:>3} min  {function.__doc__}")
        return 0
    if options.check:
        source = options.source.resolve()
        faults = blocks.faults(read_pages(source), catalog.FIGURES, source)
        for path, line, what in sorted(faults, key=lambda fault: (str(fault[0]), fault[1])):
            print(f"{path.relative_to(source)}:{line}: {what}")
        return 1 if faults else 0
    for name in options.names:
        if name not in catalog.FIGURES:
            parser.error(f"{name}: no such figure; --list shows them")
    run, failed = measure.Runner(options.programs.resolve(), SOURCE, options.kept,
                                 options.commit), 0
    names = options.names or list(catalog.FIGURES)
    for i, name in enumerate(names, 1):
        print(f"[{i}/{len(names)}] {name}: about {catalog.FIGURES[name][1]} min", flush=True)
        begin = time.time()
        try:
            renew(name, run, options.busy)
            print(f"  {(time.time() - begin) / 60:.1f} min")
        except measure.Failed as failure:
            failed = 1
            print(f"  failed, the pages keep the old one: {failure}", file=sys.stderr)
    return failed


if __name__ == "__main__":
    sys.exit(main())
