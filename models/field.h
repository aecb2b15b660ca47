// Building blocks of implicit surfaces: distances, and their smooth unions.
#pragma once

#include "common/vec/vec.h"

#include <span>
#include <vector>

namespace duet::models {

/// min(a, b), rounded where they differ by less than k (polynomial of second degree); k > 0.
inline double smooth_min(double a, double b, double k) {
    const double h = max(k - std::abs(a - b), 0.0) / k;
    return min(a, b) - h * h * k * 0.25;
}
/// max(a, b), likewise.
inline double smooth_max(double a, double b, double k) { return -smooth_min(-a, -b, k); }

/// 0 below a, 1 above b, 3s² − 2s³ between.
inline double smooth_step(double a, double b, double x) {
    const double s = clamp((x - a) / (b - a), 0.0, 1.0);
    return s * s * (3 - 2 * s);
}

/// A ball on a string: a sphere of the chain whose hull, link by link, a limb is.
struct Bead {
    Vec3d center;
    double radius = 0;
};

/// Signed distance, nearly, to the hull of two beads: the axis's nearest point has an interpolated radius.
inline double link_distance(Vec3d p, const Bead& a, const Bead& b) {
    const Vec3d axis = b.center - a.center;
    const double t = clamp(dot(p - a.center, axis) / length_squared(axis), 0.0, 1.0);
    return length(p - a.center - axis * t) - lerp(a.radius, b.radius, t);
}

/// A limb of many beads, searched by stretches: only those that may be nearest are looked at.
class Limb {
public:
    explicit Limb(std::vector<Bead> beads);
    /// The least link_distance; exact wherever it is below `bound`, else some value of at least `bound`.
    double distance(Vec3d p, double bound) const;
    std::span<const Bead> beads() const { return beads_; }

private:
    struct Stretch {
        Vec3d center;
        double radius; ///< of a sphere around all its links
        std::size_t first, last;
    };
    Stretch stretch(std::size_t first, std::size_t last) const;

    std::vector<Bead> beads_;
    std::vector<Stretch> stretches_;
    Stretch whole_;
};

/// Smooth noise in about [−1, 1], one bump a metre, by our own hash of the lattice: gradients at lattice points,
/// blended by a quintic (Perlin 2002).
double gradient_noise(Vec3d p);

} // namespace duet::models
