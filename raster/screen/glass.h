// This header declares the shading of glass from the image rendered without it.
#pragma once

#include "common/material/material.h"
#include "raster/light/direct.h"
#include "raster/screen/surroundings.h"

namespace duet::raster {

/// This is the maximum number of glass objects along a pixel's ray that are visible through each other.
inline constexpr int kGlassDeep = 4;

/// Computes the light that glass reflects and transmits at a point of the image. Both are looked up along their rays
/// in an image of the scene without this object (Scenery). Other glass in that image shows what is behind it, up to
/// kGlassDeep objects deep; the last one assumes no glass behind it.
///
/// Light is refracted at two boundaries, where the ray enters and where it leaves (Wyman 2005, "An Approximate
/// Image-Space Approach for Interactive Refraction"). The exit from a sphere is exact. The exit from a mesh is
/// searched in the depths of its nearest back faces, from plane to plane (the fixed-point search of Oliveira and
/// Brauwers 2007, "Real-Time Refraction through Deformable Objects", using the normals, too). At total internal
/// reflection the ray continues inside, to the back faces or to the front, at most kSegments times. Light partially
/// reflected inside the glass is assumed to leave with the rest, so that no energy is lost. Objects inside the glass,
/// or behind a thin sheet, are visible through it.
class SeenThrough {
public:
    /// `screen` must have Screen::behind. All arguments must outlive this object.
    SeenThrough(const PreparedData& data, const Settings& settings, const Screen& screen, const ShadingPoint& point);

    Rgb operator()(const DielectricBsdf& bsdf) const { return boundary(bsdf, 0); }
    Rgb operator()(const RoughDielectricBsdf& bsdf) const { return boundary({bsdf.eta, bsdf.tint}, bsdf.alpha); }
    Rgb operator()(const ThinDielectricBsdf& bsdf) const;
    template <typename Other> Rgb operator()(const Other&) const { return {}; }

    static constexpr int kSegments = 4, kSteps = 6;

private:
    /// A segment is a ray inside glass, or just outside of it, relative to the eye.
    struct Segment {
        Vec3 p, way;
        Vec3 n; ///< outward, where the ray leaves
        float inside = 0; ///< distance through glass, in meters
        /// Counts the events that make neighboring rays diverge: total internal reflection, or an uncertain exit.
        int lost = 0;
    };

    Rgb boundary(const DielectricBsdf& bsdf, float alpha) const;
    Rgb through(Vec3 way, float eta, float alpha) const;
    std::optional<Rgb> met_inside(Vec3 p) const;
    Segment follow(Vec3 way, float eta) const;
    std::optional<Segment> across_ball(const Segment& from) const;
    std::optional<Segment> across_picture(const Segment& from) const;
    const Screen& layer(int x, int y) const;
    Rgb mirror(Vec3 way, float alpha, bool lamps) const;

    const PreparedData& data_;
    const Screen& screen_;
    const ShadingPoint& point_;
    Scenery scenery_;
    Surroundings around_;
    Vec3 p_; ///< relative to the eye
    /// Stores the width of a pixel here, in meters, and the angle between neighboring normals, in radians:
    /// negative if concave.
    float width_ = 0, turn_ = 0;
    float size_; ///< of the object, in meters
};

/// Returns whether an object is glass, shaded only by reflection and refraction in the image without it.
bool is_glass(const PreparedData& data, std::uint32_t object);

} // namespace duet::raster
