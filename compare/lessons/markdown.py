"""The parts of a Markdown page that checks look at: code blocks, headings, links, formulas, prose."""
import re

FENCE = re.compile(r"^\s*```+\s*(\w*)")
LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^()\s]+(?:\([^)]*\)[^()\s]*)*)(?:\s+\"[^\"]*\")?\)")
INLINE_CODE = re.compile(r"(?<!`)(`+)(?!`)(.+?)(?<!`)\1(?!`)")
INLINE_FORMULA = re.compile(r"\$`(?P<quoted>[^`]+)`\$|(?<![\\$\w])\$(?P<plain>[^\s$](?:[^$]*[^\s$\\])?)\$(?![\d$])")


def blocks(text):
    """Code blocks as (line number of the fence, language, text), and the lines of the page with those made empty."""
    found, rest, start = [], [], None
    lines = text.split("\n")
    for i, line in enumerate(lines):
        fence = FENCE.match(line)
        if fence and start is None:
            start, language = i, fence.group(1)
        elif fence and not fence.group(1):
            found.append((start + 1, language, "\n".join(lines[start + 1:i])))
            start = None
            rest.append("")
            continue
        rest.append("" if start is not None else line)
    if start is not None:
        found.append((start + 1, language, None))  # the fence is never closed
    return found, rest


def blank_out(pattern, text):
    """The text with spaces for what the pattern matches; its lines stay where they are."""
    return re.sub(pattern, lambda match: re.sub(r"[^\n]", " ", match.group()), text, flags=re.DOTALL)


def without_comments(text):
    return blank_out(r"<!--.*?-->", text)


def inline_codes(lines):
    """(line number, text) of all `code` in lines of prose."""
    return [(i + 1, match.group(2).strip()) for i, line in enumerate(lines) for match in INLINE_CODE.finditer(line)]


def without_code(lines):
    return [blank_out(INLINE_CODE.pattern, line) for line in lines]


def headings(lines):
    """(line number, level, text) of all headings."""
    found = []
    for i, line in enumerate(lines):
        match = re.match(r"(#{1,6}) +(.*?) *#*$", line)
        if match:
            found.append((i + 1, len(match.group(1)), match.group(2)))
    return found


def anchor(heading):
    """What GitHub calls a heading's place: lower case, without punctuation, with hyphens for spaces."""
    text = re.sub(LINK, r"\2", heading)
    text = re.sub(r"[`*$]", "", text).strip().lower()
    return re.sub(r"[^\w\- ]", "", text).replace(" ", "-")


def links(lines):
    """(line number, is a picture, text, target) of all links and pictures."""
    return [(i + 1, match.group(1) == "!", match.group(2), match.group(3))
            for i, line in enumerate(without_code(lines)) for match in LINK.finditer(line)]


def formulas(text):
    """(line number, displayed, TeX) of all formulas, and the prose without them; both without code and comments."""
    code, lines = blocks(without_comments(text))
    found = [(line, True, body) for line, language, body in code if language == "math" and body is not None]
    # A formula between $` and `$ looks like code, so formulas go first; code in which a $ stands is rare.
    rest = "\n".join(lines)

    def take(pattern, displayed):
        nonlocal rest
        for match in re.finditer(pattern, rest, re.DOTALL):
            tex = next(group for group in match.groups() if group is not None)
            found.append((rest[:match.start()].count("\n") + 1, displayed, tex))
        rest = blank_out(pattern, rest)

    take(r"\$\$(.+?)\$\$", True)
    take(r"\$`([^`]+)`\$", False)
    rest = "\n".join(without_code(rest.split("\n")))
    take(INLINE_FORMULA.pattern, False)
    return sorted(found), rest


def prose(text):
    """The page's own words, line by line: no code, formulas, addresses or markup; alternative texts stay."""
    rest = formulas(text)[1]
    rest = re.sub(LINK, lambda match: match.group(2), rest)
    rest = re.sub(r"<https?://[^>]*>|https?://\S+|</?\w[^>]*>", " ", rest)
    return rest.split("\n")
