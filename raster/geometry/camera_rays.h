// Computes camera rays, one per SIMD lane.
#pragma once

#include "common/camera/camera.h"
#include "raster/geometry/packet.h"

namespace duet::raster {

/// Holds camera rays through the pixel positions (x, y), bit-identical to Pinhole::ray. Values that Pinhole::ray rounds
/// to float are rounded here too, but stored as doubles.
struct CameraRays {
    Vec3T<Doubles> origin, direction; ///< rounded to float precision
    Doubles t_min;                    ///< not rounded
    Doubles per_depth;                ///< distance along the ray per meter of depth

    CameraRays(const Pinhole& pinhole, const Doubles& x, const Doubles& y) {
        const auto linear = [&](Vec3d start, Vec3d dx, Vec3d dy) {
            const auto along = [&](std::size_t axis) {
                return Doubles(start[axis]) + Doubles(dx[axis]) * x + Doubles(dy[axis]) * y;
            };
            return Vec3T<Doubles>{along(0), along(1), along(2)};
        };
        const Vec3T<Doubles> from = linear(pinhole.origin, pinhole.origin_dx, pinhole.origin_dy),
                             unnormalized = linear(pinhole.direction, pinhole.direction_dx, pinhole.direction_dy);
        per_depth = xsimd::sqrt(unnormalized.x * unnormalized.x + unnormalized.y * unnormalized.y +
                                unnormalized.z * unnormalized.z);
        t_min = Doubles(pinhole.near) * per_depth;
        origin = {round_to_float(from.x), round_to_float(from.y), round_to_float(from.z)};
        direction = {round_to_float(unnormalized.x / per_depth), round_to_float(unnormalized.y / per_depth),
                     round_to_float(unnormalized.z / per_depth)};
    }

    /// Returns the ray of one lane.
    Ray at(std::size_t lane, float time) const {
        return {.origin = of(origin, lane),
                .direction = of(direction, lane),
                .t_min = static_cast<float>(t_min.get(lane)),
                .time = time};
    }

private:
    static Vec3 of(const Vec3T<Doubles>& v, std::size_t lane) {
        return {static_cast<float>(v.x.get(lane)), static_cast<float>(v.y.get(lane)),
                static_cast<float>(v.z.get(lane))};
    }
};

} // namespace duet::raster
