// This header declares the cone between a receiver and a light, and the windows of the light's shadow maps that the
// cone covers.
#pragma once

#include "raster/shadows/soft_shadow.h"

#include "common/vec/simd.h"

#include <cmath>

namespace duet::raster {

inline Quads four(float a, float b, float c, float d) {
    alignas(16) const std::array<float, 4> numbers{a, b, c, d};
    return Quads::load_aligned(numbers.data());
}

/// A window holds texels x0 to x1 and y0 to y1 of a face, inclusive.
struct AreaLightShadow::Window {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

    int columns() const { return x1 - x0 + 1; }
    int rows() const { return y1 - y0 + 1; }
    bool small() const { return columns() <= kSearchedSide && rows() <= kSearchedSide; }
};

/// This is the cone from one receiver to the light, in the light's frame or a face's; the origin is the light's
/// center. Single precision suffices because all coordinates are near the origin relative to the light's size.
class AreaLightShadow::Cone {
public:
    Cone(Emitter::Kind kind, const EmitterFrame& emitter_frame, Vec3 receiver, Vec3 normal, float lift)
        : p(receiver), n(normal), slack(lift), o(emitter_frame), kind_(kind) {
        per_height = -1 / dot(o.axis, p);
        p_u_ = dot(p - o.corner, o.dual_u), p_v_ = dot(p - o.corner, o.dual_v);
        per_meter = std::sqrt(max(dot(o.dual_u, o.dual_u), dot(o.dual_v, o.dual_v)));
        const bool is_sphere = kind_ == Emitter::Kind::kSphere, triangle = kind_ == Emitter::Kind::kTriangle;
        const Vec3 first = is_sphere ? o.corner - o.u - o.v : o.corner, u = is_sphere ? o.u * 2.0f : o.u,
                   v = is_sphere ? o.v * 2.0f : o.v;
        const Vec3 a = first + u, b = triangle ? first + v : first + u + v, c = first + v;
        corners_x = four(first.x, a.x, b.x, c.x), corners_y = four(first.y, a.y, b.y, c.y), corners_z =
            four(first.z, a.z, b.z, c.z);
    }

    /// Tests whether the line from the receiver p through p + `to`, which lies at the fraction f of the way, hits the
    /// light. A miss by up to `margin`, in units of the light's edges, also counts.
    Floats::batch_bool_type meets(const Vec3T<Floats>& to, const Floats& f, const Floats& margin) const {
        // The line meets the light's plane at corner + a·u + b·v. Multiplying both sides by f avoids the division.
        const Floats a = Floats(p_u_) * f + dot(to, broadcast<Floats>(o.dual_u)),
                     b = Floats(p_v_) * f + dot(to, broadcast<Floats>(o.dual_v));
        if (kind_ == Emitter::Kind::kSphere) return a * a + b * b <= (f + margin) * (f + margin);
        const Floats most = kind_ == Emitter::Kind::kParallelogram ? max(a, b) : a + b;
        return (min(a, b) > -margin) & (most <= f + margin);
    }

    Vec3 p, n; ///< the receiver's position and normal
    float slack; ///< height above its plane that rounding errors can cause
    EmitterFrame o;
    float per_height; ///< fraction of the way per meter along the axis
    float per_meter;  ///< units of the light's shorter edge per meter
    Quads corners_x, corners_y, corners_z; ///< corners of a parallelogram or triangle that bounds the light

private:
    Emitter::Kind kind_;
    float p_u_, p_v_;
};

/// Stores the windows on each face, with the cone in that face's coordinates.
struct AreaLightShadow::Faces {
    struct FaceWindow {
        std::size_t face;
        Cone cone;
        Window window;
    };
    std::array<std::optional<FaceWindow>, 6> windows;
    std::size_t count = 0;

    bool small() const { return count == 1 && windows[0]->window.small(); }
    /// Returns whether search() tests every texel.
    bool searched_completely() const { return small() && windows[0]->window.rows() <= kSearchedRows; }
    void add(std::size_t face, const Cone& cone, const Window& window) {
        windows[count++].emplace(FaceWindow{face, cone, window});
    }
};

} // namespace duet::raster
