#include "raster/screen_space/flat_surfaces.h"

#include "common/system/parallel.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace duet::raster {
namespace {

/// This is the confidence that the background continues behind a foreground object; see RadiancePyramid.
constexpr float kNothing = 0.95f;

} // namespace

float max_normal_angle(const ScreenGBuffer& gbuffer, int x, int y) {
    const Vec3 n = gbuffer.normal(x, y);
    const float depth = gbuffer.depth(x, y);
    if (!(depth < kInfinity)) return 0; // background
    const Image<std::uint32_t>& objects = gbuffer.color_prepass().objects;
    float most = -1;
    for (const auto& [dx, dy] : {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)}) {
        const int i = x + dx, k = y + dy;
        if (i < 0 || k < 0 || i >= gbuffer.width() || k >= gbuffer.height()) continue;
        if (objects(i, k) != objects(x, y) || !(std::abs(gbuffer.depth(i, k) - depth) <= kSameSurface * depth))
            continue;
        const float angle = length(gbuffer.normal(i, k) - n);
        if (angle < kMaxSmoothAngle) most = std::max(most, angle);
    }
    return most < 0 ? kMaxSmoothAngle : most; // an isolated pixel is small, and its curvature unknown
}

ImageFloat max_normal_angles(const ScreenGBuffer& gbuffer, int threads) {
    ImageFloat angles(gbuffer.width(), gbuffer.height());
    parallel_for(static_cast<std::size_t>(gbuffer.height()), threads, [&](std::size_t row) {
        for (int x = 0; x < gbuffer.width(); ++x)
            angles(x, static_cast<int>(row)) = max_normal_angle(gbuffer, x, static_cast<int>(row));
    });
    return angles;
}

RadiancePyramid flat_surface_radiance(const ScreenGBuffer& gbuffer, std::span<const std::uint8_t> reflective_objects,
                                      int threads) {
    const ScreenGBuffer::ColorPrepass& prepass = gbuffer.color_prepass();
    ImageFloat known(gbuffer.width(), gbuffer.height());
    parallel_for(static_cast<std::size_t>(gbuffer.height()), threads, [&](std::size_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < gbuffer.width(); ++x) {
            const bool nothing = !(gbuffer.depth(x, y) < kInfinity);
            const bool flat = !nothing && reflective_objects[prepass.objects(x, y)] == 0 && is_flat(gbuffer, x, y);
            known(x, y) = prepass.light_mask(x, y) != 0 ? 0.0f : nothing ? kNothing : flat ? 1.0f : 0.0f;
        }
    });
    return RadiancePyramid(prepass.radiance.finest(), std::move(known), threads);
}

bool is_flat(const ScreenGBuffer& gbuffer, int x, int y) {
    const float depth = gbuffer.depth(x, y);
    if (!(depth < kInfinity)) return false;
    const float pixel = gbuffer.pixel_size(depth);
    return gbuffer.normal_angle(x, y) * (gbuffer.perspective() ? depth : pixel * static_cast<float>(gbuffer.height())) <
           pixel;
}

} // namespace duet::raster
