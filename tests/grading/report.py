"""A result as text for a terminal, and as the files that gradebooks read."""
import json
import os
import pathlib
import unicodedata

STATUS = {"passed": "ok", "failed": "WRONG", "not_attempted": "not attempted"}
UNGUARDED = "Note: this computer has no system call filter (seccomp), so the submission was not shut off from files."


def printable(value):
    """The same without characters that steer a terminal or turn the direction of writing; some text is a student's."""
    if isinstance(value, dict):
        return {key: printable(item) for key, item in value.items()}
    if isinstance(value, list):
        return [printable(item) for item in value]
    if isinstance(value, str):
        return "".join(c for c in value if c in "\n\t" or unicodedata.category(c) not in ("Cc", "Cf", "Cs", "Co"))
    return value


def indent(text):
    return "\n".join("      " + line for line in text.rstrip("\n").split("\n"))


def item_text(item):
    """What a student needs to know of an item that isn't right; empty for one that is."""
    parts = []
    if item["status"] != "passed":
        parts.append(item.get("message", ""))
        parts += [f"{key + ':':10}{item[key]}" for key in ("expected", "found") if key in item]
        parts += [item["map"]] if "map" in item and item["status"] == "failed" else []
    if item.get("printed"):
        parts.append("Your program printed:\n" + item["printed"][:500])
    return "\n".join(part.rstrip("\n") for part in parts if part)


def as_text(result):
    """Points per item, and for those that were lost: what was expected, what was found, and why that may be."""
    lines = [f"{result['lab']} · {result['title']}", ""]
    if "error" in result:
        lines += [indent(result["error"]), ""]
    if not result["guarded"]:
        lines += [UNGUARDED, ""]
    for item in result["items"]:
        if item["points"] == 0 and (item["status"] == "passed" or "error" in result):
            continue
        status = "not examined" if "error" in result else STATUS[item["status"]]
        lines.append(f"{item['earned']:4d} / {item['points']:<3d} {item['title']}: {status}")
        if "error" not in result and item_text(item):
            lines.append(indent(item_text(item)))
    return "\n".join([*lines, "", f"{result['earned']} of {result['points']} points"])


def as_gradescope(result):
    """Gradescope's results.json (its «Autograder Specifications»); items of 0 points only show pictures."""
    tests = [{"name": item["title"], "score": item["earned"], "max_score": item["points"],
              "status": "passed" if item["status"] == "passed" else "failed", "output": item_text(item)}
             for item in result["items"] if item["points"] > 0]
    output = result.get("error", "") or f"{result['lab']} · {result['title']}"
    return {"score": result["earned"], "output": output, "output_format": "text", "visibility": "visible",
            "tests": tests}


def as_autolab(result):
    """The last line that an Autolab autograder prints: points by problem. Autolab's problems must be named as the
    items."""
    return {"scores": {item["title"]: item["earned"] for item in result["items"] if item["points"] > 0}}


def write_whole(path, text):
    """Writes a file that is whole or absent, whatever ends the grader."""
    partial = path.with_name(f"{path.name}.{os.getpid()}.tmp")
    partial.write_text(text, encoding="utf-8")
    partial.replace(path)


def write_json(path, value, indent=1):
    write_whole(pathlib.Path(path), json.dumps(value, indent=indent, ensure_ascii=False) + "\n")


def write_files(result, arguments):
    """Writes the files that the command line asks for."""
    if arguments.json == "-":
        print(json.dumps(result, indent=1, ensure_ascii=False))
    elif arguments.json:
        write_json(arguments.json, result)
    if arguments.gradescope:
        write_json(arguments.gradescope, as_gradescope(result))
    if arguments.autolab and arguments.autolab != "-":
        write_json(arguments.autolab, as_autolab(result), indent=None)
