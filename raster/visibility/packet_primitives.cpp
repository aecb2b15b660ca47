#include "raster/visibility/packet_primitives.h"

#include <algorithm>

namespace duet::raster {

void PacketReader::find_object(const PacketPrimitives& samples) {
    object_ = nullptr;
    const auto [low, high] = std::minmax_element(samples.ids.v.begin(), samples.ids.v.end());
    last_run_ = &triangles_.run_of(static_cast<std::uint32_t>(*low),
                                   last_run_ != nullptr ? *last_run_ : triangles_.runs.front());
    const Run& last = triangles_.run_of(static_cast<std::uint32_t>(*high), *last_run_);
    // Ids are in the order of objects. If the lowest and the highest id belong to one object, all ids between do, too.
    if (last_run_->sphere || last.sphere || last.object != last_run_->object) return;
    shape_ = &triangles_.packed(last);
    object_ = &triangles_.objects[last.object];
    const Triangles::IdRange id_range = triangles_.ids_of_object(last);
    first_id_ = id_range.first;
    low_id_ = static_cast<std::int32_t>(id_range.first);
    end_id_ = static_cast<std::int32_t>(id_range.end);
}

} // namespace duet::raster
