"""Several submissions of one lab as one program. Most of the time of a compilation goes into headers, templates and
linking, and here these happen once. Only for the repository's own texts: a submission of a student's is compiled
alone."""
import os
import re

import compiling
import labs

INCLUDE = re.compile(r"^\s*#\s*include.*$", re.MULTILINE)
FUNCTIONS = re.compile(r"^DUET_LAB\(([^)]*)\)", re.MULTILINE)


def variant(number, text, functions):
    """A submission in a namespace of its own below duet::lab, where the types of the contract are. Its functions have
    other names there: f becomes f_3, so that a call with a type of the contract finds this one and not lab::f."""
    space = f"duet::lab::variant_{number}"
    declared = [f"decltype(lab::{name}) {name}_{number};" for name in functions]
    cases = [f'if (name == "{name}") return answer(&{space}::{name}_{number}, in, out), true;' for name in functions]
    return "\n".join([
        f"namespace {space} {{\nusing namespace duet::lab;", *declared, "}",
        *(f"#define {name} {name}_{number}" for name in functions), f"#define lab lab::variant_{number}",
        INCLUDE.sub("", text),
        "#undef lab", *(f"#undef {name}" for name in functions),
        f"static bool table_{number}(std::string_view name, duet::grading::Reader& in, duet::grading::Writer& out) {{",
        *cases, "return false;\n}"])


def joined(contract, texts):
    """The source of all submissions."""
    declared = FUNCTIONS.search((labs.SOURCE / contract).read_text(encoding="utf-8"))[1]
    functions = [name.strip() for name in declared.split(",")]
    includes = {line.strip() for text in texts for line in INCLUDE.findall(text)}
    tables = ", ".join(f"table_{i}" for i in range(len(texts)))
    return "\n".join([
        '#include "tests/grading/variants.h"', f'#include "{contract}"', *sorted(includes),
        *(variant(i, text, functions) for i, text in enumerate(texts)),
        "bool duet::grading::call_by_name(std::string_view name, Reader& in, Writer& out) {",
        f"static constexpr Table tables[] = {{{tables}}};",
        "return tables[number_of_variant()](name, in, out);\n}\n"])


def build_workers(lab_id, texts, build, folder):
    """A worker for each text, in the order of the texts: one program under several names. Raises compiling.Refused
    where they can't be compiled together."""
    contract = str((labs.folder_of(lab_id) / "lab.h").relative_to(labs.SOURCE))
    source = folder / "variants.cpp"
    source.write_text(joined(contract, texts), encoding="utf-8")
    compiling.run_compiler(build, ["-static", "-I", str(labs.SOURCE), f'-DDUET_LAB_HEADER="{source}"',
                                   str(labs.SOURCE / compiling.WORKER), "-o", str(folder / "worker")],
                           "the submissions together", folder)
    workers = [folder / f"worker-{i}" for i in range(len(texts))]
    for worker in workers:
        os.link(folder / "worker", worker)
    return workers
