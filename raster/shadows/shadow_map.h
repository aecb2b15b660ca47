// This header declares shadow maps (Williams 1978, "Casting Curved Shadows on Curved Surfaces").
#pragma once

#include "common/image/image.h"
#include "raster/render.h"

#include <array>
#include <optional>

namespace duet::raster {

/// A receiver is a point that may be in shadow.
struct Receiver {
    Vec3d p;
    Vec3d n; ///< unit normal of its plane, on the visible side
    double error = 0; ///< largest distance of p from its plane, meters
};

/// A shadow map stores the depths that a light sees through one camera. Each is sampled at its texel's center, as
/// exactly as in any rendered image.
class ShadowMap {
public:
    /// Renders the depths of `casters` into side × side texels.
    ShadowMap(const RasterScene& casters, const Camera& camera, int side, int threads);

    /// Projects a point to texels from the upper left corner, and depth. The result is empty where the point is
    /// within `margin` texels of the map's edge, outside the map, or behind the near plane.
    std::optional<Vec3d> project(Vec3d p, double margin) const;
    /// Returns the unshadowed fraction of a point light's or a sun's light, in [0, 1]. This is percentage-closer
    /// filtering (Reeves, Salesin and Cook 1987) over 4 × 4 texels with the weights of the quadratic B-spline. It
    /// blurs an edge over kFilterRadius texels to each side. `projected` is the receiver's projected position, at least
    /// kMargin texels from the edge.
    /// If alpha-blended surfaces are dithered over 4 × 4 texels (raster/output/alpha_depth.h), the filter is
    /// instead a box of 4 texels over 5 × 5 of them. In each direction the box weights every rank of the dither
    /// matrix equally at any position, so the pattern cancels. An edge is blurred over kLayeredRadius texels.
    /// Each texel's depth is compared with the depth of the receiver's *plane* at the texel's center (Isidoro 2006,
    /// "Shadow Mapping: GPU-based Tips and Techniques", receiver plane depth bias). On a plane both are equal up to
    /// rounding, at any slope, so no slope-scaled bias is needed. A texel counts as
    /// - dark, if it sees a surface above the receiver's plane, and the receiver is below the tangent plane of that
    /// surface. If each of two points is on the lit side of the other's plane, neither shades the other. So the
    /// facets of a concave surface do not shade each other, at any angle of light. The tangent plane is estimated
    /// from the map around the texel. A surface on the receiver's own ray has no tolerance and shades at any contact,
    /// as a roof shades the wall that it touches. A surface that rises no more than the facets of one surface shades
    /// only where most texels are dark.
    /// - unknown, if it sees a surface below the plane that is steeper than the facets of a ridge. The receiver's
    /// surface ends before that texel, and light beyond its edge must not leak back. A surface above the plane but
    /// farther from the light than the receiver is also unknown.
    /// - lit, otherwise: it sees the receiver's own surface. A texel below the plane counts as lit only if nothing
    /// touches the receiver.
    float lit_fraction(const Receiver& receiver, Vec3d projected) const;

    static constexpr double kFilterRadius = 1.5, kLayeredRadius = 2;
    static constexpr double kMargin = 2.5; ///< texels that a receiver needs around its position, for either filter
    // These constants are bounds rather than tuned values. The tests of concave surfaces, ridges and contacts pass
    // with steepness from 0.5 to 5, fraction of the elevation from 0.9 to 0.99, falling from 0 to 0.9, 48 to 200
    // roundings, least known from 0 to 0.25, and unsure from 0.75 to 1, varied one at a time.
    static constexpr double kSteepest = 0.5; ///< facets of one surface meet at up to 27° (tangent)
    /// On the light's side the largest tangent is this fraction of the light's elevation.
    static constexpr double kOfElevation = 0.9;
    static constexpr double kFalling = 0.23; ///< the same for facets below the receiver's plane
    /// Unit: rounding of a texel's own plane (roundings_over_receiver); depths are computed in float.
    static constexpr double kDepths = 64;
    /// This is the same limit for texels up to one away, where a depth and two differences of two depths
    /// contribute.
    static constexpr double kFourDepths = 5;
    /// Filter weight: if the texels with a result weigh less, is_covered() decides.
    static constexpr double kUnsure = 0.75;
    /// Contacts shade only above this fraction of the texels with a result.
    static constexpr double kContactsShade = 0.75;
    static constexpr double kMinKnown = 0.25; ///< filter weight: texels of less total weight do not decide alone

    const Pinhole& view() const { return view_; }
    bool orthographic() const { return orthographic_; }
    int side() const { return reversed_depth_.width(); }
    /// Returns the reversed depth, near / depth, at a texel's center; 0 where nothing is visible.
    float reversed_depth(int x, int y) const { return reversed_depth_(x, y); }
    const ImageFloat& reversed_depth() const { return reversed_depth_; }
    double near() const { return view_.near; }
    /// Returns the width of a texel at a depth, in meters.
    double texel(double depth) const;

private:
    struct Plane;
    Plane plane(const Receiver& receiver, Vec3d projected) const;
    /// Returns a texel's value in the units of Plane::at. An empty texel gives a large finite depth, so that
    /// differences remain finite.
    double value_at(int x, int y) const {
        const double reversed_depth = max(static_cast<double>(reversed_depth_(x, y)), 1e-30);
        return orthographic_ ? -view_.near / reversed_depth : reversed_depth;
    }
    double roundings_over_receiver(const Plane& plane, Vec3d projected, int x, int y) const;
    bool is_covered(const Plane& plane, Vec3d projected) const;
    template <std::size_t N>
    float lit_fraction(const Receiver& receiver, Vec3d projected, int x0, int y0, const std::array<double, N>& across,
                       const std::array<double, N>& down) const;

    Pinhole view_;
    bool orthographic_, layered_; ///< layered_: alpha-blended casters are dithered
    /// Stores near / depth; 0 where nothing is visible. For a plane this is linear in texel coordinates in a
    /// perspective view; in an orthographic view the depth itself is.
    ImageFloat reversed_depth_;
};

} // namespace duet::raster
