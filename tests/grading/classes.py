"""A whole class: grades every submission of a folder, and writes a CSV, a histogram and a page for each student."""
import concurrent.futures
import csv
import html
import io
import os
import sys
import time

import compiling
import grade
import labs
import page
import report

OWN_FILES = ("grades.csv", "histogram.svg", "index.html")
BINS = 10  # of the histogram; the last one holds full points, too
STYLE = page.STYLE + """
table{border-collapse:collapse}th,td{text-align:left;padding:.2rem .8rem;border-bottom:1px solid #ddd}
td.n{text-align:right}"""


def submissions(folder):
    """(student, path) for each .cpp file and each folder with one, by name. The student is the name without .cpp."""
    if not folder.is_dir():
        raise labs.Unusable(f"--class {folder}: there is no such folder; expected a file or folder for each student")
    found, empty = [], []
    for path in sorted(folder.iterdir()):
        if path.name.startswith("."):
            continue
        if path.is_dir():
            (found if any(path.glob("*.cpp")) else empty).append((path.name, path))
        elif path.suffix == ".cpp":
            found.append((path.stem, path))
    if not found:
        raise labs.Unusable(f"--class {folder}: found no submission; expected .cpp files, or folders with .cpp files")
    students = [student for student, _ in found + empty]
    if reserved := [student for student in students if student in OWN_FILES]:
        raise labs.Unusable(f"--class {folder}: a submission is named {reserved[0]}, as a file of the grades; "
                            f"rename it")
    doubled = sorted({student for student in students if students.count(student) > 1})
    if doubled:
        raise labs.Unusable(f"--class {folder}: {', '.join(doubled)}: a file and a folder of the same name; expected "
                            f"one of them")
    return found, empty


def grade_student(lab_id, path, build, seed, folder):
    """One student's result. Where the grader itself fails, the result says so, and the class goes on."""
    try:
        return grade.grade(lab_id, path, build, seed, folder)
    except Exception as error:  # whatever it is, it must not cost all others their grades
        return {"earned": 0, "points": 100, "items": [], "error": f"the grader itself failed, grade by hand: {error}",
                "ungraded": True}


def grade_students(lab_id, found, build, seed, out):
    """The results by student, graded on all processors, with progress where someone watches."""
    results, begun = {}, time.monotonic()
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        jobs = {pool.submit(grade_student, lab_id, path, build, seed, out / student): student
                for student, path in found}
        for done, job in enumerate(concurrent.futures.as_completed(jobs), 1):
            results[jobs[job]] = job.result()
            left = (time.monotonic() - begun) / done * (len(found) - done)
            if sys.stderr.isatty():
                print(f"\r{done} of {len(found)} graded, about {left:.0f} s left ", end="", file=sys.stderr, flush=True)
    if sys.stderr.isatty():
        print(file=sys.stderr)
    return {student: results[student] for student, _ in found}


def safe_cell(text):
    """A cell that spreadsheets show as text: they run one that begins with these signs as a formula."""
    return "'" + text if text.startswith(tuple("=+-@\t\r")) else text


def as_csv(results, empty):
    """A line for each student: points, one column an item, and what went wrong as a whole."""
    titles = next(([f"{item['title']} ({item['points']})" for item in result["items"] if item["points"] > 0]
                   for result in results.values() if result["items"]), [])
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow(["student", "points", "of", *titles, "note"])
    for student, result in results.items():
        items = [item["earned"] for item in result["items"] if item["points"] > 0] or [0] * len(titles)
        points = "" if result.get("ungraded") else result["earned"]
        note = " ".join(result.get("error", "").split("\n")[:2])
        table.writerow([safe_cell(student), points, result["points"], *items, safe_cell(note)])
    for student, _ in empty:
        table.writerow([safe_cell(student), 0, "", *[""] * len(titles), "the folder holds no .cpp file"])
    return text.getvalue()


