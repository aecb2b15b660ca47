"""Commands on Markdown pages: the programs, targets, presets, scripts, options and files that they name must exist."""
import functools
import json
import re
import shlex
import subprocess

import course
import markdown

# What a reader's system has.
COMMON = {"apt-get", "cat", "cd", "chromium", "clang-format", "cp", "diff", "echo", "firefox", "g++", "gdb", "git",
          "head",
          "ls", "mkdir", "mv", "node", "open", "perf", "pip", "rm", "tail", "time", "unzip", "xargs", "xdg-open",
          "zip"}
PROGRAMS = ("raster", "raytrace", "compare")
OURS = re.compile(r"(common|raster|raytrace|compare|models|tests)/")
# The build writes these, so they need not exist.
BUILT = ("models/generated/",)
OPTION = re.compile(r"(?<![\w-])(--[a-z][a-z0-9-]*|-[A-Za-z])(?![\w-])")


@functools.lru_cache(maxsize=None)
def targets(source):
    """The names of the build's targets, as the CMake files say them, and those of each lesson."""
    names = {"all", "clean", "test"}
    for file in [source / "CMakeLists.txt", *source.glob("[a-z]*/**/CMakeLists.txt"),
                 *source.glob("[a-z]*/**/*.cmake")]:
        if "build" not in file.relative_to(source).parts:
            text = file.read_text(encoding="utf-8")
            names.update(re.findall(
                r"(?:add_custom_target|add_executable|add_library|duet_program|duet_room)\(([\w-]+)", text))
            names.update(re.findall(r"CONFIGURE OUTPUT \$\{CMAKE_RUNTIME_OUTPUT_DIRECTORY\}/([\w-]+)", text))  # scripts
    for lesson in course.lessons(source):
        names.add(f"lesson-{lesson.id}")
        if lesson.has_lab():
            names.update((f"lab-{lesson.id}", f"judge-{lesson.id}"))
    for contract in (source / "compare" / "lessons" / "assignments").glob("*/lab.h"):
        number = contract.parent.name.split("-")[0]
        names.update((f"lab-assignment-{number}", f"judge-assignment-{number}"))
    names.update(target.stem for target in (source / "tests" / "fuzz").glob("*_fuzz.cpp"))
    return names


@functools.lru_cache(maxsize=None)
def presets(source):
    return {preset["name"] for preset in json.loads((source / "CMakePresets.json").read_text())["buildPresets"]}


@functools.lru_cache(maxsize=None)
def help_of(*command):
    """What a program says of itself; empty where it isn't built or has no such subcommand."""
    try:
        result = subprocess.run([*command, "--help"], capture_output=True, text=True, timeout=30, check=False)
    except (OSError, subprocess.TimeoutExpired):
        return ""
    return result.stdout if result.returncode == 0 else ""


