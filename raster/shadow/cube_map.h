// Shadow maps all around a point.
#pragma once

#include "common/vec/frame.h"
#include "raster/shadow/shadow_map.h"

#include <array>
#include <memory>

namespace duet::raster {

/// The face of a cube about the origin that sees w: ±x, ±y, ±z in this order.
inline std::size_t cube_face(Vec3 w) {
    const std::size_t axis = longest_axis(abs(w));
    return 2 * axis + (w[axis] < 0 ? 1 : 0);
}
/// A vector as a face sees it: to its right, up, and away from the middle. Up is the axis after the face's own.
inline Vec3 to_face(std::size_t face, Vec3 w) {
    const std::size_t axis = face / 2;
    const float sign = face % 2 == 0 ? 1.0f : -1.0f;
    return {w[(axis + 2) % 3] * sign, w[(axis + 1) % 3], w[axis] * sign};
}
/// The way back.
inline Vec3 from_face(std::size_t face, Vec3 seen) {
    const std::size_t axis = face / 2;
    const float sign = face % 2 == 0 ? 1.0f : -1.0f;
    Vec3 w;
    w[(axis + 2) % 3] = seen.x * sign, w[(axis + 1) % 3] = seen.y, w[axis] = seen.z * sign;
    return w;
}

/// Six maps about a point, of cube_views (raster/shadow/light_views.h). A face that no light leaves through is null.
struct CubeMap {
    static constexpr double kGuard = 4; ///< texels of the neighbours around each face

    FrameT<double> frame; ///< its axes
    Vec3d center;
    float near = 0;          ///< depth at which nearness is 1
    float middle = 0;        ///< texels from a face's edge to its middle
    float scale = 0;         ///< texels from the middle to 45° beside it
    std::array<std::unique_ptr<ShadowMap>, 6> faces;
};

} // namespace duet::raster
