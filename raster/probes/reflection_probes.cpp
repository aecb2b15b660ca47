#include "raster/probes/reflection_probes.h"

namespace duet::raster {
namespace {

using Vec3s = Vec3T<Floats>;
using Mask = Floats::batch_bool_type;

/// Steps divide the chord between the unit vectors from the center to the start and to the end of a ray, which is
/// infinitely far away. They are at most this long, and there are at least kFewestSteps of them. kBisections narrow the
/// interval between two of them.
constexpr float kLongestStep = 0.1f, kFewestSteps = 4;
constexpr int kBisections = 6;
/// A relative difference of distances below kTolerance is a hit. A difference above kStep is the discontinuity at a
/// silhouette.
constexpr float kTolerance = 0.01f, kStep = 0.15f;
/// Lookups beside a silhouette keep this fraction of the chord away from it, about three texels on a long ray, so that
/// they do not read the silhouette itself.
constexpr float kBeside = 0.03f;

/// Follows a batch of rays through a radiance map. Vectors are relative to the map's center. `distance` returns the
/// distances of the surfaces in given directions.
template <typename Distance> class MapTracer {
public:
    MapTracer(const Vec3s& start, const Vec3s& w, const Distance& distance)
        : start_(start), w_(w), distance_(distance), length_(xsimd::sqrt(dot(start, start))) {}

    /// Returns the hits of the given lanes; other lanes are unspecified.
    Vec3s hit(const Mask& lanes) const { return start_ + w_ * search(lanes); }

private:
    /// Returns the ray parameter t of the point whose direction from the center lies at the fraction s of the chord
    /// between the unit vectors of `start` and w.
    Floats at_fraction(const Floats& s) const {
        return min(length_ * s / max(Floats(1.0f) - s, Floats(1e-20f)), Floats(RadianceMap::kFarthest));
    }
    struct Depths {
        Floats ray, surface; ///< distances from the center
    };
    Depths depths(const Floats& t) const {
        const Vec3s q = start_ + w_ * t;
        return {xsimd::sqrt(dot(q, q)), distance_(q)};
    }
    /// Marches along the ray to the first surface that the map shows, and returns its t. If the ray ends behind a
    /// surface instead, the map does not show what the ray hits. The result is then the point before that surface's
    /// silhouette, in whose direction the map shows what lies behind it. (McGuire et al. 2017, §4, march through
    /// several probes with the same three outcomes: hit, miss and unknown.)
    Floats search(const Mask& lanes) const {
        const Vec3s chord = w_ - start_ * (Floats(1.0f) / max(length_, Floats(1e-20f)));
        constexpr float kMostSteps = 2 / kLongestStep; // the chord is at most a diameter
        const Floats steps = clamp(xsimd::ceil(xsimd::sqrt(dot(chord, chord)) * Floats(1 / kLongestStep)),
                                   Floats(kFewestSteps), Floats(kMostSteps));
        Floats before(0.0f), result(RadianceMap::kFarthest); // an unobstructed ray ends at the background
        Mask done = ~lanes, hidden = before > before;
        for (float i = 1; i <= kMostSteps && !xsimd::all(done); ++i) {
            const Floats s = Floats(i) / steps;
            const auto [ray, surface] = depths(at_fraction(s));
            const Mask behind = ray > surface * Floats(1 + kTolerance), enters = behind & ~(hidden | done);
            if (xsimd::any(enters)) {
                const auto [front, back] = bisect(before, s);
                const Floats t = at_fraction(back);
                const auto [there, met] = depths(t);
                const Mask hit = there < met * Floats(1 + kStep);
                const Floats beside = at_fraction(max(front - Floats(kBeside), Floats(0.0f)));
                result = xsimd::select(enters, xsimd::select(hit, t, beside), result);
                done = done | (enters & hit);
            }
            result = xsimd::select(~(behind | done), Floats(RadianceMap::kFarthest), result);
            done = done | ~(s < Floats(1.0f));
            hidden = behind, before = s;
        }
        return result;
    }
    /// Holds an interval of fractions, from a point in front of the surfaces to one behind them. bisect() narrows it.
    struct Interval {
        Floats front, back;
    };
    Interval bisect(Floats front, Floats back) const {
        for (int i = 0; i < kBisections; ++i) {
            const Floats middle = (front + back) * Floats(0.5f);
            const auto [ray, surface] = depths(at_fraction(middle));
            const Mask behind = ray > surface;
            front = xsimd::select(behind, front, middle), back = xsimd::select(behind, middle, back);
        }
        return {front, back};
    }

    const Vec3s &start_, &w_;
    const Distance& distance_;
    Floats length_; ///< of start_
};

} // namespace

Vec3s ReflectionProbes::trace(std::size_t probe, const Vec3d& eye, const Vec3s& p, const Vec3s& w, bool lights,
                              const Mask& lanes) const {
    const RadianceMap& map = probes_[probe].map;
    const Vec3s start = probes_[probe].from_center(eye, p);
    return MapTracer(start, w, [&](const Vec3s& q) { return map.distance(q, lights); }).hit(lanes);
}

Vec3s ReflectionProbes::trace_lobe(std::size_t probe, const Vec3d& eye, const Vec3s& p, const Vec3s& w,
                                   const Floats& alpha, const Mask& lanes) const {
    const RadianceMap& map = probes_[probe].map;
    const Vec3s start = probes_[probe].from_center(eye, p);
    return MapTracer(start, w, [&](const Vec3s& q) { return map.distance(q, alpha); }).hit(lanes);
}

std::size_t ReflectionProbes::memory_bytes() const {
    std::size_t sum = 0;
    for (const Probe& probe : probes_) sum += probe.map.memory_bytes();
    return sum;
}

} // namespace duet::raster
