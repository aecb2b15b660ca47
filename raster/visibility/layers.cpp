#include "raster/visibility/layers.h"

#include "raster/shader/strip_shader.h"
#include "raster/visibility/hit_lists.h"

#include "common/scene/holes.h"

namespace duet::raster {
namespace {

void add_weighted(Shaded& sum, const Shaded& shaded, float weight) {
    sum.radiance += shaded.radiance * weight;
    sum.normal += shaded.normal * weight;
    sum.albedo += shaded.albedo * weight;
}

} // namespace

Layers::Layers(const PreparedData& data, const Settings& settings, const Program* program, const Geometry& geometry,
               const PassView& view, SampleOffset offset, std::size_t tile_index, HitTile& tile)
    : data_(data), settings_(settings), program_(program), view_(view), offset_(offset), tile_(tile) {
    HitLists lists(geometry, view, offset, tile_index, tile);
    if (lists.empty()) return;
    const PixelRect& r = tile.rect();
    pixels_.resize(static_cast<std::size_t>(r.width()) * static_cast<std::size_t>(r.height()));
    lists.for_each([&](int x, int y, const Hit& hit) { return add(x, y, hit); });
}

Shaded Layers::over(int x, int y, const Shaded& behind) {
    if (pixels_.empty()) return behind;
    const Pixel& p = pixel(x, y);
    if (p.through == 1) return behind;
    if (p.stopping.valid()) tile_.exchange(x, y, p.stopping);
    Shaded sum = p.front;
    add_weighted(sum, behind, p.through);
    return sum;
}

/// Adds the next layer of a pixel. Returns true if nothing behind it is visible.
bool Layers::add(int x, int y, const Hit& hit) {
    const float stopped = opacity(data_.scene, tile_.ray(x, y), hit);
    if (stopped == 0) return false;
    const Hit behind = tile_.exchange(x, y, hit);
    if (stopped == 1) return true;
    Pixel& p = pixel(x, y);
    if (!p.stopping.valid() && !passes_through(data_.scene, tile_.ray(x, y), hit)) p.stopping = hit;
    Shaded shaded = shade(data_, settings_, tile_, x, y);
    if (program_ != nullptr) shaded.radiance = program_->shade_hit(data_, view_, hit, offset_.position(x, y));
    add_weighted(p.front, shaded, p.through * stopped);
    p.through *= 1 - stopped;
    tile_.exchange(x, y, behind);
    return false;
}

} // namespace duet::raster
