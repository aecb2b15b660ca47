"""How a submission becomes a program that the examiner can call, or is refused with a reason.

The compiler runs without a sandbox, with limits. What it reads is checked: by the list of files that it opened, before
any message about their content is shown, and by the assembly, which could embed a file (.incbin).
"""
import contextlib
import functools
import hashlib
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import tempfile

import labs

COMPILE_SECONDS = 60
WALL_FACTOR = 5  # a compiler that waits for something uses no processor time
COMPILE_MEMORY = 2 << 30
MAX_SOURCE_BYTES = 1 << 20
MAX_OUTPUT_BYTES = 256 << 20
MAX_MESSAGE = 1 << 18
FLAGS = ["-std=c++20", "-O1", "-ffp-contract=off", "-w"]
WORKER = "tests/grading/worker.cpp"
FILE_NAME = re.compile(r"\w[\w., ()+-]*")
TEXT_DATA = re.compile(r'\s*\.(?:string|ascii|asciz)\s+"(?:[^"\\]|\\.)*"\s*')
FILE_DIRECTIVES = re.compile(r"\.(?:incbin|include|macro|irpc?|rept|altmacro)\b", re.IGNORECASE)
ERROR = re.compile(r"^(?:\./)?([^:\n]+):(\d+):(?:(\d+):)? (?:fatal )?error: ")
HINTS = [
    (r"multiple definition of `main'", "Your file has a main(); remove it, the grader has its own."),
    (r"multiple definition of `([^']+)'",
     r"\1 is defined twice: in your file, and in the grader or another of your files."),
    (r"template instantiation depth", "A template uses itself without an end."),
]


class Refused(Exception):
    """A submission that can't be compiled, or may not be: the reason, for the student."""


@functools.lru_cache(maxsize=None)
def build_settings(build):
    """What CMake wrote down for the grader: the compiler, and the libraries of the repository's own answers."""
    file = build / "lessons" / "grading" / "build.json"
    if not file.exists():
        raise labs.Unusable(f"{build} is no build folder with a grader; run: cmake --preset release")
    return json.loads(file.read_text(encoding="utf-8"))


@functools.lru_cache(maxsize=None)
def system_folders(compiler):
    """Where the compiler's own headers lie."""
    said = subprocess.run([compiler, "-E", "-v", "-x", "c++", "/dev/null"], text=True, capture_output=True,
                          check=True).stderr
    listed = said.split("#include <...> search starts here:")[1].split("End of search list.")[0]
    return [pathlib.Path(line.strip()).resolve() for line in listed.strip().splitlines()]


def quoted_line(folder, name, line, column):
    """A line of a submitted file with a mark below it, as compilers show it. They would show any file of this computer,
    if a #line directive names it; this shows none but those of the submission."""
    file = folder / name
    if "/" in name or not file.is_file():
        return []
    lines = file.read_text(errors="replace").splitlines()
    if not 1 <= line <= len(lines):
        return []
    mark = [" " * 8 + " " * (column - 1) + "^"] if column else []
    return [f"{line:5} | {lines[line - 1].expandtabs(8)[:200]}", *(text for text in mark if len(text) < 200)]


def undefined_names(text):
    """What to tell of functions that are called and not defined; empty where there are none."""
    names = dict.fromkeys(re.findall(r"undefined reference to `(.+?)'$", text, re.MULTILINE))
    of_the_lab = [match[1] for name in names if (match := re.match(r"duet::lab::(\w+)", name))]
    if of_the_lab:
        return (f"The submission doesn't define {', '.join(of_the_lab)} as lab.h declares "
                f"{'it' if len(of_the_lab) == 1 else 'them'}: "
                "with the same name, arguments and result, inside namespace duet::lab.")
    return f"{next(iter(names))} is declared and called, but nowhere defined." if names else ""


def plain_error(text, folder):
    """The compiler's first error, as short as it is useful, with a hint where the cause is a common one."""
    lines = [line.replace(f"{folder}/", "") for line in text.splitlines()]
    first = next((line for line in lines if re.search(r"error:|multiple definition", line)), lines[0] if lines else "")
    first = re.sub(r"^.*/ld: (?:\S+: in function [^:]*: ?)?", "", first).removeprefix("./")[:300]
    shown = [first]
    if match := ERROR.match(first):
        shown += quoted_line(folder, match[1], int(match[2]), int(match[3] or 0))
    hints = [match.expand(hint) for pattern, hint in HINTS if (match := re.search(pattern, first))]
    return "\n".join(shown + hints[:1])


