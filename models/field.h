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

/// A bead is one sphere of a chain; a limb is the union of the hulls of successive beads.
struct Bead {
    Vec3d center;
    double radius = 0;
};

/// Returns an approximate signed distance to the hull of two beads: the nearest point of the axis has an interpolated
/// radius.
inline double link_distance(Vec3d p, const Bead& a, const Bead& b) {
    const Vec3d axis = b.center - a.center;
    const double t = clamp(dot(p - a.center, axis) / length_squared(axis), 0.0, 1.0);
    return length(p - a.center - axis * t) - lerp(a.radius, b.radius, t);
}

/// A limb has many beads, grouped into stretches; only stretches that may be nearest are searched.
class Limb {
public:
    explicit Limb(std::vector<Bead> beads);
    /// Returns the least link_distance. It is exact below `bound`; otherwise the result is some value of at least
    /// `bound`.
    double distance(Vec3d p, double bound) const;
    std::span<const Bead> beads() const { return beads_; }

private:
    struct Stretch {
        Vec3d center;
        double radius; ///< of a bounding sphere of all its links
        std::size_t first, last;
    };
    Stretch stretch(std::size_t first, std::size_t last) const;

    std::vector<Bead> beads_;
    std::vector<Stretch> stretches_;
    Stretch whole_;
};

/// Returns smooth noise in about [−1, 1] with one feature per meter. It blends gradients at lattice points, from a
/// platform-independent hash, by a quintic (Perlin 2002).
double gradient_noise(Vec3d p);

} // namespace duet::models
