#include "compare/stress/projection_scenes.h"

namespace duet::compare {

namespace {

double log_uniform(TrialRandom& random, float low, float high) {
    return static_cast<double>(random.log_uniform(low, high));
}
double either_sign(TrialRandom& random, double x) { return random.coin() ? x : -x; }

/// Returns a point from its camera-space coordinates. It is exact if the camera is at the origin and looks along −z.
Vec3 in_camera_space(const Pinhole& pinhole, double right, double up, double depth) {
    const Vec3d x = normalize(pinhole.direction_dx), y = -normalize(pinhole.direction_dy);
    return Vec3(pinhole.origin + pinhole.forward * depth + x * right + y * up);
}

/// Returns a point in front of the eye, behind it, or exactly on the near plane or the eye's plane.
Vec3 anywhere(TrialRandom& random, const Pinhole& pinhole) {
    double depth = log_uniform(random, 1e-3f, 1e3f);
    switch (random.below(8)) {
    case 0:
        depth = 0;
        break;
    case 1:
        depth = pinhole.near;
        break;
    case 2:
    case 3:
        depth = -depth;
        break;
    default:
        break;
    }
    const double right = either_sign(random, log_uniform(random, 1e-3f, 1e3f));
    return in_camera_space(pinhole, right, either_sign(random, log_uniform(random, 1e-3f, 1e3f)), depth);
}

} // namespace

TrialView random_view(TrialRandom& random, int window_side, double near) {
    View view;
    view.width = static_cast<int>(random.log_uniform(16, 4096));
    view.height = static_cast<int>(random.log_uniform(16, 4096));
    view.camera.fov_degrees = static_cast<double>(random.uniform(5, 150));
    view.camera.near = near;
    view.camera.eye = {0, 0, 0};
    view.camera.look_at = {0, 0, -1};
    if (random.coin()) {
        view.camera.eye = Vec3d(random.vector()) * 10.0;
        view.camera.look_at = view.camera.eye + Vec3d(random.direction());
        view.camera.up = Vec3d(random.direction());
    }
    const auto start = [&](int size) {
        return static_cast<int>(random.below(static_cast<std::uint32_t>(size - window_side + 1)));
    };
    const int x = start(view.width), y = start(view.height);
    const auto offset = [&] { return static_cast<std::int32_t>(random.below(raster::kSubpixels + 1)); };
    const std::int32_t offset_x = offset();
    return {view, CameraModel(view).pinhole(), {{x, y, x + window_side, y + window_side}, {offset_x, offset()}}};
}

TrialView random_view(TrialRandom& random, int window_side) {
    return random_view(random, window_side, log_uniform(random, 1e-5f, 0.1f));
}

Vec3 point_at(const Pinhole& pinhole, Vec2d pixel, double depth) {
    const Vec3d direction = pinhole.direction + pinhole.direction_dx * pixel.x + pinhole.direction_dy * pixel.y;
    return Vec3(pinhole.origin + direction * depth);
}

Vec2d pixel_in(TrialRandom& random, const Window& window) {
    const raster::PixelRect& r = window.rect;
    const Vec2d place(random.uniform_2d());
    return {lerp(double{1} * r.x0, double{1} * r.x1, place.x), lerp(double{1} * r.y0, double{1} * r.y1, place.y)};
}

std::array<Vec3, 3> random_straddling(TrialRandom& random, const TrialView& v) {
    const Vec3 a = anywhere(random, v.pinhole), c = anywhere(random, v.pinhole);
    if (random.coin()) return {a, anywhere(random, v.pinhole), c};
    // The second corner is beyond a point visible in the window, so the edge passes through that point.
    const Vec3 seen =
        point_at(v.pinhole, pixel_in(random, v.window), v.pinhole.near + log_uniform(random, 1e-3f, 1e2f));
    return {a, seen + (seen - a) * random.log_uniform(1e-2f, 1e2f), random.coin() ? c : seen};
}

std::array<Vec3, 3> random_beyond_guard(TrialRandom& random, const TrialView& v) {
    const auto depth = [&] { return v.pinhole.near + log_uniform(random, 1e-2f, 1e3f); };
    const Vec2d p = pixel_in(random, v.window);
    const auto far = [&](Vec2d direction) { return p + direction * log_uniform(random, 1e4f, 1e7f); };
    const auto direction = [&] {
        const double angle = 2 * kPiDouble * static_cast<double>(random.uniform());
        return Vec2d(std::cos(angle), std::sin(angle));
    };
    const Vec2d away = direction();
    const Vec3 a = point_at(v.pinhole, far(away), depth()), c = point_at(v.pinhole, far(direction()), depth());
    if (random.coin()) return {a, point_at(v.pinhole, far(away * -1.0), depth()), c}; // an edge exactly through p
    return {a, point_at(v.pinhole, p + direction() * log_uniform(random, 0.1f, 100), depth()), c};
}

std::array<Vec3, 3> random_visible(TrialRandom& random, const TrialView& v) {
    const double nearest = v.pinhole.near * 1.01 + log_uniform(random, 1e-2f, 1e2f);
    const double size = log_uniform(random, 2, 2000);
    const Vec2d p = pixel_in(random, v.window);
    const auto corner = [&] {
        const Vec2d place = p + Vec2d(Vec2(random.uniform(-1, 1), random.uniform(-1, 1))) * size;
        return point_at(v.pinhole, place, nearest * log_uniform(random, 1, 1000));
    };
    const Vec3 a = corner(), b = corner();
    return {a, b, corner()};
}

std::array<Vec3, 3> random_sliver(TrialRandom& random, const TrialView& v) {
    const double nearest = v.pinhole.near * 1.01 + log_uniform(random, 1e-2f, 1e2f);
    const auto depth = [&] { return nearest * log_uniform(random, 1, 10); };
    const Vec2d within = pixel_in(random, v.window); // the sliver passes next to this pixel's sample
    const Vec2d p = v.window.offset.position(static_cast<int>(within.x), static_cast<int>(within.y)) +
                    Vec2d(Vec2(random.uniform(-1, 1), random.uniform(-1, 1))) * (1.0 / 256);
    const double angle = 2 * kPiDouble * static_cast<double>(random.uniform());
    const Vec2d along(std::cos(angle), std::sin(angle)), across(-along.y, along.x);
    const double before = -log_uniform(random, 0.01f, 100), after = log_uniform(random, 0.01f, 100);
    const double third = lerp(before, after, static_cast<double>(random.uniform(-0.1f, 1.1f)));
    const Vec2d aside = p + along * third + across * log_uniform(random, 1e-5f, 0.1f);
    const Vec3 a = point_at(v.pinhole, p + along * before, depth()),
               b = point_at(v.pinhole, p + along * after, depth());
    return {a, b, point_at(v.pinhole, aside, depth())};
}

} // namespace duet::compare
