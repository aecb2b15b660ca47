#include "common/system/file.h"

#include "common/system/error.h"

#include <cerrno>
#include <cstring>
#include <system_error>
#include <unistd.h>
#include <vector>

namespace duet {

namespace fs = std::filesystem;

std::string lower_case_extension(const fs::path& path) {
    std::string extension = path.extension().string();
    for (char& c : extension)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return extension;
}

fs::file_time_type write_time(const fs::path& path) {
    std::error_code missing;
    const fs::file_time_type time = fs::last_write_time(path, missing);
    return missing ? fs::file_time_type::min() : time;
}

namespace {

/// Returns the number of bytes of a file. It comes from the open stream, not from the path, because another program may
/// rename a file to this path at any time.
std::size_t file_size(std::ifstream& in, const fs::path& path) {
    in.seekg(0, std::ios::end);
    const std::streamoff end = in.tellg();
    in.seekg(0);
    if (!in || end < 0) throw Error(message(path.string(), ": cannot be read"));
    return static_cast<std::size_t>(end);
}

} // namespace

std::ifstream open_file(const fs::path& path, std::uint64_t limit) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (!fs::exists(status)) throw Error(message(path.string(), ": no such file"));
    if (!fs::is_regular_file(status)) throw Error(message(path.string(), ": not a regular file"));
    std::ifstream in(path, std::ios::binary);
    const std::size_t size = file_size(in, path);
    if (size > limit) throw Error(message(path.string(), ": ", size, " bytes, expected at most ", limit));
    return in;
}

std::string read_file(const fs::path& path, std::uint64_t limit) {
    std::ifstream in = open_file(path, limit);
    std::string bytes(file_size(in, path), '\0');
    in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (!in) throw Error(message(path.string(), ": cannot be read"));
    return bytes;
}

namespace {

/// Returns the name of a temporary file beside `path`. The extension is preserved, because some writers choose the file
/// format by it.
fs::path temporary_name(const fs::path& path, std::string_view process) {
    fs::path temporary = path;
    return temporary.replace_filename(message(".", path.stem().string(), ".", process, path.extension().string()));
}

} // namespace

void write_atomically(const fs::path& path, const std::function<void(const fs::path&)>& write) {
    const fs::path temporary = temporary_name(path, std::to_string(::getpid()));
    std::error_code ignored;
    try {
        write(temporary);
        std::error_code error;
        fs::rename(temporary, path, error);
        if (error) throw Error(message(path.string(), ": cannot be written: ", error.message()), 1);
    } catch (...) {
        fs::remove(temporary, ignored);
        throw;
    }
}

void remove_interrupted_writes(const fs::path& path) {
    const std::string pattern = temporary_name(path, "*").filename().string();
    const std::size_t star = pattern.rfind('*');
    const std::string_view start = std::string_view(pattern).substr(0, star);
    const std::string_view end = std::string_view(pattern).substr(star + 1);
    std::error_code error;
    std::vector<fs::path> found; // removed once the folder is read
    for (fs::directory_iterator entry(path.has_parent_path() ? path.parent_path() : ".", error), none;
         !error && entry != none; entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        if (name.size() <= start.size() + end.size() || !name.starts_with(start) || !name.ends_with(end)) continue;
        const std::string process = name.substr(start.size(), name.size() - start.size() - end.size());
        if (process.find_first_not_of("0123456789") == process.npos) found.push_back(entry->path());
    }
    for (const fs::path& file : found) fs::remove(file, error);
}

void check_written(const std::ofstream& out, const fs::path& path) {
    if (!out) throw Error(message(path.string(), ": cannot be written: ", std::strerror(errno)), 1);
}

void write_file(const fs::path& path, std::string_view bytes) {
    write_atomically(path, [&](const fs::path& temporary) {
        std::ofstream out(temporary, std::ios::binary);
        out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        out.close();
        check_written(out, path);
    });
}

} // namespace duet
