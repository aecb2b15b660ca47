#include "common/scene/file_cache.h"

#include <algorithm>
#include <chrono>

namespace duet {

namespace fs = std::filesystem;

namespace {

/// Returns when a file was written; a file that is gone has the earliest time.
fs::file_time_type write_time(const fs::path& file) {
    std::error_code missing;
    const fs::file_time_type time = fs::last_write_time(file, missing);
    return missing ? fs::file_time_type::min() : time;
}

/// Files are dated by a clock that is up to a hundredth of a second behind on Linux, and up to two on other systems.
constexpr std::chrono::milliseconds kFileClockTick{20};

} // namespace

std::shared_ptr<const void> FileCache::find(const std::string& key,
                                            const std::function<Read<std::shared_ptr<const void>>()>& read) {
    const auto known = entries_.find(key);
    if (known != entries_.end() && std::all_of(known->second.files.begin(), known->second.files.end(),
                                               [](const auto& file) { return write_time(file.first) == file.second; }))
        return known->second.value;
    const auto start = fs::file_time_type::clock::now();
    const auto [value, files] = read();
    Entry entry{value, {}};
    for (const fs::path& file : files) entry.files.emplace_back(file, write_time(file));
    // What was written meanwhile may have been read in part, and is not kept.
    if (std::all_of(entry.files.begin(), entry.files.end(),
                    [&](const auto& file) { return file.second + kFileClockTick < start; }))
        entries_[key] = std::move(entry);
    return value;
}

} // namespace duet
