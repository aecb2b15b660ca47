// These functions read a whole file up to a size limit, and write files atomically.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <string_view>

namespace duet {

/// Returns the path's extension with its dot, for example ".png", or an empty string if it has none. The letters A to Z
/// are converted to lower case, independently of the locale.
std::string lower_case_extension(const std::filesystem::path& path);

/// Returns when a file was last written. A file that is gone, or cannot be examined, has the earliest time.
std::filesystem::file_time_type write_time(const std::filesystem::path& path);

/// Opens a regular file for reading its bytes. Throws an Error that names the path if the file is missing, is not a
/// regular file, is larger than `limit` bytes or cannot be read.
std::ifstream open_file(const std::filesystem::path& path, std::uint64_t limit = std::uint64_t{1} << 32);
/// Returns the contents of a regular file. Throws an Error that names the path if the file is missing, is not a regular
/// file, is larger than `limit` bytes or cannot be read.
std::string read_file(const std::filesystem::path& path, std::uint64_t limit = std::uint64_t{1} << 32);

/// Calls write(temporary) with the path of a new file in the directory of `path`, then renames that file to `path`. The
/// output is thus complete or absent, even if the program is killed. Throws an Error (exit code 1) if the rename fails,
/// and rethrows exceptions of `write`; the temporary file is removed in both cases.
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path&)>& write);
/// Removes the temporary files that killed processes left when they wrote `path`. No process may be writing it.
void remove_interrupted_writes(const std::filesystem::path& path);
/// Throws an Error (exit code 1) with the system's reason if opening, writing or closing `out` has just failed.
void check_written(const std::ofstream& out, const std::filesystem::path& path);
/// Writes `bytes` to the file at `path` atomically, by write_atomically(). Throws an Error (exit code 1) on failure.
void write_file(const std::filesystem::path& path, std::string_view bytes);

} // namespace duet