class Commands:
    """Checks commands against the sources and, where `programs` is the folder of the built programs, their --help."""

    def __init__(self, source, programs=None):
        self.source, self.programs, self.folders = source, programs, presets(source)

    def faults(self, text):
        """(line, what) of a page's fenced sh blocks and of commands between backticks. Build folders are those of the
        presets, and those that the page itself configures (cmake -B build/fuzz)."""
        self.folders = presets(self.source) | set(re.findall(r"-B build/([\w-]+)", text))
        blocks, rest = markdown.blocks(markdown.without_comments(text))
        lines = []
        for start, language, body in blocks:
            if body is None:
                lines.append((start, None))
            elif language in ("sh", "bash", "shell", "console"):
                joined = body.replace("\\\n", "  ")
                lines += [(start + 1 + i, line) for i, line in enumerate(joined.split("\n"))]
        lines += [(line, code) for line, code in markdown.inline_codes(rest)
                  if re.match(r"(cmake|ctest|sh|python3|build/\S+/bin/\S+) ", code)]
        return [(number, fault) for number, line in lines for fault in self.of_line(line)]

    def of_line(self, line):
        if line is None:
            return ["this code block is never closed"]
        try:
            words = shlex.split(line.removeprefix("$ "), comments=True)
        except ValueError as error:
            return [f"'{line}': {error}"]
        commands, current = [], []
        for word in [*words, "&&"]:
            if word in ("&&", "||", "|", ";", "&"):
                commands.append(current)
                current = []
            else:
                current.append(word)
        return [fault for command in commands if command for fault in self.of_command(command)]

    def of_command(self, words):
        while words and (words[0] in ("sudo", "time", "env") or re.match(r"\w+=", words[0])):
            words = words[1:]
        if not words:
            return []
        name, rest = words[0], words[1:]
        if name in ("cmake", "ctest"):
            return self.of_build(words)
        if name in ("sh", "bash", "python3"):
            return self.of_script(rest)
        program = re.fullmatch(r"(?:\./)?build/([\w-]+)/bin/((?:tools/)?[\w-]+)", name)
        if program or name in PROGRAMS:
            return self.of_program(program, name, rest) + self.of_files(rest)
        lesson = re.fullmatch(r"(?:\.\./)?build/[\w-]+/lessons/bin/lesson_(\w+-\d\d)_program", name)
        if lesson:
            return self.of_lesson(lesson.group(1), rest)
        if name in COMMON:
            return self.of_files(rest) if name not in ("cp", "mv", "mkdir") else []
        return [f"'{name}' is no program of the project (compare/lessons/commands.py lists the system's)"]

    def of_build(self, words):
        faults = []
        for option, value in zip(words, words[1:]):
            preset = value if option == "--preset" else re.sub(r"^build/", "", value) if option == "--build" else None
            known = self.folders if option == "--build" else presets(self.source)
            if preset is not None and preset not in known and preset != "--preset":
                faults.append(f"'{option} {value}': no such preset, expected one of {', '.join(sorted(known))}")
        if "--target" in words:
            for target in words[words.index("--target") + 1:]:
                if target.startswith("-"):
                    break
                if target not in targets(self.source):
                    faults.append(f"'--target {target}': no such target")
        return faults

    def of_script(self, words):
        words = [word for i, word in enumerate(words) if i > 0 or not re.fullmatch(r"-\w+", word)]
        if not words or words[0] == "-c":
            return []
        script = self.source / words[0]
        if not script.is_file():
            return [f"'{words[0]}': no such script"]
        faults = self.of_files(words[1:])
        if script.suffix == ".py":
            faults += self.of_options(words, help_of("python3", "-B", str(script)), words[1:])
        return faults

    def of_program(self, program, name, words):
        if program and program.group(1) not in self.folders:
            return [f"'{name}': no such preset"]
        short = name.split("/")[-1]
        if short not in targets(self.source):
            return [f"'{name}': the build has no program of that name"]
        path = self.programs and self.programs / (program.group(2) if program else name)
        if not path or not path.exists():
            return []
        path, subcommand = str(path), []
        if words and re.fullmatch(r"[a-z-]+", words[0]) and help_of(path, words[0]):
            subcommand = [words[0]]
        elif short == "compare" and words and not words[0].startswith("-"):
            return [f"'{short} {words[0]}': no such subcommand"]
        return self.of_options([short, *subcommand], help_of(path, *subcommand) + help_of(path), words)

    def of_lesson(self, lesson_id, words):
        """A lesson has this program and, where it is built, these options (common/system/parameters.h)."""
        if f"lesson-{lesson_id}" not in targets(self.source):
            return [f"'{lesson_id}': no such lesson"]
        program = f"lesson_{lesson_id}_program"
        path = self.programs and self.programs.parent / "lessons" / "bin" / program
        return self.of_options([program], help_of(str(path)) if path else "", words)

    def of_options(self, command, text, words):
        known = set(OPTION.findall(text)) | {"--help", "-h"}
        used = [word.split("=")[0] for word in words if OPTION.fullmatch(word.split("=")[0])]
        return [f"'{' '.join(command[:2])}' has no option {option}" for option in used if text and option not in known]

    def of_files(self, words):
        """The project's own files among arguments exist. A student makes lab.cpp."""
        return [f"'{word}': no such file" for word in words if OURS.match(word)
                and not word.startswith(BUILT) and not (self.source / word).exists() and not word.endswith("/lab.cpp")]
