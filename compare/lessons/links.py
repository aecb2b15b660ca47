"""Links and pictures of Markdown pages: what they lead to must exist, headings within pages too."""
import functools
import re
import urllib.parse

import markdown


@functools.lru_cache(maxsize=None)
def anchors(path):
    """The anchors of a page's headings, repeated ones with -1, -2 …, and of its HTML anchors."""
    text = path.read_text(encoding="utf-8")
    names, seen = set(re.findall(r"<a (?:id|name)=\"([^\"]+)\"", text)), {}
    for _, _, heading in markdown.headings(markdown.blocks(text)[1]):
        name = markdown.anchor(heading)
        seen[name] = seen.get(name, -1) + 1
        names.add(name if seen[name] == 0 else f"{name}-{seen[name]}")
    return names


def faults(page, text, source):
    """(line, what) of a page's links."""
    found = []
    lines = markdown.blocks(markdown.without_comments(text))[1]
    for line, picture, words, target in markdown.links(lines):
        if re.match(r"https?://|mailto:", target):
            continue
        if picture and len(words.split()) < 3:
            found.append((line,
                          f"the picture {target} has the alternative text '{words}', expected what one sees there"))
        place, _, fragment = target.partition("#")
        path = (page.parent / urllib.parse.unquote(place)).resolve() if place else page.resolve()
        if place.startswith("/") or not path.is_relative_to(source):
            found.append((line, f"the link {target} leads out of the repository; expected a relative path"))
        elif not path.exists():
            found.append((line, f"the link {target} leads nowhere"))
        elif fragment and path.suffix == ".md" and fragment not in anchors(path):
            found.append((line, f"the link {target}: {path.name} has no heading #{fragment}"))
        elif fragment and path.suffix != ".md" and not re.fullmatch(r"L\d+(-L\d+)?", fragment):
            found.append((line, f"the link {target}: #{fragment} is no line of a file, as #L12 is"))
    return found
