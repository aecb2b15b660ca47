#include "raster/transform.h"

#include "common/system/parallel.h"
#include "raster/lanes.h"

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

/// The same for a number and a batch.
template <typename T> struct HomogeneousPoint {
    T xw, yw, depth, w;
};
template <typename T> HomogeneousPoint<T> to_pixel(const Mat4d& m, T x, T y, T z) {
    const auto row = [&](std::size_t r) { return T(m[r][0]) * x + T(m[r][1]) * y + T(m[r][2]) * z + T(m[r][3]); };
    return {row(0), row(1), row(2), row(3)};
}

/// Sums of Outcode bits as numbers. Each test is a half-space of homogeneous coordinates, right also where w <= 0.
template <typename T> T outcode_number(const HomogeneousPoint<T>& v, const Viewport& viewport) {
    using xsimd::select, duet::select;
    const double right = viewport.width, bottom = viewport.height;
    const T zero(0), guard_x = T(kGuardBand) * v.w, guard_y = guard_x;
    const auto bit = [&](auto condition, Outcode code) { return select(condition, T(code), zero); };
    const auto within = v.xw + guard_x >= zero && v.xw - T(right + kGuardBand) * v.w <= zero &&
                        v.yw + guard_y >= zero && v.yw - T(bottom + kGuardBand) * v.w <= zero;
    return bit(v.xw + v.w < zero, kLeft) + bit(v.xw - T(right + 1) * v.w > zero, kRight) +
           bit(v.yw + v.w < zero, kTop) + bit(v.yw - T(bottom + 1) * v.w > zero, kBottom) +
           bit(!(v.depth >= T(viewport.near)), kNear) + bit(!within, kGuard);
}

/// A run of vertices, as many as a batch of doubles has lanes.
void transform_batch(const std::array<std::array<double, Doubles::size>, 3>& p, const Mat4d& m,
                     const Viewport& viewport, SnappedVertex* out, std::size_t count) {
    const auto axis = [&](std::size_t i) { return Doubles::load_unaligned(p[i].data()); };
    const HomogeneousPoint<Doubles> v = to_pixel(m, axis(0), axis(1), axis(2));
    const Doubles code = outcode_number(v, viewport);
    // What must be clipped is not snapped: it may be anywhere, and its w zero.
    const auto snap_lanes = [&](Doubles coordinate) {
        const auto usable = code < Doubles(kNear); // the bits from kNear on are those of kMustClip
        return xsimd::select(usable, xsimd::nearbyint(coordinate / v.w * Doubles(kSubPixels)), Doubles(0.0));
    };
    alignas(64) std::array<double, Doubles::size> xs, ys, codes;
    snap_lanes(v.xw).store_aligned(xs.data());
    snap_lanes(v.yw).store_aligned(ys.data());
    code.store_aligned(codes.data());
    for (std::size_t i = 0; i < count; ++i) {
        out[i] = {{static_cast<std::int32_t>(xs[i]), static_cast<std::int32_t>(ys[i])},
                  static_cast<std::uint32_t>(codes[i])};
    }
}
static_assert(kNear == 16 && kGuard == 32 && (kLeft | kRight | kTop | kBottom) < kNear);

/// Returns the outcodes or-ed.
unsigned transform_chunk(const Shape& shape, const Viewport& viewport, const Chunk& chunk, TransformedObject& out) {
    constexpr std::size_t kLanes = Doubles::size;
    const Mesh* mesh = std::get_if<Mesh>(&shape);
    for (std::size_t first = chunk.first; first < chunk.last; first += kLanes) {
        const std::size_t count = std::min(kLanes, chunk.last - first);
        std::array<std::array<double, kLanes>, 3> p{};
        for (std::size_t i = 0; i < count; ++i) {
            const Vec3 vertex = mesh != nullptr ? mesh->positions[first + i] : vertex_position(shape, first + i);
            p[0][i] = static_cast<double>(vertex.x);
            p[1][i] = static_cast<double>(vertex.y);
            p[2][i] = static_cast<double>(vertex.z);
        }
        transform_batch(p, out.to_pixel, viewport, &out.vertices[first], count);
    }
    unsigned any = 0;
    for (std::size_t i = chunk.first; i < chunk.last; ++i) any |= out.vertices[i].outcode;
    return any;
}

} // namespace

Viewport viewport_of(const View& view, const Pinhole& pinhole) {
    const auto& w = pinhole.world_to_pixel[3];
    return {view.width, view.height, pinhole.near, w[0] == 0 && w[1] == 0 && w[2] == 0};
}

std::uint8_t outcode(const PixelVertex& v, const Viewport& viewport) {
    return static_cast<std::uint8_t>(outcode_number(HomogeneousPoint<double>{v.xw, v.yw, v.depth, v.w}, viewport));
}

FixedPoint snap(const PixelVertex& v) {
    return {static_cast<std::int32_t>(std::lrint(v.xw / v.w * kSubPixels)),
            static_cast<std::int32_t>(std::lrint(v.yw / v.w * kSubPixels))};
}

Mat4d object_to_pixel(const Object& object, const Pinhole& pinhole, float time) {
    if (object.identity) return pinhole.world_to_pixel;
    return pinhole.world_to_pixel * Mat4d(object_transform(object, time).to_world);
}

void transform(const Scene& scene, const std::vector<std::uint32_t>& objects, const Pinhole& pinhole, float time,
               const Viewport& viewport, int threads, std::vector<TransformedObject>& result) {
    result.resize(objects.size());
    std::vector<Chunk> chunks;
    for (std::size_t i = 0; i < objects.size(); ++i) {
        const Object& object = scene.objects[objects[i]];
        const std::size_t count = vertex_count(scene.shapes[object.shape]);
        result[i].object = objects[i];
        result[i].mirrored = !object.identity && determinant3(object_transform(object, time).to_world) < 0;
        result[i].to_pixel = object_to_pixel(object, pinhole, time);
        result[i].to_pixel_columns = transpose(result[i].to_pixel);
        result[i].vertices.resize(count);
        result[i].any_outside = 0;
        for (std::size_t first = 0; first < count; first += kChunk)
            chunks.push_back({i, first, std::min(first + kChunk, count)});
    }
    std::vector<unsigned> outside(chunks.size());
    parallel_for(chunks.size(), threads, [&](std::size_t c) {
        const std::size_t i = chunks[c].object;
        outside[c] = transform_chunk(scene.shapes[scene.objects[objects[i]].shape], viewport, chunks[c], result[i]);
    });
    for (std::size_t c = 0; c < chunks.size(); ++c) result[chunks[c].object].any_outside |= outside[c];
}

} // namespace duet::raster
