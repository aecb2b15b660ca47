#!/usr/bin/env python3
"""Exports what students get.

  export handout OUT    a folder for each lab: the contract, the starter as lab.cpp, the headers that they may include,
                        and how to compile it. No answers, no examiners, no lesson programs.
  export template OUT   a complete repository: all that builds lessons and labs and grades them, each lab.cpp made from
                        its starter, without answers, typical mistakes and hidden tests; committed, ready to push.
"""
import argparse
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import labs

# What no student gets: the repository's own answers, an instructor's hidden items, and the tests of the grader itself.
EXCLUDED = re.compile(r"tests/grading/answers/|.*/lab_test_hidden\.cpp$|"
                      r"tests/grading/\w+_test\.py$|tests/grading/(selftest|page_figures)\.py$")
README = """# {lab} · {title}

Write the functions that [{contract}](include/{contract}) declares into [lab.cpp](lab.cpp). Their comments say what each
returns.
The folder [include](include) has all headers that lab.cpp may include, besides the standard library.

Check that it compiles:

```sh
g++ -std=c++20 -Wall -Wextra -I include -c lab.cpp -o /dev/null
```

The line `not_attempted();` tells the grader that a function is not begun. Remove it when you begin.
Hand in lab.cpp. Further .cpp and .h files beside it are fine: hand in the folder then.
"""


def check_empty(out):
    if out.exists() and any(out.iterdir()):
        raise labs.Unusable(f"{out} is not empty; expected a folder that does not exist yet")


def replace_folder(made, out):
    """Puts a folder that was made beside it in the place of an earlier export: it is whole or absent."""
    if out.exists():
        shutil.rmtree(out)
    made.rename(out)


def write_handout(lab_id, folder):
    """One lab's folder: lab.cpp, include/, README.md."""
    folder.mkdir(parents=True)
    contract = labs.stage(lab_id, folder / "include")
    shutil.copyfile(labs.folder_of(lab_id) / "lab_starter.cpp", folder / "lab.cpp")
    text = README.format(lab=lab_id, title=labs.title_of(lab_id), contract=contract)
    (folder / "README.md").write_text(text, encoding="utf-8")


def write_template(folder):
    """The repository as git tracks it, without what is kept back, and its first commit."""
    listing = subprocess.run(["git", "ls-files", "-z"], cwd=labs.SOURCE, capture_output=True, text=True, check=False)
    if listing.returncode != 0:
        raise labs.Unusable(f"{labs.SOURCE} is no git clone; a template has the files that git tracks, so expected one")
    listed = listing.stdout
    for name in filter(None, listed.split("\0")):
        if not EXCLUDED.match(name) and (labs.SOURCE / name).is_file():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(labs.SOURCE / name, folder / name)
    for path in labs.all_folders().values():
        starter = folder / path.relative_to(labs.SOURCE) / "lab_starter.cpp"
        if starter.exists():  # git tracks this lab
            shutil.copyfile(starter, starter.with_name("lab.cpp"))
    ignored = folder / ".gitignore"  # the project ignores lab.cpp, students hand it in
    lines = ignored.read_text().splitlines(keepends=True)
    ignored.write_text("".join(line for line in lines if line.strip() != "lab.cpp"))
    git = ["git", "-c", "user.name=Course", "-c", "user.email=course@localhost"]
    for command in (["git", "init", "-q", "-b", "main"], ["git", "add", "-A"],
                    [*git, "commit", "-q", "-m", "Start of the course"]):
        subprocess.run(command, cwd=folder, check=True)


def main():
    parser = argparse.ArgumentParser(prog="export", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("handout", "template"))
    parser.add_argument("out", type=pathlib.Path, metavar="OUT", help="a folder that does not exist yet, or is empty")
    parser.add_argument("--labs", nargs="+", metavar="LAB", help="handout: these labs alone (default: all)")
    parser.add_argument("--replace", action="store_true", help="replace an earlier export at OUT")
    arguments = parser.parse_args()
    try:
        if not arguments.replace:
            check_empty(arguments.out)
        arguments.out.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=arguments.out.parent, prefix=".export-") as scratch:
            made = pathlib.Path(scratch) / "made"
            made.mkdir()
            if arguments.what == "template":
                write_template(made)
            else:
                for lab_id in arguments.labs or labs.all_folders():
                    write_handout(lab_id, made / lab_id)
            replace_folder(made, arguments.out)
    except labs.Unusable as error:
        print(f"export: {error}", file=sys.stderr)
        return 2
    except (OSError, subprocess.SubprocessError) as error:
        print(f"export: {arguments.out} could not be written: {error}", file=sys.stderr)
        return 1
    print(f"The {arguments.what}: {arguments.out}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
