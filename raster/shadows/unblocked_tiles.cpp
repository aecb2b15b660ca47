#include "raster/shadows/unblocked_tiles.h"

#include "common/system/parallel.h"

#include <algorithm>

namespace duet::raster {
namespace {

/// Represents a part of an object that casts shadows. A convex object that is seen from outside shades itself only
/// where its normals face away from the light.
struct Caster {
    Box3d box;
    std::uint32_t object;
    bool convex;
};

Box3d doubled(const Box3& box) { return {Vec3d(box.low), Vec3d(box.high)}; }

std::vector<Caster> casters_of(const RasterSceneData& data, const GBuffer& gbuffer) {
    std::vector<Caster> casters;
    // Rays from elsewhere than the eye, and rays through surfaces with alpha, may see an object from inside.
    const bool from_eye =
        gbuffer.position.empty() && gbuffer.projection.perspective() && !data.scene.needs.alpha;
    const auto seen_from_outside = [&](std::uint32_t object) {
        return from_eye && !data.objects[object].bounds.contains(Vec3(gbuffer.projection.eye()));
    };
    for (std::uint32_t i = 0; i < data.scene.objects.size(); ++i) {
        const Object& object = data.scene.objects[i];
        const auto* list = std::get_if<QuadList>(&data.scene.shapes[object.shape]);
        if (list == nullptr) {
            const bool sphere = std::holds_alternative<Sphere>(data.scene.shapes[object.shape]);
            casters.push_back({doubled(data.objects[i].bounds), i, sphere && seen_from_outside(i)});
            continue;
        }
        const bool is_box = list->quads.size() == 6 && data.objects[i].closed;
        const bool convex = list->quads.size() == 1 || (is_box && seen_from_outside(i));
        for (const Quad& quad : list->quads) {
            Box3d box;
            for (const Vec3& corner : corners(quad)) box.extend(transform_point(Mat4d(object.to_world), Vec3d(corner)));
            casters.push_back({box, i, convex});
        }
    }
    return casters;
}

/// Represents the origin of a source's light: a box, or the direction of a sun.
struct Origin {
    Box3d box;
    Vec3d sun; ///< unit direction to the sun; (0, 0, 0) for other lights
    double sine = 0; ///< of the angular radius of the sun
    std::uint32_t excluded = kNoObject; ///< object that does not shade this light
};

Origin origin_of(const RasterSceneData& data, const Shadows::Source& source) {
    Origin origin;
    const Light light = data.light(source.lights.front());
    if (const auto* sun = std::get_if<SunLight>(&light)) origin.sun = -Vec3d(sun->direction);
    origin.sine = static_cast<double>(source.sine);
    if (const auto* point = std::get_if<PointLight>(&light)) origin.box.extend(Vec3d(point->position));
    if (const auto* spot = std::get_if<SpotLight>(&light)) origin.box.extend(Vec3d(spot->position));
    for (const std::size_t i : source.lights) {
        const Light its = data.light(i);
        const auto* surface = std::get_if<SurfaceLight>(&its);
        if (surface == nullptr) continue;
        if (source.emits_only) origin.excluded = surface->object;
        const auto add = [&](Vec3 p) { origin.box.extend(Vec3d(p)); };
        if (const auto* triangle = std::get_if<LightTriangle>(&surface->shape))
            add(triangle->a), add(triangle->b), add(triangle->c);
        else if (const auto* quad = std::get_if<Quad>(&surface->shape))
            for (const Vec3& corner : corners(*quad)) add(corner);
        else if (const auto* sphere = std::get_if<Sphere>(&surface->shape)) {
            const Vec3 reach(sphere->radius, sphere->radius, sphere->radius);
            add(sphere->center - reach), add(sphere->center + reach);
        }
    }
    return origin;
}

/// Represents the points of a tile, and the object that all of them lie on, if there is one.
struct TilePoints {
    Box3d box;
    std::uint32_t object = kNoObject;
};

TilePoints points_of(const GBuffer& gbuffer, int x0, int y0) {
    constexpr int kSide = UnblockedTiles::kSide, kBatch = static_cast<int>(Floats::size);
    const Floats infinite(kInfinity);
    std::array<Floats, 3> low{infinite, infinite, infinite}, high{-infinite, -infinite, -infinite};
    std::int32_t first = std::numeric_limits<std::int32_t>::max(), last = -1;
    for (int y = y0; y < std::min(y0 + kSide, gbuffer.height()); ++y)
        for (int x = x0; x < std::min(x0 + kSide, gbuffer.width()); x += kBatch) {
            const auto visible = gbuffer.visible(x, y);
            const std::uint32_t lanes = lane_bits(visible);
            if (lanes == 0) continue;
            const Vec3T<Floats> p = gbuffer.points(x, y);
            const std::array<Floats, 3> axes{p.x, p.y, p.z};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                low[axis] = min(low[axis], xsimd::select(visible, axes[axis], infinite));
                high[axis] = max(high[axis], xsimd::select(visible, axes[axis], -infinite));
            }
            for (const std::size_t lane : SetBits(lanes)) {
                const std::int32_t object = gbuffer.object(x + static_cast<int>(lane), y);
                first = std::min(first, object), last = std::max(last, object);
            }
        }
    TilePoints points;
    if (last < 0) return points;
    const Vec3d eye = gbuffer.projection.eye();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        points.box.low[axis] = eye[axis] + static_cast<double>(reduce_min(low[axis]));
        points.box.high[axis] = eye[axis] + static_cast<double>(reduce_max(high[axis]));
    }
    if (first == last) points.object = static_cast<std::uint32_t>(first);
    return points;
}

} // namespace

