#include "models/distance_field.h"

#include <algorithm>
#include <cstdint>

namespace duet::models {
namespace {

constexpr std::size_t kSegmentLinks = 8;

/// Returns a component of a gradient: the lattice point's hash as a value in [−1, 1].
double lattice_value(std::int64_t x, std::int64_t y, std::int64_t z, std::uint64_t salt) {
    std::uint64_t h = salt;
    for (const std::int64_t part : {x, y, z}) {
        h ^= static_cast<std::uint64_t>(part) + 0x9e3779b97f4a7c15u + (h << 6) + (h >> 2);
        h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9u; // mixing of splitmix64 (Steele, Lea and Flood 2014)
        h = (h ^ (h >> 27)) * 0x94d049bb133111ebu;
        h ^= h >> 31;
    }
    return static_cast<double>(h >> 11) * 0x1p-52 - 1;
}

double quintic(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }

} // namespace

Limb::Limb(std::vector<LimbSphere> spheres)
    : spheres_(std::move(spheres)), bounding_segment_(segment(0, spheres_.size() - 1)) {
    for (std::size_t first = 0; first + 1 < spheres_.size(); first += kSegmentLinks)
        segments_.push_back(segment(first, std::min(first + kSegmentLinks, spheres_.size() - 1)));
}

Limb::Segment Limb::segment(std::size_t first, std::size_t last) const {
    Segment result{spheres_[(first + last) / 2].center, 0, first, last};
    for (std::size_t i = first; i <= last; ++i)
        result.radius = max(result.radius, length(spheres_[i].center - result.center) + spheres_[i].radius);
    return result;
}

double Limb::distance(Vec3d p, double bound) const {
    double nearest = bound;
    const auto too_far = [&](const Segment& s) {
        const double reach = nearest + s.radius;
        return reach <= 0 || length_squared(p - s.center) >= reach * reach;
    };
    if (too_far(bounding_segment_)) return bound;
    for (const Segment& s : segments_) {
        if (too_far(s)) continue;
        for (std::size_t i = s.first; i < s.last; ++i)
            nearest = min(nearest, round_cone_distance(p, spheres_[i], spheres_[i + 1]));
    }
    return nearest;
}

double gradient_noise(Vec3d p) {
    const Vec3d base(std::floor(p.x), std::floor(p.y), std::floor(p.z));
    const Vec3d f = p - base;
    const auto corner = [&](int dx, int dy, int dz) {
        const auto x = static_cast<std::int64_t>(base.x) + dx, y = static_cast<std::int64_t>(base.y) + dy,
                   z = static_cast<std::int64_t>(base.z) + dz;
        const Vec3d gradient(lattice_value(x, y, z, 1), lattice_value(x, y, z, 2), lattice_value(x, y, z, 3));
        return dot(gradient, f - Vec3d(dx, dy, dz));
    };
    const Vec3d w(quintic(f.x), quintic(f.y), quintic(f.z));
    double planes[2];
    for (int dz = 0; dz < 2; ++dz)
        planes[dz] =
            lerp(lerp(corner(0, 0, dz), corner(1, 0, dz), w.x), lerp(corner(0, 1, dz), corner(1, 1, dz), w.x), w.y);
    return lerp(planes[0], planes[1], w.z);
}

} // namespace duet::models
