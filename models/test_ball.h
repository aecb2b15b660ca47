// This header declares the scenes of the test ball, one for each material.
#pragma once

#include <filesystem>
#include <span>
#include <string>

namespace duet::models {

/// Describes a scene of the test ball: what its material is, and how it is written.
struct BallScene {
    std::string name, description;
    std::string material; ///< the material's keys, as JSON
    std::string objects; ///< additional lines of objects, or empty
};
/// Returns the scenes in the order of the gallery's page.
std::span<const BallScene> ball_scenes();

/// Writes the ball's mesh and the scene of each material below the folder.
void write_test_ball(const std::filesystem::path& folder);

} // namespace duet::models
