// What glass shows of the scene, as far as the picture without it does.
#pragma once

#include "common/material/material.h"
#include "raster/light/direct.h"
#include "raster/screen/surroundings.h"

namespace duet::raster {

inline constexpr int kGlassDeep = 4; ///< objects of glass on a pixel's way that are seen through each other

/// Light by way of glass at a point of the picture: the mirror image on its front, and what is seen through it, each
/// looked up along its ray in a picture of the scene without this object (Scenery). In that, other glass shows what is
/// behind it, up to kGlassDeep objects deep; the last is seen as if there were no glass behind it.
///
/// Refraction is at two boundaries (Wyman 2005, «An Approximate Image-Space Approach for Interactive Refraction»): where
/// the ray enters, and where it leaves again. A ball's far side is found exactly. A mesh's is looked for in the depths of
/// its nearest back faces, by steps from plane to plane (the fixed-point search of Oliveira and Brauwers 2007, «Real-Time
/// Refraction through Deformable Objects», by the normals too); at total reflection the ray goes on inside, to them or
/// to the front, kSegments times at most. Light that is mirrored within glass in part is taken to leave with the rest, so
/// that nothing is lost. What stands in an inside, or behind a sheet without one, is seen there.
class SeenThrough {
public:
    /// `screen` has Screen::behind. Refers to all.
    SeenThrough(const PreparedData& data, const Settings& settings, const Screen& screen, const ShadingPoint& point);

    Rgb operator()(const DielectricBsdf& bsdf) const { return boundary(bsdf, 0); }
    Rgb operator()(const RoughDielectricBsdf& bsdf) const { return boundary({bsdf.eta, bsdf.tint}, bsdf.alpha); }
    Rgb operator()(const ThinDielectricBsdf& bsdf) const;
    template <typename Other> Rgb operator()(const Other&) const { return {}; }

    static constexpr int kSegments = 4, kSteps = 6;

private:
    /// A ray in glass or just out of it, relative to the eye.
    struct Segment {
        Vec3 p, way;
        Vec3 n;            ///< outwards, where it leaves
        float inside = 0;  ///< metres gone through glass
        int lost = 0;      ///< how often neighbouring rays have parted: mirrored within, or its far side not found for sure
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
    Vec3 p_;           ///< relative to the eye
    float width_ = 0, turn_ = 0; ///< of a pixel here, metres; by which its neighbour's normal parts from its own, radians:
                                 ///< negative in a hollow
    float size_;       ///< of the object, metres
};

/// Whether an object's light comes by way of glass alone, and the picture without it is looked at for what that shows.
bool is_glass(const PreparedData& data, std::uint32_t object);

} // namespace duet::raster