def run_limited(command, folder):
    """Runs a command with limits. Returns its exit code, None where it took too long, and what it said first."""
    limits = ["prlimit", f"--as={COMPILE_MEMORY}", f"--cpu={COMPILE_SECONDS}", f"--fsize={MAX_OUTPUT_BYTES}",
              "--core=0"]
    with tempfile.TemporaryFile() as said: # no pipe: the size of a file is limited
        process = subprocess.Popen([*limits, *command], cwd=folder, stdin=subprocess.DEVNULL, stdout=said, stderr=said,
                                   start_new_session=True)
        try:
            code = process.wait(timeout=WALL_FACTOR * COMPILE_SECONDS)
        except subprocess.TimeoutExpired:
            code = None
        finally:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
            process.wait()
        said.seek(0)
        return code, said.read(MAX_MESSAGE).decode(errors="replace")


def run_compiler(build, arguments, what, folder):
    """Runs the compiler with limits. Raises Refused with its first error."""
    code, said = run_limited([build_settings(build)["compiler"], *FLAGS, *arguments], folder)
    if code == 0:
        return
    if code is None or re.search(r"signal terminated program|memory exhausted|out of memory", said):
        raise Refused(f"{what} can't be compiled within {COMPILE_SECONDS} s, {COMPILE_MEMORY >> 30} GiB of memory and "
                      f"{MAX_OUTPUT_BYTES >> 20} MiB of program. Is there a template without end, or a huge array?")
    if undefined := undefined_names(said):
        raise Refused(undefined)
    missing = re.search(r"^(?:\./)?(\S+?):(\d+):\d+: fatal error: (.*): (?:No such file|Permission|Is a dir)", said,
                        re.MULTILINE)
    if missing:
        raise Refused(f"{missing[1]}, line {missing[2]}, includes {missing[3]}, which a submission may not. {ALLOWED}")
    raise Refused(f"{what} doesn't compile. The compiler's first error:\n{plain_error(said, folder)}")


ALLOWED = "Allowed are: the lab's lab.h and what it includes, common/vec, common/image/image.h, headers of earlier " \
    "lessons, files of your own, and the standard library."


def copy_submission(files, folder):
    """Copies the submitted files, so that nothing beside them can be included by a relative path or a link. A file that
    is alone may have any name: who collects submissions names it. Returns the copies."""
    folder.mkdir()
    copies = []
    for file in files:
        if file.is_symlink() or file.parent.is_symlink() or not file.is_file():
            raise Refused(f"{file.name} is no plain file; a submission may hold no links or devices")
        name = "lab.cpp" if len(files) == 1 and not FILE_NAME.fullmatch(file.name) else file.name
        if not FILE_NAME.fullmatch(name):
            raise Refused(f"{file.name!r} is no name for a file of a submission; expected letters, digits, '.', '_' "
                          f"and '-'")
        if file.stat().st_size > MAX_SOURCE_BYTES:
            raise Refused(f"{file.name} has {file.stat().st_size} bytes; at most {MAX_SOURCE_BYTES} are compiled")
        shutil.copyfile(file, folder / name)
        copies.append(folder / name)
    return copies


def check_files_read(listing, allowed):
    """Refuses a submission for which the compiler opened a file outside the allowed folders."""
    names = re.split(r"(?<!\\)\s+", listing.read_text(errors="replace").replace("\\\n", " ").partition(":")[2].strip())
    for name in names:
        path = (listing.parent / name.replace("\\ ", " ").replace("\\#", "#").replace("$$", "$")).resolve()
        if not any(path.is_relative_to(folder) for folder in allowed):
            raise Refused(f"The submission includes {name}, which a submission may not. {ALLOWED}")


def check_preprocessed(file):
    """Refuses the line by which a compiler loads a precompiled header: that is a part of its own memory."""
    if "pch_preprocess" in file.read_text(errors="replace"):
        raise Refused("The submission loads a precompiled header, which a submission may not.")


