// This header declares building blocks of implicit surfaces: distances and their smooth unions.
#pragma once

#include "common/vec/vec.h"

#include <span>
#include <vector>

namespace duet::models {

/// Returns min(a, b), rounded by a quadratic polynomial where they differ by less than k; k > 0.
inline double smooth_min(double a, double b, double k) {
    const double h = max(k - std::abs(a - b), 0.0) / k;
    return min(a, b) - h * h * k * 0.25;
}
/// Returns max(a, b), rounded in the same way as smooth_min.
inline double smooth_max(double a, double b, double k) { return -smooth_min(-a, -b, k); }

/// Returns 0 below a, 1 above b, and 3s² − 2s³ in between.
inline double smooth_step(double a, double b, double x) {
    const double s = clamp((x - a) / (b - a), 0.0, 1.0);
    return s * s * (3 - 2 * s);
}

/// A LimbSphere is one sphere of a chain; a limb is the union of the hulls of successive spheres.
struct LimbSphere {
    Vec3d center;
    double radius = 0;
};

/// Returns an approximate signed distance to the hull of two spheres: the nearest point of the axis has an interpolated
/// radius.
inline double round_cone_distance(Vec3d p, const LimbSphere& a, const LimbSphere& b) {
    const Vec3d axis = b.center - a.center;
    const double t = clamp(dot(p - a.center, axis) / length_squared(axis), 0.0, 1.0);
    return length(p - a.center - axis * t) - lerp(a.radius, b.radius, t);
}

/// A limb has many spheres, grouped into segments; only segments that may be nearest are searched.
class Limb {
public:
    explicit Limb(std::vector<LimbSphere> spheres);
    /// Returns the least round_cone_distance. It is exact below `bound`; otherwise the result is some value of at least
    /// `bound`.
    double distance(Vec3d p, double bound) const;
    std::span<const LimbSphere> spheres() const { return spheres_; }

private:
    struct Segment {
        Vec3d center;
        double radius; ///< radius of a bounding sphere of the segment
        std::size_t first, last;
    };
    Segment segment(std::size_t first, std::size_t last) const;

    std::vector<LimbSphere> spheres_;
    std::vector<Segment> segments_;
    Segment bounding_segment_;
};

/// Returns smooth noise in about [−1, 1] with one feature per meter. It blends gradients at lattice points, from a
/// platform-independent hash, by a quintic (Perlin 2002).
double gradient_noise(Vec3d p);

} // namespace duet::models
