// Searches the depths of the image for what hides the hemisphere above a point, along one line through its pixel
// (Jimenez et al. 2016, "Practical Realtime Strategies for Accurate Indirect Occlusion", §4).
#pragma once

#include "raster/gbuffer/gbuffer.h"

namespace duet::raster {

/// Holds surfaces at half the G-buffer's resolution, from every second pixel of every second row: their normals,
/// and the radiance that they send as occluders, from the side that the viewer sees and from the other.
struct Occluders {
    Planes3 normals, front, back;
};

/// Holds what a line through each pixel hides of the hemisphere: the cosine-weighted fraction, its directions or light,
/// and the line's own share of the hemisphere.
struct OccludedLine {
    Floats all = Floats(0.0f), lost = Floats(0.0f); // with braces, the arguments would be a list of lanes
    Vec3T<Floats> directions{Floats(0.0f), Floats(0.0f), Floats(0.0f)};
};
/// Searches up to `radius` meters away from a batch of points p, relative to the eye, with unit normals. The pixel
/// (x, y) of half resolution is the first of the batch. The sixteen pixels of a block of 4 × 4 search along different
/// lines. `depth` holds the reversed depths of every second pixel of every second row. Without `occluders` (null),
/// which are the same pixels, directions are returned, else light.
OccludedLine search_line(const GBuffer& gbuffer, const PlaneFloat& depth, const Occluders* occluders,
                         const Vec3T<Floats>& p, const Vec3T<Floats>& normal, float radius, int x, int y);

} // namespace duet::raster
