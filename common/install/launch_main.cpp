// This launcher is installed under the name of each program of the Debian package. It starts lib/duet/LEVEL/NAME beside
// its own folder, where LEVEL is the highest x86-64 level that the CPU supports. The environment variable DUET_LEVEL
// replaces the CPU's level; an empty value stands for a CPU below all levels.
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <string>
#include <unistd.h>

namespace {

/// Returns the highest level of the x86-64 psABI that the CPU supports, such as "x86-64-v3", or an empty string below
/// x86-64-v2. It tests only those instructions of a level that Duet's code and its compilers use.
std::string cpu_level() {
    if (!__builtin_cpu_supports("sse4.2") || !__builtin_cpu_supports("popcnt")) return "";
    if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma") || !__builtin_cpu_supports("bmi2"))
        return "x86-64-v2";
    const bool v4 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                    __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                    __builtin_cpu_supports("avx512vl");
    return v4 ? "x86-64-v4" : "x86-64-v3";
}

} // namespace

int main(int, char** argv) {
    const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe");
    const char* const wanted = std::getenv("DUET_LEVEL");
    const std::string level = wanted != nullptr ? wanted : cpu_level();
    if (level.empty()) {
        std::cerr << self.filename().string() << ": this CPU lacks SSE4.2, which Duet needs "
                  << "(x86-64-v2: Intel since 2008, AMD since 2011)\n";
        return 2;
    }
    const std::filesystem::path program = self.parent_path().parent_path() / "lib/duet" / level / self.filename();
    execv(program.c_str(), argv);
    std::cerr << self.filename().string() << ": cannot start " << program.string() << ": " << std::strerror(errno)
              << (wanted != nullptr ? ". Set DUET_LEVEL to x86-64-v2, -v3 or -v4, or unset it\n"
                                    : ". Reinstall the package\n");
    return 1;
}
