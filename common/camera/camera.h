// The camera maps in both directions: a pixel to a ray (ray tracing) and a point to a pixel (rasterization).
#pragma once

#include "common/vec/matrix.h"
#include "common/vec/ray.h"

#include <span>

namespace duet {

/// These are the camera parameters of a scene. The camera looks from eye to look_at. In camera space, +x points right,
/// +y points up, and the camera looks along −z.
struct Camera {
    enum class Projection { kPerspective, kOrthographic };

    Projection projection = Projection::kPerspective;
    Vec3d eye{0, 0, 5}, look_at{0, 0, 0}, up{0, 1, 0};
    double fov_degrees = 40;                    ///< vertical field of view (perspective), in (0, 180)
    double height = 2;                          ///< vertical extent of the image in meters (orthographic)
    double near = 0;                            ///< distance of the near plane in meters; 0: 1e-6 × |look_at − eye|
    double aperture_radius = 0;                 ///< radius of the thin lens in meters; 0: pinhole (perspective only)
    double focus_distance = 0;                  ///< distance of the plane of focus along −z; 0: |look_at − eye|
    double shutter_open = 0, shutter_close = 1; ///< times as fractions of the objects' motion

    double near_distance() const { return near > 0 ? near : 1e-6 * length(look_at - eye); }

    friend bool operator==(const Camera&, const Camera&) = default;
};

/// A view is a camera and the size of its image in pixels.
struct View {
    Camera camera;
    int width = 0, height = 0;

    friend bool operator==(const View&, const View&) = default;
};

/// A pinhole is the view through one point of the lens. The origin and the direction of a ray are affine functions of
/// the pixel position, and a 4 × 4 matrix projects points. Pixel positions (x, y) are measured from the upper left
/// corner of the image; the center of the first pixel is (0.5, 0.5).
struct Pinhole {
    Vec3d origin, origin_dx,
        origin_dy; ///< origin(x, y) = origin + x·origin_dx + y·origin_dy; dx = dy = 0 if perspective
    Vec3d direction, direction_dx, direction_dy; ///< affine like the origin; with depth 1, so that t is the depth
    Vec3d forward;                               ///< unit vector along the camera's −z
    Mat4d world_to_pixel; ///< maps a point to (x·w, y·w, depth, w); w = depth (perspective) or 1 (orthographic)
    double near;          ///< depth of the near plane

    /// Returns the ray through a pixel position. Its direction has unit length, and t_min lies on the near plane.
    Rayd ray(Vec2d pixel, double time = 0) const;
    /// Projects a world point and returns (x, y, depth): the pixel position and the camera-space −z in meters. In a
    /// perspective view, x and y are meaningless for a point with depth <= 0.
    Vec3d project(Vec3d p) const;
};

/// A camera model stores the values of a view that all camera rays share.
class CameraModel {
public:
    explicit CameraModel(const View& view);

    /// Returns the view through the lens point of a sample in [0, 1)². The sample (0.5, 0.5) is the lens center.
    Pinhole pinhole(Vec2d lens_sample = {0.5, 0.5}) const;
    /// Returns a camera ray for a pixel position, a lens sample in [0, 1)² and a time sample in [0, 1). The ray is
    /// computed in double and then rounded to float.
    Ray ray(Vec2d pixel, Vec2d lens_sample = {0.5, 0.5}, double time_sample = 0) const;
    /// A camera sample holds the arguments of ray().
    struct Sample {
        Vec2d pixel;
        Vec2 lens{0.5f, 0.5f};
        float time = 0;
    };
    /// Computes the rays of all samples with SIMD; `rays` must have at least as many elements as `samples`. The results
    /// equal those of ray() bit for bit.
    void rays(std::span<const Sample> samples, std::span<Ray> rays) const;
    /// Maps a time sample in [0, 1] to a time between shutter_open and shutter_close.
    double time(double time_sample) const;
    bool has_lens() const { return aperture_radius_ > 0; }

private:
    template <typename T> struct UnroundedRay;
    template <typename T> UnroundedRay<T> unrounded_ray(Vec2T<T> pixel, Vec2T<T> on_disk) const;
    template <typename T> Vec3T<T> lens_offset(Vec2T<T> on_disk) const;

    Pinhole center_;
    Vec3d right_, up_;
    double aperture_radius_, focus_distance_;
    double shutter_open_, shutter_close_;
};

} // namespace duet
