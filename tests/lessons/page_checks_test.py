"""Every check of compare/lessons/pages.py finds the fault that it is for, in a small repository made here, and finds
nothing wrong with a good page.

usage: page_checks_test.py SOURCE_DIR
"""
import json
import pathlib
import subprocess
import sys
import tempfile

SOURCE = pathlib.Path(sys.argv[1]).resolve()

PROGRAM = """// Draws a sphere.
#include "common/vec/vec.h"

using namespace duet;

namespace {

// The number of spheres.
int count() {
    const int spheres = 1;

    return spheres;
}

} // namespace

int main() {
    return count() - 1;
}
"""
PAGE = """# 02 · A sphere

A ray meets a sphere. The sphere is round. The picture shows it.

![A sphere under a sky](figures/evidence.png)

```sh
cmake --build build/release --target lesson-raytrace-02
```

## The mathematics

The equation is $x_0^2 + y^2 = r^2$, and so

$$
t = \\frac{-b}{2a}
$$

## The program

<!-- quote lesson.cpp: int count -->

Then it ends.

<!-- quote lesson.cpp: int main -->

## What to look at

![The same sphere from above](figures/above.png)

## What goes wrong

See [the mathematics](#the-mathematics).

## Exercises

The lab: `cmake --build build/release --target lab-raytrace-02` grades it.

## In the library

It is [here](../../../raytrace/lessons/02-sphere/lesson.cpp).

## Sources

A book.

Next: [the same](README.md)
"""
FIRST_PAGE = """# A house

Its [lesson](raytrace/lessons/02-sphere/README.md) is about [spheres](#a-house).

```sh
cmake --build build/release --target lessons
```
"""
PRESETS = {"buildPresets": [{"name": "release"}]}


class Repository:
    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.lesson = self.folder / "raytrace" / "lessons" / "02-sphere"
        (self.lesson / "figures").mkdir(parents=True)
        (self.folder / "CMakePresets.json").write_text(json.dumps(PRESETS))
        (self.folder / "CMakeLists.txt").write_text("add_custom_target(lessons)\nduet_program(raytrace x.cpp)\n")
        (self.lesson / "lesson.cpp").write_text(PROGRAM)
        (self.lesson / "lab.h").write_text("#pragma once\n")
        (self.lesson / "README.md").write_text(PAGE)
        (self.folder / "README.md").write_text(FIRST_PAGE)
        for name in ("evidence", "above"):
            (self.lesson / "figures" / f"{name}.png").write_bytes(b"png")

    def pages(self, *arguments):
        result = subprocess.run([sys.executable, "-B", str(SOURCE / "compare" / "lessons" / "pages.py"), "--source",
                                 str(self.folder), *arguments], capture_output=True, text=True, check=False)
        if result.returncode not in (0, 1):
            sys.exit(f"pages.py ended with {result.returncode}: {result.stderr}")
        return result.returncode, result.stdout


