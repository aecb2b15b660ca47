#include "raster/probes/reflection_probes.h"

namespace duet::raster {
namespace {

using Vec3s = Vec3T<Floats>;

/// Steps that a ray takes from impostor to impostor. Three bring most rays within a texel.
constexpr int kSteps = 4;

} // namespace

Vec3s ReflectionProbes::trace(std::size_t probe, const Vec3d& eye, const Vec3s& p, const Vec3s& w, bool lights) const {
    const Vec3 offset(eye - probes_[probe].center);
    const Vec3s start = p + Vec3s{Floats(offset.x), Floats(offset.y), Floats(offset.z)};
    const RadianceMap& map = probes_[probe].map;
    // The surface seen in direction q is taken for a sphere of its distance about the center: the ray advances to it.
    Floats t = map.distance(w, lights);
    for (int i = 0; i < kSteps; ++i) {
        const Vec3s q = start + w * t;
        const Floats radius = map.distance(q, lights), across = dot(start, w);
        const Floats inner = radius * radius - dot(start, start) + across * across;
        t = max(xsimd::sqrt(max(inner, Floats(0.0f))) - across, Floats(0.0f));
    }
    return start + w * t;
}

std::size_t ReflectionProbes::memory_bytes() const {
    std::size_t sum = 0;
    for (const Probe& probe : probes_) sum += probe.map.memory_bytes();
    return sum;
}

} // namespace duet::raster
