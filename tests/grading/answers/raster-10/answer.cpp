// Ambient occlusion from the depth buffer.
#include "raster/lessons/10-ambient-occlusion/lab.h"

#include <cmath>

namespace duet::lab {

Vec3 hemisphere_direction(Vec3 n, Vec2 u) {
    const float r = std::sqrt(u.x);
    const float angle = 2 * kPi * u.y;
    Vec3 helper{0, 0, 1};
    if (std::abs(n.z) > 0.7f) helper = {0, 1, 0};
    const Vec3 a = normalize(cross(helper, n));
    const Vec3 b = cross(n, a);
    const float height = std::sqrt(1 - u.x);
    return a * (r * std::cos(angle)) + b * (r * std::sin(angle)) + n * height;
}

bool is_hidden(const DepthImage& seen, Vec3 q, float bias, float range) {
    const Vec4 clip = seen.clip_from_world * Vec4(q, 1);
    if (clip.w <= 0) return false;
    const float width = static_cast<float>(seen.distance.width());
    const float height = static_cast<float>(seen.distance.height());
    const float px = std::floor((1 + clip.x / clip.w) / 2 * width);
    const float py = std::floor((1 - clip.y / clip.w) / 2 * height);
    if (!(px >= 0 && py >= 0 && px < width && py < height)) return false;
    const float behind = clip.w - seen.distance(static_cast<int>(px), static_cast<int>(py));
    return behind > bias && behind < range;
}

float occlusion(const DepthImage& seen, Vec3 p, const std::vector<Vec3>& directions, const Search& search) {
    if (directions.empty()) return 0;
    int blocked = 0;
    for (const Vec3& d : directions) {
        bool hit = false;
        for (int k = 1; k <= search.steps; ++k) {
            const float t = static_cast<float>(k) / static_cast<float>(search.steps);
            if (is_hidden(seen, p + d * (search.radius * t * t), search.bias, search.range)) hit = true;
        }
        if (hit) blocked += 1;
    }
    return static_cast<float>(blocked) / static_cast<float>(directions.size());
}

ImageFloat blur(const ImageFloat& values, const ImageFloat& distance, int reach, float tolerance) {
    ImageFloat result(values.width(), values.height(), 0);
    for (int y = 0; y < values.height(); ++y) {
        for (int x = 0; x < values.width(); ++x) {
            float sum = 0;
            int count = 0;
            for (int j = y - reach; j <= y + reach; ++j) {
                for (int i = x - reach; i <= x + reach; ++i) {
                    if (i < 0 || j < 0 || i >= values.width() || j >= values.height()) continue;
                    const bool same = i == x && j == y;
                    if (!same && !(std::abs(distance(i, j) - distance(x, y)) <= tolerance)) continue;
                    sum += values(i, j);
                    count += 1;
                }
            }
            result(x, y) = sum / static_cast<float>(count);
        }
    }
    return result;
}

ImageFloat occlusion_image(const DepthImage& seen, const Image<Vec3>& points, const Image<Vec3>& normals, int count,
                           const Search& search) {
    ImageFloat found(points.width(), points.height(), 0);
    for (int y = 0; y < found.height(); ++y) {
        for (int x = 0; x < found.width(); ++x) {
            const Vec3 n = normals(x, y);
            if (length(n) == 0) continue;
            const float turn = static_cast<float>((x % 4) * 4 + y % 4) / 16;
            std::vector<Vec3> directions;
            for (int i = 0; i < count; ++i) {
                const float angle = 0.618034f * static_cast<float>(i) + turn;
                const float part = (static_cast<float>(i) + 0.5f) / static_cast<float>(count);
                directions.push_back(hemisphere_direction(n, {part, angle - std::floor(angle)}));
            }
            found(x, y) = occlusion(seen, points(x, y), directions, search);
        }
    }
    return blur(found, seen.distance, 1, 0.05f);
}

} // namespace duet::lab
