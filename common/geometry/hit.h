// This file defines hits, which identify a visible primitive and a position on it. Both pipelines use this type.
#pragma once

#include <cstdint>
#include <limits>

namespace duet {

inline constexpr std::uint32_t kNoObject = std::numeric_limits<std::uint32_t>::max();

/// `object` is an index into Scene::objects. `primitive` is the index of a triangle of a mesh (as loaded, after
/// polygons were triangulated), of a quad of a quad list (a box has six), or 0 for a sphere.
///
/// On a triangle abc, u and v are the barycentric coordinates of b and c. On a quad, they are the coordinates along its
/// two edges. On a sphere both are 0, because the surface point follows from the ray and t. t is the parameter along
/// the ray. Camera rays have a direction of unit length, so their t is the Euclidean distance from the ray's origin. Of
/// several hits at equal distance, the one with the lowest (object, primitive) counts.
struct Hit {
    std::uint32_t object = kNoObject;
    std::uint32_t primitive = 0;
    float u = 0, v = 0;
    float t = std::numeric_limits<float>::infinity();

    bool valid() const { return object != kNoObject; }
    friend bool operator==(const Hit&, const Hit&) = default;
};

} // namespace duet
