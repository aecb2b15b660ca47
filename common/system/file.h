// Whole files: read in one go within a limit, written whole or not at all.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace duet {

/// The path's ending with its dot, A to Z as a to z, whatever the locale: ".png"; empty where there is none.
std::string lower_case_ending(const std::filesystem::path& path);

/// The bytes of a regular file of at most `limit` bytes. Throws Error naming the path otherwise.
std::string read_file(const std::filesystem::path& path, std::size_t limit = std::size_t{1} << 32);

/// Calls write(temporary) with the path of a new file beside `path` and renames it to `path` when that returns: the
/// output is whole or absent, whatever kills the program. Throws Error (exit code 1) where that fails; the temporary
/// file is removed.
void write_whole(const std::filesystem::path& path, const std::function<void(const std::filesystem::path&)>& write);
/// The same for bytes at hand.
void write_file(const std::filesystem::path& path, std::string_view bytes);

} // namespace duet
