#include "raster/visibility/strip_samples.h"

#include <algorithm>
#include <bit>

namespace duet::raster {

bool StripReader::all_of_last_object(const StripSamples& samples) const {
    if (object_ == nullptr) return false;
    bool all = true;
    for (std::size_t i = 0; i < kStrip; i += Ints::size) {
        const Ints id = load(samples.ids, i);
        all = all && xsimd::all(id >= Ints(low_id_) && id < Ints(end_id_));
    }
    return all;
}

void StripReader::find_object(const StripSamples& samples) {
    object_ = nullptr;
    const auto [low, high] = std::minmax_element(samples.ids.v.begin(), samples.ids.v.end());
    last_run_ = &triangles_.run_of(static_cast<std::uint32_t>(*low),
                                   last_run_ != nullptr ? *last_run_ : triangles_.runs.front());
    const Run& last = triangles_.run_of(static_cast<std::uint32_t>(*high), *last_run_);
    // Numbers are in the order of objects: between two of one object there is no other's.
    if (last_run_->sphere || last.sphere || last.object != last_run_->object) return;
    shape_ = &triangles_.packed(last);
    object_ = &triangles_.objects[last.object];
    const Triangles::Numbers numbers = triangles_.of_object(last);
    first_id_ = numbers.first;
    low_id_ = static_cast<std::int32_t>(numbers.first);
    end_id_ = static_cast<std::int32_t>(numbers.end);
}

void StripReader::read(const std::int32_t* ids, StripSamples& samples) {
    const Ints none(static_cast<std::int32_t>(kNoTriangle));
    samples.seen = samples_seen(ids);
    samples.on_mesh = 0;
    if (samples.seen == 0) return;
    const Ints first(ids[std::countr_zero(samples.seen)]);
    for (std::size_t i = 0; i < kStrip; i += Ints::size) {
        const Ints read = Ints::load_aligned(ids + i);
        store(samples.ids, i, xsimd::select(read == none, first, read));
    }
    if (!all_of_last_object(samples)) find_object(samples);
    samples.object = object_;
    if (object_ == nullptr) return;
    samples.on_mesh = samples.seen;
    samples.shape = shape_;
    samples.first_id = first_id_;
}

} // namespace duet::raster
