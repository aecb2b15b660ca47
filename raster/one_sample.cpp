#include "raster/one_sample.h"

namespace duet::raster {
namespace {

Vec3 to_object_normal(const ObjectView& object, Vec3 n) {
    return object.identity ? n : transform_normal(object.to_world, n);
}

/// bᵢ = eᵢ / Σe with eᵢ linear in the pixel: see StripSolver::solve_lanes.
void set_weights(SampleCorners& sample, const Interpolation& of, Vec2d pixel, Piece piece) {
    const Interpolated at = of.at(pixel, piece);
    const std::array<double, 3> b{at.b0 / at.sum, at.b1 / at.sum, at.b2 / at.sum};
    const Vec3d sum = of.e[0] + of.e[1] + of.e[2];
    for (std::size_t k = 0; k < 3; ++k) {
        sample.weights[k] = static_cast<float>(b[k]);
        sample.dx[k] = static_cast<float>((of.e[k].x - b[k] * sum.x) / at.sum);
        sample.dy[k] = static_cast<float>((of.e[k].y - b[k] * sum.y) / at.sum);
    }
}

void set_quad(SampleCorners& sample, const Shape& shape, const WholeTriangle& whole) {
    const Corners corners = primitive_corners(shape, sample.hit.primitive);
    const std::size_t half = whole.piece == Piece::kQuadFirst ? 0 : 1;
    constexpr std::array<Vec2, 4> kCorners{Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)};
    const std::array<std::size_t, 3> used{0, 1 + half, 2 + half};
    const std::size_t diagonal = half == 0 ? 1 : 2; // the corner that it is opposite to
    for (std::size_t k = 0; k < 3; ++k) {
        sample.p[k] = corners.p[used[k]];
        sample.uv[k] = kCorners[used[k]];
        sample.edges[k] = {};
        sample.edges[k][k] = sample.edges[k][diagonal] = 1;
    }
}

void set_triangle(SampleCorners& sample, const Mesh& mesh) {
    const auto& corners = mesh.triangles[sample.hit.primitive];
    for (std::size_t k = 0; k < 3; ++k) {
        sample.p[k] = mesh.positions[corners[k]];
        if (!mesh.normals.empty()) sample.n[k] = mesh.normals[corners[k]];
        if (!mesh.uvs.empty()) sample.uv[k] = mesh.uvs[corners[k]];
        sample.edges[k][k] = 1;
    }
}

void set_sphere(SampleCorners& sample, const Scene& scene, const PassView& view, Vec2d pixel, const ObjectView& object) {
    const Vec3d p(sample.surface.p), n(sample.surface.ng);
    const auto point = [&](Vec2d place) {
        const Rayd ray = view.pinhole.ray(place);
        Hit hit = sample.hit;
        hit.t = static_cast<float>(dot(p - ray.origin, n) / dot(ray.direction, n));
        return surface_point(scene, rounded(ray, view.time), hit);
    };
    const std::array<SurfacePoint, 3> points{sample.surface, point({pixel.x + 1, pixel.y}), point({pixel.x, pixel.y + 1})};
    for (std::size_t k = 0; k < 3; ++k) {
        sample.p[k] = points[k].p_object;
        sample.n[k] = to_object_normal(object, points[k].ns);
        sample.uv[k] = points[k].uv;
        sample.edges[k] = Vec3(1, 1, 1);
    }
    sample.weights = {1, 0, 0};
    sample.dx = {-1, 1, 0};
    sample.dy = {-1, 0, 1};
}

} // namespace

std::uint32_t object_of(const Geometry& geometry, std::uint32_t id) {
    const Run& run = geometry.triangles.run_of(id);
    return run.sphere ? geometry.spheres[run.object].object : geometry.triangles.objects[run.object].object;
}

SampleCorners sample_corners(const PreparedData& data, const Geometry& geometry, const PassView& view, std::uint32_t id,
                             Vec2d pixel, const ObjectView& object) {
    SampleCorners sample;
    const Rayd exact = view.pinhole.ray(pixel);
    sample.ray = rounded(exact, view.time);
    sample.hit = find_hit(geometry, view, id, pixel);
    sample.depth = static_cast<double>(sample.hit.t) * view.pinhole.near / exact.t_min;
    sample.surface = surface_point(data.scene, sample.ray, sample.hit);
    const Vec3 ng = sample.surface.ng;
    sample.ng = to_object_normal(object, dot(ng, sample.ray.direction) > 0 ? -ng : ng);
    const Shape& shape = data.scene.shapes[data.scene.objects[object.object].shape];
    if (std::holds_alternative<Sphere>(shape)) {
        set_sphere(sample, data.scene, view, pixel, object);
        sample.middle = sample.p[0];
        return sample;
    }
    const WholeTriangle whole = geometry.triangles.whole(id);
    const FixedPoint beside{static_cast<std::int32_t>(pixel.x) * kSubPixels, static_cast<std::int32_t>(pixel.y) * kSubPixels};
    set_weights(sample, Interpolation(whole.a, whole.b, whole.c, beside), pixel, whole.piece);
    if (const Mesh* mesh = std::get_if<Mesh>(&shape)) {
        set_triangle(sample, *mesh);
        sample.middle = (sample.p[0] + sample.p[1] + sample.p[2]) * (1.0f / 3);
    } else {
        set_quad(sample, shape, whole);
        sample.middle = (sample.p[0] + sample.p[whole.piece == Piece::kQuadFirst ? 2 : 1]) * 0.5f; // the whole quad's
    }
    return sample;
}

} // namespace duet::raster
