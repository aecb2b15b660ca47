// The scenes of the test ball: one a material.
#pragma once

#include <span>
#include <string>

namespace duet::models {

struct BallScene {
    std::string name, description;
    std::string material; ///< its keys, as JSON
    std::string objects;  ///< more lines of objects, or empty
};
/// In the order of the gallery's page.
std::span<const BallScene> ball_scenes();

} // namespace duet::models
