#include "raster/transform.h"

#include "common/system/parallel.h"

#include <algorithm>
#include <cmath>

namespace duet::raster {
namespace {

/// A run of one object's vertices: the unit of parallel work.
struct Chunk {
    std::size_t object, first, last;
};
constexpr std::size_t kChunk = 8192;

std::size_t vertex_count(const Shape& shape) {
    if (const Mesh* mesh = std::get_if<Mesh>(&shape)) return mesh->positions.size();
    if (const QuadList* list = std::get_if<QuadList>(&shape)) return 4 * list->quads.size();
    return 0;
}

Vec3 vertex_position(const Shape& shape, std::size_t index) {
    if (const Mesh* mesh = std::get_if<Mesh>(&shape)) return mesh->positions[index];
    return primitive_corners(shape, static_cast<std::uint32_t>(index / 4)).p[index % 4];
}

void transform_chunk(const Shape& shape, const Mat4d& to_pixel, const Viewport& viewport, const Chunk& chunk,
                     TransformedObject& out) {
    for (std::size_t i = chunk.first; i < chunk.last; ++i) {
        const Vec4d p = to_pixel * Vec4d(Vec3d(vertex_position(shape, i)), 1.0);
        const PixelVertex vertex{.xw = p.x, .yw = p.y, .w = p.w, .depth = p.z};
        out.vertices[i] = vertex;
        out.outcodes[i] = outcode(vertex, viewport);
        if (!(out.outcodes[i] & kMustClip)) out.snapped[i] = snap(vertex);
    }
}

} // namespace

std::uint8_t outcode(const PixelVertex& v, const Viewport& viewport) {
    const double right = viewport.width, bottom = viewport.height;
    // Each test is a half-space of homogeneous coordinates, right also where w <= 0.
    unsigned code = 0;
    if (v.xw + v.w < 0) code |= kLeft;
    if (v.xw - (right + 1) * v.w > 0) code |= kRight;
    if (v.yw + v.w < 0) code |= kTop;
    if (v.yw - (bottom + 1) * v.w > 0) code |= kBottom;
    if (!(v.depth >= viewport.near)) code |= kNear;
    if (!(v.xw + kGuardBand * v.w >= 0 && v.xw - (right + kGuardBand) * v.w <= 0 && v.yw + kGuardBand * v.w >= 0 &&
          v.yw - (bottom + kGuardBand) * v.w <= 0))
        code |= kGuard;
    return static_cast<std::uint8_t>(code);
}

FixedPoint snap(const PixelVertex& v) {
    return {static_cast<std::int32_t>(std::lrint(v.xw / v.w * kSubPixels)),
            static_cast<std::int32_t>(std::lrint(v.yw / v.w * kSubPixels))};
}

Mat4d object_to_pixel(const Object& object, const Pinhole& pinhole, float time) {
    if (object.identity) return pinhole.world_to_pixel;
    return pinhole.world_to_pixel * Mat4d(object_transform(object, time).to_world);
}

std::vector<TransformedObject> transform(const Scene& scene, const std::vector<std::uint32_t>& objects,
                                         const Pinhole& pinhole, float time, const Viewport& viewport, int threads) {
    std::vector<TransformedObject> result(objects.size());
    std::vector<Mat4d> to_pixel(objects.size());
    std::vector<Chunk> chunks;
    for (std::size_t i = 0; i < objects.size(); ++i) {
        const Object& object = scene.objects[objects[i]];
        const std::size_t count = vertex_count(scene.shapes[object.shape]);
        result[i].object = objects[i];
        result[i].mirrored = !object.identity && determinant3(object_transform(object, time).to_world) < 0;
        result[i].vertices.resize(count);
        result[i].snapped.resize(count);
        result[i].outcodes.resize(count);
        to_pixel[i] = object_to_pixel(object, pinhole, time);
        for (std::size_t first = 0; first < count; first += kChunk)
            chunks.push_back({i, first, std::min(first + kChunk, count)});
    }
    parallel_for(chunks.size(), threads, [&](std::size_t c) {
        const std::size_t i = chunks[c].object;
        transform_chunk(scene.shapes[scene.objects[objects[i]].shape], to_pixel[i], viewport, chunks[c], result[i]);
    });
    for (TransformedObject& object : result)
        for (const std::uint8_t code : object.outcodes) object.any_outside |= code;
    return result;
}

} // namespace duet::raster
