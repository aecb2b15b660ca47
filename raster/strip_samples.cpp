#include "raster/strip_samples.h"

#include <algorithm>
#include <bit>

namespace duet::raster {

void StripSamples::load(const std::int32_t* ids) {
    const Ints none(static_cast<std::int32_t>(kNoTriangle));
    const std::uint32_t seen = samples_seen(ids), before = seen_;
    seen_ = seen;
    on_mesh_ = one_object_ != nullptr ? seen : 0;
    if (seen == 0) return;
    const Ints first(ids[std::countr_zero(seen)]);
    bool same = before != 0;
    std::int32_t low = kNoTriangle, high = 0;
    for (std::size_t i = 0; i < kStrip; i += Ints::size) {
        const Ints read = Ints::load_aligned(ids + i), filled = xsimd::select(read == none, first, read);
        same = same && xsimd::all(filled == raster::load(ids_, i));
        store(ids_, i, filled);
    }
    if (same) return;
    for (const std::int32_t id : ids_.v) {
        low = std::min(low, id);
        high = std::max(high, id);
    }
    one_object_ = nullptr;
    one_mesh_ = nullptr;
    on_mesh_ = 0;
    last_run_ = &triangles_.run_of(static_cast<std::uint32_t>(low),
                                   last_run_ != nullptr ? *last_run_ : triangles_.runs.front());
    const Run& last = triangles_.run_of(static_cast<std::uint32_t>(high), *last_run_);
    // Numbers are in the order of objects: between two of one object there is no other's.
    if (last_run_->sphere || last.sphere || last.object != last_run_->object) return;
    one_mesh_ = std::get_if<Mesh>(&triangles_.shape(last));
    if (one_mesh_ == nullptr) return;
    one_object_ = &triangles_.objects[last.object];
    on_mesh_ = seen;
    first_id_ = last.first_id - last.first;
    few_ = 0;
    each_ = false;
    for (std::uint32_t left = (1u << kStrip) - 1; left != 0 && !each_; left &= ~few_lanes_[few_ - 1]) {
        each_ = few_ == kFew;
        if (each_) break;
        const Ints id(ids_[static_cast<std::size_t>(std::countr_zero(left))]);
        std::uint32_t lanes = 0;
        for (std::size_t i = 0; i < kStrip; i += Ints::size) lanes |= lane_bits(raster::load(ids_, i) == id) << i;
        few_lanes_[few_++] = lanes;
    }
    changed_ = true;
}

} // namespace duet::raster
