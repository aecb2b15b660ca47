"""Writes index.html beside the pictures of all lessons: title, picture, seconds, lines of code, link to the page.

usage: contact_sheet.py SOURCE_DIR LESSONS_OUT
"""
import html
import json
import os
import pathlib
import sys

import course

HEAD = "<!doctype html><html lang=en><meta charset=utf-8><meta name=viewport content='width=device-width'>"


STYLE = """body{font:16px/1.5 system-ui,sans-serif;max-width:75rem;margin:2rem auto;padding:0 1rem;color:#222;
background:#fff}
main{display:grid;grid-template-columns:repeat(auto-fill,minmax(20rem,1fr));gap:1.5rem}
a{color:inherit;text-decoration:none}a:hover b{text-decoration:underline}
img{width:100%;aspect-ratio:16/9;object-fit:contain;background:#eef0f2;border-radius:4px}small{color:#666}"""


def card(lesson, out):
    """One lesson: its evidence picture, which leads to its page, and what its program cost."""
    facts = json.loads((out / lesson.id / "lesson.json").read_text())
    picture = next(f"{lesson.id}/evidence{ending}" for ending in (".png", ".svg")
                   if (out / lesson.id / f"evidence{ending}").exists())
    title = html.escape(f"{lesson.number} · {lesson.title()}")
    page = html.escape(os.path.relpath(lesson.page, out))
    return (f'<a href="{page}"><img src="{picture}" alt="{title}" loading="lazy"><br><b>{title}</b><br>'
            f'<small>{facts["seconds"]:.1f} s, {facts["lines"]} lines</small></a>'), facts["seconds"]


def main():
    source, out = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    parts, total = [], 0.0
    for room, name in course.ROOMS.items():
        lessons = [lesson for lesson in course.lessons(source) if lesson.room == room]
        if not lessons:
            continue
        cards = [card(lesson, out) for lesson in lessons]
        total += sum(seconds for _, seconds in cards)
        parts.append(f"<h2>{name}</h2><main>{''.join(text for text, _ in cards)}</main>")
    head = f"{HEAD}<title>Lessons</title><style>{STYLE}</style><h1>Lessons</h1>"
    partial = out / f"index.html.{os.getpid()}"
    partial.write_text(f"{head}<p>All programs together ran for {total:.0f} s.</p>{''.join(parts)}</html>\n",
                       encoding="utf-8")
    partial.replace(out / "index.html")


if __name__ == "__main__":
    main()
