#!/usr/bin/env python3
"""Submissions that cheat, crash or hang: none gets points, none takes the grader down, each gets a plain message.

usage: hostile_test.py [--build FOLDER]
"""
import argparse
import concurrent.futures
import os
import pathlib
import sys
import tempfile

import grade
import labs
import report
import variants

LAB = "raytrace-02"
CONTRACT = labs.folder_of(LAB) / "lab.h"
STARTER = (labs.folder_of(LAB) / "lab_starter.cpp").read_text(encoding="utf-8")
CALL_SECONDS = 0.1  # the usual limit is longer, and these wait for it
FORBIDDEN = "which a submission may not"
EVIDENCE = pathlib.Path(tempfile.gettempdir()) / "duet-hostile"

# What the sandbox must keep a program from: each is an expression that is true where it succeeds.
REACHES = [
    'open("/etc/passwd", O_RDONLY) >= 0',
    'open(".", O_RDONLY | O_DIRECTORY) >= 0',
    f'open("{EVIDENCE}", O_WRONLY | O_CREAT, 0600) >= 0',
    f'creat("{EVIDENCE}", 0600) >= 0',
    'open("result.json", O_WRONLY | O_CREAT, 0600) >= 0',
    'open("../result.json", O_WRONLY | O_CREAT, 0600) >= 0',
    'open("/proc/self/maps", O_RDONLY) >= 0',
    'open(("/proc/" + std::to_string(getppid()) + "/mem").c_str(), O_RDWR) >= 0',
    'open("/proc/1/environ", O_RDONLY) >= 0',
    'std::ifstream("/etc/hostname").good()',
    'std::fopen("/etc/hostname", "r") != nullptr',
    'opendir("/") != nullptr',
    'stat("/etc/passwd", &status) == 0',
    'access("/etc/passwd", R_OK) == 0',
    f'symlink("/etc/passwd", "{EVIDENCE}") == 0',
    f'link("/etc/passwd", "{EVIDENCE}") == 0',
    f'mkdir("{EVIDENCE}", 0700) == 0',
    f'rename("result.json", "{EVIDENCE}") == 0',
    'unlink("worker") == 0',
    'chdir("/") == 0',
    'chroot("/") == 0',
    'chmod("worker", 0777) == 0',
    'memfd_create("x", 0) >= 0',
    'dup(4) >= 0',
    'pipe(pair) == 0',
    'socket(AF_INET, SOCK_STREAM, 0) >= 0',
    'socket(AF_UNIX, SOCK_STREAM, 0) >= 0',
    'socketpair(AF_UNIX, SOCK_STREAM, 0, pair) == 0',
    'fork() >= 0',
    'vfork() > 0',
    'syscall(SYS_clone, 17, 0, 0, 0, 0) >= 0',
    'syscall(SYS_clone3, &status, 64) >= 0',
    'execl("/bin/true", "true", nullptr) == 0',
    'syscall(SYS_execveat, -100, "/bin/true", nullptr, nullptr, 0) == 0',
    'std::system("true") == 0',
    'popen("true", "r") != nullptr',
    'kill(getppid(), 9) == 0',
    'kill(-1, 9) == 0',
    'syscall(SYS_tgkill, getppid(), getppid(), 9) == 0',
    'syscall(SYS_tkill, getppid(), 9) == 0',
    'ptrace(PTRACE_ATTACH, getppid(), nullptr, nullptr) == 0',
    'ptrace(PTRACE_TRACEME, 0, nullptr, nullptr) == 0',
    'syscall(SYS_process_vm_readv, getppid(), nullptr, 0, nullptr, 0, 0) >= 0',
    'syscall(SYS_pidfd_open, getppid(), 0) >= 0',
    'syscall(SYS_prlimit64, 0, RLIMIT_AS, &limit, nullptr) == 0',
    'setrlimit(RLIMIT_AS, &limit) == 0',
    'prctl(PR_SET_PDEATHSIG, 0) == 0',
    'setsid() >= 0',
    'setuid(0) == 0',
    'alarm(1) != 0xffffffffu && syscall(SYS_alarm, 0) >= 0',
    'syscall(SYS_io_uring_setup, 4, nullptr) >= 0 || errno == EFAULT',
    'syscall(SYS_bpf, 0, nullptr, 0) >= 0 || errno == EINVAL',
    'syscall(SYS_userfaultfd, 0) >= 0',
    'syscall(SYS_unshare, 0) == 0',
    'syscall(SYS_mount, "x", "/", "tmpfs", 0, nullptr) == 0',
    'syscall(SYS_shmget, 1, 4096, 01600) >= 0',
    'syscall(SYS_mq_open, "/x", O_CREAT, 0600, nullptr) >= 0',
    'syscall(SYS_inotify_init1, 0) >= 0',
    'syscall(0x40000000 | SYS_open, "/etc/passwd", 0, 0) >= 0',  # by the numbers of the x32 interface
    'starts_a_thread()',
]
REACH_HEAD = "".join(f"#include <{name}>\n" for name in (
    "cstdio", "cstdlib", "fstream", "string", "thread", "cerrno", "fcntl.h", "dirent.h", "unistd.h", "csignal",
                                                         "sys/mman.h",
    "sys/prctl.h", "sys/ptrace.h", "sys/resource.h", "sys/socket.h", "sys/stat.h", "sys/syscall.h")) + """
static struct stat status;
static rlimit limit{1u << 30, 1u << 30};
static int pair[2];
static bool starts_a_thread() {
    try { std::thread([] {}).join(); return true; } catch (...) { return false; }
}
"""
REACH_BODY = "".join(f"if ({reach}) return {1000 + i};\n" for i, reach in enumerate(REACHES)) + "return 999;"

