#include "raster/visibility/hit_lists.h"

#include "common/sampling/hash.h"

#include <algorithm>
#include <optional>

namespace duet::raster {
namespace {

bool nearer(const Hit& a, const Hit& b) {
    if (a.t != b.t) return a.t < b.t;
    return a.object != b.object ? a.object < b.object : a.primitive < b.primitive;
}

} // namespace

/// The threshold is the pixel's rank plus a hash within the rank's step of 1/16, so that the mean is exact for every
/// opacity.
bool blocks_in_dither(int x, int y, float left) {
    const std::uint64_t hash = hash_combine(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
    return 1 - left > unit_float(dither_rank(x, y) << 28 | high_bits(hash) >> 4);
}

HitLists::HitLists(const Geometry& geometry, const PassView& view, SampleOffset offset, std::size_t tile_index,
                   const HitTile& tile)
    : geometry_(geometry), view_(view), offset_(offset), tile_index_(tile_index), tile_(tile) {
    if (geometry.overlaps_tile(tile_index)) pixels_ = Image<Pixel>(tile.rect().width(), tile.rect().height());
}

void HitLists::draw() {
    for (const TileLists::Item& item : geometry_.triangle_lists.tile(tile_index_)) {
        const Batch& batch = geometry_.batches[item.batch];
        for (std::uint32_t k = 0; k < item.count; ++k) draw_triangle(batch.triangles[batch.order[item.first + k]]);
    }
    const PixelRect& r = tile_.rect();
    for (const TileLists::Item& item : geometry_.fragment_lists.tile(tile_index_)) {
        const Batch& batch = geometry_.batches[item.batch];
        for (std::uint32_t k = 0; k < item.count; ++k) {
            const Fragment& fragment = batch.fragments[item.first + k];
            const int x = r.x0 + tile_sample_x(fragment.sample_index), y = r.y0 + tile_sample_y(fragment.sample_index);
            if (!pixel(x, y).done) add(x, y, listed(fragment.id));
        }
    }
    for (const std::uint32_t i : geometry_.sphere_bins.tile(tile_index_)) draw_sphere(geometry_.spheres[i]);
}

void HitLists::draw_triangle(const DrawTriangle& triangle) {
    const auto& c = triangle.corners;
    const std::array<EdgeFunction, 3> edges{EdgeFunction(c[0], c[1]), EdgeFunction(c[1], c[2]),
                                            EdgeFunction(c[2], c[0])};
    std::optional<ListedTriangle> whole; // found when needed: few triangles cover an unfinished pixel
    const PixelRect r = intersect(tile_.rect(), pixels_within(c, offset_));
    for (int y = r.y0; y < r.y1; ++y)
        for (int x = r.x0; x < r.x1; ++x) {
            if (pixel(x, y).done) continue;
            const std::int64_t sx = std::int64_t{x} * kSubpixels + offset_.x,
                               sy = std::int64_t{y} * kSubpixels + offset_.y;
            if (!std::ranges::all_of(edges, [&](const EdgeFunction& e) { return e.at(sx, sy) >= 0; })) continue;
            if (!whole) whole = listed(triangle.id);
            add(x, y, *whole);
        }
}

void HitLists::draw_sphere(const DrawSphere& sphere) {
    const PixelRect r = intersect(tile_.rect(), sphere.bounds);
    for (int y = r.y0; y < r.y1; ++y)
        for (int x = r.x0; x < r.x1; ++x) {
            if (pixel(x, y).done) continue;
            Ray ray = tile_.ray(x, y);
            for (int side = 0; side < 2; ++side) { // the front side, then the inside of the back
                const std::optional<float> t = sphere.intersect(ray);
                if (!t) break;
                add(x, y, {.object = sphere.object, .primitive = 0, .t = *t});
                ray.t_min = *t;
            }
        }
}

HitLists::ListedTriangle HitLists::listed(std::uint32_t id) const {
    const Run& run = geometry_.triangles.run_of(id);
    return {geometry_.triangles.unclipped(run, Triangles::index(run, id)), geometry_.primitive(run, id)};
}

void HitLists::add(int x, int y, const ListedTriangle& triangle) {
    add(x, y,
        hit_triangle(triangle.whole, triangle.primitive, offset_.position(x, y),
                     tile_.distance_per_depth(x, y), view_.pinhole.near));
}

// Inserts a hit into the sorted list of a pixel's nearest unprocessed hits.
void HitLists::add(int x, int y, const Hit& hit) {
    Pixel& p = pixel(x, y);
    if (!nearer(p.last, hit) || !nearer(hit, tile_.hit(x, y))) return;
    if (p.count == kStored) {
        p.more = true;
        if (!nearer(hit, p.nearest[kStored - 1])) return;
        --p.count;
    }
    std::size_t i = p.count++;
    for (; i > 0 && nearer(hit, p.nearest[i - 1]); --i) p.nearest[i] = p.nearest[i - 1];
    p.nearest[i] = hit;
}

} // namespace duet::raster
