#include "raster/shadows/soft_shadow.h"

#include "raster/shadows/light_cone.h"

#include <algorithm>
#include <cmath>

namespace duet::raster {
namespace {

constexpr int kMaxNarrowings = 4;
constexpr float kMinShrink = 0.8f; ///< the cone is recomputed only if the bound shrinks at least by this factor
/// Ratio of length to width; a thinner light is degenerate in float and is treated as a sphere.
constexpr double kThinnest = 1e5;

} // namespace

AreaLightShadow::AreaLightShadow(CubeMap cube, const Emitter& emitter) : cube_(std::move(cube)), kind_(emitter.kind) {
    if (kind_ == Emitter::Kind::kSphere) {
        radius_ = static_cast<float>(emitter.radius);
    } else {
        const float part = kind_ == Emitter::Kind::kTriangle ? 1.0f / 3 : 0.5f;
        u_ = Vec3(cube_.frame.to_local(emitter.u)), v_ = Vec3(cube_.frame.to_local(emitter.v));
        corner_ = (u_ + v_) * -part;
        radius_ = std::max({length(corner_), length(corner_ + u_), length(corner_ + v_), length(corner_ + u_ + v_)});
        // Double precision is needed: a sliver's area is a difference of nearly equal products.
        const Vec3d u = emitter.u, v = emitter.v, n = cross(u, v);
        const double over = 1 / dot(n, n);
        const Vec3d dual_u = cross(v, n) * over, dual_v = cross(n, u) * over;
        dual_u_ = Vec3(cube_.frame.to_local(dual_u)), dual_v_ = Vec3(cube_.frame.to_local(dual_v));
        const double thinness = static_cast<double>(radius_) * max(length(dual_u), length(dual_v));
        if (!(thinness < kThinnest)) kind_ = Emitter::Kind::kSphere; // also where n = 0
    }
    for (std::size_t face = 0; face < 6; ++face) {
        if (kind_ != Emitter::Kind::kSphere)
            face_frames_[face] = EmitterFrame{{}, corner_, u_, v_, dual_u_, dual_v_}.turned(face);
        if (cube_.faces[face]) nearest_[face] = std::make_unique<HiZPyramid>(depths_before_light(face));
    }
    compute_closest();
}

/// Returns a face's reversed depths without surfaces behind a flat one-sided light. A ceiling around the light would
/// otherwise be nearest everywhere.
ImageFloat AreaLightShadow::depths_before_light(std::size_t face) const {
    ImageFloat image = cube_.faces[face]->reversed_depth();
    if (kind_ == Emitter::Kind::kSphere || cube_.faces[5] != nullptr) return image;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            const float right = static_cast<float>(x) + 0.5f - cube_.middle, up = cube_.middle -
                static_cast<float>(y) - 0.5f;
            if (from_face(face, {right, up, cube_.scale}).z < 0) image(x, y) = 0;
        }
    return image;
}

AreaLightShadow::EmitterFrame AreaLightShadow::EmitterFrame::turned(std::size_t face) const {
    return {to_face(face, axis), to_face(face, corner), to_face(face, u),
            to_face(face, v),    to_face(face, dual_u), to_face(face, dual_v)};
}

AreaLightShadow::EmitterFrame AreaLightShadow::turned(const EmitterFrame& emitter_frame, std::size_t face) const {
    if (kind_ == Emitter::Kind::kSphere) return emitter_frame.turned(face);
    EmitterFrame result = face_frames_[face];
    result.axis = to_face(face, emitter_frame.axis);
    return result;
}

std::optional<AreaLightShadow::EmitterFrame> AreaLightShadow::emitter_frame_from(Vec3 p) const {
    if (kind_ != Emitter::Kind::kSphere) {
        if (p.z == 0) return std::nullopt; // a receiver in the light's plane has no blockers
        return EmitterFrame{{0, 0, p.z < 0 ? 1.0f : -1.0f}, corner_, u_, v_, dual_u_, dual_v_};
    }
    const float distance = length(p);
    if (!(distance > radius_)) return std::nullopt; // a receiver inside the sphere has none either
    const Vec3 axis = -p / distance;
    const Frame disk = frame_from_normal(axis);
    // The disk through the center that fills the cone tangent to the sphere replaces the sphere.
    const float radius = radius_ / safe_sqrt(1 - sqr(radius_ / distance));
    return EmitterFrame{axis, {}, disk.s * radius, disk.t * radius, disk.s / radius, disk.t / radius};
}

float AreaLightShadow::visibility(const Receiver& receiver, TapRange taps) const {
    const Vec3 p(cube_.frame.to_local(receiver.p - cube_.center)), n(cube_.frame.to_local(receiver.n));
    const std::size_t main_face = cube_face(p);
    const std::optional<EmitterFrame> emitter_frame = emitter_frame_from(p);
    if (!emitter_frame || cube_.faces[main_face] == nullptr) return 1;
    const float farthest = kind_ == Emitter::Kind::kSphere ? length(emitter_frame->u) : radius_;
    float reach = initial_reach(p, main_face, farthest);
    if (!(reach > 0)) return 1;
    const float slack = 2 * static_cast<float>(receiver.error) + length(p) * 0x1p-19f;
    const Cone main(kind_, turned(*emitter_frame, main_face), to_face(main_face, p), to_face(main_face, n), slack);

    Faces searched = faces(main, main_face, *emitter_frame, p, n, reach);
    for (int i = 0; i < kMaxNarrowings && !searched.small(); ++i) {
        const float bound = this->bound(searched, farthest);
        if (bound <= 0) return 1;
        const bool narrower = bound < kMinShrink * reach;
        reach = std::min(reach, bound);
        if (!narrower) break;
        searched = faces(main, main_face, *emitter_frame, p, n, reach);
    }
    Blockers blockers = search(searched);
    bool again = searched.count > 1; // other faces may see blockers close to the light
    if (!(blockers.weights > 0) && !searched.searched_completely()) {
        // A blocker close to the receiver may lie between the searched texels, so the texels around the line to the
        // center are tested.
        bool whole = true; // the main face contains the receiver itself
        if (const auto window = this->window(main, 0, whole)) add_blockers(main, main_face, *window, blockers);
        // At a shadow's edge the visible part of a blocker may be smaller than the search step.
        if (!(blockers.weights > 0)) blockers = search_blocks(searched);
        again = true;
    }
    if (!(blockers.weights > 0)) return 1;
    const float blocker = blockers.sum / blockers.weights;
    const Faces seen = again ? faces(main, main_face, *emitter_frame, p, n, blocker) : searched;
    const auto dark = [&](int first, int count) {
        float sum = 0;
        for (std::size_t i = 0; i < seen.count; ++i)
            sum += count_dark_taps(blocker, seen.windows[i]->cone, seen.windows[i]->face, first, count);
        return sum;
    };
    const float few = dark(taps.first, TapRange::kBlock);
    // If all taps of the block are dark, the rest are assumed dark. If none is dark, a blocker was still found, so
    // the receiver is at the edge of the penumbra and the remaining taps are needed.
    const bool agree = few >= TapRange::kBlock;
    const int rest = taps.count - TapRange::kBlock;
    const float part = agree || rest == 0 ? few / TapRange::kBlock
                                          : (few + dark(taps.first + TapRange::kBlock,
                                                        rest)) / static_cast<float>(taps.count);
    return clamp(1 - part, 0.0f, 1.0f);
}

std::int64_t AreaLightShadow::memory_bytes() const {
    std::int64_t sum = 0;
    for (const auto& pyramid : nearest_)
        if (pyramid) sum += pyramid->memory_bytes();
    return sum;
}

} // namespace duet::raster
