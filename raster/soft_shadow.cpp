#include "raster/soft_shadow.h"

#include "common/sampling/sobol.h"
#include "common/sampling/warp.h"
#include "common/vec/simd.h"

#include <algorithm>
#include <cmath>

namespace duet::raster {
namespace {

constexpr int kTaps = TapRange::kBlocks * TapRange::kBlock;
constexpr int kNarrowings = 4;
constexpr double kThinnest = 1e5; ///< length over width: what is thinner has no outline in floats, and counts as a ball
constexpr float kWorthwhile = 0.8f; ///< a narrower cone is worth another look if it is so much narrower

/// Points of a light of each kind, as parts of its edges: a (0,2)-net, of which each block is a coarser one.
struct TapTable {
    alignas(64) std::array<float, kTaps> a, b;
};
TapTable tap_table(Emitter::Kind kind) {
    TapTable table;
    for (std::uint32_t i = 0; i < kTaps; ++i) {
        const auto index = static_cast<std::size_t>(i);
        Vec2 u{(static_cast<float>(reverse_bits(i) >> 8) + 0.5f) * 0x1p-24f + 0.5f / kTaps,
               (static_cast<float>(reverse_bits(sobol_second(i)) >> 8) + 0.5f) * 0x1p-24f + 0.5f / kTaps};
        std::swap(u.x, u.y);
        if (kind == Emitter::Kind::kBall) u = concentric_disk(u);
        if (kind == Emitter::Kind::kTriangle) u = uniform_triangle(u);
        table.a[index] = u.x, table.b[index] = u.y;
    }
    return table;
}
const TapTable& taps_of(Emitter::Kind kind) {
    static const std::array<TapTable, 3> tables{tap_table(Emitter::Kind::kParallelogram),
                                                tap_table(Emitter::Kind::kTriangle), tap_table(Emitter::Kind::kBall)};
    return tables[static_cast<std::size_t>(kind)];
}

Quads four(float a, float b, float c, float d) {
    alignas(16) const std::array<float, 4> numbers{a, b, c, d};
    return Quads::load_aligned(numbers.data());
}
template <typename T> Vec3T<T> lanes(Vec3 v) { return {T(v.x), T(v.y), T(v.z)}; }

} // namespace

/// Texels x0 to x1, y0 to y1 of a face.
struct SoftLight::Window {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

    int columns() const { return x1 - x0 + 1; }
    int rows() const { return y1 - y0 + 1; }
    bool small() const { return columns() <= kSearchedSide && rows() <= kSearchedSide; }
};

/// The light from one receiver, in the light's own frame, or a face's: the light's centre is the origin. Floats do here,
/// for all is near the origin by the light's own measure.
class SoftLight::Cone {
public:
    Cone(Emitter::Kind kind, const Outline& outline, Vec3 receiver, Vec3 normal, float lift)
        : p(receiver), n(normal), slack(lift), o(outline), kind_(kind) {
        per_height = -1 / dot(o.axis, p);
        p_u_ = dot(p - o.corner, o.dual_u), p_v_ = dot(p - o.corner, o.dual_v);
        per_metre = std::sqrt(max(dot(o.dual_u, o.dual_u), dot(o.dual_v, o.dual_v)));
        const bool ball = kind_ == Emitter::Kind::kBall, triangle = kind_ == Emitter::Kind::kTriangle;
        const Vec3 first = ball ? o.corner - o.u - o.v : o.corner, u = ball ? o.u * 2.0f : o.u, v = ball ? o.v * 2.0f : o.v;
        const Vec3 a = first + u, b = triangle ? first + v : first + u + v, c = first + v;
        corners_x = four(first.x, a.x, b.x, c.x), corners_y = four(first.y, a.y, b.y, c.y), corners_z = four(first.z, a.z, b.z, c.z);
    }

    /// Whether the line from the receiver through `to` from there, at the fraction f of the way, goes on to the light, or
    /// passes beside that by up to `margin`, as a part of its edges.
    Floats::batch_bool_type meets(const Vec3T<Floats>& to, const Floats& f, const Floats& margin) const {
        // The line goes on to corner + a·u + b·v; both sides times the fraction save the division.
        const Floats a = Floats(p_u_) * f + dot(to, lanes<Floats>(o.dual_u)), b = Floats(p_v_) * f + dot(to, lanes<Floats>(o.dual_v));
        if (kind_ == Emitter::Kind::kBall) return a * a + b * b <= (f + margin) * (f + margin);
        const Floats most = kind_ == Emitter::Kind::kParallelogram ? max(a, b) : a + b;
        return (min(a, b) > -margin) & (most <= f + margin);
    }

