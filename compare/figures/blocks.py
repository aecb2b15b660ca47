"""Fills and checks blocks of measured figures on Markdown pages. compare/figures.sh writes each block:

    <!-- figure: NAME DIGEST -->
    | scene | ms |
    …
    <!-- end of figure -->

The digest is that of the block's lines and of the images that it shows, so that a change by hand is noticed.
"""
import hashlib
import os
import re

BLOCK = re.compile(r"<!-- figure: (?P<name>\S+)(?: (?P<digest>[0-9a-f]+))? -->\n(?P<body>.*?)<!-- end of figure -->",
                   re.DOTALL)
MARKER = re.compile(r"<!-- (?:figure: (\S+)|end of figure)")
IMAGE = re.compile(r"(!\[[^\]]*\]\()([^)]+)\)")
NUMBER = r"\d[\d,]*(?:\.\d+)?(?:e-?\d+)?"
# This matches a number with a unit of time or speed, or a ratio of two of them.
TIMED = re.compile(rf"\b{NUMBER} ?(?:ms|µs|ns|s|seconds?|minutes?|hours?|Mrays/s|frames/s|fps)(?![\w-])"
                   rf"|\b{NUMBER} times (?:as (?:fast|long|large|much)|faster|slower|less|more|the)"
                   rf"|\b{NUMBER} % (?:faster|slower|less time|more time)")
# The same in prose omits seconds and longer units, because "10 seconds" is more often a limit than a measurement.
TIMED_PROSE = re.compile(TIMED.pattern.replace("|s|seconds?|minutes?|hours?", "") + rf"|MSE (?:of |is )?{NUMBER}")
# This matches headings of columns and rows whose numbers are measured.
MEASURED = re.compile(r"\b(?:ms|milliseconds|seconds|minutes|hours|Mrays/s|frames/s|(?:rel|R)?MSE|rmse|FLIP|flip|ratio|"
                      r"speed|speedup|faster|slower|times as|scaling|error|rate|memory|time|before|after|since|MB|GB)"
                      r"(?![\w`])")
NUMERIC = re.compile(rf"(?:[−-]?{NUMBER}(?:[ ,/–%×()-]|to)*)+")


def digest(body, folder):
    """Returns a digest of the lines of a block and the files of its images, which are relative to the folder of the
    page."""
    sha = hashlib.sha256(body.encode())
    for _, target in IMAGE.findall(body):
        path = folder / target
        sha.update(path.read_bytes() if path.is_file() else b"missing")
    return sha.hexdigest()[:12]


def fill(page, text, name, body, source):
    """Returns the page's text with this body in all blocks of that name. The body gives its images relative to
    `source`."""
    body = IMAGE.sub(lambda image: f"{image[1]}{os.path.relpath(source / image[2], page.parent)})", body.strip()) + "\n"
    filled = f"<!-- figure: {name} {digest(body, page.parent)} -->\n{body}<!-- end of figure -->"
    return BLOCK.sub(lambda block: filled if block["name"] == name else block[0], text)


def cells(line):
    return [cell.strip().strip("*") for cell in re.sub(r"`[^`]*`", "`", line).strip().strip("|").split("|")]


def loose_faults(text, measurements):
    """Returns (line, what) of measured figures outside of blocks. On a page of `measurements` every number of a table
    counts. Elsewhere a cell counts if it has a number with a unit of time or speed, a ratio of such, or if it is a
    number below or beside a heading that names a measured quantity. In prose a time in milliseconds or less counts, a
    ratio of times, and an MSE."""
    lines = BLOCK.sub(lambda block: re.sub(r"[^\n]", "", block[0]), text).split("\n")
    faults, heads, code = [], None, False
    for number, line in enumerate(lines, 1):
        code ^= line.startswith("```")
        if code or not line.startswith("|"):
            heads = None
            if not code and TIMED_PROSE.search(re.sub(r"`[^`]*`", "", line)):
                faults.append((number, f"'{TIMED_PROSE.search(line)[0]}' is no figure of compare/figures.sh"))
            continue
        row = cells(line)
        if heads is None:
            heads = row
            continue
        for head, cell in zip(heads[1:], row[1:]):
            measured = measurements or MEASURED.search(head) or MEASURED.search(row[0])
            if TIMED.search(cell) or (measured and NUMERIC.fullmatch(cell)):
                faults.append((number, f"'{cell}' is no figure of compare/figures.sh"))
    return faults


def page_faults(page, text, known):
    """Returns (line, what) of the faults of a page. Every figure must be in a whole block of a known name that nobody
    changed by hand."""
    faults = loose_faults(text, page.name == "measurements.md")
    whole = list(BLOCK.finditer(text))
    for block in whole:
        line = text[:block.start()].count("\n") + 1
        if block["name"] not in known:
            faults.append((line, f"compare/figures.sh knows no figure '{block['name']}'"))
        elif block["digest"] != digest(block["body"], page.parent):
            faults.append((line, f"'{block['name']}' is not as measured: sh compare/figures.sh {block['name']}"))
    inside = [range(block.start(), block.end()) for block in whole]
    for marker in MARKER.finditer(text):
        if not any(marker.start() in block for block in inside):
            faults.append((text[:marker.start()].count("\n") + 1, f"'{marker[0]}' is half a block"))
    return faults


def faults(pages, known, source):
    """Returns (path, line, what) of the faults of all pages {path: text}, of figures that no page shows, and of plots
    that no block shows."""
    found = [(page, *fault) for page, text in pages.items() for fault in page_faults(page, text, known)]
    blocks = [(page, block) for page, text in pages.items() for block in BLOCK.finditer(text)]
    shown = {block["name"] for _, block in blocks}
    found += [(source / "README.md", 1, f"no page shows the figure '{name}'") for name in known if name not in shown]
    plots = {(page.parent / target).resolve() for page, block in blocks for _, target in IMAGE.findall(block["body"])}
    found += [(plot, 1, "no figure shows this plot") for plot in sorted((source / "gallery").glob("*.svg"))
              if plot.resolve() not in plots]
    return found
