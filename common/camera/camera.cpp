#include "common/camera/camera.h"

#include "common/sampling/warp.h"
#include "common/vec/simd.h"

#include <array>
#include <cmath>

namespace duet {

namespace {

// Rounds a point to float coordinates. Both pipelines then use exactly the same eye point, as they use the same float
// vertices. The code uses conversion instructions instead of casts to float and back, because GCC 12 removes such a
// pair of casts when it vectorizes. Rays through the lens would then not pass through their origin.
Vec3d round_to_float(Vec3d p) {
    const auto one = [](double x) {
        return _mm_cvtsd_f64(_mm_cvtss_sd(_mm_setzero_pd(), _mm_cvtsd_ss(_mm_setzero_ps(), _mm_set_sd(x))));
    };
    return {one(p.x), one(p.y), one(p.z)};
}

Vec3T<DoubleBatch> round_to_float(const Vec3T<DoubleBatch>& p) {
    const auto one = [](DoubleBatch x) { return to_doubles(to_floats(x)); };
    return {one(p.x), one(p.y), one(p.z)};
}

// Returns `up`, or another vector if `up` is parallel to `forward`.
Vec3d usable_up(Vec3d forward, Vec3d up) {
    const double sine_squared = length_squared(cross(forward, up));
    if (sine_squared > 1e-24 * length_squared(up)) return up;
    return std::abs(forward.y) < 0.9 ? Vec3d(0, 1, 0) : Vec3d(0, 0, -1);
}

// Returns the inverse of the map from pixels to rays. Let q = p − origin, with camera coordinates c = (right·q,
// up·q, forward·q). A perspective view has c = w·(direction + x·dx + y·dy) with w = depth. An orthographic view
// has c = (x·dx, y·dy, depth) with w = 1.
Mat4d pixel_matrix(const Pinhole& view, Vec3d right, Vec3d up, bool orthographic) {
    const Vec3d dx = orthographic ? view.origin_dx : view.direction_dx;
    const Vec3d dy = orthographic ? view.origin_dy : view.direction_dy;
    const double pixels_right = 1 / dot(dx, right), pixels_up = 1 / dot(dy, up);
    const Vec3d skew = orthographic ? Vec3d() : Vec3d(dot(view.direction, right), dot(view.direction, up), 0);
    const Vec3d row_x = (right - view.forward * skew.x) * pixels_right;
    const Vec3d row_y = (up - view.forward * skew.y) * pixels_up;
    const auto row = [&](Vec3d r) { return std::array<double, 4>{r.x, r.y, r.z, -dot(r, view.origin)}; };
    Mat4d m;
    m[0] = row(row_x);
    m[1] = row(row_y);
    m[2] = row(view.forward);
    m[3] = orthographic ? std::array<double, 4>{0, 0, 0, 1} : m[2];
    return m;
}

} // namespace

Rayd Pinhole::ray(Vec2d pixel, double time) const {
    const Vec3d d = direction + direction_dx * pixel.x + direction_dy * pixel.y;
    const double per_depth = length(d); // distance along the ray per unit of depth
    Rayd ray;
    ray.origin = origin + origin_dx * pixel.x + origin_dy * pixel.y;
    ray.direction = d / per_depth;
    ray.t_min = near * per_depth;
    ray.time = time;
    return ray;
}

Vec3d Pinhole::project(Vec3d p) const {
    const Vec4d h = world_to_pixel * Vec4d(p, 1.0);
    return {h.x / h.w, h.y / h.w, h.z};
}

CameraModel::CameraModel(const View& view)
    : aperture_radius_(view.camera.projection == Camera::Projection::kPerspective ? view.camera.aperture_radius : 0),
      focus_distance_(view.camera.focus_distance > 0 ? view.camera.focus_distance
                                                     : length(view.camera.look_at - view.camera.eye)),
      shutter_open_(view.camera.shutter_open), shutter_close_(view.camera.shutter_close) {
    const Camera& camera = view.camera;
    const bool orthographic = camera.projection == Camera::Projection::kOrthographic;
    const Vec3d eye = round_to_float(camera.eye);
    const Vec3d forward = normalize(camera.look_at - eye);
    right_ = normalize(cross(forward, usable_up(forward, camera.up)));
    up_ = cross(right_, forward);

    // This is half the height of the image: in meters (orthographic), or at unit depth (perspective).
    const double half_height = orthographic ? camera.height / 2 : std::tan(radians(camera.fov_degrees) / 2);
    const double half_width = half_height * view.width / view.height;
    const Vec3d corner = up_ * half_height - right_ * half_width;
    const Vec3d dx = right_ * (2 * half_width / view.width), dy = up_ * (-2 * half_height / view.height);

    center_.forward = forward;
    center_.near = camera.near_distance();
    if (orthographic) {
        center_.origin = round_to_float(eye + corner);
        center_.origin_dx = dx;
        center_.origin_dy = dy;
        center_.direction = forward;
    } else {
        center_.origin = eye;
        center_.direction = forward + corner;
        center_.direction_dx = dx;
        center_.direction_dy = dy;
    }
    center_.world_to_pixel = pixel_matrix(center_, right_, up_, orthographic);
}

// Holds a ray before its rounding to float. T is double or a batch of doubles.
template <typename T> struct CameraModel::UnroundedRay {
    Vec3T<T> origin, direction;
    T t_min;
};

// Returns the offset of a lens point from the lens center. The lens point itself is rounded to float coordinates.
template <typename T> Vec3T<T> CameraModel::lens_offset(Vec2T<T> on_disk) const {
    const Vec2T<T> lens = on_disk * T(aperture_radius_);
    const Vec3T<T> origin = broadcast<T>(center_.origin);
    return round_to_float(origin + broadcast<T>(right_) * lens.x + broadcast<T>(up_) * lens.y) - origin;
}

// The plane of focus is the same for all lens points: the ray of a pixel passes through the point at
// focus_distance · direction from the lens center. Because of rounding, the lens offset itself has a tiny depth.
Pinhole CameraModel::pinhole(Vec2d lens_sample) const {
    if (!has_lens()) return center_;
    const Vec3d offset = lens_offset(Vec2d(concentric_disk(Vec2(lens_sample))));
    const double depth = focus_distance_ - dot(offset, center_.forward);
    Pinhole view = center_;
    view.origin = center_.origin + offset;
    view.direction = (center_.direction * focus_distance_ - offset) / depth;
    view.direction_dx = center_.direction_dx * (focus_distance_ / depth);
    view.direction_dy = center_.direction_dy * (focus_distance_ / depth);
    view.world_to_pixel = pixel_matrix(view, right_, up_, false);
    return view;
}

// Computes the same ray as pinhole(lens_sample).ray(pixel), but without the matrix. `on_disk` is the lens sample mapped
// to the unit disk.
template <typename T> CameraModel::UnroundedRay<T> CameraModel::unrounded_ray(Vec2T<T> pixel, Vec2T<T> on_disk) const {
    Vec3T<T> d = broadcast<T>(center_.direction) + broadcast<T>(center_.direction_dx) * pixel.x +
                 broadcast<T>(center_.direction_dy) * pixel.y;
    Vec3T<T> origin;
    if (has_lens()) {
        const Vec3T<T> offset = lens_offset(on_disk);
        d = (d * T(focus_distance_) - offset) / (T(focus_distance_) - dot(offset, broadcast<T>(center_.forward)));
        origin = broadcast<T>(center_.origin) + offset;
    } else {
        origin = broadcast<T>(center_.origin) + broadcast<T>(center_.origin_dx) * pixel.x +
                 broadcast<T>(center_.origin_dy) * pixel.y;
    }
    const T per_depth = length(d); // distance along the ray per unit of depth
    return {origin, d / per_depth, T(center_.near) * per_depth};
}

Ray CameraModel::ray(Vec2d pixel, Vec2d lens_sample, double time_sample) const {
    const UnroundedRay<double> unrounded =
        unrounded_ray<double>(pixel, has_lens() ? Vec2d(concentric_disk(Vec2(lens_sample))) : Vec2d());
    Ray ray;
    ray.origin = Vec3(unrounded.origin);
    ray.direction = Vec3(unrounded.direction);
    ray.t_min = static_cast<float>(unrounded.t_min);
    ray.time = static_cast<float>(time(time_sample));
    return ray;
}

void CameraModel::rays(std::span<const Sample> samples, std::span<Ray> rays) const {
    constexpr std::size_t kLanes = kSimdLanes;
    using Floats = FloatBatch<kLanes>;
    using Row = std::array<float, kLanes>;
    std::size_t done = 0;
    for (; samples.size() - done >= kLanes; done += kLanes) {
        const auto batch = samples.subspan(done, kLanes);
        alignas(64) Row lens_x{}, lens_y{};
        alignas(64) std::array<double, kLanes> x, y;
        for (std::size_t i = 0; i < kLanes; ++i) {
            lens_x[i] = batch[i].lens.x;
            lens_y[i] = batch[i].lens.y;
            x[i] = batch[i].pixel.x;
            y[i] = batch[i].pixel.y;
        }
        if (has_lens()) {
            const Vec2T<Floats> disk = concentric_disk(
                Vec2T<Floats>(Floats::load_aligned(lens_x.data()), Floats::load_aligned(lens_y.data())));
            disk.x.store_aligned(lens_x.data());
            disk.y.store_aligned(lens_y.data());
        }
        alignas(64) std::array<Row, 7> components;
        for (std::size_t i = 0; i < kLanes; i += kDoubleLanes) {
            const auto unrounded =
                unrounded_ray<DoubleBatch>({DoubleBatch::load_aligned(&x[i]), DoubleBatch::load_aligned(&y[i])},
                                           {load_doubles(&lens_x[i]), load_doubles(&lens_y[i])});
            for (std::size_t axis = 0; axis < 3; ++axis) {
                store_floats(unrounded.origin[axis], &components[axis][i]);
                store_floats(unrounded.direction[axis], &components[3 + axis][i]);
            }
            store_floats(unrounded.t_min, &components[6][i]);
        }
        for (std::size_t i = 0; i < kLanes; ++i) {
            Ray& ray = rays[done + i];
            ray.origin = {components[0][i], components[1][i], components[2][i]};
            ray.direction = {components[3][i], components[4][i], components[5][i]};
            ray.t_min = components[6][i];
            ray.t_max = kInfinity;
            ray.time = static_cast<float>(time(static_cast<double>(batch[i].time)));
        }
    }
    for (; done < samples.size(); ++done)
        rays[done] = ray(samples[done].pixel, Vec2d(samples[done].lens), static_cast<double>(samples[done].time));
}

double CameraModel::time(double time_sample) const { return lerp(shutter_open_, shutter_close_, time_sample); }

} // namespace duet