    Vec3 p, n;        ///< the receiver
    float slack;      ///< height over its plane that rounding accounts for
    Outline o;
    float per_height; ///< the fraction of the way that a metre along the axis is
    float per_metre;  ///< the part of the light's shorter edge that a metre is
    Quads corners_x, corners_y, corners_z; ///< of a parallelogram, or a triangle, around the light

private:
    Emitter::Kind kind_;
    float p_u_, p_v_;
};

/// Parts of faces, and the cone as each sees it.
struct SoftLight::Faces {
    struct Part {
        std::size_t face;
        Cone cone;
        Window window;
    };
    std::array<std::optional<Part>, 6> parts;
    std::size_t count = 0;

    bool small() const { return count == 1 && parts[0]->window.small(); }
    void add(std::size_t face, const Cone& cone, const Window& window) { parts[count++].emplace(Part{face, cone, window}); }
};

SoftLight::SoftLight(CubeMap cube, const Emitter& emitter) : cube_(std::move(cube)), kind_(emitter.kind) {
    if (kind_ == Emitter::Kind::kBall) {
        radius_ = static_cast<float>(emitter.radius);
    } else {
        const float part = kind_ == Emitter::Kind::kTriangle ? 1.0f / 3 : 0.5f;
        u_ = Vec3(cube_.frame.to_local(emitter.u)), v_ = Vec3(cube_.frame.to_local(emitter.v));
        corner_ = (u_ + v_) * -part;
        radius_ = std::max({length(corner_), length(corner_ + u_), length(corner_ + v_), length(corner_ + u_ + v_)});
        // In doubles: the difference of products is all of a sliver's area.
        const Vec3d u = emitter.u, v = emitter.v, n = cross(u, v);
        const double over = 1 / dot(n, n);
        const Vec3d dual_u = cross(v, n) * over, dual_v = cross(n, u) * over;
        dual_u_ = Vec3(cube_.frame.to_local(dual_u)), dual_v_ = Vec3(cube_.frame.to_local(dual_v));
        const double thinness = static_cast<double>(radius_) * max(length(dual_u), length(dual_v));
        if (!(thinness < kThinnest)) kind_ = Emitter::Kind::kBall; // also where n = 0
    }
    for (std::size_t face = 0; face < 6; ++face) {
        if (kind_ != Emitter::Kind::kBall) flat_[face] = Outline{{}, corner_, u_, v_, dual_u_, dual_v_}.turned(face);
        if (cube_.faces[face]) nearest_[face] = std::make_unique<NearestPyramid>(before_light(face));
    }
    find_closest();
}

namespace {

/// The middle of cell (x, y) of n × n on a face, unit.
Vec3 cell_way(std::size_t face, int x, int y, int n) {
    const float step = 2.0f / static_cast<float>(n);
    return normalize(from_face(face, {-1 + (static_cast<float>(x) + 0.5f) * step, 1 - (static_cast<float>(y) + 0.5f) * step, 1}));
}

} // namespace

/// What a face sees, but for what stands behind a flat light that shines to one side: a ceiling around it would be nearest
/// to all.
ImageFloat SoftLight::before_light(std::size_t face) const {
    ImageFloat image = cube_.faces[face]->nearness();
    if (kind_ == Emitter::Kind::kBall || cube_.faces[5] != nullptr) return image;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            if (from_face(face, {static_cast<float>(x) + 0.5f - cube_.middle, cube_.middle - static_cast<float>(y) - 0.5f, cube_.scale}).z < 0)
                image(x, y) = 0;
    return image;
}

/// Of each cell of directions, the distance of what is closest that may be in the cone of a receiver there. All of a
/// cone is within the light's radius of the line from the centre to the receiver: what is seen at the distance d and the
/// angle ψ beside the receiver is so only if d sin ψ ≤ r.
void SoftLight::find_closest() {
    constexpr int kSeen = 2 * kWays;
    struct Seen {
        Vec3 way;
        float distance; ///< at least
    };
    std::vector<Seen> seen;
    const int side = 2 * static_cast<int>(cube_.middle);
    for (std::size_t face = 0; face < 6; ++face) {
        if (nearest_[face] == nullptr) continue;
        for (int y = 0; y < kSeen; ++y)
            for (int x = 0; x < kSeen; ++x) {
                const Vec3 way = cell_way(face, x, y, kSeen);
                const auto texel = [&](int cell) { return std::min(cell * side / kSeen, side - 1); };
                const float nearness = nearest_[face]->greatest(texel(x), texel(y), texel(x + 1), texel(y + 1));
                if (nearness > 0) seen.push_back({way, cube_.near / nearness * 0.9999f});
            }
    }
    // Half the diagonals of a cell of each kind, at most, and the texels of the guard that a cell may reach over.
    const float slack = std::sqrt(2.0f) / kWays + std::sqrt(2.0f) / kSeen + 0.1f;
    const float cosine = std::cos(slack), sine = std::sin(slack);
    for (std::size_t face = 0; face < 6; ++face)
        for (int y = 0; y < kWays; ++y)
            for (int x = 0; x < kWays; ++x) {
                const Vec3 way = cell_way(face, x, y, kWays);
                float closest = kInfinity;
                for (const Seen& s : seen) {
                    if (s.distance >= closest) continue;
                    const float c = dot(way, s.way);
                    const float beside = c >= cosine  ? 0.0f
                                         : c < -sine ? 1.0f // behind: only as close as the light itself
                                                     : std::sqrt(1 - c * c) * cosine - c * sine; // sin(ψ − slack)
                    if (s.distance * beside <= radius_) closest = s.distance;
                }
                closest_[(face * kWays + static_cast<std::size_t>(y)) * kWays + static_cast<std::size_t>(x)] = closest;
            }
}

SoftLight::Outline SoftLight::Outline::turned(std::size_t face) const {
    return {to_face(face, axis), to_face(face, corner), to_face(face, u),
            to_face(face, v),    to_face(face, dual_u), to_face(face, dual_v)};
}

SoftLight::Outline SoftLight::turned(const Outline& outline, std::size_t face) const {
    if (kind_ == Emitter::Kind::kBall) return outline.turned(face);
    Outline result = flat_[face];
    result.axis = to_face(face, outline.axis);
    return result;
}

std::optional<SoftLight::Outline> SoftLight::outline_from(Vec3 p) const {
    if (kind_ != Emitter::Kind::kBall) {
        if (p.z == 0) return std::nullopt; // nothing is before a receiver in the light's own plane
        return Outline{{0, 0, p.z < 0 ? 1.0f : -1.0f}, corner_, u_, v_, dual_u_, dual_v_};
    }
    const float distance = length(p);
    if (!(distance > radius_)) return std::nullopt; // nor within its ball
    const Vec3 axis = -p / distance;
    const Frame disk = frame_from_normal(axis);
    // The disk through the centre that fills the cone of the lines that touch the ball.
    const float radius = radius_ / safe_sqrt(1 - sqr(radius_ / distance));
    return Outline{axis, {}, disk.s * radius, disk.t * radius, disk.s / radius, disk.t / radius};
}

/// As bound(), of all that is around the receiver's direction.
float SoftLight::first_reach(Vec3 p, std::size_t face, float farthest) const {
    const Vec3 along = to_face(face, p);
    const auto cell = [&](float at) {
        return static_cast<std::size_t>(std::clamp(static_cast<int>((at / along.z + 1) * (0.5f * kWays)), 0, kWays - 1));
    };
    const float distance = length(p), closest = closest_[(face * kWays + cell(-along.y)) * kWays + cell(along.x)];
    if (closest >= std::max(distance, farthest)) return 0;
    return distance > farthest ? std::min((distance - closest) / (distance - farthest), 1.0f) : 1.0f;
}

namespace {

/// What is seen, in a face, of the part before it of the hull of a point and a quadrangle.
void clip_hull(Vec3 p, const Lanes<Quads>& x, const Lanes<Quads>& y, const Lanes<Quads>& z, float clip, float& left, float& right,
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

/// The part of a face that the cone, up to a fraction of the way, covers; none if it misses the face. `whole`: set to
/// false where the cone goes on beyond the face.
std::optional<SoftLight::Window> SoftLight::window(const Cone& cone, float reach, bool& whole) const {
    const float clip = 1e-4f * (length(cone.p) + radius_); // before the light's plane all of the map is covered
    const Quads t(reach), one(1.0f);
    const Quads qx = Quads(cone.p.x) + (cone.corners_x - Quads(cone.p.x)) * t, qy = Quads(cone.p.y) + (cone.corners_y - Quads(cone.p.y)) * t,
                qz = Quads(cone.p.z) + (cone.corners_z - Quads(cone.p.z)) * t;
    float left, right, bottom, top;
    const bool before = lowest(qz) >= clip && cone.p.z >= clip;
    if (before) {
        const Quads per_depth = one / qz, x = qx * per_depth, y = qy * per_depth;
        const float px = cone.p.x / cone.p.z, py = cone.p.y / cone.p.z;
        left = std::min(px, lowest(x)), right = std::max(px, highest(x));
        bottom = std::min(py, lowest(y)), top = std::max(py, highest(y));
    } else {
        clip_hull(cone.p, Lanes<Quads>(qx), Lanes<Quads>(qy), Lanes<Quads>(qz), clip, left, right, bottom, top);
    }
    if (!before || left < -1 || right > 1 || bottom < -1 || top > 1) whole = false;
    if (left > 1 || right < -1 || bottom > 1 || top < -1 || !(left <= right)) return std::nullopt;
    const int last = 2 * static_cast<int>(cube_.middle) - 1;
    const auto place = [&](float at, float margin) { // with every texel of which the filter would take a part
        return std::clamp(static_cast<int>(cube_.middle + std::clamp(at, -1.0f, 1.0f) * cube_.scale + margin), 0, last);
    };
    return Window{place(left, -0.5f), place(-top, -0.5f), place(right, 0.5f), place(-bottom, 0.5f)};
}

/// What the cone covers up to a fraction of the way: parts of one face or of several.
SoftLight::Faces SoftLight::faces(const Cone& cone, std::size_t main_face, const Outline& outline, Vec3 p, Vec3 n, float reach) const {
    Faces result;
    bool whole = true;
    if (const auto window = this->window(cone, reach, whole)) result.add(main_face, cone, *window);
    for (std::size_t face = 0; !whole && face < 6; ++face) {
        if (face == main_face || cube_.faces[face] == nullptr) continue;
        const Cone there(kind_, turned(outline, face), to_face(face, p), to_face(face, n), cone.slack);
        bool other = true;
        if (const auto window = this->window(there, reach, other)) result.add(face, there, *window);
    }
    return result;
}

/// Adds up at which fraction of the way blockers in a window stand. Each counts by how much of the light it hides: its
/// size as seen from the receiver.
void SoftLight::add_blockers(const Cone& cone, std::size_t face, const Window& window, Blockers& blockers) const {
    const int rows = std::min(window.rows(), kSearchedRows);
    const float down = static_cast<float>(window.rows()) / static_cast<float>(rows),
                across = static_cast<float>(window.columns()) / kSearchedSide;
    // As in dark_taps: a texel's point is over the receiver's plane where height + over · nearness > 0.
    const float per_texel = cube_.near / cube_.scale;
    const Floats over(-dot(cone.n, cone.p) - cone.slack), n_x(cone.n.x * per_texel);
    const int width = 2 * static_cast<int>(cube_.middle);
    // Of a narrow window whole rows are loaded, wherever they begin.
    const bool narrow = window.columns() <= kSearchedSide;
    const int left = narrow ? std::min(window.x0, width - kSearchedSide) : window.x0;
    for (int first = 0; first < kSearchedSide; first += static_cast<int>(Floats::size)) {
        const Floats column = load(kLanesAsFloats, 0) + Floats(static_cast<float>(first));
        const Floats x = Floats(static_cast<float>(left)) + (narrow ? column : xsimd::floor(column * Floats(across)));
        const auto inside = (x >= Floats(static_cast<float>(window.x0))) & (x <= Floats(static_cast<float>(window.x1)));
        const Ints places = truncated(x);
        const Floats from_middle = x + Floats(0.5f - cube_.middle), height_x = n_x * from_middle;
        for (int row = 0; row < rows; ++row) {
            const int y = window.y0 + static_cast<int>(static_cast<float>(row) * down);
            const float up = cube_.middle - 0.5f - static_cast<float>(y);
            const float* line = cube_.faces[face]->nearness().pixels().data() + y * width;
            const Floats nearness = narrow ? Floats::load_unaligned(line + left + first) : gather(line, places);
            const Floats height = height_x + Floats(cone.n.y * per_texel * up + cone.n.z * cube_.near);
            const auto above = inside & (height + over * nearness > Floats(0.0f));
            if (xsimd::any(above)) add_row(cone, above, nearness, from_middle, up, blockers);
        }
    }
}

void SoftLight::add_row(const Cone& cone, const Floats::batch_bool_type& above, const Floats& nearness, const Floats& right, float up,
                        Blockers& blockers) const {
    const Floats depth = Floats(cube_.near) / nearness, per_scale = depth * Floats(1 / cube_.scale);
    const Vec3T<Floats> to{right * per_scale - Floats(cone.p.x), Floats(up) * per_scale - Floats(cone.p.y),
                           depth - Floats(cone.p.z)};
    const Floats fraction = dot(lanes<Floats>(cone.o.axis), to) * Floats(cone.per_height);
    // Where the cone is narrower than a texel, half a texel beside it still belongs to what the filter sees: but not the
    // next facet of a concave surface (ShadowMap::kConcave).
    const Floats none(0.0f), margin = per_scale * Floats(0.5f * cone.per_metre);
    const auto steps_up = dot(lanes<Floats>(cone.n), to) > per_scale * Floats(static_cast<float>(ShadowMap::kConcave));
    const auto blocks = above & (fraction > none) & (fraction < Floats(1.0f)) &
                        cone.meets(to, fraction, xsimd::select(steps_up, margin, none));
    if (!xsimd::any(blocks)) return;
    const Floats weight = Floats(1.0f) / ((fraction + margin) * (fraction + margin));
    blockers.weights += xsimd::hadd(xsimd::select(blocks, weight, none));
    blockers.sum += xsimd::hadd(xsimd::select(blocks, weight * fraction, none));
}

/// How many of some taps, in the plane parallel to the light in which blockers are taken to be, are dark, of those that
/// one face sees: of the four texels about each, weighed by how near they are, those that see something between
/// receiver and light.
float SoftLight::dark_taps(float blocker, const Cone& cone, std::size_t face, int first, int count) const {
    const ShadowMap& map = *cube_.faces[face];
    const TapTable& table = taps_of(kind_);
    const float* nearness = map.nearness().pixels().data();
    const Vec3 n = cone.n, axis = cone.o.axis * cone.per_height;
    // A texel in the direction d = (x, y, 1) stands at q = d · near / nearness: over the plane where n·(q − p) > slack,
    // between where 0 < axis·(q − p) < 1. All times nearness, so that nothing is divided.
    const Floats over(dot(n, cone.p) + cone.slack), before(dot(axis, cone.p));
    const float per_texel = cube_.near / cube_.scale;
    const Floats n_x(n.x * per_texel), n_y(-n.y * per_texel), a_x(axis.x * per_texel), a_y(-axis.y * per_texel);
    const Vec3 start = cone.p * (1 - blocker) + cone.o.corner * blocker, u = cone.o.u * blocker, v = cone.o.v * blocker;
    Floats dark(0.0f);
    for (int i = first; i < first + count; i += static_cast<int>(Floats::size)) {
        const auto at = static_cast<std::size_t>(i);
        const Floats a = Floats::load_aligned(&table.a[at]), b = Floats::load_aligned(&table.b[at]);
        const Floats qx = Floats(start.x) + a * Floats(u.x) + b * Floats(v.x), qy = Floats(start.y) + a * Floats(u.y) + b * Floats(v.y),
                     qz = Floats(start.z) + a * Floats(u.z) + b * Floats(v.z);
        // Of what is beyond the face nothing is looked up.
        const auto seen_here = (qz > Floats(0.0f)) & (xsimd::abs(qx) <= qz) & (xsimd::abs(qy) <= qz);
        if (!xsimd::any(seen_here)) continue;
        const Floats per_depth = xsimd::select(seen_here, Floats(cube_.scale) / qz, Floats(0.0f));
        const Floats x = Floats(cube_.middle - 0.5f) + qx * per_depth, y = Floats(cube_.middle - 0.5f) - qy * per_depth;
        const Floats x0 = xsimd::floor(x), y0 = xsimd::floor(y), fx = x - x0, fy = y - y0;
        const Ints place = truncated(y0 * Floats(static_cast<float>(map.side())) + x0);
        const Floats from_middle_x = x0 + Floats(0.5f - cube_.middle), from_middle_y = y0 + Floats(0.5f - cube_.middle);
        const Floats height = Floats(n.z * cube_.near) + n_x * from_middle_x + n_y * from_middle_y;
        const Floats way = Floats(axis.z * cube_.near) + a_x * from_middle_x + a_y * from_middle_y;
        const auto hidden = [&](int step, const Floats& h, const Floats& w, const Floats& weight) {
            const Floats seen = gather(nearness + step, place), part = w - before * seen;
            const auto between = (h - over * seen > Floats(0.0f)) & (part > Floats(0.0f)) & (part < seen);
            return xsimd::select(between, weight, Floats(0.0f));
        };
        const Floats one(1.0f), gx = one - fx, gy = one - fy;
        const Floats upper = hidden(0, height, way, gx * gy) + hidden(1, height + n_x, way + a_x, fx * gy);
        const Floats lower = hidden(map.side(), height + n_y, way + a_y, gx * fy) +
                             hidden(map.side() + 1, height + n_x + n_y, way + a_x + a_y, fx * fy);
        dark += xsimd::select(seen_here, upper + lower, Floats(0.0f));
    }
    return xsimd::hadd(dark);
}

/// How far from the receiver, as a fraction of the way, anything in the parts of the map can stand.
float SoftLight::bound(const Faces& faces, float farthest) const {
    float bound = 0;
    for (std::size_t i = 0; i < faces.count; ++i) {
        const auto& [face, cone, window] = *faces.parts[i];
        const float nearness = nearest_[face]->greatest(window.x0, window.y0, window.x1, window.y1);
        if (!(nearness > 0)) continue;
        const float depth = cube_.near / nearness * 0.9999f, distance = length(cone.p);
        // What is at the fraction f of the way is no farther from the centre than |p| (1 − f) + r f; and, where one
        // face sees all, no deeper than p.z (1 − f) + z f.
        if (distance > farthest) bound = std::max(bound, (distance - depth) / (distance - farthest));
        else bound = 1;
        if (faces.count > 1) continue;
        const float deepest = highest(cone.corners_z);
        if (cone.p.z > deepest) bound = std::min(bound, (cone.p.z - depth) / (cone.p.z - deepest));
    }
    return bound;
}

float SoftLight::visibility(const Receiver& receiver, TapRange taps) const {
    const Vec3 p(cube_.frame.to_local(receiver.p - cube_.center)), n(cube_.frame.to_local(receiver.n));
    const std::size_t main_face = cube_face(p);
    const std::optional<Outline> outline = outline_from(p);
    if (!outline || cube_.faces[main_face] == nullptr) return 1;
    const float farthest = kind_ == Emitter::Kind::kBall ? length(outline->u) : radius_;
    float reach = first_reach(p, main_face, farthest);
    if (!(reach > 0)) return 1;
    const float slack = 2 * static_cast<float>(receiver.error) + length(p) * 0x1p-19f;
    const Cone main(kind_, turned(*outline, main_face), to_face(main_face, p), to_face(main_face, n), slack);

    Faces searched = faces(main, main_face, *outline, p, n, reach);
    for (int i = 0; i < kNarrowings && !searched.small(); ++i) {
        const float bound = this->bound(searched, farthest);
        if (bound <= 0) return 1;
        const bool narrower = bound < kWorthwhile * reach;
        reach = std::min(reach, bound);
        if (!narrower) break;
        searched = faces(main, main_face, *outline, p, n, reach);
    }
    Blockers blockers;
    for (std::size_t i = 0; i < searched.count; ++i)
        add_blockers(searched.parts[i]->cone, searched.parts[i]->face, searched.parts[i]->window, blockers);
    if (!(blockers.weights > 0)) return 1;
    const float blocker = blockers.sum / blockers.weights;
    const Faces seen = searched.count > 1 ? faces(main, main_face, *outline, p, n, blocker) : searched;
    const auto dark = [&](int first, int count) {
        float sum = 0;
        for (std::size_t i = 0; i < seen.count; ++i) sum += dark_taps(blocker, seen.parts[i]->cone, seen.parts[i]->face, first, count);
        return sum;
    };
    const float few = dark(taps.first, TapRange::kBlock);
    const bool agree = few <= 0 || few >= TapRange::kBlock;
    const int rest = taps.count - TapRange::kBlock;
    const float part = agree || rest == 0 ? few / TapRange::kBlock
                                          : (few + dark(taps.first + TapRange::kBlock, rest)) / static_cast<float>(taps.count);
    return clamp(1 - part, 0.0f, 1.0f);
}

std::int64_t SoftLight::memory_bytes() const {
    std::int64_t sum = 0;
    for (const auto& pyramid : nearest_)
        if (pyramid) sum += pyramid->memory_bytes();
    return sum;
}

} // namespace duet::raster
