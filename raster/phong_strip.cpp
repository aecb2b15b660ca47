#include "raster/phong_strip.h"

#include "raster/phong.h"

#include <algorithm>

namespace duet::raster {
namespace {

using Vec3s = Vec3T<Floats>;
using Rgbs = RgbT<Floats>;

Vec3s load(const std::array<StripOf<float>, 3>& v, std::size_t i) {
    return {raster::load(v[0], i), raster::load(v[1], i), raster::load(v[2], i)};
}
Vec3s spread(Vec3 v) { return {Floats(v.x), Floats(v.y), Floats(v.z)}; }
Rgbs spread(Rgb c) { return {Floats(c.r), Floats(c.g), Floats(c.b)}; }
Vec3s unit(Vec3s v) { return v * inverse_sqrt(dot(v, v)); }
/// v where the sign is positive, else −v.
Vec3s with_sign(Vec3s v, Floats sign) {
    const Floats factor = xsimd::select(sign < Floats(0.0f), Floats(-1.0f), Floats(1.0f));
    return v * factor;
}

/// A normal under the map whose inverse is given, of any length.
Vec3s to_world(const Mat4& to_object, Vec3s n) {
    const auto column = [&](std::size_t c) {
        return Floats(to_object[0][c]) * n.x + Floats(to_object[1][c]) * n.y + Floats(to_object[2][c]) * n.z;
    };
    return {column(0), column(1), column(2)};
}

} // namespace

PhongStrips::PhongStrips(const PreparedData& data, const PassView& view) : data_(data), view_(view) {
    usable_ = std::all_of(data.scene.lights.begin(), data.scene.lights.end(), [](const Light& light) {
        return std::holds_alternative<SunLight>(light) || std::holds_alternative<PointLight>(light);
    });
}

bool PhongStrips::shade(const StripSolver& solver, int x, int y, SampleOffset offset, StripColors& colors) {
    if (!usable_ || solver.on_mesh() != solver.seen() || solver.one_mesh()->normals.empty()) return false;
    const std::uint32_t index = solver.one_object()->object;
    const std::optional<Rgb>& color = data_.objects[index].one_color;
    if (!color) return false;

    const Object& object = data_.scene.objects[index];
    const Mat4 to_object =
        object.identity ? Mat4() : object.moving ? object_transform(object, view_.time).to_object : object.to_object;
    const Pinhole& pinhole = view_.pinhole;
    const Vec2d first = offset.position(x, y);
    const Vec3 start(pinhole.direction + pinhole.direction_dx * first.x + pinhole.direction_dy * first.y),
        step_x(pinhole.direction_dx), step_y(pinhole.direction_dy);
    const Vec3 eye(pinhole.origin + pinhole.origin_dx * first.x + pinhole.origin_dy * first.y),
        eye_x(pinhole.origin_dx), eye_y(pinhole.origin_dy);
    const Rgbs base = spread(*color), ambient = spread(data_.ambient * *color);
    for (std::size_t i = 0; i < kStrip; i += Floats::size) {
        const auto narrow = [&](const StripOf<double>& wide) {
            return narrowed(raster::load(wide, i), raster::load(wide, i + Doubles::size));
        };
        const Floats across = raster::load(kColumns<float>, i), down = raster::load(kRows<float>, i);
        const Vec3s way = spread(start) + spread(step_x) * across + spread(step_y) * down;
        const Vec3s wo = -unit(way);
        Vec3s n = load(solver.normal, i), ng = load(solver.ng, i);
        if (!object.identity) {
            n = to_world(to_object, n);
            ng = to_world(to_object, ng);
        }
        n = with_sign(unit(n), dot(n, ng)); // in the hemisphere of the side that is seen
        Rgbs sum = ambient;
        for (const Light& light : data_.scene.lights) {
            if (const auto* sun = std::get_if<SunLight>(&light)) {
                sum += phong(base, n, wo, spread(-sun->direction), spread(sun->irradiance));
            } else {
                const auto& point = std::get<PointLight>(light);
                const Vec3s p = spread(eye) + spread(eye_x) * across + spread(eye_y) * down + way * narrow(solver.depth);
                const Vec3s way_there = spread(point.position) - p;
                const Floats squared = dot(way_there, way_there);
                sum += phong(base, n, wo, unit(way_there), spread(point.intensity) * (Floats(1.0f) / squared));
            }
        }
        store(colors.r, i, sum.r);
        store(colors.g, i, sum.g);
        store(colors.b, i, sum.b);
    }
    return true;
}

} // namespace duet::raster
