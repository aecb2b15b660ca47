#include "raster/shading/alpha_layers.h"

#include "raster/shader/packet_shader.h"
#include "raster/visibility/hit_lists.h"

#include "common/scene/alpha_mask.h"

namespace duet::raster {
namespace {

void add_weighted(ShadedSample& sum, const ShadedSample& shaded, float weight) {
    sum.radiance += shaded.radiance * weight;
    sum.normal += shaded.normal * weight;
    sum.albedo += shaded.albedo * weight;
}

} // namespace

Layers::Layers(const RasterSceneData& data, const RasterSettings& settings, const ShaderProgram* program,
               const Geometry& geometry, const PassView& view, SampleOffset offset, std::size_t tile_index,
               HitTile& tile)
    : data_(data), settings_(settings), program_(program), view_(view), offset_(offset), tile_(tile) {
    HitLists lists(geometry, view, offset, tile_index, tile);
    if (lists.empty()) return;
    pixels_ = Image<Pixel>(tile.rect().width(), tile.rect().height());
    lists.for_each([&](int x, int y, const Hit& hit) { return add(x, y, hit); });
}

ShadedSample Layers::over(int x, int y, const ShadedSample& behind) {
    if (pixels_.empty()) return behind;
    const Pixel& p = pixel(x, y);
    if (p.transmittance == 1) return behind;
    if (p.blocking_hit.valid()) tile_.exchange(x, y, p.blocking_hit);
    ShadedSample sum = p.front;
    add_weighted(sum, behind, p.transmittance);
    return sum;
}

/// Adds the next layer of a pixel. Returns true if nothing behind it is visible.
bool Layers::add(int x, int y, const Hit& hit) {
    const float opacity_here = opacity(data_.scene, tile_.ray(x, y), hit);
    if (opacity_here == 0) return false;
    const Hit behind = tile_.exchange(x, y, hit);
    if (opacity_here == 1) return true;
    Pixel& p = pixel(x, y);
    if (!p.blocking_hit.valid() && !passes_alpha_mask(data_.scene, tile_.ray(x, y), hit)) p.blocking_hit = hit;
    ShadedSample shaded = sample_attributes(data_, settings_, tile_, x, y);
    if (program_ != nullptr) shaded.radiance = program_->shade_hit(data_, view_, hit, offset_.position(x, y));
    add_weighted(p.front, shaded, p.transmittance * opacity_here);
    p.transmittance *= 1 - opacity_here;
    tile_.exchange(x, y, behind);
    return false;
}

} // namespace duet::raster
