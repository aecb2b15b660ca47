#include "common/scene/file_cache.h"

#include "common/system/file.h"

#include <algorithm>
#include <chrono>

namespace duet {

namespace fs = std::filesystem;

namespace {

/// The clock that dates files lags by up to 10 ms on Linux, and by up to 20 ms on other systems.
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
    // A file that was written meanwhile may have been read in part. The value is not cached then.
    if (std::all_of(entry.files.begin(), entry.files.end(),
                    [&](const auto& file) { return file.second + kFileClockTick < start; }))
        entries_[key] = std::move(entry);
    return value;
}

} // namespace duet
