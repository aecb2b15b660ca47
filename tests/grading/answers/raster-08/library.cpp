// The library's tangents (common/geometry/surface_point.h) and frame (common/vec/frame.h). Its normal maps are read
// within apply_normal_maps, which has no smaller parts, so the rest is the lesson's; raster_08_test.cpp compares the
// whole.
#include "common/geometry/surface_point.h"
#include "common/vec/frame.h"
#include "raster/lessons/08-normal-maps/lab.h"
#include "raster/lessons/08-normal-maps/normal_map.h"

namespace duet::lab {

std::optional<Tangents> tangents(std::array<Vec3, 3> p, std::array<Vec2, 3> uv) {
    const Mesh mesh{.positions = {p[0], p[1], p[2]},
                    .normals = {},
                    .uvs = {uv[0], uv[1], uv[2]},
                    .triangles = {{0, 1, 2}},
                    .material_slots = {}};
    Hit hit;
    hit.object = hit.primitive = 0, hit.u = hit.v = 0.25f, hit.t = 1;
    const SurfacePoint at = surface_point(mesh, hit, Ray{}, Mat4(), Mat4(), true);
    if (at.dpdu == Vec3() && at.dpdv == Vec3()) return std::nullopt;
    return Tangents{at.dpdu, at.dpdv};
}

TangentFrame tangent_frame(Vec3 n, Tangents tangents) {
    // This is a triangle with these tangents.
    const std::array<Vec3, 3> p{Vec3{0, 0, 0}, tangents.along_u, tangents.along_v};
    lesson::Triangle triangle;
    for (std::size_t i = 0; i < 3; ++i) triangle[i].p = p[i];
    triangle[1].uv = {1, 0}, triangle[2].uv = {0, 1};
    const auto [t, b] = lesson::tangent_frame(triangle, n);
    return {t, b};
}

Vec3 decode_normal(Rgb texel) { return lesson::decode_normal(texel); }

Vec3 perturb(Vec3 n, TangentFrame frame, Vec3 mapped) { return normalize(Frame{frame.t, frame.b, n}.to_world(mapped)); }

ImageRgb normal_map(const ImageFloat& heights) { return lesson::normal_map(heights); }

} // namespace duet::lab
