// This file caches the meshes and images of a scene that is read repeatedly, as an editor does after each change.
#pragma once

#include "common/scene/scene.h"

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace duet {

/// A FileCache returns values that it has read before, unless one of their files has changed since. It stores every
/// value until a newer one replaces it. Only one thread may use it at a time; parse_scene() sees to that.
class FileCache {
public:
    /// A Read is a value and the files that it was made from.
    template <typename Value> struct Read {
        Value value;
        std::vector<std::filesystem::path> files;
    };
    /// Returns the value of a key, made by `read` if it is not in the cache. A key always stands for the same type.
    template <typename Value>
    std::shared_ptr<const Value> get(const std::string& key, const std::function<Read<Value>()>& read) {
        return std::static_pointer_cast<const Value>(find(key, [&read] {
            Read<Value> made = read();
            return Read<std::shared_ptr<const void>>{std::make_shared<Value>(std::move(made.value)),
                                                     std::move(made.files)};
        }));
    }

    /// Returns a value that is computed from its key alone: that of an earlier call if it is still in use, else a new
    /// one, made by `make`.
    template <typename Value>
    std::shared_ptr<const Value> reuse(const std::string& key, const std::function<Value()>& make) {
        std::erase_if(computed_, [](const auto& entry) { return entry.second.expired(); });
        std::weak_ptr<const void>& known = computed_[key];
        auto value = std::static_pointer_cast<const Value>(known.lock());
        if (!value) known = value = std::make_shared<const Value>(make());
        return value;
    }

    /// Returns a lock that the thread holds which uses the cache.
    std::unique_lock<std::mutex> lock() { return std::unique_lock(mutex_); }

private:
    struct Entry {
        std::shared_ptr<const void> value;
        /// These are the files, and when each was written.
        std::vector<std::pair<std::filesystem::path, std::filesystem::file_time_type>> files;
    };
    std::shared_ptr<const void> find(const std::string& key,
                                     const std::function<Read<std::shared_ptr<const void>>()>& read);

    std::mutex mutex_;
    std::map<std::string, Entry> entries_;
    std::map<std::string, std::weak_ptr<const void>> computed_;
};

/// This is the size limit of a scene file in bytes. Scene files are text, and meshes and images are in separate
/// files. The parsed tree takes up to fifty times the file's size in memory.
inline constexpr std::size_t kMaxSceneBytes = std::size_t{1} << 26;

/// Reads the text of a scene file as parse_scene(path, text) does, and takes its meshes and images from the cache. With
/// Transforms::kKept the scene shares the meshes with the cache. Several threads may read with one cache; they take
/// turns.
Scene parse_scene(const std::filesystem::path& path, std::string_view text, FileCache& cache,
                  Transforms transforms = Transforms::kBaked);

} // namespace duet
