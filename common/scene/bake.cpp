#include "common/scene/bake.h"

#include <algorithm>
#include <utility>

namespace duet {

namespace {

Vec3 point(const Mat4d& m, Vec3 p) { return Vec3(transform_point(m, Vec3d(p))); }

/// Returns the factor by which the map scales all lengths, or nothing where it is not a similarity. The test has a
/// tolerance, because matrix entries are rounded to float.
std::optional<double> similarity_scale(const Mat4d& m) {
    const auto column = [&](std::size_t c) { return Vec3d(m[0][c], m[1][c], m[2][c]); };
    const Vec3d x = column(0), y = column(1), z = column(2);
    const double scale = std::cbrt(abs(determinant3(m)));
    const double tolerance = 1e-6 * sqr(scale);
    const auto differs = [&](double value, double expected) { return !(abs(value - expected) <= tolerance); };
    if (differs(dot(x, x), sqr(scale)) || differs(dot(y, y), sqr(scale)) || differs(dot(z, z), sqr(scale)))
        return std::nullopt;
    if (differs(dot(x, y), 0) || differs(dot(y, z), 0) || differs(dot(z, x), 0)) return std::nullopt;
    return scale;
}

/// Returns whether the map has no rotation or mirroring, so that a sphere's texture coordinates are unchanged.
bool is_uniform_scale(const Mat4& m) {
    return m[0][0] > 0 && m[0][0] == m[1][1] && m[1][1] == m[2][2] && m[0][1] == 0 && m[0][2] == 0 && m[1][0] == 0 &&
           m[1][2] == 0 && m[2][0] == 0 && m[2][1] == 0;
}

struct TextureUse {
    /// `any` is true if the object's materials use a texture, and `solid` if one of these is evaluated in object space.
    bool any = false, solid = false;
};

TextureUse texture_use(const Scene& scene, const Object& object) {
    TextureUse use;
    const auto add_texture = [&](std::int32_t texture) {
        if (texture < 0) return;
        use.any = true;
        const Texture& t = scene.textures.textures[static_cast<std::size_t>(texture)];
        const auto* checker = std::get_if<CheckerTexture>(&t);
        use.solid = use.solid || std::holds_alternative<NoiseTexture>(t) || (checker != nullptr && checker->solid);
    };
    for (const std::uint32_t index : object.materials) {
        for_each_texture(scene.materials[index], add_texture);
        if (index < scene.maps.size()) for_each_texture(scene.maps[index], add_texture);
    }
    return use;
}

/// Returns whether corners that coincided before the transform still coincide. In mirrored quads the second and the
/// fourth corner are exchanged.
bool corners_still_coincide(const std::vector<Quad>& before, const std::vector<Quad>& after, bool mirrored) {
    std::vector<std::pair<std::array<float, 3>, std::array<float, 3>>> moved;
    for (std::size_t i = 0; i < before.size(); ++i) {
        const std::array<Vec3, 4> from = corners(before[i]), to = corners(after[i]);
        for (std::size_t k = 0; k < 4; ++k) {
            const Vec3 p = to[mirrored ? (4 - k) % 4 : k];
            moved.push_back({{from[k].x, from[k].y, from[k].z}, {p.x, p.y, p.z}});
        }
    }
    std::sort(moved.begin(), moved.end());
    for (std::size_t i = 1; i < moved.size(); ++i)
        if (moved[i].first == moved[i - 1].first && moved[i].second != moved[i - 1].second) return false;
    return true;
}

bool bake(QuadList& list, const Mat4& m, bool textured) {
    if (determinant3(m) < 0 && textured) return false;
    std::vector<Quad> after;
    for (const Quad& quad : list.quads) after.push_back(transformed(quad, m));
    if (list.quads.size() > 1 && !corners_still_coincide(list.quads, after, determinant3(m) < 0)) return false;
    list.quads = std::move(after);
    return true;
}

bool bake(Sphere& sphere, const Mat4& m, bool textured) {
    const std::optional<Sphere> moved = transformed(sphere, m);
    if (!moved || (textured && !is_uniform_scale(m))) return false;
    sphere = *moved;
    return true;
}

bool bake(Mesh& mesh, const Mat4& m, bool textured) {
    const bool mirrors = determinant3(m) < 0;
    if (mirrors && textured && mesh.uvs.empty()) return false;
    const Mat4d forward(m), inverse = inverse_affine(forward);
    if (!mesh.normals.empty() && !similarity_scale(forward)) return false;
    for (Vec3& p : mesh.positions) p = point(forward, p);
    for (Vec3& n : mesh.normals) n = Vec3(normalize(transform_normal(inverse, Vec3d(n))));
    if (mirrors)
        for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
    return true;
}

} // namespace

Quad transformed(const Quad& quad, const Mat4& to_world) {
    const Mat4d m(to_world);
    const Vec3 u(transform_vector(m, Vec3d(quad.u))), v(transform_vector(m, Vec3d(quad.v)));
    return determinant3(m) < 0 ? Quad{point(m, quad.corner), v, u} : Quad{point(m, quad.corner), u, v};
}

std::array<Vec3, 3> transformed(const std::array<Vec3, 3>& triangle, const Mat4& to_world) {
    const Mat4d m(to_world);
    const Vec3 a = point(m, triangle[0]), b = point(m, triangle[1]), c = point(m, triangle[2]);
    return determinant3(m) < 0 ? std::array{a, c, b} : std::array{a, b, c};
}

std::optional<Sphere> transformed(const Sphere& sphere, const Mat4& to_world) {
    const Mat4d m(to_world);
    const std::optional<double> scale = similarity_scale(m);
    if (!scale) return std::nullopt;
    return Sphere{point(m, sphere.center), static_cast<float>(static_cast<double>(sphere.radius) * *scale)};
}

void bake(Scene& scene, Object& object) {
    const TextureUse textures = texture_use(scene, object);
    if (textures.solid) return;
    const bool baked = std::visit([&](auto& shape) { return bake(shape, object.to_world, textures.any); },
                                  scene.shapes.edit(object.shape));
    if (!baked) return;
    object.to_world = object.to_world_end = object.to_object = Mat4();
    object.identity = true;
}

} // namespace duet
