// This file defines reference images: rendered once with many samples and a separate seed, then cached outside of the
// repository.
#pragma once

#include "common/image/image.h"

#include <filesystem>
#include <optional>
#include <string>

namespace duet::compare {

/// A Reference is a reference image and its estimated uncertainty.
struct Reference {
    ImageRgb mean;
    ImageRgb variance; ///< of `mean`, estimated per pixel with at least one degree of freedom

    /// Returns the reference's own estimated error, the mean of its variance. A perfect image would be measured
    /// with this error.
    double mse() const;
};

/// A ReferenceKey holds everything that determines a reference's content and accuracy. Equal keys imply equal images.
struct ReferenceKey {
    std::string scene_hash; ///< hash_scene_files
    std::string estimator;  ///< "path", "naive", "cycles"
    int version = 0;        ///< version of the estimator, such as raytrace::kEstimatorVersion
    int width = 0, height = 0;
    int depth = 0; ///< maximum number of scattering events
    int spp = 0;
    std::string program = {}; ///< name and version of an external renderer, such as "Blender 3.4.1"; empty: Duet

    /// Returns the key as one line of text, which is stored in the file.
    std::string text() const;
};

/// Returns $XDG_CACHE_HOME/duet/references or ~/.cache/duet/references; if neither variable is set, a folder
/// below the system's temporary folder.
std::filesystem::path default_reference_folder();

/// A ReferenceCache is a folder of references, one EXR file each (R, G, B and variance.R, .G, .B), named
/// SCENE-ESTIMATOR-HASH.exr.
class ReferenceCache {
public:
    explicit ReferenceCache(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// Returns the file of a reference, whether it exists or not.
    std::filesystem::path path(const std::string& scene_name, const ReferenceKey& key) const;
    /// Returns nothing if there is no file, if it cannot be read, or if it has another key.
    std::optional<Reference> find(const std::string& scene_name, const ReferenceKey& key) const;
    /// Creates the folder if needed. The file is written completely or not at all. Throws Error (exit code 1)
    /// on failure.
    void store(const std::string& scene_name, const ReferenceKey& key, const Reference& reference) const;

private:
    std::filesystem::path folder_;
};

} // namespace duet::compare
