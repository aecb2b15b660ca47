"""The labs of the course: where each lies, and which headers its submissions may include."""
import functools
import os
import pathlib
import re
import shutil

SOURCE = pathlib.Path(__file__).resolve().parents[2]
ROOMS = ("raytrace", "raster", "compare")
# Headers of the repository that need no library: what a submission may include beside the lab's contract.
HEADER_ONLY = re.compile(r"common/vec/|common/image/(image|rgb)\.h|common/system/(error|huge_pages)\.h|\w+/lessons/")


class Unusable(Exception):
    """Arguments that can't be graded: what was found, what was expected."""


def all_folders():
    """Each lab's folder by its id, in the order of the course."""
    folders = {}
    for room in ROOMS:
        for contract in sorted(SOURCE.glob(f"{room}/lessons/[0-9][0-9]-*/lab.h")):
            folders[f"{room}-{contract.parent.name[:2]}"] = contract.parent
    for contract in sorted(SOURCE.glob("compare/lessons/assignments/[0-9]-*/lab.h")):
        folders[f"assignment-{contract.parent.name[0]}"] = contract.parent
    return folders


def folder_of(lab_id):
    """The folder of a lab such as raytrace-05 or assignment-2."""
    folders = all_folders()
    if lab_id not in folders:
        raise Unusable(f"there is no lab '{lab_id}'; the labs are: {', '.join(folders)}")
    return folders[lab_id]


def title_of(lab_id):
    """The title that the lab's examiner has."""
    test = folder_of(lab_id) / "lab_test.cpp"
    match = re.search(r'LAB_TITLE\("[^"]*",\s*"([^"]*)"\)', test.read_text(encoding="utf-8")) if test.exists() else None
    return match[1] if match else lab_id


@functools.lru_cache(maxsize=None)
def headers_of(path):
    """A header of the repository and all that it includes, as paths from the top of the repository."""
    known, waiting = set(), [path]
    while waiting:
        name = waiting.pop()
        if name not in known and (SOURCE / name).is_file():
            known.add(name)
            waiting += re.findall(r'^#include "([^"]+)"', (SOURCE / name).read_text(encoding="utf-8"), re.MULTILINE)
    return frozenset(known)


def stands_alone(path):
    """Whether a header can be used without a library of the project or of others."""
    text = "".join((SOURCE / name).read_text(encoding="utf-8") for name in headers_of(path))
    return all(HEADER_ONLY.match(name) for name in headers_of(path)) and "#include <xsimd" not in text


def earlier_lessons(folder):
    """The folders of the same room's earlier lessons; for labs in compare/, none: their contract names what they
    use."""
    if folder.parent.parent.name == "compare":
        return []
    return [other for other in sorted(folder.parent.iterdir()) if other.is_dir() and other.name[:2] < folder.name[:2]]


def allowed_headers(lab_id):
    """What a submission may include: the contract and its includes, vectors, images, and earlier lessons' headers."""
    folder = folder_of(lab_id)
    contract = str((folder / "lab.h").relative_to(SOURCE))
    candidates = [*(SOURCE / "common" / "vec").glob("*.h"), SOURCE / "common" / "image" / "image.h"]
    for earlier in earlier_lessons(folder):
        candidates += [path for path in earlier.glob("*.h") if not path.name.startswith("lab")]
    names = [str(path.relative_to(SOURCE)) for path in candidates]
    return headers_of(contract).union(*(headers_of(name) for name in names if stands_alone(name)))


@functools.lru_cache(maxsize=None)
def stage(lab_id, folder):
    """Copies what a submission may include, and nothing else, into a folder of its own. Returns the contract's path."""
    allowed = allowed_headers(lab_id)
    for path in list(folder.rglob("*.h")):
        if str(path.relative_to(folder)) not in allowed:
            path.unlink()
    for name in allowed:
        target = folder / name
        target.parent.mkdir(parents=True, exist_ok=True)
        if not target.exists() or target.read_bytes() != (SOURCE / name).read_bytes():
            partial = target.with_suffix(f".{os.getpid()}")
            shutil.copyfile(SOURCE / name, partial)
            partial.replace(target)
    return str((folder_of(lab_id) / "lab.h").relative_to(SOURCE))


def submitted_files(path):
    """A submission is one .cpp file, or a folder of .cpp and .h files."""
    if not path.exists():
        raise Unusable(f"{path}: there is no such file or folder; expected a lab.cpp, or a folder with one")
    files = sorted(path.glob("*.cpp")) + sorted(path.glob("*.h")) if path.is_dir() else [path]
    if not any(file.suffix == ".cpp" for file in files):
        raise Unusable(f"{path}: found no .cpp file; expected a lab.cpp")
    return files
