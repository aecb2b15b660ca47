"""A lesson's program builds without the rest of the project: of its object files and libraries only images and what
they stand on (common/image, common/system) are the project's.

usage: alone_test.py BUILD_DIR
"""
import pathlib
import re
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "compare" / "lessons"))
import course  # noqa: E402


def commands_of(build, target):
    """All commands that make a target from nothing."""
    ninja = re.search(r"CMAKE_MAKE_PROGRAM:\w+=(.+)", (build / "CMakeCache.txt").read_text()).group(1)
    return subprocess.run([ninja, "-C", build, "-t", "commands", target], capture_output=True, text=True,
                          check=True).stdout


def main():
    build, faults, lessons = pathlib.Path(sys.argv[1]), [], course.lessons()
    for lesson in lessons:
        commands = commands_of(build, f"lesson-{lesson.id}")
        sources = set(re.findall(r" -c \S*?/((?:common|raster|raytrace|compare|models|tests)/\S+)", commands))
        own = str(lesson.folder.relative_to(course.SOURCE)) + "/lesson.cpp"
        for source in sorted(sources):
            if source != own and not re.match(r"common/(image|system)/", source):
                faults.append(f"lesson-{lesson.id} compiles {source}")
        if own not in sources:
            faults.append(f"lesson-{lesson.id} does not compile its own {own}")
        for library in sorted(set(re.findall(r"libduet_\w+", commands)) - {"libduet_image"}):
            faults.append(f"lesson-{lesson.id} links {library}")
    in_all = re.findall(r"lesson_\S+_program|judge-\S+", commands_of(build, "all"))
    if in_all:
        faults.append(f"the target all makes {in_all[0]}; expected no lesson and no lab")
    print("\n".join(faults) or f"each of {len(lessons)} lessons builds alone")
    sys.exit(1 if faults or not lessons else 0)


main()
