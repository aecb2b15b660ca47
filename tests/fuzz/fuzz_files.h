// These functions serve the fuzz targets whose reader takes the path of a file.
#pragma once

#include "common/system/error.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <unistd.h>

namespace duet {

inline void require(bool condition) {
    if (!condition) std::abort();
}

/// Returns this process's own folder, in memory where the system has /dev/shm.
inline std::filesystem::path fuzz_folder() {
    const std::filesystem::path base =
        std::filesystem::is_directory("/dev/shm") ? "/dev/shm" : std::filesystem::temp_directory_path();
    const std::filesystem::path folder = base / ("duet-fuzz-" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    return folder;
}

inline void write_bytes(const std::filesystem::path& path, std::string_view bytes) {
    std::ofstream(path, std::ios::binary | std::ios::trunc)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

/// Calls read(), which must return or throw Error, and nothing else.
template <class Read> void returns_or_throws_error(const Read& read) {
    try {
        read();
    } catch (const Error&) {
    }
}

} // namespace duet
