// This header declares the shading of glass from the image rendered without it.
#pragma once

#include "common/material/material.h"
#include "raster/lighting/direct_lighting.h"
#include "raster/screen_space/screen_space_tracer.h"

namespace duet::raster {

/// This is the maximum number of glass objects along a pixel's ray that are visible through each other.
inline constexpr int kMaxGlassDepth = 4;

/// Computes the light that glass reflects and transmits at a point of the image. Both are looked up along their rays
/// in an image of the scene without this object (ReflectionSource). Other glass in that image shows what is behind it,
/// up to kMaxGlassDepth objects deep; the last one assumes no glass behind it.
///
/// Light is refracted at two boundaries, where the ray enters and where it leaves (Wyman 2005, "An Approximate
/// Image-Space Approach for Interactive Refraction"). The exit from a sphere is exact. The exit from a mesh is
/// searched in the depths of its nearest back faces, from plane to plane (the fixed-point search of Oliveira and
/// Brauwers 2007, "Real-Time Refraction through Deformable Objects", using the normals, too). At total internal
/// reflection the ray continues inside, to the back faces or to the front, at most kSegments times. Light partially
/// reflected inside the glass is assumed to leave with the rest, so that no energy is divergences. Objects inside the
/// glass, or behind a thin sheet, are visible through it.
class ScreenSpaceRefraction {
public:
    /// `gbuffer` must have ScreenGBuffer::behind. All arguments must outlive this object.
    ScreenSpaceRefraction(const RasterSceneData& data, const RasterSettings& settings, const ScreenGBuffer& gbuffer,
                          const ShadingPoint& point);

    Rgb operator()(const DielectricBsdf& bsdf) const { return boundary(bsdf, 0); }
    Rgb operator()(const RoughDielectricBsdf& bsdf) const { return boundary({bsdf.eta, bsdf.tint}, bsdf.alpha); }
    Rgb operator()(const ThinDielectricBsdf& bsdf) const;
    template <typename Other> Rgb operator()(const Other&) const { return {}; }

    static constexpr int kSegments = 4, kSteps = 6;

private:
    /// A segment is a ray inside glass, or just outside of it, relative to the eye.
    struct Segment {
        Vec3 p, direction;
        Vec3 n; ///< outward, where the ray leaves
        float inside = 0; ///< distance through glass, in meters
        /// Counts the events that make neighboring rays diverge: total internal reflection, or an uncertain exit.
        int divergences = 0;
    };

    Rgb boundary(const DielectricBsdf& bsdf, float alpha) const;
    Rgb through(Vec3 direction, float eta, float alpha) const;
    std::optional<Rgb> hit_inside(Vec3 p) const;
    Segment trace_inside(Vec3 direction, float eta) const;
    std::optional<Segment> across_sphere(const Segment& from) const;
    std::optional<Segment> across_back_faces(const Segment& from) const;
    const ScreenGBuffer& layer(int x, int y) const;
    Rgb reflection(Vec3 direction, float alpha, bool include_lights) const;

    const RasterSceneData& data_;
    const ScreenGBuffer& gbuffer_;
    const ShadingPoint& point_;
    ReflectionSource source_;
    ScreenSpaceTracer tracer_;
    Vec3 p_; ///< relative to the eye
    /// Stores the width of a pixel here, in meters, and the angle between neighboring normals, in radians:
    /// negative if concave.
    float width_ = 0, normal_angle_ = 0;
    float size_; ///< of the object, in meters
};

/// Returns whether an object is glass, shaded only by reflection and refraction in the image without it.
bool is_glass(const RasterSceneData& data, std::uint32_t object);

} // namespace duet::raster
