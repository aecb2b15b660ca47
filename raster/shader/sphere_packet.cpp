#include "raster/shader/sphere_packet.h"

#include "common/geometry/sphere.h"

namespace duet::raster {
namespace {

using Vector = Vec3T<Doubles>;

/// Represents camera rays relative to a sphere's center. The camera-space −z of a direction is 1, so ray parameters
/// are depths.
struct CameraLines {
    Vec3d origin, origin_dx, origin_dy, direction, direction_dx, direction_dy; ///< as in Pinhole

    CameraLines(const Pinhole& pinhole, const DrawSphere& sphere)
        : origin(pinhole.origin), origin_dx(pinhole.origin_dx), origin_dy(pinhole.origin_dy),
          direction(pinhole.direction), direction_dx(pinhole.direction_dx), direction_dy(pinhole.direction_dy) {
        if (!sphere.identity) {
            const Mat4d inverse(sphere.to_object);
            origin = transform_point_inverse(Mat4d(sphere.to_world), inverse, origin);
            for (Vec3d* v : {&origin_dx, &origin_dy, &direction, &direction_dx, &direction_dy})
                *v = transform_vector(inverse, *v);
        }
        origin = origin - Vec3d(sphere.sphere.center);
    }
    static Vector linear(Vec3d start, Vec3d dx, Vec3d dy, const Doubles& x, const Doubles& y) {
        const auto along = [&](std::size_t axis) {
            return Doubles(start[axis]) + Doubles(dx[axis]) * x + Doubles(dy[axis]) * y;
        };
        return {along(0), along(1), along(2)};
    }
    Vector origins(const Doubles& x, const Doubles& y) const { return linear(origin, origin_dx, origin_dy, x, y); }
    Vector directions(const Doubles& x, const Doubles& y) const {
        return linear(direction, direction_dx, direction_dy, x, y);
    }
};

Vector normalized(const Vector& v) { return v * (Doubles(1.0) / xsimd::sqrt(dot(v, v))); }

void store(SpherePacket::Vectors& to, std::size_t i, const Vector& v) {
    for (std::size_t axis = 0; axis < 3; ++axis) store_rounded(to[axis], i, v[axis]);
}

} // namespace

SpherePacket::SpherePacket(const PassView& view, const SamplePacket& packet, const DrawSphere& sphere, bool steps) {
    const CameraLines lines(view.pinhole, sphere);
    const double radius = static_cast<double>(sphere.sphere.radius);
    PacketOf<double> xs, ys;
    for (std::size_t i = 0; i < kPacketSize; ++i) {
        const Vec2d p = packet.position(i);
        xs[i] = p.x, ys[i] = p.y;
    }
    const Doubles zero(0.0), one(1.0);
    for (std::size_t i = 0; i < kPacketSize; i += Doubles::size) {
        const Doubles x = load(xs, i), y = load(ys, i);
        const Vector o = lines.origins(x, y), d = lines.directions(x, y);
        SphereTest<Doubles> test(o * Doubles(-1.0), SphereTestLine<Doubles>(d), Doubles(radius));
        test.discriminant = max(test.discriminant, zero); // a ray that misses by rounding hits the closest point
        const auto roots = test.roots();
        const Doubles t =
            xsimd::select(roots.near > Doubles(view.pinhole.near), roots.near, roots.far);
        const Vector here = normalized(o + d * t);
        store(n, i, here);
        store_rounded(side, i, xsimd::select(dot(here, d) > zero, Doubles(-1.0), one));
        store_rounded(depth, i, t);
        if (!steps) continue;
        const auto beside = [&](const Doubles& to_x, const Doubles& to_y) {
            const Vector from = lines.origins(to_x, to_y), direction = lines.directions(to_x, to_y);
            return normalized(from + direction * ((Doubles(radius) - dot(from, here)) / dot(direction, here)));
        };
        store(n_right, i, beside(x + one, y));
        store(n_down, i, beside(x, y + one));
    }
}

} // namespace duet::raster
