// amphora.obj and amphora.png: a Greek vase with two handles, some 5,000 triangles.
#include "models/amphora.h"

#include "models/generate.h"
#include "models/mesh_builder.h"

#include <algorithm>
#include <array>

namespace duet::models {
namespace {

/// (radius, height) along the wall, metres: from the middle of the foot's underside, up the outside, over the lip and
/// down the inside to the middle of the floor. The splines' ends are the first and last points, on the axis.
constexpr std::array kOutside = {Vec2d(0, 0.012),     Vec2d(0.07, 0.01),   Vec2d(0.105, 0.0),   Vec2d(0.118, 0.012),
                                 Vec2d(0.108, 0.036), Vec2d(0.082, 0.055), Vec2d(0.088, 0.085), Vec2d(0.145, 0.19),
                                 Vec2d(0.205, 0.32),  Vec2d(0.228, 0.44),  Vec2d(0.205, 0.55),  Vec2d(0.15, 0.63),
                                 Vec2d(0.1, 0.685),   Vec2d(0.084, 0.75),  Vec2d(0.09, 0.82),   Vec2d(0.115, 0.868),
                                 Vec2d(0.134, 0.878), Vec2d(0.140, 0.895), Vec2d(0.132, 0.91)};
constexpr std::array kInside = {Vec2d(0.132, 0.91), Vec2d(0.115, 0.906), Vec2d(0.096, 0.88), Vec2d(0.074, 0.82),
                                Vec2d(0.069, 0.75), Vec2d(0.085, 0.68),  Vec2d(0.14, 0.61),  Vec2d(0.19, 0.54),
                                Vec2d(0.21, 0.44),  Vec2d(0.188, 0.32),  Vec2d(0.125, 0.18), Vec2d(0.06, 0.1),
                                Vec2d(0, 0.085)};

/// A Catmull-Rom spline through all points (the ends doubled), sampled at equal steps of its length.
std::vector<Vec2d> sample_profile(std::span<const Vec2d> points, int count) {
    const auto at = [&](std::ptrdiff_t i) {
        return points[static_cast<std::size_t>(clamp<std::ptrdiff_t>(i, 0, std::ssize(points) - 1))];
    };
    std::vector<Vec2d> fine;
    constexpr int kSteps = 64;
    for (std::ptrdiff_t i = 0; i + 1 < std::ssize(points); ++i) {
        for (int k = 0; k < kSteps; ++k) {
            const double f = static_cast<double>(k) / kSteps;
            const Vec2d a = at(i - 1), b = at(i), c = at(i + 1), d = at(i + 2);
            fine.push_back((b * 2.0 + (c - a) * f + (a * 2.0 - b * 5.0 + c * 4.0 - d) * (f * f) +
                            (b * 3.0 - a - c * 3.0 + d) * (f * f * f)) *
                           0.5);
        }
    }
    fine.push_back(points.back());
    std::vector<double> along{0};
    for (std::size_t i = 1; i < fine.size(); ++i) {
        const Vec2d step = fine[i] - fine[i - 1];
        along.push_back(along.back() + std::sqrt(dot(step, step)));
    }
    std::vector<Vec2d> result;
    for (int i = 0; i <= count; ++i) {
        const double wanted = along.back() * i / count;
        const auto next = static_cast<std::size_t>(std::ranges::lower_bound(along, wanted) - along.begin());
        if (next == 0)
            result.push_back(fine.front());
        else {
            const double f = (wanted - along[next - 1]) / (along[next] - along[next - 1]);
            result.push_back(fine[next - 1] * (1 - f) + fine[std::min(next, fine.size() - 1)] * f);
        }
    }
    return result;
}

constexpr int kOutsideRows = 36, kInsideRows = 12;

void add_wall(MeshBuilder& mesh) {
    std::vector<Vec2d> profile = sample_profile(kOutside, kOutsideRows);
    const std::vector<Vec2d> inside = sample_profile(kInside, kInsideRows);
    profile.insert(profile.end(), inside.begin() + 1, inside.end());
    Sheet sheet;
    sheet.columns = 44;
    sheet.rows = kOutsideRows + kInsideRows;
    sheet.closed_s = sheet.pole_low = sheet.pole_high = true;
    const auto row = [&](double t) { return static_cast<std::size_t>(std::lround(t * sheet.rows)); };
    sheet.point = [&](double s, double t) {
        const double angle = -2 * kPiDouble * s; // so that u runs to the right seen from outside
        const Vec2d p = profile[row(t)];
        return Vec3d(p.x * std::sin(-angle), p.y, p.x * std::cos(angle));
    };
    sheet.uv = [&](double s, double t) {
        const double j = static_cast<double>(row(t));
        const double v = j <= kOutsideRows ? kAmphoraPaintedV * j / kOutsideRows
                                           : lerp(kAmphoraPaintedV, 1.0, (j - kOutsideRows) / kInsideRows);
        return Vec2d(s, v);
    };
    add_sheet(mesh, sheet);
}

/// From the shoulder up and over to the neck below the lip, at x > 0 or x < 0.
void add_handle(MeshBuilder& mesh, double side) {
    constexpr std::array kWay = {Vec2d(0.158, 0.594), Vec2d(0.235, 0.70), Vec2d(0.235, 0.89), Vec2d(0.082, 0.806)};
    Tube tube;
    tube.columns = 8;
    tube.rows = 24;
    tube.center = [&](double t) { // a cubic Bézier curve
        const double s = 1 - t;
        const Vec2d p =
            kWay[0] * (s * s * s) + kWay[1] * (3 * s * s * t) + kWay[2] * (3 * s * t * t) + kWay[3] * (t * t * t);
        return Vec3d(side * p.x, p.y, 0);
    };
    tube.radii = [](double) { return Vec2d(0.013, 0.021); };
    tube.uv_low = {0.0, 0.91};
    tube.uv_high = {1.0, 0.99};
    add_tube(mesh, tube);
}

} // namespace

void write_amphora(const std::filesystem::path& folder) {
    MeshBuilder mesh;
    add_wall(mesh);
    add_handle(mesh, 1);
    add_handle(mesh, -1);
    compute_normals(mesh, 60);
    write_obj(folder / "meshes/amphora.obj", mesh, "An amphora, made by models/amphora.cpp.");
    write_png(folder / "textures/amphora.png", paint_amphora());
}

} // namespace duet::models
