#include "raster/assemble.h"

#include "raster/clip.h"

#include "common/system/parallel.h"

#include <algorithm>

namespace duet::raster {
namespace {

/// A run of one object's primitives: the unit of parallel work.
struct Chunk {
    std::size_t object, first, last;
};
constexpr std::size_t kChunk = 4096;

/// Takes primitives one by one to their set-up triangles.
class Assembler {
public:
    Assembler(const TransformedObject& object, const Viewport& viewport, const std::vector<SampleOffset>& samples,
              const Skips& skips, bool cull_backfaces, DrawList& out)
        : object_(object), viewport_(viewport), samples_(samples), skips_(skips), cull_backfaces_(cull_backfaces),
          out_(out) {}

    void add(std::uint32_t primitive, Piece piece, std::array<std::size_t, 3> index) {
        const unsigned a = object_.outcodes[index[0]], b = object_.outcodes[index[1]], c = object_.outcodes[index[2]];
        if (skips_.frustum && (a & b & c & kFrustum) != 0) {
            ++out_.culled.outside;
            return;
        }
        const Whole whole{primitive, piece, object_.vertices[index[0]], object_.vertices[index[1]],
                          object_.vertices[index[2]]};
        if (((a | b | c) & kMustClip) == 0) {
            set_up(whole, {object_.snapped[index[0]], object_.snapped[index[1]], object_.snapped[index[2]]});
            return;
        }
        const ClippedPolygon polygon = clip(whole.a, whole.b, whole.c, viewport_);
        if (polygon.count == 0) ++out_.culled.outside;
        std::array<FixedPoint, 8> p;
        for (std::size_t i = 0; i < static_cast<std::size_t>(polygon.count); ++i) p[i] = snap(polygon.vertices[i]);
        for (std::size_t i = 2; i < static_cast<std::size_t>(polygon.count); ++i) set_up(whole, {p[0], p[i - 1], p[i]});
    }

private:
    /// A primitive as it was before clipping: where depth and barycentrics come from.
    struct Whole {
        std::uint32_t primitive;
        Piece piece;
        const PixelVertex &a, &b, &c;
    };

    void set_up(const Whole& whole, std::array<FixedPoint, 3> p) {
        const std::int64_t area = doubled_area(p[0], p[1], p[2]);
        if (area == 0 && skips_.degenerate) {
            ++out_.culled.degenerate;
        } else if (cull_backfaces_ && is_backface(area, object_.mirrored)) {
            ++out_.culled.backfaces;
        } else if (skips_.subpixel && !may_cover_a_sample(p)) {
            ++out_.culled.subpixel;
        } else {
            const FixedPoint beside{std::clamp(std::min({p[0].x, p[1].x, p[2].x}), 0, viewport_.width * kSubPixels),
                                    std::clamp(std::min({p[0].y, p[1].y, p[2].y}), 0, viewport_.height * kSubPixels)};
            if (area < 0) std::swap(p[1], p[2]);
            out_.triangles.push_back(
                {p, object_.object, whole.primitive, whole.piece, Interpolation(whole.a, whole.b, whole.c, beside)});
        }
    }

    bool may_cover_a_sample(const std::array<FixedPoint, 3>& p) const {
        return std::any_of(samples_.begin(), samples_.end(),
                           [&](SampleOffset offset) { return !pixels_within(p, offset).empty(); });
    }

    const TransformedObject& object_;
    const Viewport& viewport_;
    const std::vector<SampleOffset>& samples_;
    const Skips& skips_;
    bool cull_backfaces_;
    DrawList& out_;
};

void assemble_chunk(const Shape& shape, const Chunk& chunk, Assembler& assembler) {
    const Mesh* mesh = std::get_if<Mesh>(&shape);
    for (std::size_t i = chunk.first; i < chunk.last; ++i) {
        const auto primitive = static_cast<std::uint32_t>(i);
        if (mesh) {
            const auto& index = mesh->triangles[i];
            assembler.add(primitive, Piece::kTriangle, {index[0], index[1], index[2]});
        } else {
            assembler.add(primitive, Piece::kQuadFirst, {4 * i, 4 * i + 1, 4 * i + 2});
            assembler.add(primitive, Piece::kQuadSecond, {4 * i, 4 * i + 2, 4 * i + 3});
        }
    }
}

/// The chunks' lists one after the other, copied in parallel.
DrawList concatenate(const std::vector<DrawList>& parts, int threads) {
    DrawList all;
    std::vector<std::size_t> start;
    std::size_t count = 0;
    for (const DrawList& part : parts) {
        start.push_back(count);
        count += part.triangles.size();
        all.culled += part.culled;
    }
    all.triangles.resize(count);
    parallel_for(parts.size(), threads, [&](std::size_t i) {
        std::copy(parts[i].triangles.begin(), parts[i].triangles.end(),
                  all.triangles.begin() + static_cast<std::ptrdiff_t>(start[i]));
    });
    return all;
}

} // namespace

DrawList assemble(const PreparedData& data, const std::vector<TransformedObject>& objects, const Viewport& viewport,
                  const std::vector<SampleOffset>& samples, const Skips& skips, int threads) {
    const Scene& scene = data.scene;
    const auto shape_of = [&](std::size_t i) -> const Shape& {
        return scene.shapes[scene.objects[objects[i].object].shape];
    };
    std::vector<Chunk> chunks;
    for (std::size_t i = 0; i < objects.size(); ++i) {
        const std::size_t count = primitive_count(shape_of(i));
        for (std::size_t first = 0; first < count; first += kChunk)
            chunks.push_back({i, first, std::min(first + kChunk, count)});
    }
    std::vector<DrawList> parts(chunks.size());
    parallel_for(chunks.size(), threads, [&](std::size_t c) {
        const TransformedObject& object = objects[chunks[c].object];
        const bool cull_backfaces = skips.back_faces && may_cull_backfaces(object, data.objects[object.object].solid);
        Assembler assembler(object, viewport, samples, skips, cull_backfaces, parts[c]);
        assemble_chunk(shape_of(chunks[c].object), chunks[c], assembler);
    });
    return concatenate(parts, threads);
}

} // namespace duet::raster
