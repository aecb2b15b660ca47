#include "raster/geometry/transform.h"

#include "common/system/parallel.h"
#include "raster/geometry/packet.h"
#include "raster/geometry/sample_positions.h"

#include <algorithm>
#include <cmath>

namespace duet::raster {
namespace {

/// Represents a range of one object's vertices, the unit of parallel work.
struct Chunk {
    std::size_t object, first, last;
};
constexpr std::size_t kChunk = 8192; ///< most vertices of a chunk

std::size_t vertex_count(const Shape& shape) {
    if (const Mesh* mesh = std::get_if<Mesh>(&shape)) return mesh->positions.size();
    if (const QuadList* list = std::get_if<QuadList>(&shape)) return 4 * list->quads.size();
    return 0;
}

Vec3 vertex_position(const Shape& shape, std::size_t index) {
    if (const Mesh* mesh = std::get_if<Mesh>(&shape)) return mesh->positions[index];
    return primitive_vertices(shape, static_cast<std::uint32_t>(index / 4)).p[index % 4];
}

/// Represents a homogeneous pixel position. T is a number or a SIMD batch.
template <typename T> struct HomogeneousPoint {
    T xw, yw, depth, w;
};
template <typename T> HomogeneousPoint<T> to_pixel(const Mat4d& m, T x, T y, T z) {
    const auto row = [&](std::size_t r) { return T(m[r][0]) * x + T(m[r][1]) * y + T(m[r][2]) * z + T(m[r][3]); };
    return {row(0), row(1), row(2), row(3)};
}

/// Returns the Outcode bits as a number. Each test is a half-space of homogeneous coordinates, which is correct for
/// w <= 0 too.
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

/// Stores sixteen vertex positions, one array per axis.
using VertexPacket = std::array<PacketOf<float>, 3>;
/// Stores sixteen snapped vertices with their outcodes.
struct SnappedPacket {
    PacketOf<std::int32_t> x, y, outcode;
};

/// Loads sixteen vertices from `first` on. If fewer are left before `end`, the last one is repeated.
void gather(const Shape& shape, std::size_t first, std::size_t end, VertexPacket& p) {
    const std::size_t last = std::min(kPacketSize, end - first) - 1;
    if (const Mesh* mesh = std::get_if<Mesh>(&shape)) {
        static_assert(sizeof(Vec3) == 3 * sizeof(float));
        constexpr std::size_t kAhead = 16 * kPacketSize; // the hardware prefetcher does not follow gather instructions
        if (first + kAhead + kPacketSize <= end)
            for (std::size_t i = 0; i < kPacketSize; i += 5) prefetch(&mesh->positions[first + kAhead + i]);
        for (std::size_t i = 0; i < kPacketSize; i += Ints::size) {
            const Ints index = min(load(kLanes, i), Ints(static_cast<std::int32_t>(last))) * Ints(3);
            for (std::size_t axis = 0; axis < 3; ++axis)
                store(p[axis], i, raster::gather(&mesh->positions[first].x + axis, index));
        }
        return;
    }
    for (std::size_t i = 0; i < kPacketSize; ++i) {
        const Vec3 vertex = vertex_position(shape, first + std::min(i, last));
        for (std::size_t axis = 0; axis < 3; ++axis) p[axis][i] = vertex[axis];
    }
}

void transform_packet(const VertexPacket& p, const Mat4d& m, const Viewport& viewport, SnappedPacket& out) {
    for (std::size_t i = 0; i < kPacketSize; i += Doubles::size) {
        const HomogeneousPoint<Doubles> v =
            to_pixel(m, load_doubles(p[0].at(i)), load_doubles(p[1].at(i)), load_doubles(p[2].at(i)));
        const Doubles code = outcode_number(v, viewport);
        // A vertex that must be clipped is not snapped: its position is unbounded and its w may be zero.
        const auto usable = code < Doubles(kNear); // all bits from kNear on belong to kMustClip
        const auto snapped = [&](Doubles coordinate) {
            return xsimd::select(usable, xsimd::nearbyint(coordinate / v.w * Doubles(kSubpixels)), Doubles(0.0));
        };
        store_ints(snapped(v.xw), out.x.at(i));
        store_ints(snapped(v.yw), out.y.at(i));
        store_ints(code, out.outcode.at(i));
    }
}
static_assert(kNear == 16 && kGuard == 32 && (kLeft | kRight | kTop | kBottom) < kNear);

/// Transforms a chunk and returns the bitwise or of its outcodes.
unsigned transform_chunk(const Shape& shape, const Viewport& viewport, const Chunk& chunk, TransformedObject& out) {
    VertexPacket p;
    SnappedPacket snapped;
    unsigned any = 0;
    for (std::size_t first = chunk.first; first < chunk.last; first += kPacketSize) {
        gather(shape, first, chunk.last, p);
        transform_packet(p, out.to_pixel, viewport, snapped);
        for (std::size_t i = 0; i < std::min(kPacketSize, chunk.last - first); ++i) {
            const auto outcode = static_cast<std::uint32_t>(snapped.outcode[i]);
            out.vertices[first + i] = {{snapped.x[i], snapped.y[i]}, outcode};
            any |= outcode;
        }
    }
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
    return {static_cast<std::int32_t>(std::lrint(v.xw / v.w * kSubpixels)),
            static_cast<std::int32_t>(std::lrint(v.yw / v.w * kSubpixels))};
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
        result[i].to_pixel_transposed = transpose(result[i].to_pixel);
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
