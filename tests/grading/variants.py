"""Several submissions of one lab as one program. Most of the time of a compilation goes into headers and linking, and
here both happen once. Only for the repository's own texts: a submission of a student's is compiled alone."""
import os
import re

import compiling
import labs

INCLUDE = re.compile(r'^\s*#\s*include.*$', re.MULTILINE)
ONCE = re.compile(r'^\s*#\s*pragma once.*$', re.MULTILINE)


def without_includes(text):
    return ONCE.sub("", INCLUDE.sub("", text))


def joined(contract_path, texts):
    """The source of all submissions: their includes, then for each its own copy of the contract, and its text."""
    contract = (labs.SOURCE / contract_path).read_text(encoding="utf-8")
    includes = {line.strip() for text in (contract, *texts) for line in INCLUDE.findall(text)}
    parts = ['#include "tests/grading/variants.h"', *sorted(line for line in includes if contract_path not in line)]
    for i, text in enumerate(texts):
        parts += [f"#define lab lab_{i}", f"#define DUET_TABLE table_{i}",
                  "namespace duet::lab { inline void not_attempted() { grading::submission_not_attempted(); } }",
                  without_includes(contract), without_includes(text), "#undef lab", "#undef DUET_TABLE"]
    tables = ", ".join(f"table_{i}" for i in range(len(texts)))
    parts.append("bool duet::grading::call_by_name(std::string_view name, Reader& in, Writer& out) {\n"
                 f"    static constexpr Table tables[] = {{{tables}}};\n"
                 "    return tables[number_of_variant()](name, in, out);\n}")
    return "\n".join(parts) + "\n"


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
