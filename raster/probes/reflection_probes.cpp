#include "raster/probes/reflection_probes.h"

namespace duet::raster {
namespace {

using Vec3s = Vec3T<Floats>;

/// Steps that a ray takes from impostor to impostor. Three bring most rays within a texel.
constexpr int kSteps = 4;
/// Points of a ray that are searched where the steps do not end on a surface.
constexpr int kSearched = 16;
/// Relative differences of distances below this are a hit.
constexpr float kTolerance = 0.03f;

/// Follows a batch of rays through a radiance map. Vectors are relative to the map's center.
class ImpostorTracer {
public:
    ImpostorTracer(const RadianceMap& map, const Vec3s& start, const Vec3s& w, bool lights)
        : map_(map), start_(start), w_(w), lights_(lights), across_(dot(start, w)), squared_(dot(start, start)) {}

    Vec3s hit() const {
        Floats t = advance(map_.distance(w_, lights_), kSteps);
        const auto lost = mismatch(t) > Floats(kTolerance);
        if (xsimd::any(lost)) t = xsimd::select(lost, best_match(t), t);
        return start_ + w_ * t;
    }

private:
    /// Takes the surface in the direction of the point at t for a sphere of its distance about the center, and advances
    /// to it.
    Floats advance(Floats t, int steps) const {
        for (int i = 0; i < steps; ++i) {
            const Floats radius = map_.distance(start_ + w_ * t, lights_);
            const Floats inner = radius * radius - squared_ + across_ * across_;
            t = max(xsimd::sqrt(max(inner, Floats(0.0f))) - across_, Floats(0.0f));
        }
        return t;
    }
    /// Returns by how much the distance of the point at t differs from that of the surface in its direction.
    Floats mismatch(const Floats& t) const {
        const Vec3s q = start_ + w_ * t;
        const Floats distance = xsimd::sqrt(dot(q, q)), radius = map_.distance(q, lights_);
        return abs(distance - radius) / max(min(distance, radius), Floats(1e-20f));
    }
    /// Returns the point whose distance matches best. Where an object hides from the center what the ray meets, that is
    /// near the object's silhouette, on the surface behind.
    Floats best_match(const Floats& otherwise) const {
        const Floats length = xsimd::sqrt(squared_);
        Floats best = otherwise, least = mismatch(otherwise);
        for (int i = 1; i < kSearched; ++i) {
            const float s = static_cast<float>(i) / kSearched; // even in angle between `start` and w
            const Floats t = length * Floats(s / (1 - s)), difference = mismatch(t);
            const auto better = difference < least;
            best = xsimd::select(better, t, best), least = min(difference, least);
        }
        const Floats refined = advance(best, 2);
        return xsimd::select(mismatch(refined) < least, refined, best);
    }

    const RadianceMap& map_;
    const Vec3s &start_, &w_;
    bool lights_;
    Floats across_, squared_;
};

} // namespace

Vec3s ReflectionProbes::trace(std::size_t probe, const Vec3d& eye, const Vec3s& p, const Vec3s& w, bool lights) const {
    const Vec3 offset(eye - probes_[probe].center);
    const Vec3s start = p + Vec3s{Floats(offset.x), Floats(offset.y), Floats(offset.z)};
    return ImpostorTracer(probes_[probe].map, start, w, lights).hit();
}

std::size_t ReflectionProbes::memory_bytes() const {
    std::size_t sum = 0;
    for (const Probe& probe : probes_) sum += probe.map.memory_bytes();
    return sum;
}

} // namespace duet::raster
