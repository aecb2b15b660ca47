#include "raster/shadows/light_cone.h"

#include <algorithm>

namespace duet::raster {
namespace {

/// Computes the bounds, in a face's image plane, of the convex hull of a point and a quadrilateral, clipped to z ≥
/// clip.
void clip_hull(Vec3 p, const Lanes<Quads>& x, const Lanes<Quads>& y, const Lanes<Quads>& z, float clip, float& left,
               float& right,
               float& bottom, float& top) {
    left = bottom = kInfinity, right = top = -kInfinity;
    const auto cover = [&](Vec3 q) {
        const float per_depth = 1 / q.z;
        left = std::min(left, q.x * per_depth), right = std::max(right, q.x * per_depth);
        bottom = std::min(bottom, q.y * per_depth), top = std::max(top, q.y * per_depth);
    };
    const auto cover_edge = [&](Vec3 a, Vec3 b) {
        if ((a.z >= clip) != (b.z >= clip)) {
            const Vec3 q = a + (b - a) * ((clip - a.z) / (b.z - a.z));
            cover({q.x, q.y, clip});
        }
    };
    std::array<Vec3, 4> corners;
    for (std::size_t i = 0; i < 4; ++i) corners[i] = {x[i], y[i], z[i]};
    if (p.z >= clip) cover(p);
    for (std::size_t i = 0; i < 4; ++i) {
        if (corners[i].z >= clip) cover(corners[i]);
        cover_edge(p, corners[i]);
        cover_edge(corners[i], corners[(i + 1) % 4]);
    }
}

} // namespace

/// Returns the window of a face that the cone covers up to the fraction `reach` of the way, or none if the cone
/// misses the face. Sets `whole` to false where the cone extends beyond the face.
std::optional<AreaLightShadow::Window> AreaLightShadow::window(const Cone& cone, float reach, bool& whole) const {
    const float clip = 1e-4f * (length(cone.p) + radius_); // the projection is unbounded at the light's plane
    const Quads t(reach), one(1.0f);
    const Quads qx = Quads(cone.p.x) + (cone.corners_x - Quads(cone.p.x)) * t,
                qy = Quads(cone.p.y) + (cone.corners_y - Quads(cone.p.y)) * t,
                qz = Quads(cone.p.z) + (cone.corners_z - Quads(cone.p.z)) * t;
    float left, right, bottom, top;
    const bool before = reduce_min(qz) >= clip && cone.p.z >= clip;
    if (before) {
        const Quads per_depth = one / qz, x = qx * per_depth, y = qy * per_depth;
        const float px = cone.p.x / cone.p.z, py = cone.p.y / cone.p.z;
        left = std::min(px, reduce_min(x)), right = std::max(px, reduce_max(x));
        bottom = std::min(py, reduce_min(y)), top = std::max(py, reduce_max(y));
    } else {
        clip_hull(cone.p, Lanes<Quads>(qx), Lanes<Quads>(qy), Lanes<Quads>(qz), clip, left, right, bottom, top);
    }
    if (!before || left < -1 || right > 1 || bottom < -1 || top > 1) whole = false;
    if (left > 1 || right < -1 || bottom > 1 || top < -1 || !(left <= right)) return std::nullopt;
    const int last = 2 * static_cast<int>(cube_.middle) - 1;
    const auto texel_index = [&](float at, float margin) { // includes every texel that the filter would weight
        return std::clamp(static_cast<int>(cube_.middle + std::clamp(at, -1.0f, 1.0f) * cube_.scale + margin), 0, last);
    };
    return Window{texel_index(left, -0.5f), texel_index(-top, -0.5f), texel_index(right, 0.5f),
                  texel_index(-bottom, 0.5f)};
}

/// Returns the windows, on one or more faces, that the cone covers up to the fraction `reach` of the way.
AreaLightShadow::Faces AreaLightShadow::faces(const Cone& cone, std::size_t main_face,
                                              const EmitterFrame& emitter_frame, Vec3 p, Vec3 n, float reach) const {
    Faces result;
    bool whole = true;
    if (const auto window = this->window(cone, reach, whole)) result.add(main_face, cone, *window);
    for (std::size_t face = 0; !whole && face < 6; ++face) {
        if (face == main_face || cube_.faces[face] == nullptr) continue;
        const Cone there(kind_, turned(emitter_frame, face), to_face(face, p), to_face(face, n), cone.slack);
        bool other = true;
        if (const auto window = this->window(there, reach, other)) result.add(face, there, *window);
    }
    return result;
}

} // namespace duet::raster
