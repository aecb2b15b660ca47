#include "common/scene/obj/triangulate.h"

#include "common/vec/box.h"
#include "common/vec/robust.h"

namespace duet {

namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

/// Projects the corners along the axis nearest to the normal. The result is relative to the first corner and
/// counter-clockwise.
std::vector<Vec2d> project(std::span<const Vec3> polygon) {
    const Vec3d n = newell_normal(polygon), size = abs(n);
    const std::size_t axis = longest_axis(size);
    std::vector<Vec2d> projected;
    projected.reserve(polygon.size());
    for (const Vec3 p : polygon) {
        const Vec3d d = Vec3d(p) - Vec3d(polygon[0]);
        const double x = d[(axis + 1) % 3], y = d[(axis + 2) % 3];
        projected.push_back(n[axis] < 0 ? Vec2d(y, x) : Vec2d(x, y));
    }
    return projected;
}

/// Returns twice the signed area of abc, which is positive where abc is counter-clockwise.
double area(Vec2d a, Vec2d b, Vec2d c) {
    const Vec2d u = b - a, v = c - a;
    return difference_of_products(u.x, v.y, u.y, v.x);
}

bool is_convex(const std::vector<Vec2d>& p) {
    const std::size_t n = p.size();
    // x_direction_changes counts the direction changes of x. A polygon that winds twice also turns left at each corner,
    // but its x changes direction more than twice.
    int x_direction_changes = 0;
    double last = 0, first = 0;
    for (std::size_t i = 0; i < n; ++i) {
        if (!(area(p[i], p[(i + 1) % n], p[(i + 2) % n]) > 0)) return false;
        const double dx = p[(i + 1) % n].x - p[i].x;
        if (dx == 0) continue;
        if (last == 0) first = dx;
        x_direction_changes += last * dx < 0;
        last = dx;
    }
    return x_direction_changes + (last * first < 0) <= 2;
}

double distance_squared(Vec3 a, Vec3 b) { return length_squared(Vec3d(a) - Vec3d(b)); }

void split_quad(std::span<const Vec3> q, const std::vector<Vec2d>& p, Triangles& triangles) {
    // For each diagonal this is the smaller area of the two triangles. It is negative where the diagonal lies
    // outside.
    const double by_02 = min(area(p[0], p[1], p[2]), area(p[0], p[2], p[3]));
    const double by_13 = min(area(p[0], p[1], p[3]), area(p[1], p[2], p[3]));
    const bool both = by_02 > 0 && by_13 > 0;
    const bool use_02 = both ? distance_squared(q[0], q[2]) <= distance_squared(q[1], q[3]) : by_02 >= by_13;
    if (use_02) {
        triangles.push_back({0, 1, 2});
        triangles.push_back({0, 2, 3});
    } else {
        triangles.push_back({0, 1, 3});
        triangles.push_back({1, 2, 3});
    }
}

/// An EarClipper holds the remaining corners of a polygon as a doubly linked ring.
class EarClipper {
public:
    explicit EarClipper(const std::vector<Vec2d>& points) : p_(points), next_(points.size()), previous_(points.size()) {
        const auto n = static_cast<std::uint32_t>(points.size());
        for (std::uint32_t i = 0; i < n; ++i) {
            next_[i] = (i + 1) % n;
            previous_[i] = (i + n - 1) % n;
        }
        for (std::uint32_t i = 0; i < n; ++i)
            if (!(turn(i) > 0)) reflex_.push_back(i);
    }

    void clip(Triangles& triangles) {
        std::uint32_t at = 0;
        for (std::size_t left = p_.size(); left > 3; --left) {
            at = next_ear(at, left);
            triangles.push_back({previous_[at], at, next_[at]});
            remove(at);
            at = next_[at]; // moves on: clipping at the same corner again would make a fan of slivers
        }
        triangles.push_back({previous_[at], at, next_[at]});
    }

private:
    double turn(std::uint32_t i) const { return area(p_[previous_[i]], p_[i], p_[next_[i]]); }

    /// Returns the next ear of the ring. Rounding or a self-intersection may leave none. The result is then the first
    /// corner that is not reflex, or `start` if all are.
    std::uint32_t next_ear(std::uint32_t start, std::size_t left) const {
        std::uint32_t flattest = start;
        for (std::size_t k = 0; k < left; ++k, start = next_[start]) {
            if (is_ear(start)) return start;
            if (turn(flattest) < 0 && turn(start) >= 0) flattest = start;
        }
        return flattest;
    }

    /// Returns whether corner i is an ear: a convex corner whose triangle contains no other corner. Only reflex
    /// corners can lie in it.
    bool is_ear(std::uint32_t i) const {
        const Vec2d a = p_[previous_[i]], b = p_[i], c = p_[next_[i]];
        if (!(area(a, b, c) > 0)) return false;
        for (const std::uint32_t r : reflex_) {
            const Vec2d q = p_[r];
            if (q == a || q == b || q == c) continue; // a bridge to a hole visits its ends twice
            if (area(a, b, q) >= 0 && area(b, c, q) >= 0 && area(c, a, q) >= 0) return false;
        }
        return true;
    }

    void remove(std::uint32_t i) {
        next_[previous_[i]] = next_[i];
        previous_[next_[i]] = previous_[i];
        // Only the angles of the two neighbors change, and a convex neighbor stays convex.
        std::erase_if(reflex_,
                      [&](std::uint32_t r) { return r == i || ((r == previous_[i] || r == next_[i]) && turn(r) > 0); });
    }

    const std::vector<Vec2d>& p_;
    std::vector<std::uint32_t> next_, previous_, reflex_;
};

} // namespace

Vec3d newell_normal(std::span<const Vec3> polygon) {
    Vec3d sum;
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
        sum += cross(Vec3d(polygon[i]) - Vec3d(polygon[0]), Vec3d(polygon[i + 1]) - Vec3d(polygon[0]));
    return sum;
}

bool triangulate(std::span<const Vec3> polygon, Triangles& triangles) {
    if (polygon.size() == 3) {
        triangles.push_back({0, 1, 2});
        return true;
    }
    const std::vector<Vec2d> projected = project(polygon);
    if (polygon.size() == 4) {
        split_quad(polygon, projected, triangles);
    } else if (is_convex(projected)) {
        for (std::uint32_t i = 1; i + 1 < polygon.size(); ++i) triangles.push_back({0, i, i + 1});
    } else {
        if (polygon.size() > kMaxConcaveCorners) return false;
        EarClipper(projected).clip(triangles);
    }
    return true;
}

} // namespace duet
