// This header declares a cube of shadow maps around a point.
#pragma once

#include "common/vec/frame.h"
#include "raster/shadows/shadow_map.h"

#include <array>
#include <memory>

namespace duet::raster {

/// Returns the face of a cube about the origin that contains the direction w; the order is +x, −x, +y, −y, +z,
/// −z.
inline std::size_t cube_face(Vec3 w) {
    const std::size_t axis = longest_axis(abs(w));
    return 2 * axis + (w[axis] < 0 ? 1 : 0);
}
/// Returns a vector in a face's coordinates: to the right, up, and outward. "Up" is the axis after the face's own.
inline Vec3 to_face(std::size_t face, Vec3 w) {
    const std::size_t axis = face / 2;
    const float sign = face % 2 == 0 ? 1.0f : -1.0f;
    return {w[(axis + 2) % 3] * sign, w[(axis + 1) % 3], w[axis] * sign};
}
/// Returns the vector with the given face coordinates; the inverse of to_face().
inline Vec3 from_face(std::size_t face, Vec3 seen) {
    const std::size_t axis = face / 2;
    const float sign = face % 2 == 0 ? 1.0f : -1.0f;
    Vec3 w;
    w[(axis + 2) % 3] = seen.x * sign, w[(axis + 1) % 3] = seen.y, w[axis] = seen.z * sign;
    return w;
}

/// Holds six shadow maps around a point, rendered by Shadows (raster/shadows/shadow_maps.h) from the cameras of
/// cube_views. A face through which no light leaves is null.
struct CubeMap {
    static constexpr double kGuard = 4; ///< guard texels of the neighboring faces around each face

    FrameT<double> frame; ///< the cube's axes
    Vec3d center;
    float near = 0;   ///< depth at which reversed depth is 1
    float middle = 0; ///< texels from a face's edge to its center
    float scale = 0;  ///< texels from the center to 45° off the axis
    std::array<std::unique_ptr<ShadowMap>, 6> faces;
};

} // namespace duet::raster