# name: (includes and declarations, body of hit_sphere, what an item must say). Compiled together, each in a namespace.
TOGETHER = {
    "endless loop": ("", "for (volatile int i = 0;; ++i) {}", "an endless loop"),
    "exit": ("#include <cstdlib>", "std::exit(0);", "ended the program by itself (exit code 0)"),
    "quick exit": ("#include <unistd.h>", "_exit(0);", "ended the program by itself (exit code 0)"),
    "exit at the end of the program": ("#include <cstdlib>", "std::atexit([] { std::_Exit(0); }); std::exit(1);",
                                       "ended the program by itself"),
    "abort": ("#include <cstdlib>", "std::abort();", "aborted"),
    "null pointer": ("", "volatile int* p = nullptr; *p = 1; return 2.0f;", "segmentation fault"),
    "endless recursion": ("static int deep(volatile int n) { volatile char a[4096]; a[0] = char(n); return deep(n + 1) "
                          "+ a[0]; }",
                          "return float(deep(0));", "segmentation fault"),
    "division by zero": ("", "volatile int zero = 0; return float(7 / zero);", "divided by zero"),
    "huge allocation": ("#include <vector>", "std::vector<char> all(std::size_t{3} << 30, 'x'); return float(all[7]);",
                        "requested more memory"),
    "memory that grows": ("#include <vector>",
                          "std::vector<std::vector<char>> all; for (;;) all.emplace_back().reserve(1 << 24);",
                          "requested more memory"),
    "exception": ("#include <stdexcept>", 'throw std::runtime_error("boo");', "threw an exception: boo"),
    "strange exception": ("", "throw 7;", "no std::exception"),
    "prints the answer": ("#include <cstdio>", 'std::printf("100 of 100 points\\n"); std::fflush(stdout); return 7.0f;',
                          "is wrong"),
    "floods the output": ("#include <cstdio>",
                          'static int left = 300000; for (; left > 0; --left) std::puts("spam"); return 7.0f;', ""),
    "closes the pipes": ("#include <unistd.h>", "for (int i = 0; i < 64; ++i) close(i); return 2.0f;", "hit_sphere"),
    "forges a reply": ("#include <unistd.h>",
                       'const char text[] = "forged forged forged"; (void)!write(4, text, sizeof text); '
                       "return 2.0f;", "malformed"),
    "an answer without end": ("#include <unistd.h>",
                              "const unsigned long size = 1ul << 40; (void)!write(4, &size, 8); return 2.0f;",
                              "larger than"),
    "floods the reply": ("#include <unistd.h>",
                         "static char zeros[1 << 20]; for (;;) (void)!write(4, zeros, sizeof zeros);",
                         "hit_sphere"),
    "reads the next question": ("#include <unistd.h>", "char next[64]; (void)!read(3, next, sizeof next); return 2.0f;",
                                "gave no answer"),
    "stops itself": ("#include <csignal>", "raise(SIGSTOP); return 2.0f;", "gave no answer"),
    "ends itself by a signal": ("#include <csignal>", "raise(SIGKILL); return 2.0f;", "was ended"),
    "ignores signals": ("#include <csignal>",
                        "for (int i = 1; i < 64; ++i) std::signal(i, SIG_IGN); for (volatile int i = 0;; ++i) {}",
                        "an endless loop"),
    "returns from a crash": ("#include <csignal>",
                             "std::signal(SIGSEGV, [](int) {}); volatile int* p = nullptr; *p = 1; return 2.0f;",
                             "an endless loop"),
    "waits without end": ("#include <sys/syscall.h>\n#include <unistd.h>",
                          "int word = 0; syscall(SYS_futex, &word, 0, 0, nullptr); "
                          "return 2.0f;", "gave no answer"),
    "writes a large file into a pipe": ("#include <csignal>", "raise(SIGXFSZ); return 2.0f;", "tried to write a file"),
    "not a number": ("#include <cmath>", "return NAN;", "is wrong"),
}
# Compiled alone: what these declare acts on the whole program, or does not compile, or may not.
ALONE = {
    "exit before main": ("#include <cstdlib>\nstatic const int quit = (std::exit(0), 1);", "return 2.0f;",
                         "ended the program by itself (exit code 0)"),
    "writes to the pipe before main": ("#include <unistd.h>\n__attribute__((constructor)) static void early() "
                                       "{ for (int i = 0; i < 9; ++i) (void)!write(4, "
                                       "\"\\1\\0\\0\\0\\0\\0\\0\\0\", 9); }",
                                       "return 2.0f;", "hit_sphere"),
    "crashes at the end of the program": (
        "struct Last { ~Last() { __builtin_trap(); } }; static Last last;", "return 7.0f;", "is wrong"),
    "an operator new of its own": (
        "#include <cstdlib>\n#include <new>\nvoid* operator new(std::size_t) { return nullptr; }\n"
                                   "void operator delete(void*) noexcept {}\nvoid operator delete(void*, std::size_t) "
                                   "noexcept {}",
                                   "return 2.0f;", "hit_sphere"),
    "a write of its own": ('extern "C" long write(int, const void*, unsigned long n) { return long(n); }',
                           "return 2.0f;", ""),
    "a main of its own": ("int main() {}", "return 2.0f;", "remove it"),
    "the grader's own function": ("namespace duet::lab { void not_attempted() {} }", "return 2.0f;", "defined twice"),
    "the lesson's own header": ('#include "raytrace/lessons/02-sphere/sphere.h"', "return 2.0f;", FORBIDDEN),
    "the examiner's source": ('#include "raytrace/lessons/02-sphere/lab_test.cpp"', "return 2.0f;", FORBIDDEN),
    "the examiner's source by its path": (
        f'#include "{CONTRACT.with_name("lab_test.cpp")}"', "return 2.0f;", FORBIDDEN),
    "a file of the system": ('#include "/etc/passwd"', "return 2.0f;", FORBIDDEN),
    "a file of the system by a relative path": ('#include "' + "../" * 12 + 'etc/passwd"', "return 2.0f;", FORBIDDEN),
    "a device": ('#include "/dev/stdin"', "return 2.0f;", FORBIDDEN),
    "assembler": ('asm(".incbin \\"/etc/passwd\\"");', "return 2.0f;", "uses assembler"),
    "assembler in a name": ('extern int name asm("x\\n.INCBIN \\"/etc/passwd\\"\\n"); int* p = &name;', "return 2.0f;",
                            "uses assembler"),
    "assembler in a section's name": (
        '__attribute__((section(".x,\\"a\\"\\n.IncBin \\"/etc/passwd\\"\\n#"))) int name = 1;',
                                      "return 2.0f;", "uses assembler"),
    "a precompiled header": ('#pragma GCC pch_preprocess "./lab.cpp"', "return 2.0f;", "precompiled header"),
    "doesn't compile": ("", "return 2.0f", "doesn't compile"),
    "endless templates": ("template <int N> struct Deep { static constexpr int value = Deep<N + 1>::value; };",
                          "return float(Deep<0>::value);", "without an end"),
    "a huge array": ("#include <cstddef>", "static char all[std::size_t{1} << 40] = {1}; return float(all[7]);", ""),
}


