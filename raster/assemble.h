// Stages 2 to 4 over all primitives: cull → clip → set up gives the list of what is to be drawn.
#pragma once

#include "raster/cull.h"
#include "raster/prepare.h"
#include "raster/setup.h"

#include <vector>

namespace duet::raster {

struct DrawList {
    std::vector<SetupTriangle> triangles; ///< by object, then primitive
    CullCounts culled;
};

/// Cuts the objects' primitives to triangles ready to be covered. Each triangle of a mesh is one, each quad two (the
/// diagonal is shared, so no sample falls through or counts twice), a clipped one a fan. `skips` says what is left
/// out. Independent of `threads`, in content and in order.
DrawList assemble(const PreparedData& data, const std::vector<TransformedObject>& objects, const Viewport& viewport,
                  const std::vector<SampleOffset>& samples, const Skips& skips, int threads);

} // namespace duet::raster
