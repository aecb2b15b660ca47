"""What the course consists of: its rooms, its lessons and their files, read from the folders. Also the other pages."""
import pathlib
import re

SOURCE = pathlib.Path(__file__).resolve().parents[2]
ROOMS = {"raytrace": "Ray tracing", "raster": "Rasterization", "compare": "Both ways"}


def code_lines(path):
    """The number of a source file's lines of code. Blank lines and lines of nothing but a comment don't count, so that
    nobody leaves them out to stay below the limit."""
    lines = (line.strip() for line in path.read_text(encoding="utf-8").splitlines())
    return sum(bool(line) and not line.startswith("//") for line in lines)


class Lesson:
    """A folder such as raytrace/lessons/02-sphere, whose id is raytrace-02."""

    def __init__(self, folder):
        self.folder = folder
        self.room = folder.parent.parent.name
        self.number = folder.name[:2]
        self.id = f"{self.room}-{self.number}"
        self.page = folder / "README.md"

    def program_files(self):
        """The files of the lesson's program: lesson.cpp and the headers that it adds, without those of the lab."""
        return sorted(path for path in self.folder.iterdir()
                      if path.suffix in (".cpp", ".h") and not path.name.startswith("lab"))

    def program_lines(self):
        return sum(code_lines(path) for path in self.program_files())

    def figures(self):
        return sorted((self.folder / "figures").glob("*.*"))

    def title(self):
        """The page's first heading without its number: "A ray meets a sphere"."""
        if not self.page.exists():
            return self.folder.name[3:].replace("-", " ")
        match = re.search(r"^# *(?:\d\d *· *)?(.+)$", self.page.read_text(encoding="utf-8"), re.MULTILINE)
        return match.group(1).strip() if match else self.folder.name

    def has_lab(self):
        return (self.folder / "lab.h").exists()


def lessons(source=SOURCE):
    """All lessons that have a program and a page, by room in the order above, then by number. A program without its
    page is a draft: no target builds it."""
    found = [Lesson(folder) for room in ROOMS for folder in sorted((source / room / "lessons").glob("[0-9][0-9]-*"))]
    return [lesson for lesson in found if (lesson.folder / "lesson.cpp").exists() and lesson.page.exists()]


HOUSE = ("common", "raster", "raytrace", "compare", "models", "tests", "gallery")


def other_pages(source=SOURCE):
    """All Markdown pages of the repository except those of lessons: the first page and the pages of each room."""
    of_lessons = {lesson.page for lesson in lessons(source)}
    drafts = {page for room in ROOMS for page in (source / room / "lessons").glob("[0-9][0-9]-*/*.md")}
    pages = [source / "README.md", *(page for room in HOUSE for page in (source / room).rglob("*.md"))]
    return sorted(page for page in pages if page.exists() and page not in of_lessons | drafts)


def pick(ids, source=SOURCE):
    """The lessons with these ids, all without any. Ends the program where one does not exist."""
    known = lessons(source)
    for wanted in ids:
        if wanted not in [lesson.id for lesson in known]:
            raise SystemExit(f"{wanted}: no such lesson, expected one of {', '.join(x.id for x in known)}")
    return [lesson for lesson in known if not ids or lesson.id in ids]
