"""The labs of the course: where each lies, and how a submission becomes a program that the examiner can call."""
import hashlib
import os
import pathlib
import re
import resource
import shutil
import subprocess

SOURCE = pathlib.Path(__file__).resolve().parents[2]
COMPILER = os.environ.get("CXX", "g++")
COMPILE_SECONDS = 60
COMPILE_MEMORY = 3 << 30
INCLUDE = re.compile(r"^[ \t]*(?:#|%:|\?\?=)[ \t]*(include|include_next|import|embed)\b[ \t]*(.*)", re.MULTILINE)


class Unusable(Exception):
    """Arguments that can't be graded: what was found, what was expected."""


class Refused(Exception):
    """A submission that can't be compiled, or may not be: the reason, for the student."""


def folder_of(lab_id):
    """The folder of a lab such as raytrace-05 or assignment-2."""
    room, _, number = lab_id.rpartition("-")
    base = SOURCE / ("compare/lessons/assignments" if room == "assignment" else f"{room}/lessons")
    found = sorted(base.glob(f"{number}-*")) if number else []
    if not found or not (found[0] / "lab.h").exists():
        raise Unusable(f"there is no lab {lab_id}; the labs are: {', '.join(all_ids())}")
    return found[0]


def all_ids():
    """The ids of all labs."""
    ids = []
    for room in ("raytrace", "raster", "compare"):
        ids += [f"{room}-{path.parent.name[:2]}" for path in sorted(SOURCE.glob(f"{room}/lessons/[0-9][0-9]-*/lab.h"))]
    assignments = sorted(SOURCE.glob("compare/lessons/assignments/[0-9]-*/lab.h"))
    return ids + [f"assignment-{path.parent.name.split('-')[0]}" for path in assignments]


def headers_of(path, known=None):
    """A header of the repository and all that it includes, as paths from the top of the repository."""
    known = set() if known is None else known
    if path not in known:
        known.add(path)
        for name in re.findall(r'^#include "([^"]+)"', (SOURCE / path).read_text(), re.MULTILINE):
            headers_of(name, known)
    return known


def stage(lab_id, folder):
    """Copies what a submission may include, and nothing else, into a folder of its own."""
    contract = str((folder_of(lab_id) / "lab.h").relative_to(SOURCE))
    for name in headers_of(contract) | headers_of("common/image/image.h") | headers_of("common/vec/matrix.h"):
        target = folder / name
        target.parent.mkdir(parents=True, exist_ok=True)
        if not target.exists() or target.read_bytes() != (SOURCE / name).read_bytes():
            shutil.copyfile(SOURCE / name, target)
    return contract


def submitted_files(path):
    """A submission is one .cpp file, or a folder of .cpp and .h files."""
    if not path.exists():
        raise Unusable(f"{path}: there is no such file or folder; expected a lab.cpp, or a folder with one")
    files = sorted(path.glob("*.cpp")) + sorted(path.glob("*.h")) if path.is_dir() else [path]
    if not any(file.suffix == ".cpp" for file in files):
        raise Unusable(f"{path}: found no .cpp file; expected a lab.cpp")
    return files


def check_text(files, staged):
    """Refuses includes of what a submission may not read, and assembler, which could embed any file."""
    own = {file.name for file in files}
    for file in files:
        text = file.read_text(errors="replace").replace("\\\n", "")
        for match in INCLUDE.finditer(text):
            directive, name = match.group(1), match.group(2).strip()
            system = re.fullmatch(r"<[a-z0-9_]+(\.h)?>\s*(//.*|/\*.*)?", name)
            quoted = re.fullmatch(r'"([^"]+)"\s*(//.*|/\*.*)?', name)
            ours = quoted and not re.match(r"/|.*\.\.", quoted[1]) and (quoted[1] in own or (staged / quoted[1]).exists())
            if directive != "include" or not (system or ours):
                raise Refused(f"{file.name} includes {name}, which a submission may not: expected the lab's lab.h, the "
                              "headers that it includes, files of your own, or the standard library")
        if re.search(r"\b(asm|__asm|__asm__)\b|\.incbin|_Pragma|#\s*pragma\s+GCC", text):
            raise Refused(f"{file.name} uses assembler or compiler pragmas, which a submission may not")


def limited():
    """In the compiler's process: endless templates must not take the computer down."""
    resource.setrlimit(resource.RLIMIT_AS, (COMPILE_MEMORY, COMPILE_MEMORY))
    resource.setrlimit(resource.RLIMIT_CPU, (COMPILE_SECONDS, COMPILE_SECONDS))


def compile_command(arguments, what):
    """Runs the compiler. Raises Refused with its first error."""
    try:
        done = subprocess.run([COMPILER, "-std=c++20", "-O1", "-ffp-contract=off", "-w", *arguments], text=True,
                              errors="replace", capture_output=True, timeout=COMPILE_SECONDS + 10, preexec_fn=limited,
                              check=False)
    except subprocess.TimeoutExpired as error:
        raise Refused(f"{what}: the compiler needs more than {COMPILE_SECONDS} s; is there endless template recursion?"
                      ) from error
    if done.returncode != 0:
        lines = done.stderr.splitlines()
        first = next((i for i, line in enumerate(lines) if "error" in line or "undefined reference" in line), 0)
        shown = "\n".join(line[:300] for line in lines[first:first + 4])
        raise Refused(f"{what} doesn't compile. The compiler's first error:\n{shown}" if lines else
                      f"{what} doesn't compile: the compiler was ended (too much memory or time)")


def worker_object(lab_id, staged, contract):
    """The worker's own half: it depends on the contract alone, and is compiled once for all submissions."""
    sources = ["tests/grading/worker.cpp", "tests/grading/channel.h", "tests/grading/wire.h"]
    digest = hashlib.sha256(b"".join((SOURCE / name).read_bytes() for name in sorted(headers_of(contract)) + sources))
    target = staged.parent / f"worker-{digest.hexdigest()[:16]}.o"
    if not target.exists():
        partial = target.with_suffix(f".{os.getpid()}")
        compile_command(["-I", str(SOURCE), f'-DDUET_LAB_HEADER="{contract}"', "-c", str(SOURCE / sources[0]), "-o",
                         str(partial)], f"the contract of {lab_id}")
        partial.rename(target)
    return target


def build_worker(lab_id, path, build, out, trusted=False):
    """Compiles a submission into a worker program in `out`, and returns its path. `trusted` (for the repository's own
    answers) may include and link the whole project."""
    staged = build / "lessons" / "grading" / lab_id / "include"
    contract = stage(lab_id, staged)
    files = submitted_files(path)
    if not trusted:
        check_text(files, staged)
    worker = worker_object(lab_id, staged, contract)
    program = out / "worker"
    sources = [str(file) for file in files if file.suffix == ".cpp"]
    if trusted:
        libraries = [str(build / name) for name in ("libduet_raster.a", "libduet_raytrace.a", "libduet_common.a",
                                                    "libduet_image.a") if (build / name).exists()]
        compile_command(["-march=native", "-I", str(SOURCE), *sources, str(worker), *libraries, "-ltbb", "-lOpenEXR-3_1",
                         "-lpthread", "-o", str(program)], path.name)
    else:
        include = ["-I", str(staged)] + (["-I", str(path)] if path.is_dir() else [])
        compile_command([*include, *sources, str(worker), "-static", "-o", str(program)], path.name)
    return program
