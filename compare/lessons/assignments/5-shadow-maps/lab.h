// Assignment 5: shadow maps against the traced truth.
#pragma once

#include "common/image/image.h"
#include "common/vec/matrix.h"
#include "tests/grading/lab.h"

#include <vector>

namespace duet::lab {

/// An opaque triangle. It throws shadows from both sides.
struct Triangle {
    Vec3 a, b, c;
};

/// The sun or a spot light. A spot light is a disk that faces along `direction`, and shines into a cone.
struct Light {
    Vec3 direction;       ///< in which the light goes, of length 1
    float radius = 0;     ///< of the disk of a spot light, in meters; of the sun, the tangent of its angular radius
    bool spot = false;    ///< whether it is a spot light; otherwise it is the sun
    Vec3 position = {};   ///< of a spot light: the center of its disk
    float half_angle = 1; ///< of a spot light: between `direction` and the rim of the cone, in radians, in (0, 1.2]
};

// The distance of a point p ALONG the light, which all functions below use, is in meters:
//   of a spot light   dot(p - position, direction)
//   of the sun        the same from the plane of depth 0, which LightView places. Only differences of it matter.

/// The camera of a light. The map is square.
struct LightView {
    Mat4 clip_from_world; ///< to clip space: after division by w, x and y in [-1, 1] (y up) and depths in [0, 1]. w is
                          ///< 1 for the sun, and the distance along the light for a spot light
    float near = 0,
          far = 1;   ///< the distances along the light, in meters, that have the depths 0 and 1. near of the sun
                     ///< is 0. The depth at distance t is (t - near) / (far - near) for the sun, and
                     ///< far (t - near) / (t (far - near)) for a spot light
    float width = 1; ///< of what the map shows, in meters: for a spot light, at the distance 1 m
};

/// What a light sees: at the center of each texel, row 0 at the top, the depth of the nearest triangle; infinity where
/// there is none.
struct ShadowMap {
    LightView view;
    ImageFloat depth;
};

/// What the pixels of an image see. The normal has length 1 and points to the side that is seen; it is (0, 0, 0) where
/// the pixel sees nothing.
struct GBuffer {
    Image<Vec3> point, normal;
};

/// The camera of a light.
/// The sun's holds all triangles. Its width and its far are at most 1.1 times the diagonal of the axis-aligned box
/// around the triangles.
/// A spot light's map shows the square around its cone: width is 2 tan(half_angle). Let m be the smallest distance
/// along the light of any corner: near is between 0.8 m and m, but 0.05 if m is below 0.05. far is 1 to 1.1 times the
/// largest distance. What is nearer than `near` throws no shadow.
LightView light_view(const Light& light, const std::vector<Triangle>& triangles);

/// The depths in a map of side × side texels. Triangles may lie in front of near or beyond the map in part or as a
/// whole.
ImageFloat depth_map(const std::vector<Triangle>& triangles, const LightView& view, int side);

/// For each pixel the fraction of (2 reach + 1)² texels that say that it is lit: up to `reach` to each side of the one
/// in which the point lies. Texels beside the map say so, too. How you avoid acne is up to you. It is 0 where the pixel
/// sees nothing, where the surface is turned away from the (center of the) light, and where the point is outside the
/// cone of a spot light.
ImageFloat shadows(const ShadowMap& map, const Light& light, const GBuffer& gbuffer, int reach);

/// The width of the penumbra in meters, on a surface that faces the light, at the distance `receiver` along the light,
/// behind a straight edge at the distance `blocker`. 0 unless 0 < blocker < receiver.
float penumbra_width(const Light& light, float blocker, float receiver);

/// The fraction of the light's disk that each pixel sees, by the map: the mean depth of what blocks the light around
/// the point gives the penumbra's width, and that gives the filter's (percentage-closer soft shadows). 0 where
/// `shadows` is.
ImageFloat soft_shadows(const ShadowMap& map, const Light& light, const GBuffer& gbuffer);

/// The truth: the fraction of rays from each pixel's point to the light that meet no triangle on the way. For
/// samples = 1 the ray leads to the light's center, otherwise `samples` rays lead to points spread evenly over its
/// disk. The disk of the sun: directions -direction + radius · (a point of the unit disk perpendicular to it). 0 where
/// `shadows` is.
ImageFloat traced_shadows(const std::vector<Triangle>& triangles, const Light& light, const GBuffer& gbuffer,
                          int samples);

} // namespace duet::lab

DUET_LAB(light_view, depth_map, shadows, penumbra_width, soft_shadows, traced_shadows)
