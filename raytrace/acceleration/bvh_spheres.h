// Tests rays against the spheres of a leaf with SIMD. The results are bit-equal to those of intersect_sphere.
#pragma once

#include "common/geometry/sphere.h"
#include "common/vec/robust.h"
#include "raytrace/acceleration/bvh.h"

#include <bit>
#include <limits>

namespace duet::raytrace {

/// Prepares a ray for sphere tests.
struct SphereRay {
    const Ray& ray;
    Vec3d origin;
    SphereTestLine<double> line;

    explicit SphereRay(const Ray& its) : ray(its), origin(its.origin), line(Vec3d(its.direction)) {}
};

/// Tests one ray against all spheres of a block, in double precision like the scalar test. (A preceding filter in float
/// gains nothing: a ray usually starts on a sphere, which the filter cannot reject.)
class SphereBlockTest {
public:
    [[gnu::always_inline]] SphereBlockTest(const SphereRay& its, const SphereBlock& block, float end) {
        const Ray& ray = its.ray;
        alignas(32) BlockLanes<float> near, far;
        unsigned met = 0;
        for (std::size_t i = 0; i < kBlockSize; i += kDoubleLanes) {
            const auto along = [&](std::size_t axis) {
                return load_doubles(block.center[axis].data() + i) - DoubleBatch(its.origin[axis]);
            };
            const SphereTest<DoubleBatch> test({along(0), along(1), along(2)}, SphereTestLine<DoubleBatch>(its.line),
                                               load_doubles(block.radius.data() + i));
            const unsigned these = lane_bits(test.hits_forward());
            met |= these << i;
            if (these == 0) continue;
            const auto roots = test.roots();
            store_floats(roots.near, near.data() + i);
            store_floats(roots.far, far.data() + i);
        }
        hits_ = met;
        if (met == 0) return;
        const auto t_near = Batch::load_aligned(near.data()), t_far = Batch::load_aligned(far.data());
        const Batch first(ray.t_min), last(end);
        const auto near_counts = (t_near > first) & (t_near <= last), far_counts = (t_far > first) & (t_far <= last);
        hits_ &= lane_bits(near_counts | far_counts);
        xsimd::select(near_counts, t_near, t_far).store_aligned(t_.data());
    }

    unsigned hits() const { return hits_; } ///< bit mask of the lanes with a hit in (t_min, end]
    float t(std::size_t lane) const { return t_[lane]; }

private:
    using Batch = FloatBatch<kBlockSize>;

    unsigned hits_;
    alignas(32) BlockLanes<float> t_;
};

/// Holds the lines of N rays, one ray per lane: origin x, y, z, then direction x, y, z.
template <std::size_t N> using LineLanes = std::array<std::array<float, N>, 6>;

/// Returns 1 / d·d for the direction d of a line, which may_hit needs. It is NaN if a square may underflow or overflow;
/// may_hit never rejects such rays. T is float or a batch of floats.
template <typename T> T filter_scale(const Vec3T<T>& direction) {
    const T squared = dot(direction, direction);
    const auto in_range = (squared > T(1e-20f)) & (squared < T(1e20f));
    return select(in_range, T(1.0f) / squared, T(std::numeric_limits<float>::quiet_NaN()));
}
/// Returns a bit mask of the lanes whose line may hit its sphere. The other lines certainly miss. The test is in float.
/// With the unit roundoff u and g = center − origin, the parameter of the closest point on the line has an error below
/// 10u|g|, and so has the point; its distance from the center has an error below 14u|g|. (If these values overflow,
/// both sides of the comparison are infinite. Unused lanes, whose radius is NaN, are never set.)
template <typename Batch>
unsigned may_hit(const Vec3T<Batch>& to_center, const Vec3T<Batch>& direction, Batch scale, Batch radius) {
    const Vec3T<Batch> closest = direction * (dot(to_center, direction) * scale) - to_center;
    const Batch far = xsimd::abs(to_center.x) + xsimd::abs(to_center.y) + xsimd::abs(to_center.z) + radius;
    const Batch reach = radius + far * Batch(16 * kRoundoff<float>) + Batch(std::numeric_limits<float>::min());
    constexpr unsigned kAll = (1u << (sizeof(Batch) / sizeof(float))) - 1;
    return ~lane_bits(dot(closest, closest) > reach * reach) & lane_bits(radius == radius) & kAll;
}

/// Tests N rays against one sphere at a time with may_hit.
template <std::size_t N> class SphereFilter {
public:
    using Batch = FloatBatch<N>;

    explicit SphereFilter(const LineLanes<N>& lines)
        : origin_(load(lines, 0)), direction_(load(lines, 3)), scale_(filter_scale(direction_)) {}

    /// Returns a bit mask of the rays whose line may hit the sphere.
    unsigned may_hit(const Sphere& sphere) const {
        const Vec3T<Batch> to_center(Batch(sphere.center.x) - origin_.x, Batch(sphere.center.y) - origin_.y,
                                     Batch(sphere.center.z) - origin_.z);
        return raytrace::may_hit(to_center, direction_, scale_, Batch(sphere.radius));
    }

private:
    static Vec3T<Batch> load(const LineLanes<N>& lines, std::size_t first) {
        const auto at = [&](std::size_t i) { return Batch::load_aligned(lines[first + i].data()); };
        return {at(0), at(1), at(2)};
    }

    Vec3T<Batch> origin_, direction_;
    Batch scale_;
};

/// Tests one sphere against a subset of N rays, in double precision.
template <std::size_t N> class SphereRaysTest {
public:
    using Batch = FloatBatch<N>;

    SphereRaysTest(const LineLanes<N>& lines, unsigned rays, const Sphere& sphere, Batch t_min, Batch ends) {
        constexpr unsigned kSome = (1u << kDoubleLanes) - 1;
        alignas(sizeof(Batch)) std::array<float, N> near, far;
        near.fill(0), far.fill(0);
        const auto spread = [](float x) { return DoubleBatch(static_cast<double>(x)); };
        for (std::size_t i = 0; i < N; i += kDoubleLanes) {
            if ((rays >> i & kSome) == 0) continue;
            const auto load = [&](std::size_t column) { return load_doubles(lines[column].data() + i); };
            const SphereTest<DoubleBatch> test({spread(sphere.center.x) - load(0), spread(sphere.center.y) - load(1),
                                                spread(sphere.center.z) - load(2)},
                                               SphereTestLine<DoubleBatch>({load(3), load(4), load(5)}),
                                               spread(sphere.radius));
            const unsigned met = lane_bits(test.hits_forward());
            hits_ |= met << i;
            if (met == 0) continue;
            const auto roots = test.roots();
            store_floats(roots.near, near.data() + i);
            store_floats(roots.far, far.data() + i);
        }
        const Batch t_near = Batch::load_aligned(near.data()), t_far = Batch::load_aligned(far.data());
        const auto near_counts = (t_near > t_min) & (t_near <= ends), far_counts = (t_far > t_min) & (t_far <= ends);
        hits_ &= rays & lane_bits(near_counts | far_counts);
        t_ = xsimd::select(near_counts, t_near, t_far);
    }

    unsigned hits() const { return hits_; } ///< bit mask of the rays of the subset with a hit in (t_min, end]
    Batch t() const { return t_; }          ///< hit distances of the rays in hits()

private:
    unsigned hits_ = 0;
    Batch t_;
};

} // namespace duet::raytrace
