// Reference pictures: rendered once with many samples and a seed of their own, then kept outside the repository.
#pragma once

#include "common/image/image.h"

#include <filesystem>
#include <optional>
#include <string>

namespace duet::compare {

/// A picture that stands for the truth, and how sure it is of it.
struct Reference {
    ImageRgb mean;
    ImageRgb variance; ///< of `mean`, estimated in each pixel by itself with one degree of freedom or more

    /// Its own error, estimated: the mean of its variance. A perfect picture would be charged with it.
    double mse() const;
};

/// Everything that decides what a reference shows and how well. Equal keys, equal pictures.
struct ReferenceKey {
    std::string scene_hash; ///< hash_scene_files
    std::string estimator;  ///< "path", "naive", "cycles"
    int version = 0;        ///< of that estimator: raytrace::kEstimatorVersion
    int width = 0, height = 0;
    int depth = 0; ///< scattering events at most
    int spp = 0;
    std::string program = {}; ///< another's name and version, which decide, too: "Blender 3.4.1"; empty: ours

    /// All of it in one line, which the file keeps.
    std::string text() const;
};

/// $XDG_CACHE_HOME/duet/references, ~/.cache/duet/references, or below the system's temporary folder where neither
/// variable is set.
std::filesystem::path default_reference_folder();

/// A folder of references, one EXR file each (R, G, B and variance.R, .G, .B), named SCENE-ESTIMATOR-HASH.exr.
class ReferenceCache {
public:
    explicit ReferenceCache(std::filesystem::path folder) : folder_(std::move(folder)) {}

    std::filesystem::path path(const std::string& scene_name, const ReferenceKey& key) const;
    /// Empty where there is none: no file, one that cannot be read, or one of another key.
    std::optional<Reference> find(const std::string& scene_name, const ReferenceKey& key) const;
    /// Makes the folder; the file is whole or absent. Throws Error (exit code 1) where that fails.
    void store(const std::string& scene_name, const ReferenceKey& key, const Reference& reference) const;

private:
    std::filesystem::path folder_;
};

} // namespace duet::compare
