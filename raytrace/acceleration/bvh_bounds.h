// Defines boxes for the builders of hierarchies. They are SIMD vectors for speed, and their areas do not overflow.
#pragma once

#include "common/vec/box.h"
#include "common/vec/simd.h"

#include <algorithm>
#include <limits>

namespace duet::raytrace {

/// Stores a box with x, y, z and one unused lane. It is empty when constructed.
struct Bounds {
    using Float4 = FloatBatch<4>;
    Float4 low = Float4(kInfinity), high = Float4(-kInfinity);

    void extend(Float4 l, Float4 h) {
        low = xsimd::min(low, l);
        high = xsimd::max(high, h);
    }
    void extend(const Bounds& other) { extend(other.low, other.high); }
    Box3 box() const {
        alignas(16) std::array<float, 4> l, h;
        low.store_aligned(l.data());
        high.store_aligned(h.data());
        return {Vec3(l[0], l[1], l[2]), Vec3(h[0], h[1], h[2])};
    }
};

/// Computes the surface area of boxes relative to that of an enclosing box, which does not overflow at any scale.
class RelativeArea {
public:
    explicit RelativeArea(const Bounds& whole) {
        const Vec3 size = whole.box().diagonal();
        const float largest = max_component(size);
        scale_ = Bounds::Float4(largest > 0 ? 1 / max(largest, 0x1p-126f) : 0.0f);
        const float area = half(whole);
        per_area_ = area > 0 ? 1 / area : 0;
    }
    float operator()(const Bounds& bounds) const { return half(bounds) * per_area_; }

private:
    float half(const Bounds& bounds) const {
        alignas(16) std::array<float, 4> d;
        ((bounds.high - bounds.low) * scale_).store_aligned(d.data());
        return d[0] * d[1] + d[1] * d[2] + d[2] * d[0];
    }
    Bounds::Float4 scale_;
    float per_area_;
};

} // namespace duet::raytrace
