// The camera, which maps both ways: a pixel to a ray (ray tracing) and a point to a pixel (rasterization).
#pragma once

#include "common/vec/matrix.h"
#include "common/vec/ray.h"

#include <span>

namespace duet {

/// As a scene describes it. The camera looks from eye to look_at; its +x is right, +y up, and it looks along −z.
struct Camera {
    enum class Projection { kPerspective, kOrthographic };

    Projection projection = Projection::kPerspective;
    Vec3d eye{0, 0, 5}, look_at{0, 0, 0}, up{0, 1, 0};
    double fov_degrees = 40;                    ///< vertical field of view (perspective), in (0, 180)
    double height = 2;                          ///< vertical extent of the picture in metres (orthographic)
    double near = 0;                            ///< distance of the near plane; 0: 1e-6 × |look_at − eye|
    double aperture_radius = 0;                 ///< of the thin lens, metres; 0: a pinhole. Perspective only
    double focus_distance = 0;                  ///< of the plane in focus, along −z; 0: |look_at − eye|
    double shutter_open = 0, shutter_close = 1; ///< as fractions of the objects' motion

    double near_distance() const { return near > 0 ? near : 1e-6 * length(look_at - eye); }
};

/// A camera and the size of the picture it takes.
struct View {
    Camera camera;
    int width = 0, height = 0;
};

/// A view through one point of the lens: rays are affine in the pixel, points project by a 4 × 4 matrix. Pixel (x, y)
/// is measured from the upper left corner; the centre of the first pixel is (0.5, 0.5).
struct Pinhole {
    Vec3d origin, origin_dx,
        origin_dy; ///< origin(x, y) = origin + x·origin_dx + y·origin_dy (orthographic; dx = dy = 0 else)
    Vec3d direction, direction_dx, direction_dy; ///< likewise; its camera-space −z is 1, so depth = t of this direction
    Vec3d forward;                               ///< unit vector of the camera's −z
    Mat4d world_to_pixel; ///< (x·w, y·w, depth, w) of a world point; w = depth (perspective) or 1 (orthographic)
    double near;          ///< smallest depth seen

    /// The ray through a pixel, direction of unit length, starting (t_min) at the near plane.
    Rayd ray(Vec2d pixel, double time = 0) const;
    /// (x, y, depth) of a world point. Depth is camera-space −z; a point at depth 0 or less has no meaningful x, y.
    Vec3d project(Vec3d p) const;
};

/// A view prepared for many rays.
class CameraModel {
public:
    explicit CameraModel(const View& view);

    /// The view through the lens point of lens_sample ∈ [0, 1)²: (0.5, 0.5) is the lens's centre.
    Pinhole through(Vec2d lens_sample = {0.5, 0.5}) const;
    /// A camera ray: pixel position, lens sample and time sample in [0, 1). Computed in double, then rounded.
    Ray ray(Vec2d pixel, Vec2d lens_sample = {0.5, 0.5}, double time_sample = 0) const;
    /// The same of many: points.size() rays, to the same bits.
    struct Point {
        Vec2d pixel;
        Vec2 lens{0.5f, 0.5f};
        float time = 0;
    };
    void rays(std::span<const Point> points, std::span<Ray> rays) const;
    /// The moment in the shutter interval of a sample in [0, 1].
    double time(double time_sample) const;
    bool has_lens() const { return aperture_radius_ > 0; }

private:
    template <typename T> struct Exact;
    template <typename T> Exact<T> exact_ray(Vec2T<T> pixel, Vec2T<T> on_disk) const;
    template <typename T> Vec3T<T> lens_offset(Vec2T<T> on_disk) const;

    Pinhole center_;
    Vec3d right_, up_;
    double aperture_radius_, focus_distance_;
    double shutter_open_, shutter_close_;
};

} // namespace duet
