// This header declares soft shadows of area lights, from depth maps rendered at the light's center.
#pragma once

#include "raster/geometry/packet.h"
#include "raster/lighting/tap_range.h"
#include "raster/shadows/cube_map.h"
#include "raster/shadows/emitter.h"
#include "raster/visibility/hi_z_pyramid.h"

#include <memory>
#include <vector>

namespace duet::raster {

/// A soft light is an area light, or a cell of one, with the depths seen from its center.
class AreaLightShadow {
public:
    AreaLightShadow(CubeMap cube, const Emitter& emitter);

    /// Returns the unshadowed fraction of the light's irradiance, in [0, 1], estimated from the depths seen from its
    /// center. The method is percentage-closer soft shadows (Fernando 2005). Blockers are searched in the cone
    /// between receiver and light. Their mean position, as a fraction of the way to the light, gives the penumbra's
    /// width. The result is the lit fraction of taps over that width.
    /// The method differs from Fernando's in order to avoid biases and noise:
    /// - Taps are placed where lines from the receiver to points of the light meet the assumed plane of the blockers,
    /// which is parallel to the light. So the filter has the light's own shape in every direction. The points are the
    /// same for every receiver.
    /// - A tap counts as dark if its surface is above the receiver's plane and in front of the light, so a flat
    /// surface never shades itself, at any slope. In the taps and in the search, the line from the receiver to that
    /// surface must also hit the light, so the walls of a corner are not blockers.
    /// - The nearest depth in the window that the cone covers bounds the distance of blockers from the receiver. This
    /// bound shortens the cone and so the window, repeatedly. The final window is searched texel by texel, up to
    /// kSearchedSide × kSearchedRows texels, so no blocker is missed at a contact. If no blocker is found, the blocks
    /// of texels whose nearest depth may be a blocker's are searched. Otherwise the faint edge of a penumbra would be
    /// jagged, since only some receivers would find the blocker.
    float visibility(const Receiver& receiver, TapRange taps) const;

    std::int64_t memory_bytes() const;
    const CubeMap& cube() const { return cube_; }

    static constexpr int kSearchedSide = 16, kSearchedRows = 8;
    static constexpr double kConcave = 0.25; ///< facets that meet at up to 14° do not shade each other

private:
    /// The light as seen from a receiver: its points are corner + a·u + b·v, and the dual vectors recover a and b.
    struct EmitterFrame {
        Vec3 axis, corner, u, v, dual_u, dual_v;
        EmitterFrame turned(std::size_t face) const;
    };
    class Cone;
    struct Window;
    struct Faces;
    struct Blockers {
        float sum = 0, weights = 0;
    };

    std::optional<EmitterFrame> emitter_frame_from(Vec3 p) const;
    EmitterFrame turned(const EmitterFrame& emitter_frame, std::size_t face) const;
    ImageFloat depths_before_light(std::size_t face) const;
    void compute_closest();
    float initial_reach(Vec3 p, std::size_t face, float farthest) const;
    std::optional<Window> window(const Cone& cone, float reach, bool& whole) const;
    Faces faces(const Cone& cone, std::size_t main_face, const EmitterFrame& emitter_frame, Vec3 p, Vec3 n,
                float reach) const;
    float bound(const Faces& faces, float farthest) const;
    Blockers search(const Faces& faces) const;
    Blockers search_blocks(const Faces& faces) const;
    void add_blockers(const Cone& cone, std::size_t face, const Window& window, Blockers& blockers) const;
    void add_blocks(const Cone& cone, std::size_t face, const Window& window, Blockers& blockers) const;
    struct BlockerBatch;
    BlockerBatch evaluate_blockers(const Cone& cone, const Floats::batch_bool_type& above, const Floats& reversed_depth,
                                   const Floats& right, float up, float block) const;
    float count_dark_taps(float blocker, const Cone& cone, std::size_t face, int first, int count) const;

    CubeMap cube_;
    Emitter::Kind kind_;
    float radius_ = 0; ///< of the light about its center
    Vec3 corner_, u_, v_, dual_u_, dual_v_; ///< of a flat light, in the cube's frame
    std::array<EmitterFrame, 6> face_frames_; ///< the same in each face's coordinates
    std::array<std::unique_ptr<HiZPyramid>, 6> nearest_;
    static constexpr int kDirectionCells = 8; ///< cells of directions along a face's side
    std::array<float, 6 * kDirectionCells * kDirectionCells> closest_{};
};

} // namespace duet::raster
