"""The page of a graded submission: points, hints, and the pictures expected and found."""
import base64
import html
import re
import shutil

import report

HEAD = "<!doctype html><html lang=en><meta charset=utf-8><meta name=viewport content='width=device-width'>"
STYLE = """body{font:16px/1.5 system-ui,sans-serif;max-width:60rem;margin:2rem auto;padding:0 1rem;color:#222}
section{border-left:6px solid #0a7d4f;padding:.2rem 1rem;margin:1rem 0;background:#f6f7f8}
section.failed{border-color:#c0392b}section.not_attempted{border-color:#999}
h2{font-size:1.1rem}pre{overflow:auto hidden;line-height:1.1}figure{display:inline-block;margin:.5rem 1rem .5rem 0}
img{image-rendering:pixelated;width:20rem;max-width:100%}figcaption{font-size:.85rem}td{padding:0 1rem 0 0}"""


def picture(folder, image):
    data = base64.b64encode((folder / image["file"]).read_bytes()).decode()
    name = html.escape(image["name"])
    return f'<figure><img src="data:image/png;base64,{data}" alt="{name}"><figcaption>{name}</figcaption></figure>'


def section(folder, item):
    parts = [f'<section class="{item["status"]}"><h2>{item["earned"]} / {item["points"]} · '
             f'{html.escape(item["title"])}: '
             f'{item["status"].replace("_", " ")}</h2>']
    if item.get("message") and item["status"] != "passed":
        parts.append(f"<p>{html.escape(item['message'])}</p>")
    rows = [f"<tr><td>{key}<td><code>{html.escape(item[key])}</code>" for key in ("expected", "found") if key in item]
    parts += [f"<table>{''.join(rows)}</table>"] if rows else []
    parts += [f"<pre>{html.escape(item['map'])}</pre>"] if "map" in item else []
    parts += [f"<p>Your program printed:</p><pre>{html.escape(item['printed'])}</pre>"] if item.get("printed") else []
    parts += [picture(folder, image) for image in item.get("images", []) if (folder / image["file"]).exists()]
    return "\n".join(parts) + "</section>"


def write_images(result, images_folder, folder):
    """Every image of a result as a file, named by what it shows: "your rasterizer" becomes your-rasterizer.png, and a
    second one of that name your-rasterizer-2.png."""
    folder.mkdir(parents=True, exist_ok=True)
    names = []
    for image in (image for item in result["items"] for image in item.get("images", [])):
        names.append(re.sub(r"[^a-z0-9]+", "-", image["name"].lower()).strip("-"))
        number = f"-{names.count(names[-1])}" if names.count(names[-1]) > 1 else ""
        if (images_folder / image["file"]).exists():
            shutil.copyfile(images_folder / image["file"], folder / f"{names[-1]}{number}.png")


def write(result, images_folder, folder):
    """Writes folder/index.html, with all pictures in it."""
    folder.mkdir(parents=True, exist_ok=True)
    title = html.escape(f"{result['lab']} · {result['title']}")
    body = [f"{HEAD}<title>{title}</title><style>{STYLE}</style>",
            f"<h1>{title}</h1><p><b>{result['earned']} of {result['points']} points</b>, seed {result['seed']}</p>"]
    if "error" in result:
        body.append(f"<pre>{html.escape(result['error'])}</pre>")
    body += [section(images_folder, item) for item in result["items"]]
    report.write_whole(folder / "index.html", "\n".join(body) + "</html>\n")
