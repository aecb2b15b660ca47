#include "raster/shadows/near_casters.h"

#include "raster/shadows/depth_cube.h"

#include "common/sampling/sobol.h"
#include "common/sampling/warp.h"

#include <algorithm>

namespace duet::raster {
namespace {

constexpr int kSide = 64;             ///< texels along a side of the octahedral map
constexpr std::uint32_t kPoints = 32; ///< points on the light
constexpr float kMeetAt = 3;          ///< lines from all points on the light meet at this multiple of the reach

} // namespace

bool near_casters_surround(const CubeMap& cube, float reach) {
    std::ptrdiff_t near = 0, all = 0;
    for (const auto& face : cube.faces) {
        const ImageFloat& depths = face->reversed_depth();
        near += std::ranges::count_if(depths, [&](float reversed) { return cube.near < reach * reversed; });
        all += static_cast<std::ptrdiff_t>(depths.size());
    }
    return near * 2 > all;
}

OctahedralMap near_visibility(double radius, float reach, const std::function<CubeMap(Vec3d)>& draw) {
    OctahedralMap result(kSide);
    const auto for_each_texel = [&](const auto& visit) {
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x) visit(result.texel(x, y), result.direction(x, y));
    };
    for (std::uint32_t i = 0; i < kPoints; ++i) {
        const Vec3 normal = uniform_sphere(sobol_net_point(i, kPoints));
        const Vec3d point = Vec3d(normal) * radius;
        const DepthCube cube(draw(point));
        const Vec3 from(point);
        for_each_texel([&](OctahedralMap::Texel& texel, Vec3 w) {
            Floats width;
            const auto seen = cube.surface(broadcast<Floats>(w * (reach * kMeetAt) - from), width);
            const Vec3 q = abs(Vec3(seen.x.get(0), seen.y.get(0), seen.z.get(0)) + from);
            // The weight of a point is its projected area in the direction.
            const float weight = max(dot(normal, w), 0.0f);
            texel[0] += max(q.x, max(q.y, q.z)) < reach ? 0.0f : weight;
            texel[1] += weight;
        });
    }
    for_each_texel([](OctahedralMap::Texel& texel, Vec3) { texel[0] /= texel[1]; });
    result.finish();
    return result;
}

} // namespace duet::raster
