// Soft shadows of lights that have an area, from the depths that their centre sees.
#pragma once

#include "raster/lanes.h"
#include "raster/shadow/cube_map.h"
#include "raster/shadow/emitter.h"
#include "raster/visibility/nearest_pyramid.h"
#include "raster/taps.h"

#include <memory>
#include <vector>

namespace duet::raster {

/// A light of an area, or a piece of one, and the depths seen from its centre.
class SoftLight {
public:
    SoftLight(CubeMap cube, const Emitter& emitter);

    /// The part of the light's irradiance that arrives, in [0, 1], estimated from the depths its centre sees:
    /// percentage-closer soft shadows (Fernando 2005). Blockers are searched in the cone between the receiver and the
    /// light; their mean place, as a fraction of the way, says how wide the penumbra is; the part of as wide a piece of
    /// the map that the light sees past them is the answer.
    ///
    /// Departures from Fernando's, so that nothing need be guessed, and nothing be grainy:
    /// - Taps lie where lines from the receiver to points of the light meet the plane, parallel to the light, in which
    ///   blockers are taken to be, so that the filter has the light's own shape whatever its direction. The points are
    ///   the same for every receiver.
    /// - What a tap finds counts where it stands over the receiver's plane, before the light, so that a flat surface does
    ///   not shade itself, however steep; and, as in the search, only where the line to it from the receiver goes
    ///   on to the light, so that the walls of a corner are no blockers.
    /// - How far from the receiver blockers can be is known from the nearest depth in the part of the map that the cone
    ///   covers; that bounds the cone, and so the part, again and again. What is left is searched texel by texel, up to
    ///   kSearchedSide × kSearchedRows of them: no blocker is missed at a contact. Where they find none, those blocks of
    ///   texels are searched again of which the nearest depth may be a blocker's: a shadow's faint rim is no saw of
    ///   receivers that happened to find what throws it and receivers that did not.
    float visibility(const Receiver& receiver, TapRange taps) const;

    std::int64_t memory_bytes() const;

    static constexpr int kSearchedSide = 16, kSearchedRows = 8;
    static constexpr double kConcave = 0.25; ///< facets that meet at up to 14° do not shade each other

private:
    /// The light as a receiver sees it: points corner + a·u + b·v, and what takes them back to a and b.
    struct Outline {
        Vec3 axis, corner, u, v, dual_u, dual_v;
        Outline turned(std::size_t face) const;
    };
    class Cone;
    struct Window;
    struct Faces;
    struct Blockers {
        float sum = 0, weights = 0;
    };

    std::optional<Outline> outline_from(Vec3 p) const;
    Outline turned(const Outline& outline, std::size_t face) const;
    ImageFloat before_light(std::size_t face) const;
    void find_closest();
    float first_reach(Vec3 p, std::size_t face, float farthest) const;
    std::optional<Window> window(const Cone& cone, float reach, bool& whole) const;
    Faces faces(const Cone& cone, std::size_t main_face, const Outline& outline, Vec3 p, Vec3 n, float reach) const;
    float bound(const Faces& faces, float farthest) const;
    Blockers search(const Faces& faces) const;
    Blockers search_closely(const Faces& faces) const;
    void add_blockers(const Cone& cone, std::size_t face, const Window& window, Blockers& blockers) const;
    void add_blocks(const Cone& cone, std::size_t face, const Window& window, Blockers& blockers) const;
    struct Found;
    Found found(const Cone& cone, const Floats::batch_bool_type& above, const Floats& nearness, const Floats& right, float up,
                float block) const;
    float dark_taps(float blocker, const Cone& cone, std::size_t face, int first, int count) const;

    CubeMap cube_;
    Emitter::Kind kind_;
    float radius_ = 0;     ///< of the light about its centre
    Vec3 corner_, u_, v_, dual_u_, dual_v_; ///< of a flat one, in the cube's frame
    std::array<Outline, 6> flat_;           ///< the same as each face sees it
    std::array<std::unique_ptr<NearestPyramid>, 6> nearest_;
    static constexpr int kWays = 8; ///< cells of directions along a face's side
    std::array<float, 6 * kWays * kWays> closest_{};
};

} // namespace duet::raster
