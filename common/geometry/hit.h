// The answer both pipelines give to «which primitive is seen here, and where on it?».
#pragma once

#include <cstdint>
#include <limits>

namespace duet {

inline constexpr std::uint32_t kNoObject = std::numeric_limits<std::uint32_t>::max();

/// `object` indexes Scene::objects; `primitive` is the triangle of a mesh (after the one triangulation), the quad of a
/// quad list (a box has six), or 0 for a sphere. On a triangle abc, u and v are the barycentric coordinates of b and c;
/// on a quad the coordinates along its two edges; on a sphere both are 0 (the surface point follows from the ray and
/// t). t is the distance along the ray, whose direction has unit length for camera rays: the Euclidean distance from
/// the eye. At equal distance the lower (object, primitive) wins.
struct Hit {
    std::uint32_t object = kNoObject;
    std::uint32_t primitive = 0;
    float u = 0, v = 0;
    float t = std::numeric_limits<float>::infinity();

    bool valid() const { return object != kNoObject; }
    friend bool operator==(const Hit&, const Hit&) = default;
};

} // namespace duet