def submission(declarations, body):
    """The starter with a hit_sphere of another kind."""
    return (f'{declarations}\n#include "{CONTRACT.relative_to(labs.SOURCE)}"\nnamespace duet::lab {{\n'
            f"std::optional<float> hit_sphere(Vec3, float, const Ray&) "
            f"{{ {body} }}\n}}\n#define hit_sphere of_the_starter\n"
            f"{STARTER}\n#undef hit_sphere\n")


def fault(name, result, expected):
    """What is wrong with how the grader takes a submission; nothing where all is well."""
    said = result.get("error", "") + " ".join(item.get("message", "") for item in result["items"])
    if result["earned"]:
        return f"{name}: it gets {result['earned']} points"
    if expected not in said:
        return f"{name}: nothing says '{expected}', but: {said[:400]}"
    return None


def faults_together(build, folder):
    texts = [submission(declarations, body) for declarations, body, _ in TOGETHER.values()]
    workers = variants.build_workers(LAB, texts, build, folder)

    def examined(name, worker):
        out = folder / worker.name.replace("worker", "out")
        out.mkdir()
        result = grade.examine(grade.judge_of(LAB, build), out, "--worker", worker, "--seconds", str(CALL_SECONDS))
        return fault(name, report.printable(result), TOGETHER[name][2])

    with concurrent.futures.ThreadPoolExecutor(2 * (os.cpu_count() or 1)) as pool:
        return list(pool.map(examined, TOGETHER, workers))


