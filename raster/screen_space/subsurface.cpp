#include "raster/screen_space/subsurface.h"

#include "raster/gbuffer/neighbors.h"
#include "raster/geometry/lane_math.h"

#include <utility>

namespace duet::raster {
namespace {

using Mask = Floats::batch_bool_type;

Floats look_up(const std::vector<float>& table, const PlaneInt& materials, int x, int y) {
    return gather(table.data() + 1, load(materials, x, y));
}

enum class Axis { kRows, kColumns };

/// Blurs the light of solids along rows or along columns.
class Blur {
public:
    /// `fractions` holds SolidMaterials::fraction for each pixel.
    Blur(const SolidMaterials& materials, const PlaneFloat& fractions, const GBuffer& gbuffer, Axis axis,
         const Planes3& light)
        : materials_(materials), fractions_(fractions), gbuffer_(gbuffer), axis_(axis), light_(light) {}

    /// Returns the blurred light. The weight of a pixel is the fraction of the profile that its width covers. No pixel
    /// is skipped, because with gaps a thin bright line would appear several times.
    RgbT<Floats> at(int x, int y) const {
        const RgbT<Floats> own = light_.color(x, y);
        const Mask solid = load(fractions_, x, y) > Floats(0.0f);
        if (!xsimd::any(solid)) return own;
        const Center center = center_at(x, y, own, solid);
        RgbT<Floats> before = within(center, 0.5f), sum = own * before;
        for (int offset = 1; offset <= kMostPixels; ++offset) {
            const Floats distance = center.slope.along * Floats(static_cast<float>(offset));
            if (!xsimd::any(solid & (center.least * distance < Floats(diffusion_profile::kReach)))) break;
            const RgbT<Floats> all = within(center, static_cast<float>(offset) + 0.5f),
                               weight = (all - before) * Floats(0.5f);
            // Profiles wider than the filter fade out over its last third.
            const float fade = min(1.0f, 3 - 3.0f * static_cast<float>(offset) / kMostPixels);
            for (const int side : {offset, -offset})
                sum += weight * (tap(x, y, side, center) * Floats(fade) + own * Floats(1 - fade));
            before = all;
        }
        sum += own * (RgbT<Floats>(Floats(1.0f)) - before);
        return blend(solid, sum, own);
    }

private:
    static constexpr int kMostPixels = 96; ///< radius of the filter

    struct Slope {
        Floats along; ///< distance in meters from a pixel to the next, on the tangent plane
        Floats depth; ///< greatest change of depth from a pixel to the next, in meters
    };
    struct Center {
        RgbT<Floats> light, scale; ///< scale: the parameters b of the profiles, 1/m
        Floats least;              ///< scale of the channel whose light travels farthest
        Floats depth;
        Slope slope;
    };
    Center center_at(int x, int y, const RgbT<Floats>& light, const Mask& solid) const {
        const RgbT<Floats> scale = scales(x, y, solid);
        return {light, scale, min(min(scale.r, scale.g), scale.b), depth_of(load(gbuffer_.reversed_depth, x, y)),
                slope_at(x, y)};
    }

    Slope slope_at(int x, int y) const {
        constexpr float kLeastFacing = 0.2f; // at smaller cosines, surfaces are stretched no further
        const Vec3T<Floats> p = gbuffer_.points(x, y), n = gbuffer_.normal.vector(x, y);
        const Floats pixel = gbuffer_.projection.pixel_size(depth_of(load(gbuffer_.reversed_depth, x, y)));
        const Floats facing = max(abs(dot(n, gbuffer_.projection.to_viewer(p))), Floats(kLeastFacing));
        const Vec3T<Floats> step =
            broadcast<Floats>(axis_ == Axis::kRows ? gbuffer_.projection.right() : gbuffer_.projection.down());
        const Floats tangent = min(abs(dot(n, step)) / facing, Floats(1 / kLeastFacing));
        return {pixel * sqrt(Floats(1.0f) + tangent * tangent), pixel * tangent};
    }

    Floats depth_of(const Floats& reversed) const {
        return Floats(gbuffer_.projection.near()) / max(reversed, Floats(1e-30f));
    }

