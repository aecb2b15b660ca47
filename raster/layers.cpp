#include "raster/layers.h"

#include "raster/strip_shader.h"

#include "common/scene/holes.h"

#include <algorithm>

namespace duet::raster {

namespace {

bool nearer(const Hit& a, const Hit& b) {
    if (a.t != b.t) return a.t < b.t;
    return a.object != b.object ? a.object < b.object : a.primitive < b.primitive;
}

bool touches(const Geometry& geometry, std::size_t tile) {
    return !geometry.outlines.tile(tile).empty() || !geometry.fragments.tile(tile).empty() ||
           (!geometry.spheres.empty() && !geometry.sphere_bins.tile(tile).empty());
}

void add_weighted(Shaded& sum, const Shaded& shaded, float weight) {
    sum.radiance += shaded.radiance * weight;
    sum.normal += shaded.normal * weight;
    sum.albedo += shaded.albedo * weight;
}

} // namespace

Layers::Layers(const PreparedData& data, const Settings& settings, const Program* program, const Geometry& geometry, const PassView& view,
               SampleOffset offset, std::size_t tile_index, HitTile& tile)
    : data_(data), settings_(settings), program_(program), geometry_(geometry), view_(view), offset_(offset), tile_index_(tile_index),
      tile_(tile) {
    if (!touches(geometry, tile_index)) return;
    const PixelRect& r = tile.rect();
    pixels_.resize(static_cast<std::size_t>(r.width()) * static_cast<std::size_t>(r.height()));
    for (bool again = true; again;) {
        draw_outlines();
        draw_fragments();
        draw_spheres();
        again = false;
        for (int y = r.y0; y < r.y1; ++y)
            for (int x = r.x0; x < r.x1; ++x) {
                resolve(x, y);
                again = again || !pixel(x, y).done;
            }
    }
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

void Layers::draw_outlines() {
    for (const TileLists::Item& item : geometry_.outlines.tile(tile_index_)) {
        const Batch& batch = geometry_.batches[item.batch];
        for (std::uint32_t k = 0; k < item.count; ++k) draw_outline(batch.triangles[batch.order[item.first + k]]);
    }
}

void Layers::draw_outline(const DrawTriangle& triangle) {
    const auto& c = triangle.corners;
    const std::array<EdgeFunction, 3> edges{EdgeFunction(c[0], c[1]), EdgeFunction(c[1], c[2]), EdgeFunction(c[2], c[0])};
    const PixelRect r = intersect(tile_.rect(), pixels_within(c, offset_));
    for (int y = r.y0; y < r.y1; ++y)
        for (int x = r.x0; x < r.x1; ++x) {
            const std::int64_t sx = std::int64_t{x} * kSubPixels + offset_.x, sy = std::int64_t{y} * kSubPixels + offset_.y;
            if (std::all_of(edges.begin(), edges.end(), [&](const EdgeFunction& e) { return e.at(sx, sy) >= 0; }))
                add_triangle(triangle.id, x, y);
        }
}

void Layers::draw_fragments() {
    const PixelRect& r = tile_.rect();
    for (const TileLists::Item& item : geometry_.fragments.tile(tile_index_)) {
        const Batch& batch = geometry_.batches[item.batch];
        for (std::uint32_t k = 0; k < item.count; ++k) {
            const Fragment& fragment = batch.fragments[item.first + k];
            add_triangle(fragment.id, r.x0 + place_x(fragment.place), r.y0 + place_y(fragment.place));
        }
    }
}

void Layers::draw_spheres() {
    if (geometry_.spheres.empty()) return;
    for (const std::uint32_t i : geometry_.sphere_bins.tile(tile_index_)) {
        const DrawSphere& sphere = geometry_.spheres[i];
        const PixelRect r = intersect(tile_.rect(), sphere.bounds);
        for (int y = r.y0; y < r.y1; ++y)
            for (int x = r.x0; x < r.x1; ++x) {
                Ray ray = tile_.ray(x, y);
                for (int side = 0; side < 2; ++side) { // its front, and through that its inside
                    const std::optional<float> t = sphere.intersect(ray);
                    if (!t) break;
                    add(x, y, {.object = sphere.object, .primitive = 0, .t = *t});
                    ray.t_min = *t;
                }
            }
    }
}

void Layers::add_triangle(std::uint32_t id, int x, int y) {
    const Triangles& triangles = geometry_.triangles;
    const Run& run = triangles.run_of(id);
    const std::uint32_t index = Triangles::index(run, id);
    const WholeTriangle whole = triangles.whole(run, index);
    add(x, y,
        hit_triangle(whole, triangles.objects[run.object].object, whole.piece == Piece::kTriangle ? index : index / 2,
                     offset_.position(x, y), tile_.distance_per_depth(x, y), view_.pinhole.near));
}

// Keeps a pixel's nearest hits beyond those dealt with, sorted.
void Layers::add(int x, int y, const Hit& hit) {
    Pixel& p = pixel(x, y);
    if (p.done || !nearer(p.last, hit) || !nearer(hit, tile_.hit(x, y))) return;
    if (p.count == kKept) {
        p.more = true;
        if (!nearer(hit, p.nearest[kKept - 1])) return;
        --p.count;
    }
    std::size_t i = p.count++;
    for (; i > 0 && nearer(hit, p.nearest[i - 1]); --i) p.nearest[i] = p.nearest[i - 1];
    p.nearest[i] = hit;
}

void Layers::resolve(int x, int y) {
    Pixel& p = pixel(x, y);
    if (p.done) return;
    for (std::size_t i = 0; i < p.count; ++i) {
        const Hit& hit = p.nearest[i];
        const float stopped = opacity(data_.scene, tile_.ray(x, y), hit);
        if (stopped == 0) continue;
        const Hit behind = tile_.exchange(x, y, hit);
        if (stopped == 1) {
            p.done = true;
            return;
        }
        if (!p.stopping.valid() && !passes_through(data_.scene, tile_.ray(x, y), hit)) p.stopping = hit;
        Shaded shaded = shade(data_, settings_, tile_, x, y);
        if (program_ != nullptr) shaded.radiance = program_->shade_hit(data_, view_, hit, offset_.position(x, y));
        add_weighted(p.front, shaded, p.through * stopped);
        p.through *= 1 - stopped;
        tile_.exchange(x, y, behind);
    }
    p.done = !p.more;
    if (p.count > 0) p.last = p.nearest[p.count - 1];
    p.more = false;
    p.count = 0;
}

} // namespace duet::raster
