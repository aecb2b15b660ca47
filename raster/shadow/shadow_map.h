// Shadow maps: what a light sees hides the rest from it (Williams 1978, «Casting Curved Shadows on Curved Surfaces»).
#pragma once

#include "common/image/image.h"
#include "raster/render.h"

#include <array>
#include <optional>

namespace duet::raster {

/// A point that may lie in a shadow.
struct Receiver {
    Vec3d p;
    Vec3d n;          ///< unit normal of its plane, on the side that is seen
    double error = 0; ///< how far p may be off its plane, metres
};

/// The depths that a light sees through one camera, each at the centre of its texel, as exact as any picture's.
class ShadowMap {
public:
    /// Draws `casters`, depths alone, onto side × side texels.
    ShadowMap(const Prepared& casters, const Camera& camera, int side, int threads);

    /// Where a point is seen: texels from the upper left corner, and depth. Empty where that is nearer than `margin`
    /// texels to the map's edge, beyond it, or not before the light.
    std::optional<Vec3d> place(Vec3d p, double margin) const;
    /// The part of a point light's or a sun's light that arrives, in [0, 1]: percentage-closer filtering (Reeves,
    /// Salesin and Cook 1987) over 4 × 4 texels, weighed by the quadratic B-spline about the point's place: an edge is
    /// blurred over kFilterRadius texels to both sides. `place` is the receiver's, kMargin or more from the edge.
    ///
    /// Where surfaces that let a part of the light through are dithered over 4 × 4 texels (raster/visibility/layered_nearness.h), the
    /// filter is the box of 4 texels about the point's place instead, over 5 × 5 of them: in each direction it takes
    /// every rank of the pattern for as much as any other, wherever the place is, so that nothing of the pattern is left,
    /// and an edge is blurred over kLayeredRadius texels.
    ///
    /// Each texel's depth is compared with that of the receiver's *plane* at the texel's centre (Isidoro 2006, «Shadow
    /// Mapping: GPU-based Tips and Techniques», receiver plane depth bias). On a plane both are the same number but for
    /// rounding, however steep the light: there is no slope to be guessed. A texel says
    /// - dark, if it sees something over that, under whose own plane the receiver is: of two points of which each is on the
    ///   lit side of the other's plane neither shades the other, as on the facets of a valley, however light grazes them and
    ///   however steeply they meet. The plane is what the map has around the texel. What is on the receiver's own ray has no
    ///   slack at all, and shades at any contact, as a roof the wall that it lies on. What rises no more than facets of one
    ///   surface do shades where most texels are dark.
    /// - nothing, if it sees something behind that, steeper than the facets of a ridge: the receiver's surface ends before,
    ///   and what light there is beyond its edge does not leak back around it. Nor if what stands over the plane is farther
    ///   from the light than the receiver.
    /// - lit, else: it sees the receiver's surface. What is under the plane says so only where nothing lies on the receiver.
    float lit_fraction(const Receiver& receiver, Vec3d place) const;

    static constexpr double kFilterRadius = 1.5, kLayeredRadius = 2;
    static constexpr double kMargin = 2.5; ///< texels that a receiver needs about its place, by either filter
    // Bounds, not measures: the tests of hollows, ridges and contacts pass with any steepness from 0.5 to 5, any part of the
    // elevation from 0.9 to 0.99, falling from 0 to 0.9, 48 to 200 times the rounding, least known from 0 to 0.25 and unsure
    // from 0.75 to 1, one at a time.
    static constexpr double kSteepest = 0.5;    ///< facets of one surface meet at up to 27°,
    static constexpr double kOfElevation = 0.9; ///< or, on the light's side, at most nearly as steeply as light falls;
    static constexpr double kFalling = 0.23;    ///< those under the receiver's plane at less of it
    static constexpr double kDepths = 64; ///< roundings of a texel's own plane (roundings_over_receiver): its depths are solved in float
    static constexpr double kFourDepths = 5; ///< the same of texels up to one beside the place: of a depth, and two differences of two
    static constexpr double kUnsure = 0.75; ///< of the filter: where texels of less weight say anything, what covers the receiver counts
    static constexpr double kContactsShade = 0.75; ///< of the texels that say anything: where less block, contacts do not shade
    static constexpr double kLeastKnown = 0.25; ///< of the filter: texels of less weight together do not decide alone

    int side() const { return nearness_.width(); }
    /// near / depth at a texel's centre; 0 where nothing is seen.
    float nearness(int x, int y) const { return nearness_(x, y); }
    const ImageFloat& nearness() const { return nearness_; }
    double near() const { return view_.near; }
    /// The width of a texel at a depth, metres.
    double texel(double depth) const;

private:
    struct Plane;
    Plane plane(const Receiver& receiver, Vec3d place) const;
    /// As Plane::at, what a texel sees; nothing is far away, but no infinity, of which no differences could be taken.
    double seen(int x, int y) const {
        const double nearness = max(static_cast<double>(nearness_(x, y)), 1e-30);
        return orthographic_ ? -view_.near / nearness : nearness;
    }
    double roundings_over_receiver(const Plane& plane, Vec3d place, int x, int y) const;
    bool is_covered(const Plane& plane, Vec3d place) const;
    template <std::size_t N>
    float lit_fraction(const Receiver& receiver, Vec3d place, int x0, int y0, const std::array<double, N>& across,
                       const std::array<double, N>& down) const;

    Pinhole view_;
    bool orthographic_, layered_; ///< layered: some of what it sees is dithered
    /// near / depth; 0 where nothing is seen. Of a point's plane it is linear in the texels' coordinates, seen from a
    /// point; seen from infinitely far depth itself is.
    ImageFloat nearness_;
};

} // namespace duet::raster