# What is changed in which file, and a part of what must be said then.
FAULTS = [
    ("README.md", "A ray meets", "A ray meeets", "'meeets' is in no dictionary"),
    ("README.md", "is round", "is grey", "'grey' is British, expected 'gray'"),
    ("README.md", "# 02 · A sphere", "# 03 · A sphere", "expected '# 02 · …'"),
    ("README.md", "## Exercises", "## Tasks", "no section '## Exercises'"),
    ("README.md", "## What goes wrong", "## Sources\n\n## What goes wrong", "the section 'Sources' comes too early"),
    ("README.md", "figures/above.png", "figures/below.png", "the link figures/below.png leads nowhere"),
    ("README.md", "figures/above.png", "figures/evidence.png", "shows 1 figures, expected at least two"),
    ("README.md", "figures/above.png", "figures/evidence.png", "figures/above.png is not shown"),
    ("README.md", "![A sphere under a sky]", "![sky]", "the alternative text 'sky'"),
    ("README.md", "(#the-mathematics)", "(#mathematics)", "has no heading #mathematics"),
    ("README.md", "--target lesson-raytrace-02", "--target lesson-raytrace-07",
     "'--target lesson-raytrace-07': no such target"),
    ("README.md", "--target lab-raytrace-02", "--target lab-raytrace-03", "'--target lab-raytrace-03': no such target"),
    ("README.md", "build/release --target lesson", "build/relaese --target lesson", "no such preset"),
    ("README.md", "A book.", "```sh\nbuild/release/bin/rasterise x\n```", "no program of that name"),
    ("README.md", "A book.", "```sh\npython3 tests/none.py\n```", "'tests/none.py': no such script"),
    ("README.md", "A book.", "```sh\nfrobnicate --all\n```", "'frobnicate' is no program"),
    ("README.md", "A book.", "```sh\nls models/none.json\n```", "'models/none.json': no such file"),
    ("README.md", "A book.", "```sh\nls", "this code block is never closed"),
    ("README.md", "\\frac{-b}{2a}", "\\frac{-b{2a}", "KaTeX parse error"),
    ("README.md", "$x_0^2", "$\\unknown x_0^2", "Undefined control sequence: \\unknown"),
    ("README.md", "= r^2$", "= \\{r\\}^2$", "GitHub shows \\{ as {"),
    ("README.md", "$x_0^2 +", "$\\mathbf{v}_0$ is $w_{ab}$, $", "as emphasis"),
    ("README.md", "A book.", "```cpp\nint i;\n```\n\n## The program\n\n```cpp\nint j;\n```",
     "is not quoted by a marker"),
    ("README.md", "int count -->", "int counter -->", "no line of lesson.cpp contains 'int counter'"),
    ("README.md", "lesson.cpp: int main -->", "lesson.cpp: count() -->",
     "2 paragraphs of lesson.cpp contain 'count()'"),
    ("README.md", "lesson.cpp: int main -->", "sphere.h: int main -->", "no file sphere.h beside the page"),
    ("README.md", "<!-- quote lesson.cpp: int main -->", "", "the page quotes no line 17, 18, 19: 'int main() {'"),
    ("README.md", "Next: [the same](README.md)", "The end.", "does not end with 'Next:"),
    ("lesson.cpp", "    return count() - 1;", "    return count() - 1;" + "\n    count();" * 140,
     "the program has 151 lines of code"),
    ("lesson.cpp", "return count() - 1;", "return count() - 1; //" + " long" * 30, "columns, at most 120"),
    ("lesson.cpp", "spheres = 1", "spheres = 2", "a quote differs from its source"),
]
# The same of the repository's first page, which no lesson owns.
FIRST_PAGE_FAULTS = [
    ("raytrace/lessons/02-sphere/README.md", "raytrace/README.md", "the link raytrace/README.md leads nowhere"),
    ("(#a-house)", "(#the-house)", "has no heading #the-house"),
    ("build/release --target", "build/fast --target", "no such preset"),
    ("is about", "is abuot", "'abuot' is in no dictionary"),
    ("is about", "is about\n\n<!-- quote none.h: int -->\n\n", "no file none.h beside the page"),
]


def main():
    failures = []
    with tempfile.TemporaryDirectory() as folder:
        repository = Repository(folder)
        status, said = repository.pages("--write", "raytrace-02")
        if status != 0:
            failures.append(f"a good page has faults:\n{said}")
        page = (repository.lesson / "README.md").read_text()
        if ("```cpp\n// The number of spheres.\nint count() {\n    const int spheres = 1;\n\n"
                    "    return spheres;\n}\n```" not in page):
            failures.append(f"the quote of a function is not the whole function:\n{page}")
        if repository.pages("--write", "raytrace-02") and (repository.lesson / "README.md").read_text() != page:
            failures.append("filling in quotes twice changes the page")
        quotable = subprocess.run(["sh", "-c", "command -v hunspell && command -v node"], capture_output=True,
                                  check=False)
        all_faults = [(repository.lesson / file, ["raytrace-02"], *fault) for file, *fault in FAULTS]
        all_faults += [(repository.folder / "README.md", [], *fault) for fault in FIRST_PAGE_FAULTS]
        for path, arguments, old, new, expected in all_faults:
            needs_programs = any(word in expected for word in ("dictionary", "British", "KaTeX", "Undefined"))
            if quotable.returncode != 0 and needs_programs:
                continue
            good = path.read_text()
            if old not in good:
                failures.append(f"{path.name} has no '{old}' to change")
            path.write_text(good.replace(old, new, 1))
            status, said = repository.pages(*arguments)
            path.write_text(good)
            if status != 1 or expected not in said:
                failures.append(f"{path.name} with '{new}' for '{old}': expected '{expected}', found\n{said}")
    print("\n\n".join(failures) or f"{len(all_faults)} faults found, each by its check")
    sys.exit(1 if failures else 0)


main()