// Uses the separating axis theorem. The axes are those of the boxes, and the normals of the planes through
// corresponding edges.
bool misses_shaft(const Box3d& a, const Box3d& b, const Box3d& box) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (box.high[axis] < std::min(a.low[axis], b.low[axis]) || box.low[axis] > std::max(a.high[axis], b.high[axis]))
            return true;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        for (unsigned corner = 0; corner < 4; ++corner) {
            const auto along = [&](const Box3d& from, std::size_t axis, bool high) {
                return high ? from.high[axis] : from.low[axis];
            };
            const bool high_i = (corner & 1u) != 0, high_j = (corner & 2u) != 0;
            const double ni = along(a, j, high_j) - along(b, j, high_j), nj = along(b, i, high_i) - along(a, i, high_i);
            // bound() returns the least or the greatest value of n·p over a box.
            const auto bound = [&](const Box3d& from, bool greatest) {
                return ni * along(from, i, (ni > 0) == greatest) + nj * along(from, j, (nj > 0) == greatest);
            };
            if (bound(box, true) < std::min(bound(a, false), bound(b, false)) ||
                bound(box, false) > std::max(bound(a, true), bound(b, true)))
                return true;
        }
    }
    return false;
}

UnblockedTiles::UnblockedTiles(const RasterSceneData& data, const GBuffer& gbuffer, int threads)
    : columns_((gbuffer.width() + kSide - 1) / kSide) {
    const std::vector<Caster> casters = casters_of(data, gbuffer);
    if (casters.size() > kMostCasters || data.scene.needs.motion) return;
    std::vector<Origin> origins;
    for (const Shadows::Source& source : data.shadows->sources()) origins.push_back(origin_of(data, source));
    const double far = 2 * length(Vec3d(data.scene.bounds.diagonal()));
    const int rows = (gbuffer.height() + kSide - 1) / kSide;
    sources_.assign(static_cast<std::size_t>(columns_ * rows), 0);
    parallel_for(sources_.size(), threads, [&](std::size_t i) {
        const int column = static_cast<int>(i) % columns_, row = static_cast<int>(i) / columns_;
        const TilePoints points = points_of(gbuffer, column * kSide, row * kSide);
        if (points.box.empty()) return;
        for (std::size_t k = 0; k < origins.size(); ++k) {
            const Origin& origin = origins[k];
            const Vec3d shift = origin.sun * far, wider = Vec3d(1, 1, 1) * (origin.sine * far);
            const Box3d light = length_squared(shift) > 0
                                    ? Box3d{points.box.low + shift - wider, points.box.high + shift + wider}
                                    : origin.box;
            const bool clear = std::ranges::all_of(casters, [&](const Caster& caster) {
                return caster.object == origin.excluded || (caster.convex && caster.object == points.object) ||
                       misses_shaft(points.box, light, caster.box);
            });
            if (clear) sources_[i] |= std::uint64_t{1} << k;
        }
    });
}

} // namespace duet::raster
