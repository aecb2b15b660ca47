#include "common/medium/cloud.h"

#include "common/system/parallel.h"
#include "common/texture/noise.h"

#include <algorithm>
#include <cmath>

namespace duet {

std::array<int, 3> grid_size(const Box3& box, int resolution) {
    const Vec3d sides = Vec3d(box.high) - Vec3d(box.low);
    std::array<int, 3> size{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double cells = resolution * (sides[axis] / max_component(sides));
        size[axis] = std::max(static_cast<int>(std::ceil(cells)), 1) + 1;
    }
    return size;
}

DensityGrid make_cloud(const Cloud& cloud, const Box3& box) {
    const Vec3d half = (Vec3d(box.high) - Vec3d(box.low)) * 0.5;
    const std::array<int, 3> size = grid_size(box, cloud.resolution);
    const auto count = [&](std::size_t axis) { return static_cast<std::size_t>(size[axis]); };
    std::vector<float> densities(count(0) * count(1) * count(2));
    const auto position = [&](std::size_t axis, std::size_t i) { // from −1 to 1 between the sides of the box
        return 2 * static_cast<double>(i) / (size[axis] - 1) - 1;
    };
    parallel_for(count(2), 0, [&](std::size_t z) {
        for (std::size_t y = 0; y < count(1); ++y)
            for (std::size_t x = 0; x < count(0); ++x) {
                const Vec3d p(position(0, x), position(1, y), position(2, z));
                const double inside = 1 - length_squared(p);
                if (!(inside > 0)) continue; // beyond the ellipsoid that touches the sides
                const double noise = fractal_noise(p * half * static_cast<double>(cloud.scale), cloud.octaves);
                const double excess = noise + 3 * static_cast<double>(cloud.coverage) - 3 + 2 * inside;
                // The density fades out in a thin shell at the ellipsoid, however large the noise is.
                const double fade = std::min(1.0, 8 * inside);
                densities[x + count(0) * (y + count(1) * z)] =
                    static_cast<float>(fade * clamp(excess / static_cast<double>(cloud.softness), 0.0, 1.0));
            }
    });
    return {size, std::move(densities)};
}

} // namespace duet
