#include "raster/fog/fog_grid.h"

#include "raster/fog/pixel_rays.h"
#include "raster/lighting/background.h"

#include <algorithm>

namespace duet::raster {
namespace {

using Vec3s = Vec3T<Floats>;
using Color = RgbT<Floats>;
const Floats kNone(0.0f);

} // namespace

AmbientLight environment_in_fog(const RasterSceneData& data, const RasterSettings& settings,
                                const ScreenProjection& projection) {
    if (!shows_environment(data, settings)) return {};
    Rgb mean = data.ambient;
    if (data.sun) mean = mean - data.sun->light.irradiance * (kInvPi / 4); // sun_lights() has this part
    return [light = broadcast<Floats>(mean),
            media = frame_media(data.scene.media, settings, projection)](const Vec3s& p) {
        Color sum(kNone);
        for (const Vec3 axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)})
            for (const Vec3 w : {axis, -axis})
                sum += transmittance(optical_depth<Floats>(media, p, broadcast<Floats>(w), Floats(kInfinity)));
        return light * sum * Floats(1.0f / 6);
    };
}

/// Returns the in-scattered and emitted radiance between the eye and the surfaces. Within the slice that contains the
/// surface, the media are taken to be lit evenly. `depth` is the optical depth up to the surface.
Color FogGrid::light_before(int x, int y, const PixelRays& rays, const Color& depth) const {
    const Floats distance = min(rays.distance, Floats(distances_.back()));
    const Floats slice =
        xsimd::log1p(max(distance - Floats(nearest_), kNone) * Floats(1 / scale_)) * Floats(slices_per_log_);
    const Ints k = truncated(min(slice, Floats(static_cast<float>(slices_ - 1))));
    const Floats begin = gather(distances_.data(), k), end = gather(distances_.data() + 1, k);
    const Floats length = max(end - begin, Floats(1e-15f)), within = clamp(distance - begin, kNone, length);
    const Vec3s entry = rays.origin + rays.direction * begin;
    const Color whole = optical_depth<Floats>(media_, entry, rays.direction, length),
                part = optical_depth<Floats>(media_, entry, rays.direction, within);
    const auto fraction = [&](const Floats& all, const Floats& some) {
        const Floats scattered = some * mean_transmittance(some) / max(all * mean_transmittance(all), Floats(1e-12f));
        return xsimd::select(all > Floats(1e-6f), scattered, within / length);
    };
    const Color fractions{fraction(whole.r, part.r), fraction(whole.g, part.g), fraction(whole.b, part.b)};
    const Color light = interpolate(light_, x, y, k, fractions);
    if (stopped_.empty()) return light;
    // A cloud's edge is sharper than a froxel. Scale the light by the ratio of the pixel's own opacity to the
    // interpolated opacity.
    const Color around = interpolate(stopped_, x, y, k, fractions);
    const auto share = [](const Floats& own_depth, const Floats& mean) {
        const Floats least(1e-5f); // added to both opacities, so that thin haze keeps its light
        return min((least - xsimd::expm1(-own_depth)) / (least + mean), Floats(2.0f));
    };
    return light * Color(share(depth.r, around.r), share(depth.g, around.g), share(depth.b, around.b));
}

/// Interpolates bilinearly between the rays of the four nearest columns, and linearly between both ends of each slice.
Color FogGrid::interpolate(const Planes3& planes, int x, int y, const Ints& slices, const Color& within) const {
    const float per_pixel = 1 / static_cast<float>(side_);
    const Floats across = lane_offsets(static_cast<float>(x), 1) * Floats(per_pixel);
    const Floats left = min(xsimd::floor(across), Floats(static_cast<float>(std::max(columns_ - 2, 0)))),
                 fx = across - left;
    const int top = std::min(y / side_, std::max(rows_ - 2, 0)), right = columns_ > 1 ? 1 : 0;
    const float below = static_cast<float>(y) * per_pixel - static_cast<float>(top);
    const Ints at = slices * Ints(planes.x.stride()) + truncated(left);
    Color result(kNone);
    for (int j = 0; j < std::min(rows_, 2); ++j) {
        const auto channel = [&](const PlaneFloat& plane, const Floats& fz) {
            const auto at_end = [&](int ends) {
                const float* from = plane.row(row(top + j, ends));
                return lerp(gather(from, at), gather(from + right, at), fx);
            };
            return lerp(at_end(0), at_end(1), fz);
        };
        result += Color(channel(planes.x, within.r), channel(planes.y, within.g), channel(planes.z, within.b)) *
                  Floats(j == 0 ? 1 - below : below);
    }
    return result;
}

Planes3 FogGrid::haze(const GBuffer& gbuffer, int threads) const {
    std::vector<Medium> scattering = media_;
    for (Medium& medium : scattering) medium.absorption = Rgb();
    Planes3 result(gbuffer.width(), gbuffer.height());
    for_each_batch(gbuffer.width(), gbuffer.height(), threads, [&](int x, int y) {
        const PixelRays rays(gbuffer, x, y);
        const auto depth = [&](std::span<const Medium> media) {
            return optical_depth<Floats>(media, rays.origin, rays.direction, min(rays.distance, Floats(1e20f)));
        };
        result.set(x, y, depth(scattering) * mean_transmittance(depth(media_)));
    });
    return result;
}

void FogGrid::apply(const GBuffer& gbuffer, int threads, bool scattered, Planes3& radiance) const {
    if (media_.empty()) return; // the boxes of all media are too thin for floats
    for_each_batch(gbuffer.width(), gbuffer.height(), threads, [&](int x, int y) {
        const PixelRays rays(gbuffer, x, y);
        const Color depth = optical_depth<Floats>(media_, rays.origin, rays.direction, rays.distance);
        Color sum = radiance.color(x, y) * transmittance(depth);
        if (scattered) sum += light_before(x, y, rays, depth);
        radiance.set(x, y, sum);
    });
}

} // namespace duet::raster