def bin_counts(results):
    """How many students earned 0 to 9 percent of the points, 10 to 19, …, 90 to 100."""
    counts = [0] * BINS
    for result in results.values():
        if not result.get("ungraded"):
            counts[min(BINS - 1, BINS * result["earned"] // result["points"])] += 1
    return counts


def bin_name(i):
    return f"{i * 100 // BINS} to {100 if i == BINS - 1 else (i + 1) * 100 // BINS - 1}"


def histogram_text(counts):
    widest = max(counts)
    return "\n".join(f"{bin_name(i):>9} % {'█' * round(40 * count / max(widest, 1))} {count}"
                     for i, count in enumerate(counts))


def histogram_svg(counts, title):
    """The histogram as a picture: a bar for each range of points, with its count above it."""
    bars = []
    for i, count in enumerate(counts):
        height, x = 200 * count / max(*counts, 1), 40 + 56 * i
        bars.append(f'<rect x="{x}" y="{240 - height:.1f}" width="48" height="{height:.1f}" fill="#0a7d4f"/>'
                    f'<text x="{x + 24}" y="{234 - height:.1f}">{count}</text><text x="{x + 24}" '
                    f'y="258">{bin_name(i)}</text>')
    return ('<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 640 290" width="640" height="290" '
            'font-family="sans-serif" '
            f'font-size="12" text-anchor="middle"><text x="320" y="20" font-size="16">{html.escape(title)}</text>'
            f'{"".join(bars)}<path d="M40 240h556" stroke="#222"/><text x="320" y="282">percent of the '
            f'points</text></svg>\n')


def hardest_items(results):
    """(title, how many of all students earned its points), the one that fewest earned first."""
    earned = {}
    for result in results.values():
        for item in result["items"]:
            if item["points"] > 0:
                earned.setdefault(item["title"], []).append(item["status"] == "passed")
    return sorted(((title, sum(passed)) for title, passed in earned.items()), key=lambda row: row[1])


def as_page(title, results, svg):
    """The class at a glance: the histogram, the items from the hardest on, and a link to each student's page."""
    rows = [f'<tr><td><a href="{html.escape(student)}/index.html">{html.escape(student)}</a>'
            f'<td class="n">{"by hand" if result.get("ungraded") else result["earned"]}'
            f'<td>{html.escape(result.get("error", "").split(chr(10))[0])}' for student, result in results.items()]
    items = [f'<tr><td>{html.escape(name)}<td class="n">{count} of {len(results)}'
             for name, count in hardest_items(results)]
    return (f"{page.HEAD}<title>{html.escape(title)}</title><style>{STYLE}</style>"
            f"<h1>{html.escape(title)}</h1>{svg}<h2>Items, the hardest first</h2><table><tr><th>item<th>students with "
            f"its points"
            f"{''.join(items)}</table><h2>Students</h2><table><tr><th>student<th>points"
            f"<th>note{''.join(rows)}</table></html>\n")


def grade_class(arguments):
    """Grades all submissions of a folder and writes grades.csv, histogram.svg and index.html, and a page a student."""
    found, empty = submissions(arguments.class_folder)
    out = arguments.out
    if out.resolve().is_relative_to(arguments.class_folder.resolve()):
        raise labs.Unusable(f"--out {out}: lies among the submissions; expected a folder outside "
                            f"{arguments.class_folder}")
    out.mkdir(parents=True, exist_ok=True)
    grade.judge_of(arguments.lab, arguments.build)
    compiling.prepare(arguments.lab, arguments.build)
    results = grade_students(arguments.lab, found, arguments.build, arguments.seed, out)
    title = f"{arguments.lab} · {labs.title_of(arguments.lab)}: {len(results)} submissions"
    counts = bin_counts(results)
    report.write_whole(out / "grades.csv", as_csv(results, empty))
    svg = histogram_svg(counts, title)
    report.write_whole(out / "histogram.svg", svg)
    report.write_whole(out / "index.html", as_page(title, results, svg))
    print(f"{title}\n\n{histogram_text(counts)}\n")
    for student, result in results.items():
        if result.get("ungraded"):
            print(f"{student}: {result['error']}")
    for student, _ in empty:
        print(f"{student}: the folder holds no .cpp file")
    print(f"Points: {out / 'grades.csv'}\nThe page: {out / 'index.html'} (open it in a browser)")