def fault_alone(name, build, folder):
    path = folder / "lab.cpp"
    path.write_text(submission(*ALONE[name][:2]), encoding="utf-8")
    return fault(name, grade.grade(LAB, path, build, options=("--seconds", str(CALL_SECONDS))), ALONE[name][2])


def faults_of_reaching(build, folder):
    """What a submission that tries to reach out gets done, on a computer with a sandbox."""
    path = folder / "lab.cpp"
    path.write_text(submission(REACH_HEAD, REACH_BODY), encoding="utf-8")
    result = grade.grade(LAB, path, build)
    found = {item["found"] for item in result["items"] if item.get("found")}
    if not result["guarded"]:
        print("This computer has no sandbox: what a submission can reach is not tested.")
        return []
    done = [REACHES[int(value) - 1000]
            for value in found if value.isdigit() and 1000 <= int(value) < 1000 + len(REACHES)]
    said = [item.get("message", "") for item in result["items"]]
    faults = [f"a submission can do this: {reach}" for reach in done]
    return faults if "999" in found else [*faults, f"reaching out: {result.get('error')} {found} {said}"]


def fault_of_a_shown_line(build, folder):
    """A #line directive must not make a message show another file's text."""
    secret = folder / "secret.txt"
    secret.write_text("4711 is the answer\n")
    path = folder / "lab.cpp"
    path.write_text(f'#include "{CONTRACT.relative_to(labs.SOURCE)}"\n#line 1 "{secret}"\nint x = y;\n')
    error = grade.grade(LAB, path, build).get("error", "")
    return None if "doesn't compile" in error and "4711" not in error else f"a #line directive: it says {error}"


def fault_of_links(build, folder):
    """A folder with a link to a file outside is refused."""
    linked = folder / "linked"
    linked.mkdir()
    (linked / "lab.cpp").write_text(STARTER)
    (linked / "mine.h").symlink_to("/etc/passwd")
    error = grade.grade(LAB, linked, build).get("error", "")
    return None if "no plain file" in error else f"a link: it says {error}"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--build", type=pathlib.Path, default=grade.DEFAULT_BUILD)
    build = parser.parse_args().build.resolve()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        faults = faults_together(build, folder) + [fault_alone(name, build, folder) for name in ALONE]
        faults += [*faults_of_reaching(build, folder), fault_of_a_shown_line(build, folder),
                   fault_of_links(build, folder)]
    faults = [text for text in faults if text]
    if EVIDENCE.exists() or EVIDENCE.is_symlink():
        faults.append(f"a submission made {EVIDENCE}")
    print("\n".join(faults) or f"{len(TOGETHER) + len(ALONE) + 3} hostile submissions got nothing")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
