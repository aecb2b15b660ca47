#include "raster/gbuffer/gbuffer_pass.h"

#include "raster/gbuffer/surface_lobes.h"
#include "raster/shader/one_sample.h"
#include "raster/shader/strip_shader.h"
#include "raster/shadings/shadings.h"
#include "raster/visibility/cover.h"
#include "raster/visibility/strip_samples.h"

#include "common/system/control.h"
#include "common/system/parallel.h"

#include <bit>
#include <optional>

namespace duet::raster {
namespace {

/// Describes how a material's lobes follow from the base color alone, so that they need no surface point.
struct ColorToLobes {
    enum class Kind { kDiffuse, kMetal, kOther };
    Kind kind = Kind::kOther;
    float alpha = 1;
};

ColorToLobes color_to_lobes(const Material& material) {
    if (const auto* diffuse = std::get_if<Diffuse>(&material); diffuse != nullptr && !diffuse->rough())
        return {ColorToLobes::Kind::kDiffuse, 1};
    if (std::holds_alternative<Emissive>(material)) return {ColorToLobes::Kind::kDiffuse, 1};
    if (const auto* metal = std::get_if<Metal>(&material);
        metal != nullptr && metal->roughness.constant() && !metal->conductor.exists())
        return {ColorToLobes::Kind::kMetal, sqr(clamp(metal->roughness.value, 0.0f, 1.0f))};
    return {};
}

/// Fills the G-buffer of one tile, packet by packet.
class TileFiller {
public:
    TileFiller(const PreparedData& data, const Geometry& geometry, const PassView& view,
               std::span<const ColorToLobes> shortcuts, const Program& normals, const Program& colors,
               const DepthTile& tile, GBuffer& gbuffer, Planes3& emission)
        : data_(data), scene_(data.scene), geometry_(geometry), view_(view), shortcuts_(shortcuts), tile_(tile),
          gbuffer_(gbuffer), emission_(emission), reader_(geometry.triangles),
          normals_(normals.for_tile(data, geometry, view, tile.rect())),
          colors_(colors.for_tile(data, geometry, view, tile.rect())) {}

    void run() {
        const PixelRect& rect = tile_.rect();
        for (int y = rect.y0; y < rect.y1; y += DepthTile::kStripRows)
            for (int x = rect.x0; x < rect.x1; x += static_cast<int>(kStripWidth)) fill_packet(x, y);
    }

private:
    void fill_packet(int x0, int y0) {
        const StripPlace place = strip_place(tile_, x0, y0);
        StripSamples samples;
        reader_.read(place.ids, samples);
        if (samples.seen == 0) return;
        StripColors n, color;
        normals_->shade(place, n);
        colors_->shade(place, color);
        const PixelRect& rect = tile_.rect();
        for (std::uint32_t left = samples.seen; left != 0; left &= left - 1) {
            const auto i = static_cast<std::size_t>(std::countr_zero(left));
            const int x = x0 + static_cast<int>(i % kStripWidth), y = y0 + static_cast<int>(i / kStripWidth);
            if (x >= rect.x1 || y >= rect.y1) continue;
            const Vec3 normal(2 * n.r[i] - 1, 2 * n.g[i] - 1, 2 * n.b[i] - 1);
            gbuffer_.reversed_depth(x, y) = place.nearness[i];
            fill_pixel(x, y, samples.id(i), normal / max(length(normal), 1e-6f),
                       Rgb(color.r[i], color.g[i], color.b[i]), place.position(i));
        }
    }

    void fill_pixel(int x, int y, std::uint32_t id, Vec3 normal, Rgb color, Vec2d pixel) {
        const auto [object, primitive] = object_and_primitive(id);
        const std::uint32_t material = material_index(scene_, object, primitive);
        gbuffer_.object(x, y) = static_cast<std::int32_t>(object);
        gbuffer_.material(x, y) = static_cast<std::int32_t>(material);
        gbuffer_.normal.set_at(x, y, normal);
        if (emitter(scene_.materials[material]) != nullptr)
            emission_.set_at(x, y, hit_emission(scene_, view_, find_hit(geometry_, view_, id, pixel), pixel, 1));
        const SurfaceLobes lobes = lobes_of(material, color, id, normal, pixel);
        gbuffer_.diffuse.set_at(x, y, lobes.diffuse);
        gbuffer_.specular.set_at(x, y, lobes.specular);
        gbuffer_.alpha(x, y) = lobes.alpha;
        if (!gbuffer_.coat.empty()) gbuffer_.coat(x, y) = lobes.coat, gbuffer_.coat_alpha(x, y) = lobes.coat_alpha;
    }

    SurfaceLobes lobes_of(std::uint32_t material, Rgb color, std::uint32_t id, Vec3 normal, Vec2d pixel) const {
        const ColorToLobes& shortcut = shortcuts_[material];
        if (shortcut.kind == ColorToLobes::Kind::kDiffuse) return {.diffuse = color, .specular = {}};
        if (shortcut.kind == ColorToLobes::Kind::kMetal)
            return {.diffuse = {}, .specular = color, .alpha = shortcut.alpha};
        const Ray ray = rounded(view_.pinhole.ray(pixel), view_.time);
        const Hit hit = find_hit(geometry_, view_, id, pixel);
        const RayFootprint footprint =
            scene_.needs.footprints ? PixelFootprint(view_.pinhole, 1).at(ray, hit.t) : RayFootprint{};
        const SurfacePoint point = surface_point(scene_, ray, hit, &footprint);
        const float cosine = clamp(-dot(normal, ray.direction), 1e-4f, 1.0f);
        return surface_lobes(bsdf_at(scene_.materials[material], scene_.textures, point), cosine);
    }

    struct Primitive {
        std::uint32_t object, primitive;
    };
    Primitive object_and_primitive(std::uint32_t id) {
        const Run& run = reader_.run_of(id);
        if (run.sphere) return {geometry_.spheres[run.object].object, 0};
        const Triangles& triangles = geometry_.triangles;
        return {triangles.objects[run.object].object,
                static_cast<std::uint32_t>(triangles.packed(run).primitive(Triangles::index(run, id)))};
    }

    const PreparedData& data_;
    const Scene& scene_;
    const Geometry& geometry_;
    const PassView& view_;
    std::span<const ColorToLobes> shortcuts_; ///< parallel to Scene::materials
    const DepthTile& tile_;
    GBuffer& gbuffer_;
    Planes3& emission_;
    StripReader reader_;
    std::unique_ptr<StripShader> normals_, colors_;
};

} // namespace

bool any_clear_coat(const Scene& scene) {
    return std::any_of(scene.materials.begin(), scene.materials.end(), [](const Material& material) {
        const auto* p = std::get_if<Principled>(&material);
        return p != nullptr && (p->clearcoat.value > 0 || !p->clearcoat.constant());
    });
}

void fill_gbuffer(const PreparedData& data, const Settings& settings, const Geometry& geometry, const PassView& view,
                  const TileGrid& grid, SampleOffset offset, const Control& control, GBuffer& gbuffer,
                  Planes3& emission) {
    std::vector<ColorToLobes> shortcuts;
    for (const Material& material : data.scene.materials) shortcuts.push_back(color_to_lobes(material));
    const std::unique_ptr<Program> normals = normal_program(), colors = albedo_program();
    parallel_for(grid.size(), settings.threads, [&](std::size_t i) {
        if (control.stopped()) return;
        DepthTile tile;
        cover(geometry, view, offset, grid.tile(i), i, tile);
        TileFiller(data, geometry, view, shortcuts, *normals, *colors, tile, gbuffer, emission).run();
    });
}

} // namespace duet::raster
