#include "compare/bench/reference.h"

#include "common/image/image_file.h"
#include "common/sampling/digest.h"
#include "common/system/error.h"

#include <algorithm>
#include <cstdlib>

namespace duet::compare {

namespace {

namespace fs = std::filesystem;

constexpr const char* kKeyAttribute = "duet:reference";

} // namespace

double Reference::mse() const {
    double sum = 0;
    for (const Rgb& v : variance) sum += average(Rgbd(v));
    return sum / static_cast<double>(variance.size());
}

std::string ReferenceKey::text() const {
    return message("scene ", scene_hash, ", estimator ", estimator, " ", version, ", ", width, "x", height, ", depth ",
                   depth, ", ", spp, " samples per pixel", program.empty() ? "" : ", by ", program);
}

fs::path default_reference_folder() {
    const auto variable = [](const char* name) {
        const char* const value = std::getenv(name);
        return std::string(value != nullptr ? value : "");
    };
    const std::string cache = variable("XDG_CACHE_HOME"), home = variable("HOME");
    const fs::path base = !cache.empty()  ? fs::path(cache)
                          : !home.empty() ? fs::path(home) / ".cache"
                                          : fs::temp_directory_path();
    return base / "duet" / "references";
}

fs::path ReferenceCache::path(const std::string& scene_name, const ReferenceKey& key) const {
    return folder_ / (scene_name + "-" + key.estimator + "-" + to_hex(hash_bytes(0, key.text())) + ".exr");
}

std::optional<Reference> ReferenceCache::find(const std::string& scene_name, const ReferenceKey& key) const {
    const fs::path file_path = path(scene_name, key);
    if (!fs::exists(file_path)) return std::nullopt;
    try {
        const ExrFile file = read_exr(file_path);
        const bool same = std::any_of(file.attributes.begin(), file.attributes.end(), [&](const ExrAttribute& a) {
            return a.name == kKeyAttribute && a.value == key.text();
        });
        Reference reference{rgb_image("", file), rgb_image("variance.", file)};
        if (!same || reference.mean.empty() || reference.variance.empty()) return std::nullopt;
        if (file.width != key.width || file.height != key.height) return std::nullopt;
        return reference;
    } catch (const Error&) {
        return std::nullopt; // damaged, so it is rendered again
    }
}

void ReferenceCache::store(const std::string& scene_name, const ReferenceKey& key, const Reference& reference) const {
    std::error_code error;
    fs::create_directories(folder_, error);
    if (!fs::is_directory(folder_))
        throw Error(message(folder_.string(), ": the folder of references cannot be made: ", error.message()), 1);
    std::vector<ExrChannel> channels = rgb_channels("", reference.mean);
    for (ExrChannel& channel : rgb_channels("variance.", reference.variance)) channels.push_back(std::move(channel));
    write_exr(path(scene_name, key), key.width, key.height, channels, {{kKeyAttribute, key.text()}});
}

} // namespace duet::compare
