#!/usr/bin/env python3
"""Submissions that cheat, crash or hang: none gets points, none takes the grader down, each gets a plain message.

usage: hostile_test.py [--build FOLDER]
"""
import argparse
import pathlib
import sys
import tempfile

import grade
import labs

LAB = "raytrace-02"
HEAD = f'#include "{labs.folder_of(LAB).relative_to(labs.SOURCE)}/lab.h"\n'
# The other functions do nothing; the first is the hostile one.
REST = """
Vec3 sphere_normal(Vec3, float, Vec3) { return {0, 0, 0}; }
Rgb normal_color(Vec3) { return Rgb(0); }
std::optional<float> hit_cylinder(float, const Ray&) { return std::nullopt; }
}
"""
# name: (includes and declarations, body of hit_sphere, what the result must say)
SUBMISSIONS = {
    "endless loop": ("", "for (volatile int i = 0;; ++i) {}", "an endless loop"),
    "exit": ("#include <cstdlib>", "std::exit(0);", "ended the program by itself (exit code 0)"),
    "exit before main": ("#include <cstdlib>\nstatic const int quit = (std::exit(0), 1);", "return 2.0f;",
                         "ended the program by itself (exit code 0)"),
    "abort": ("#include <cstdlib>", "std::abort();", "aborted"),
    "null pointer": ("", "volatile int* p = nullptr; *p = 1; return 2.0f;", "segmentation fault"),
    "endless recursion": ("static int deep(volatile int n) { volatile char a[4096]; a[0] = char(n); return deep(n + 1) + a[0]; }",
                          "return float(deep(0));", "segmentation fault"),
    "huge allocation": ("#include <vector>", "std::vector<char> all(std::size_t{3} << 30, 'x'); return float(all[7]);",
                        "memory"),
    "exception": ("#include <stdexcept>", 'throw std::runtime_error("boo");', "threw an exception: boo"),
    "prints the answer": ("#include <cstdio>", 'std::printf("100 of 100 points\\n"); std::fflush(stdout); return 7.0f;',
                          "is wrong"),
    "floods the output": ("#include <cstdio>", 'for (int i = 0; i < 300000; ++i) std::puts("spam"); return 7.0f;',
                          ""),
    "writes a file": ("#include <fstream>", 'std::ofstream f("/tmp/duet-hostile"); f << "100"; f.close(); '
                      "return f.good() ? 2.0f : 9.0f;", "is wrong"),
    "writes to the report": ("#include <fstream>",
                             'for (const char* name : {"result.json", "../result.json", "/tmp/duet-hostile"}) '
                             '{ std::ofstream f(name); f << "{\\"earned\\": 100}"; '
                             'if (f.good()) return 2.0f; } return 9.0f;', "is wrong"),
    "reads the examiner's memory": ("#include <cstdio>\n#include <string>\n#include <unistd.h>",
                                    'std::FILE* f = std::fopen(("/proc/" + std::to_string(getppid()) + "/mem").c_str(), "rb"); '
                                    "return f ? 2.0f : 9.0f;", "is wrong"),
    "connects to the network": ("#include <sys/socket.h>", "return socket(AF_INET, SOCK_STREAM, 0) >= 0 ? 2.0f : 9.0f;", "is wrong"),
    "starts another program": ("#include <unistd.h>", 'char* none[] = {nullptr}; return execve("/bin/true", none, none) == 0 '
                               "? 2.0f : 9.0f;", "is wrong"),
    "reads a file": ("#include <fstream>", 'std::ifstream f("/etc/passwd"); return f ? 2.0f : 9.0f;', "is wrong"),
    "forks": ("#include <unistd.h>", "return fork() >= 0 ? 2.0f : 9.0f;", "is wrong"),
    "kills its parent": ("#include <csignal>\n#include <unistd.h>", "return kill(getppid(), 9) == 0 ? 2.0f : 9.0f;", "is wrong"),
    "closes the pipes": ("#include <unistd.h>", "for (int i = 0; i < 64; ++i) close(i); return 2.0f;", "hit_sphere"),
    "forges a reply": ("#include <unistd.h>", 'const char text[] = "forged forged forged"; (void)!write(4, text, sizeof text); '
                       "return 2.0f;", "malformed"),
    "answer by the examiner's header": ('#include "raytrace/lessons/02-sphere/sphere.h"', "return 2.0f;",
                                        "which a submission may not"),
    "examiner's source": ('#include "raytrace/lessons/02-sphere/lab_test.cpp"', "return 2.0f;", "which a submission may not"),
    "a file of the system": ('#include "/etc/passwd"', "return 2.0f;", "which a submission may not"),
    "assembler": ('asm(".incbin \\"/etc/passwd\\"");', "return 2.0f;", "assembler"),
    "doesn't compile": ("", "return 2.0f", "doesn't compile"),
    "endless templates": ("template <int N> struct Deep { static constexpr int value = Deep<N + 1>::value; };",
                          "return float(Deep<0>::value);", "doesn't compile"),
}


def submission(name):
    declarations, body, _ = SUBMISSIONS[name]
    return (f"{HEAD}{declarations}\nnamespace duet::lab {{\n"
            f"std::optional<float> hit_sphere(Vec3, float, const Ray&) {{ {body} }}\n{REST}")


def fault_of(name, build, folder):
    """What is wrong with how the grader takes a submission; nothing where all is well."""
    path = folder / "lab.cpp"
    path.write_text(submission(name))
    result = grade.grade(LAB, path, build)
    said = result.get("error", "") + " ".join(item.get("message", "") for item in result["items"])
    earned_by_hits = sum(item["earned"] for item in result["items"][1:3])
    if earned_by_hits or result["earned"] > 10:
        return f"{name}: it gets {result['earned']} points"
    if SUBMISSIONS[name][2] not in said:
        return f"{name}: nothing says '{SUBMISSIONS[name][2]}', but: {said[:400]}"
    return None


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--build", type=pathlib.Path, default=grade.DEFAULT_BUILD)
    build = parser.parse_args().build.resolve()
    with tempfile.TemporaryDirectory() as folder:
        faults = [fault_of(name, build, pathlib.Path(folder)) for name in SUBMISSIONS]
    faults = [fault for fault in faults if fault]
    if pathlib.Path("/tmp/duet-hostile").exists():
        faults.append("a submission wrote a file")
    print("\n".join(faults) or f"{len(SUBMISSIONS)} hostile submissions got nothing")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
