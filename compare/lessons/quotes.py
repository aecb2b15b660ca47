"""Quotes of source files on Markdown pages: a marker names what is quoted, and the code block below it is filled in.

    <!-- quote sphere.h: inline std::optional<float> hit_sphere -->       the paragraph that contains the text
    <!-- quote lesson.cpp: const Ray ray ... image(x, y) = -->            from one line through another, shifted left

A paragraph is a whole function, struct or group of lines: it begins at an unindented line after a blank one. Paths are
relative to the page.
"""
import re
import textwrap

MARKER = re.compile(r"^<!-- quote (?P<file>\S+): (?P<text>.+?) -->\s*$")
LANGUAGES = {".h": "cpp", ".cpp": "cpp", ".py": "python", ".sh": "sh", ".txt": "text", ".cmake": "cmake"}
# Lines that need no explanation: they are the same in all programs.
TRIVIAL = re.compile(r"^\s*$|^#include |^#pragma once|^(inline )?namespace [\w:]* ?\{$|^\} // namespace|^using "
                     r"namespace ")


class Fault(Exception):
    """What is wrong with a marker."""


def paragraphs(lines):
    """Pairs (first, last) of line indices, last inclusive; blank lines between them belong to none."""
    result, start = [], None
    for i, line in enumerate(lines):
        after_blank = i == 0 or not lines[i - 1].strip()
        closes = line.startswith("}") and not line.startswith("} // namespace")
        label = re.match(r"(public|protected|private):", line)
        if line.strip() and not line[0].isspace() and after_blank and not closes and not label:
            if start is not None:
                result.append((start, i))
            start = i
    if start is not None:
        result.append((start, len(lines)))
    return [(first, last_text(lines, first, end)) for first, end in result]


def last_text(lines, first, end):
    """The last line in [first, end) that is not blank."""
    return max(i for i in range(first, end) if lines[i].strip())


def quoted_range(lines, text, name):
    """The lines (first, last) that a marker's text names in a file."""
    begin, _, end = text.partition(" ... ")
    hits = [i for i, line in enumerate(lines) if begin in line]
    if not hits:
        raise Fault(f"no line of {name} contains '{begin}'")
    if end:
        if len(hits) > 1:
            raise Fault(f"lines {', '.join(str(i + 1) for i in hits)} of {name} contain '{begin}', expected one")
        for i in range(hits[0], len(lines)):
            if end in lines[i]:
                return hits[0], i
        raise Fault(f"no line of {name} from {hits[0] + 1} on contains '{end}'")
    found = [(first, last) for first, last in paragraphs(lines) if any(first <= i <= last for i in hits)]
    if len(found) != 1:
        raise Fault(f"{len(found)} paragraphs of {name} contain '{begin}' (lines "
                    f"{', '.join(str(i + 1) for i in hits)}), "
                    "expected one: add what tells it from the others")
    return found[0]


def fill(page, text):
    """The page's text with all its quotes filled in; which lines of which files it quotes; and faults (line, what)."""
    lines, result, faults, quoted = text.split("\n"), [], [], {}
    i = 0
    while i < len(lines):
        result.append(lines[i])
        marker = MARKER.match(lines[i])
        i += 1
        if not marker:
            continue
        path = page.parent / marker["file"]
        fence = "```" + LANGUAGES.get(path.suffix, "text")
        try:
            if not path.is_file():
                raise Fault(f"no file {marker['file']} beside the page")
            source = path.read_text(encoding="utf-8").split("\n")
            first, last = quoted_range(source, marker["text"], marker["file"])
        except Fault as fault:
            faults.append((i, str(fault)))
            continue
        quoted.setdefault(path.resolve(), set()).update(range(first, last + 1))
        block = textwrap.dedent("\n".join(source[first:last + 1]))
        i = skip_block(lines, i, fence)
        result += [fence, block, "```"]
    return "\n".join(result), quoted, faults


def skip_block(lines, i, fence):
    """The index after the code block that begins at line i; i where none is there."""
    if i >= len(lines) or lines[i].strip() != fence:
        return i
    for end in range(i + 1, len(lines)):
        if lines[end].strip() == "```":
            return end + 1
    return i


def unquoted(path, quoted):
    """The lines (index, text) of a source file that need an explanation and are not quoted."""
    lines = path.read_text(encoding="utf-8").split("\n")
    head = next((i for i, line in enumerate(lines) if not line.startswith("//")), 0)  # says what the file is
    return [(i, line) for i, line in enumerate(lines)
            if i >= head and i not in quoted and not TRIVIAL.match(line)]


def handmade(text):
    """Line numbers of C++ blocks in the section "The program" that follow no marker."""
    section, found, inside, lines = "", [], False, text.split("\n")
    for i, line in enumerate(lines):
        if line.startswith("```"):
            if not inside and section == "The program" and line.startswith("```cpp") and not MARKER.match(lines[i - 1]):
                found.append(i + 1)
            inside = not inside
        elif not inside and line.startswith("## "):
            section = line[3:].strip()
    return found
