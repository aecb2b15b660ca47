#include "raster/geometry/triangles.h"

#include <algorithm>

namespace duet::raster {

const Run& Triangles::run_of(std::uint32_t id, const Run& hint) const {
    if (id - hint.first_id < hint.count) return hint;
    const auto after = std::upper_bound(runs.begin(), runs.end(), id,
                                        [](std::uint32_t number, const Run& run) { return number < run.first_id; });
    return *(after - 1);
}

} // namespace duet::raster
