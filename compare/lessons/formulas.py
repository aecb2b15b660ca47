"""Formulas of Markdown pages: all must parse (by KaTeX, in one process), and mean the same on GitHub."""
import json
import pathlib
import re
import shutil
import subprocess

import markdown

SCRIPT = pathlib.Path(__file__).with_name("formulas.js")
PUNCTUATION = r"!-/:-@\[-`{-~"


class Missing(Exception):
    """A program that a check needs is not installed."""


def run_katex(formulas, *arguments):
    """What formulas.js answers for a list of (TeX, displayed)."""
    node = shutil.which("node") or shutil.which("nodejs")
    if not node:
        raise Missing("formulas are not checked: Node.js was not found (Debian, Ubuntu: apt-get install katex)")
    result = subprocess.run([node, str(SCRIPT), *arguments], input=json.dumps(formulas), capture_output=True, text=True,
                            check=False)
    if result.returncode == 77:
        raise Missing(f"formulas are not checked: {result.stderr.strip()}")
    if result.returncode != 0:
        raise RuntimeError(f"formulas.js failed: {result.stderr}")
    return json.loads(result.stdout)


def faults_of_syntax(texts):
    """Of pages {path: text}: (path, line, what KaTeX says)."""
    where, formulas = [], []
    for path, text in texts.items():
        for line, displayed, tex in markdown.formulas(text)[0]:
            where.append((path, line))
            formulas.append((tex, displayed))
    answers = run_katex(formulas)
    return [(*place, f"{answer} in ${tex.strip()}$")
            for place, answer, (tex, _) in zip(where, answers, formulas) if answer]


def faults_on_github(text):
    """(line, what) of a page's formulas between dollar signs that GitHub reads as Markdown first: it drops the
    backslash before punctuation, and takes pairs of _ or * for emphasis. Between $` and `$ and in ```math blocks it
    does neither."""
    faults = []
    rest = "\n".join(markdown.blocks(markdown.without_comments(text))[1])
    rest = re.sub(r"\$`[^`]+`\$", lambda match: "x" * len(match.group()), rest)
    rest = "\n".join(markdown.without_code(rest.split("\n")))
    spans = [match.span() for match in re.finditer(rf"\$\$.+?\$\$|{markdown.INLINE_FORMULA.pattern}", rest, re.DOTALL)]
    advice = "put the formula between $` and `$, or into a ```math block"
    for begin, end in spans:
        line = rest[:begin].count("\n") + 1
        for escape in sorted(set(re.findall(rf"\\[{PUNCTUATION}]", rest[begin:end]))):
            faults.append((line, f"GitHub shows {escape} as {escape[1]} in {rest[begin:end].strip()[:60]}: leave it "
                                 f"out, or {advice}"))
    for start, paragraph in paragraphs(rest):
        inside = [(begin - start, end - start) for begin, end in spans]
        clash = emphasis(paragraph, inside)
        if clash:
            line = rest[:start + clash[0]].count("\n") + 1
            faults.append((line, f"GitHub reads {paragraph[clash[0]:clash[1] + 1]!r} as emphasis: {advice}"))
    return faults


def paragraphs(text):
    """(offset, text) of what stands between blank lines."""
    return [(match.start(), match.group()) for match in re.finditer(r"(?:[^\n]*\S[^\n]*\n?)+", text)]


def emphasis(text, formulas):
    """The first pair of offsets of _ or * that make emphasis by CommonMark's rules, of which one is in a formula."""
    def formula_of(i):
        return next((span for span in formulas if span[0] <= i < span[1]), None)

    openers = []
    for match in re.finditer(r"_+|\*+", text):
        i, end, mark = match.start(), match.end(), match.group()[0]
        before, after = text[i - 1:i] or " ", text[end:end + 1] or " "
        if before == "\\":
            continue
        space_before, space_after = before.isspace(), after.isspace()
        sign_before, sign_after = (bool(re.match(rf"[{PUNCTUATION}]", c)) for c in (before, after))
        left = not space_after and (not sign_after or space_before or sign_before)
        right = not space_before and (not sign_before or space_after or sign_after)
        can_open = left and (mark == "*" or not right or sign_before)
        can_close = right and (mark == "*" or not left or sign_after)
        opener = next((x for x in reversed(openers) if text[x] == mark), None)
        if can_close and opener is not None:
            if formula_of(i) or formula_of(opener):
                return opener, i
            openers = [x for x in openers if x < opener]
        elif can_open:
            openers.append(i)
    return None
