// The library's directions (common/sampling/warp.h) with the lesson's question to the depth buffer.
#include "common/sampling/warp.h"
#include "common/vec/frame.h"
#include "raster/lessons/10-ambient-occlusion/lab.h"
#include "raster/lessons/10-ambient-occlusion/occlusion.h"

namespace duet::lab {

Vec3 hemisphere_direction(Vec3 n, Vec2 u) { return frame_from_normal(n).to_world(cosine_hemisphere(u)); }

bool is_hidden(const DepthImage& seen, Vec3 q, float bias, float range) {
    const lesson::GBuffer buffer{seen.clip_from_world, {}, {}, seen.distance};
    return lesson::is_hidden(buffer, q, {.bias = bias, .range = range});
}

float occlusion(const DepthImage& seen, Vec3 p, const std::vector<Vec3>& directions, const Search& search) {
    const lesson::GBuffer buffer{seen.clip_from_world, {}, {}, seen.distance};
    float blocked = 0;
    for (const Vec3& d : directions) {
        bool found = false;
        for (int k = 1; k <= search.steps && !found; ++k) {
            const float t = sqr(static_cast<float>(k) / static_cast<float>(search.steps));
            found =
                lesson::is_hidden(buffer, p + d * (search.radius * t), {.bias = search.bias, .range = search.range});
        }
        blocked += found;
    }
    return directions.empty() ? 0 : blocked / static_cast<float>(directions.size());
}

ImageFloat blur(const ImageFloat& values, const ImageFloat& distance, int reach, float tolerance) {
    ImageFloat result = values;
    for (int y = 0; y < values.height(); ++y)
        for (int x = 0; x < values.width(); ++x) {
            float sum = 0, count = 0;
            for (int j = max(y - reach, 0); j <= min(y + reach, values.height() - 1); ++j)
                for (int i = max(x - reach, 0); i <= min(x + reach, values.width() - 1); ++i)
                    if ((i == x && j == y) || std::abs(distance(i, j) - distance(x, y)) <= tolerance)
                        sum += values(i, j), ++count;
            result(x, y) = sum / count;
        }
    return result;
}

ImageFloat occlusion_image(const DepthImage& seen, const Image<Vec3>& points, const Image<Vec3>& normals, int count,
                           const Search& search) {
    const lesson::GBuffer buffer{seen.clip_from_world, points, normals, seen.distance};
    ImageFloat result(points.width(), points.height(), 0);
    for (int y = 0; y < result.height(); ++y)
        for (int x = 0; x < result.width(); ++x)
            if (length(normals(x, y)) > 0)
                result(x, y) = lesson::occlusion(
                    buffer, x, y,
                    {.directions = count, .radius = search.radius, .bias = search.bias, .range = search.range});
    return result;
}

} // namespace duet::lab