    RgbT<Floats> scales(int x, int y, const Mask& solid) const {
        const Floats back = look_up(materials_.internal_reflectance, gbuffer_.material, x, y);
        const Floats part = look_up(materials_.solid_part, gbuffer_.material, x, y);
        const RgbT<Floats> albedo = gbuffer_.diffuse.color(x, y) * (Floats(1.0f) / part);
        const auto channel = [&](const Floats& a, std::size_t c) {
            const Floats path = look_up(materials_.mean_free_path[c], gbuffer_.material, x, y);
            const Floats seen = clamp(a, Floats(0.0f), Floats(1.0f));
            const Floats inside = seen / (Floats(1.0f) - back + seen * back); // the albedo without the coat
            return diffusion_profile::scale(seen) /
                   (xsimd::select(solid, path, Floats(1.0f)) * free_path_factor(inside, back));
        };
        return {channel(albedo.r, 0), channel(albedo.g, 1), channel(albedo.b, 2)};
    }

    /// Returns the fraction of the light that leaves within this many pixels, by channel.
    static RgbT<Floats> within(const Center& center, float pixels) {
        const Floats x = center.slope.along * Floats(pixels);
        return {diffusion_profile::fraction_within(center.scale.r * x),
                diffusion_profile::fraction_within(center.scale.g * x),
                diffusion_profile::fraction_within(center.scale.b * x)};
    }

    /// Returns the light at a distance of `offset` pixels, weighted by whether the pixel belongs to the center's solid.
    /// The weight decreases as the pixel's depth deviates from that of the tangent plane. The center's light has the
    /// remaining weight.
    RgbT<Floats> tap(int x, int y, int offset, const Center& center) const {
        const int column = axis_ == Axis::kRows ? x + offset : x, row = axis_ == Axis::kRows ? y : y + offset;
        const Vec3T<Floats> light = load_at(light_, column, row);
        const Floats away = abs(depth_of(load_at(gbuffer_.reversed_depth, column, row)) - center.depth);
        const Floats off = away - center.slope.depth * Floats(static_cast<float>(std::abs(offset)));
        const Floats alike = clamp(Floats(1.0f) - off * center.least, Floats(0.0f), Floats(1.0f));
        const Floats fraction = load_at(fractions_, column, row);
        const Floats weight = xsimd::select(fraction > Floats(0.0f), alike, Floats(0.0f));
        return center.light + (RgbT<Floats>{light.x, light.y, light.z} - center.light) * weight;
    }

    const SolidMaterials& materials_;
    const PlaneFloat& fractions_;
    const GBuffer& gbuffer_;
    const Axis axis_;
    const Planes3& light_;
};

} // namespace

SolidLobes::SolidLobes(const SolidMaterials& materials, GBuffer& gbuffer, int threads)
    : gbuffer_(gbuffer), all_(gbuffer.diffuse), solids_(gbuffer.width(), gbuffer.height()), others_(solids_),
      specular_(gbuffer.specular), coat_(gbuffer.coat) {
    for_each_batch(gbuffer.width(), gbuffer.height(), threads, [&](int x, int y) {
        const RgbT<Floats> all = all_.color(x, y);
        const RgbT<Floats> solid = all * look_up(materials.fraction, gbuffer.material, x, y);
        solids_.set(x, y, solid), others_.set(x, y, all - solid);
    });
}

void SolidLobes::show(Lobes lobes) {
    gbuffer_.diffuse = lobes == Lobes::kAll ? all_ : lobes == Lobes::kSolids ? solids_ : others_;
    const int width = gbuffer_.width(), height = gbuffer_.height();
    gbuffer_.specular = lobes == Lobes::kSolids ? Planes3(width, height) : specular_;
    if (!coat_.empty()) gbuffer_.coat = lobes == Lobes::kSolids ? PlaneFloat(width, height) : coat_;
}

void blur_solid_light(const SolidMaterials& materials, const GBuffer& gbuffer, int threads, Planes3& light) {
    Planes3 buffer(gbuffer.width(), gbuffer.height());
    PlaneFloat fractions(gbuffer.width(), gbuffer.height());
    for_each_batch(gbuffer.width(), gbuffer.height(), threads,
                   [&](int x, int y) { store(fractions, x, y, look_up(materials.fraction, gbuffer.material, x, y)); });
    // Rows come second: bright tops of solids, seen at a grazing angle, leave streaks along columns, which the rows
    // blur.
    for (const Axis axis : {Axis::kColumns, Axis::kRows}) {
        const Blur blur(materials, fractions, gbuffer, axis, light);
        for_each_batch(gbuffer.width(), gbuffer.height(), threads,
                       [&](int x, int y) { buffer.set(x, y, blur.at(x, y)); });
        std::swap(light, buffer);
    }
}

} // namespace duet::raster
