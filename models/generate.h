// The models made by code: each one file of this folder, all of them listed in generate.cpp.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace duet::models {

/// A model that the generator can make: its files, relative to the output folder, and the function that writes them.
struct Model {
    enum class Kind {
        kCommitted, ///< small: kept in the repository, where a test holds it equal to what its function writes
        kBuilt,     ///< over 1 MB: made by the build into generated/
        kOnRequest, ///< larger still: made when asked for by name
    };

    std::string name;
    Kind kind = Kind::kCommitted;
    std::vector<std::string> files;
    /// Writes the files below the folder. The bytes depend on nothing but the code.
    std::function<void(const std::filesystem::path& folder)> write;
};

/// All models, in the order in which they are made.
std::span<const Model> all_models();

/// Makes one model's files, and the folders they lie in, below the folder.
void make(const Model& model, const std::filesystem::path& folder);

// One function a model, each in the file of its name.
void write_amphora(const std::filesystem::path& folder);
void write_bowl(const std::filesystem::path& folder);
inline constexpr const char* kHallFile = "generated/hall.obj";
void write_hall(const std::filesystem::path& folder);
void write_lanterns(const std::filesystem::path& folder);
void write_octopus(const std::filesystem::path& folder);
void write_octopus_hundred_thousand(const std::filesystem::path& folder);
void write_octopus_million(const std::filesystem::path& folder);
void write_pear(const std::filesystem::path& folder);
void write_plinth(const std::filesystem::path& folder);
void write_sky(const std::filesystem::path& folder);
void write_spheres(const std::filesystem::path& folder);
void write_test_ball(const std::filesystem::path& folder);

} // namespace duet::models
