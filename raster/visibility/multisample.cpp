#include "raster/visibility/multisample.h"

#include "common/system/error.h"

namespace duet::raster {
namespace {

/// Returns the offsets of positions given in sixteenths of a pixel, relative to the pixel center.
std::vector<SampleOffset> pattern(std::initializer_list<std::array<int, 2>> sixteenths) {
    std::vector<SampleOffset> result;
    for (const auto& [x, y] : sixteenths) result.push_back({(x + 8) * (kSubpixels / 16), (y + 8) * (kSubpixels / 16)});
    return result;
}

} // namespace

const std::vector<SampleOffset>& multisample_pattern(int count) {
    static const auto k2 = pattern({{4, 4}, {-4, -4}});
    static const auto k4 = pattern({{-2, -6}, {6, -2}, {-6, 2}, {2, 6}});
    static const auto k8 = pattern({{1, -3}, {-1, 3}, {5, 1}, {-3, -5}, {-5, 5}, {-7, -1}, {3, 7}, {7, -7}});
    static const auto k16 = pattern({{1, 1},
                                     {-1, -3},
                                     {-3, 2},
                                     {4, -1},
                                     {-5, -2},
                                     {2, 5},
                                     {5, 3},
                                     {3, -5},
                                     {-2, 6},
                                     {0, -7},
                                     {-4, -6},
                                     {-6, 4},
                                     {-8, 0},
                                     {7, -4},
                                     {6, 7},
                                     {-7, -8}});
    for (const auto* known : {&k2, &k4, &k8, &k16})
        if (static_cast<int>(known->size()) == count) return *known;
    throw Error(message("multisampling: found ", count, " samples per pixel, expected 2, 4, 8 or 16"));
}

Layer& LayeredTile::layer_at(std::size_t i) {
    if (i == layers_.size()) {
        layers_.push_back(std::make_unique_for_overwrite<Layer>());
        layers_.back()->counts_.fill(0);
        layers_.back()->used_.fill(false);
        layers_.back()->ids_.fill(static_cast<std::int32_t>(kNoTriangle));
    }
    return *layers_[i];
}

void LayeredTile::add_one(std::uint32_t sample_index, std::int32_t id, SampleOffset offset) {
    std::size_t i = 0;
    while (i < layers_.size() && layers_[i]->counts_[sample_index] > 0 && layers_[i]->ids_[sample_index] != id) ++i;
    Layer& layer = layer_at(i);
    if (layer.counts_[sample_index]++ == 0) {
        layer.ids_[sample_index] = id;
        layer.sum_x_[sample_index] = layer.sum_y_[sample_index] = 0;
        layer.used_[sample_index / kPacketSize] = true;
    }
    layer.sum_x_[sample_index] += offset.x;
    layer.sum_y_[sample_index] += offset.y;
}

void LayeredTile::add(const DepthTile& tile) {
    const SampleOffset offset = tile.offset();
    const Ints x(offset.x), y(offset.y), one(1);
    for (std::uint32_t first = 0; first < kTileSamples; first += static_cast<std::uint32_t>(kPacketSize)) {
        if (rect_.x0 + tile_sample_x(first) >= rect_.x1 || rect_.y0 + tile_sample_y(first) >= rect_.y1) continue;
        bool same = !layers_.empty() && layers_[0]->used_[first / kPacketSize];
        for (std::size_t i = first; same && i < first + kPacketSize; i += Ints::size)
            same = xsimd::all(Ints::load_aligned(&layers_[0]->ids_[i]) == Ints::load_aligned(tile.ids() + i));
        if (!same) { // this is the first sample, or there are several primitives
            for (std::uint32_t i = first; i < first + kPacketSize; ++i) add_one(i, tile.ids()[i], offset);
            continue;
        }
        Layer& layer = *layers_[0];
        for (std::size_t i = first; i < first + kPacketSize; i += Ints::size) {
            const auto add_to = [i](std::array<std::int32_t, kTileSamples>& sums, const Ints& by) {
                (Ints::load_aligned(&sums[i]) + by).store_aligned(&sums[i]);
            };
            add_to(layer.counts_, one);
            add_to(layer.sum_x_, x);
            add_to(layer.sum_y_, y);
        }
    }
}

void LayeredTile::layer_packet(std::size_t i, int x, int y, LayerPacket& layer_packet) const {
    const Layer& layer = *layers_[i];
    const std::uint32_t first = sample_index(x, y);
    layer_packet.packet = {.x = x, .y = y, .offset = {}, .whole_pixels = true};
    if (!layer.used_[first / kPacketSize]) return;
    layer_packet.packet.ids = &layer.ids_[first];
    for (std::size_t k = 0; k < kPacketSize; ++k) {
        const int count = layer.counts_[first + k];
        layer_packet.offsets[k] = {};
        if (count == 0 || count == count_) continue;
        layer_packet.offsets[k] = {(layer.sum_x_[first + k] + count / 2) / count,
                                   (layer.sum_y_[first + k] + count / 2) / count};
        layer_packet.packet.offsets = &layer_packet.offsets;
    }
}

} // namespace duet::raster
