#include "common/material/surface_maps.h"

#include "common/material/reflectance.h"

#include <cmath>

namespace duet {

namespace {

const Texture& texture_at(const TextureSet& textures, std::int32_t index) {
    return textures.textures[static_cast<std::size_t>(index)];
}

/// Returns the normal map's normal in a right-handed frame about ns. The frame is mirrored where the uv
/// parametrization is mirrored.
Vec3 mapped_normal(const TextureSet& textures, const SurfaceMaps& maps, const SurfacePoint& point) {
    const Vec3 across = cross(point.ns, point.dpdu), tangent = cross(across, point.ns);
    if (!(length_squared(tangent) > 0)) return point.ns;
    const bool mirrored = dot(cross(point.dpdu, point.dpdv), point.ng) < 0;
    const Vec3 t = normalize(tangent), b = cross(point.ns, t) * (mirrored ? -1.0f : 1.0f);
    const Rgb c = evaluate_texture(textures, texture_at(textures, maps.normal), point);
    const Vec3 n = t * ((2 * c.r - 1) * maps.normal_scale) + b * ((2 * c.g - 1) * maps.normal_scale) +
                   point.ns * (2 * c.b - 1);
    const float size = length(n);
    return size > 0 ? n / size : point.ns;
}

/// Returns half the distance over which the bump map's heights are differenced, in uv: half a texel, or half the
/// sample's footprint where that is larger.
Vec2 half_step(const TextureSet& textures, const Texture& texture, const SurfacePoint& point) {
    Vec2 step{1e-4f, 1e-4f};
    if (const auto* image = std::get_if<ImageTexture>(&texture)) {
        const ImageRgb& texels = textures.images[image->image];
        step = {0.5f / (abs(image->scale.x) * static_cast<float>(texels.width())),
                0.5f / (abs(image->scale.y) * static_cast<float>(texels.height()))};
    }
    const float du = (abs(point.duv_dx.x) + abs(point.duv_dy.x)) / 2,
                dv = (abs(point.duv_dx.y) + abs(point.duv_dy.y)) / 2;
    return {du > step.x && std::isfinite(du) ? du : step.x, dv > step.y && std::isfinite(dv) ? dv : step.y};
}

/// Returns the bump-mapped normal: ns minus the surface gradient of the heights, normalized.
Vec3 bumped_normal(const TextureSet& textures, const SurfaceMaps& maps, const SurfacePoint& point) {
    const Vec3d n(point.ns), dpdu(point.dpdu), dpdv(point.dpdv);
    const double det = dot(n, cross(dpdu, dpdv));
    if (det == 0) return point.ns;
    const Texture& texture = texture_at(textures, maps.bump);
    const auto height = [&](float du, float dv) {
        SurfacePoint shifted = point;
        shifted.uv = {point.uv.x + du, point.uv.y + dv};
        shifted.p_object = point.p_object; // solid textures do not vary with uv, so they give no bump
        return static_cast<double>(evaluate_texture(textures, texture, shifted).r * maps.bump_scale);
    };
    const Vec2 step = half_step(textures, texture, point);
    const double dh_du = (height(step.x, 0) - height(-step.x, 0)) / (2 * static_cast<double>(step.x));
    const double dh_dv = (height(0, step.y) - height(0, -step.y)) / (2 * static_cast<double>(step.y));
    const Vec3d gradient = (cross(dpdv, n) * dh_du + cross(n, dpdu) * dh_dv) / det;
    return Vec3(normalize(n - gradient));
}

/// Bends ns just enough that the mirrored direction to the viewer lies above the plane with normal `terminator_normal`.
/// Near a silhouette that plane may face away from the viewer. The direction to the viewer is then projected onto the
/// plane (as in clamp_to_visible_side), because the half vector of two directions below the plane also lies below it.
Vec3 ensure_valid_reflection(Vec3 ns, Vec3 terminator_normal, Vec3 to_viewer) {
    const float facing = dot(to_viewer, terminator_normal);
    if (facing < 0) to_viewer = normalize(to_viewer - terminator_normal * facing);
    const Vec3 mirrored = reflect(to_viewer, ns);
    const float above = dot(mirrored, terminator_normal);
    constexpr float kMinCosine = 0.01f;
    if (above >= kMinCosine) return ns;
    return normalize(to_viewer + normalize(mirrored + terminator_normal * (kMinCosine - above)));
}

} // namespace

void apply_normal_maps(const TextureSet& textures, const SurfaceMaps& maps, Vec3 direction, SurfacePoint& point) {
    if (!maps.perturbs_normal()) return;
    if (maps.bump >= 0) point.ns = bumped_normal(textures, maps, point);
    if (maps.normal >= 0) point.ns = mapped_normal(textures, maps, point);
    if (!is_finite(point.ns)) point.ns = point.terminator_normal;
    const float side = dot(point.ng, direction) > 0 ? -1.0f : 1.0f;
    point.ns = ensure_valid_reflection(point.ns * side, point.terminator_normal * side, -normalize(direction)) * side;
    if (dot(point.ns, point.ng) < 0) point.ns = normalize(point.ns - point.ng * (1.001f * dot(point.ns, point.ng)));
}

float opacity(const TextureSet& textures, const SurfaceMaps& maps, const SurfacePoint& point) {
    SurfacePoint unfiltered = point;
    unfiltered.duv_dx = unfiltered.duv_dy = Vec2();
    const float value = evaluate_clamped(textures, maps.opacity, unfiltered);
    if (maps.cutoff > 0) return value >= maps.cutoff ? 1.0f : 0.0f;
    return value;
}

} // namespace duet