def check_assembly(file):
    """Refuses assembler of the student's: its directives could embed any file into the program."""
    for line in file.read_text(errors="replace").splitlines():
        if line.startswith("#APP") or (FILE_DIRECTIVES.search(line) and not TEXT_DATA.fullmatch(line)):
            raise Refused("The submission uses assembler, which a submission may not.")


def compile_source(build, source, include, allowed):
    """Preprocesses, compiles and checks one of the student's files. Returns the assembly file."""
    folder, name = source.parent, source.name
    listing, preprocessed, assembly = (source.with_suffix(suffix) for suffix in (".d", ".ii", ".s"))
    try:
        run_compiler(build, [*include, "-E", "-MD", "-MF", f"./{listing.name}", f"./{name}", "-o",
                             f"./{preprocessed.name}"], name, folder)
    except Refused as refused: # an error in a file that may not be read must not show its content
        where = re.search(r"first error:\n([^:\n]*):", str(refused))
        if where and not any((folder / where[1]).resolve().is_relative_to(path) for path in allowed):
            raise Refused(f"The submission includes {where[1]}, which a submission may not. {ALLOWED}") from None
        raise
    check_files_read(listing, allowed)
    check_preprocessed(preprocessed)
    run_compiler(build, ["-S", f"./{preprocessed.name}", "-o", f"./{assembly.name}"], name, folder)
    check_assembly(assembly)
    return assembly


def worker_object(lab_id, build, folder, contract):
    """The worker's own half: it depends on the contract alone, and is compiled once for all submissions."""
    read = sorted(labs.headers_of(contract) | labs.headers_of(WORKER))
    digest = hashlib.sha256(b"".join((labs.SOURCE / name).read_bytes() for name in read)).hexdigest()[:16]
    target = folder / f"worker-{digest}.o"
    if not target.exists():
        partial = target.with_suffix(f".{os.getpid()}")
        run_compiler(build, ["-I", str(labs.SOURCE), f'-DDUET_LAB_HEADER="{contract}"', "-c", str(labs.SOURCE / WORKER),
                             "-o", str(partial)], f"the contract of {lab_id}", folder)
        for outdated in folder.glob("worker-*.o"):
            outdated.unlink(missing_ok=True)
        partial.rename(target)
    return target


def prepare(lab_id, build):
    """Makes what all submissions of a lab share, before several are compiled at the same time."""
    shared = build / "lessons" / "grading" / lab_id
    worker_object(lab_id, build, shared, labs.stage(lab_id, shared / "include"))


def build_worker(lab_id, path, build, out):
    """Compiles a submission into a worker program in the empty folder `out`, and returns the program's path."""
    shared = build / "lessons" / "grading" / lab_id
    contract = labs.stage(lab_id, shared / "include")
    files = labs.submitted_files(path)
    own = out / "submission"
    copies = copy_submission(files, own)
    allowed = [own.resolve(), (shared / "include").resolve(), *system_folders(build_settings(build)["compiler"])]
    include = ["-I", str(shared / "include"), "-iquote", str(own)]
    assembled = [compile_source(build, file, include, allowed) for file in copies if file.suffix == ".cpp"]
    worker = worker_object(lab_id, build, shared, contract)
    # -fno-lto: sections of a linker plugin, which a submission could write itself, would start another compiler
    run_compiler(build, ["-static", "-fno-lto", str(worker), *map(str, assembled), "-o", str(out / "worker")],
                 path.name, own)
    return out / "worker"


def build_trusted_worker(lab_id, path, build, out):
    """Compiles one of the repository's own answers, which may include and link the whole project."""
    shared = build / "lessons" / "grading" / lab_id
    worker = worker_object(lab_id, build, shared, labs.stage(lab_id, shared / "include"))
    libraries = [name
                 for name in build_settings(build)["libraries"] if name.startswith("-") or pathlib.Path(name).exists()]
    run_compiler(build, ["-march=native", "-I", str(labs.SOURCE), str(path.resolve()), str(worker), *libraries, "-o",
                         str(out / "worker")], path.name, out)
    return out / "worker"
