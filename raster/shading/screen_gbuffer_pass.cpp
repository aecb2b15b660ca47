#include "raster/shading/screen_gbuffer_pass.h"

#include "raster/output/display_tile.h"
#include "raster/screen_space/occlusion_image.h"
#include "raster/screen_space/ray_march.h"
#include "raster/screen_space/required_passes.h"
#include "raster/screen_space/screen_space_reflection.h"
#include "raster/screen_space/screen_space_refraction.h"
#include "raster/shading/built_in_shaders.h"
#include "raster/shading/packet_shader.h"
#include "raster/shading/shade_sample.h"
#include "raster/shading/single_hit.h"
#include "raster/visibility/hit_lists.h"

#include "common/sampling/hash.h"
#include "common/system/control.h"
#include "common/system/parallel.h"

#include <algorithm>
#include <atomic>

namespace duet::raster {
namespace {

/// Returns the prepass radiance of a pixel if its key matches, else null.
const Rgb* matching_radiance(const ScreenGBuffer::ColorPrepass& prepass, std::uint32_t key, int x, int y) {
    return key != 0 && key == prepass.keys(x, y) ? &prepass.radiance.finest()(x, y) : nullptr;
}

/// Returns, for each object, whether all of its materials satisfy reflects_image_only.
std::vector<std::uint8_t> reflective_objects(const Scene& scene) {
    const auto of_mirror = [&](std::uint32_t material) { return reflects_image_only(scene.materials[material]); };
    std::vector<std::uint8_t> result;
    for (const Object& object : scene.objects)
        result.push_back(std::all_of(object.materials.begin(), object.materials.end(), of_mirror));
    return result;
}

/// Computes the ambient occlusion if shading needs it.
void add_occlusion(const RasterSceneData& data, const RasterSettings& settings, ScreenGBuffer& gbuffer) {
    if (needs_occlusion(data, settings))
        gbuffer.set_occlusion(std::make_shared<const OcclusionImage>(
            gbuffer, settings.ambient_occlusion, static_cast<float>(occlusion_radius(data, settings)),
            settings.threads));
}

/// Renders the G-buffer and the prepasses of one view.
class ScreenGBufferPass {
public:
    ScreenGBufferPass(const RasterSceneData& data, const RasterSettings& settings, const TileGrid& grid,
                      const PassView& central, const Control& control)
        : data_(data), settings_(settings), grid_(grid), central_(central), control_(control),
          reflective_objects_(reflective_objects(data.scene)), tiles_with_glass_(grid.size(), 0) {}

    std::unique_ptr<ScreenGBuffer> run() {
        PooledGeometry geometry(*data_.geometries);
        process_geometry(data_, grid_, central_, settings_, *geometry);
        std::unique_ptr<ScreenGBuffer> gbuffer = depths_and_normals(*geometry);
        add_occlusion(data_, settings_, *gbuffer);
        const bool glass = needs_glass_layers(data_, settings_);
        if (!glass && !needs_color_prepass(data_, settings_)) return gbuffer;
        color_prepass(*geometry, nullptr, *gbuffer);
        add_shapes(true, *gbuffer);
        set_flat_radiance(*gbuffer);
        if (!glass) return gbuffer;
        render_behind_glass(*gbuffer);
        color_prepass(*geometry, &gbuffer->color_prepass(), *gbuffer);
        set_flat_radiance(*gbuffer);
        return gbuffer;
    }

private:
    int width() const { return grid_.region.width(); }
    int height() const { return grid_.region.height(); }
    template <typename F> void for_tiles(const F& visit) const {
        parallel_for(grid_.size(), settings_.threads, [&](std::size_t i) {
            if (!control_.stopped()) visit(i, grid_.tile(i));
        });
    }

    void set_flat_radiance(ScreenGBuffer& gbuffer) const {
        gbuffer.set_flat_radiance(flat_surface_radiance(gbuffer, reflective_objects_, settings_.threads));
    }

    /// Renders the depths and normals at the pixels' centers.
    std::unique_ptr<ScreenGBuffer> depths_and_normals(const Geometry& geometry) const {
        ImageFloat reversed_depth(width(), height());
        ImageRgb normals(width(), height());
        const std::unique_ptr<ShaderProgram> normal = normal_program();
        for_tiles([&](std::size_t i, const PixelRect& rect) {
            render_depth_and_color_tile(data_, geometry, central_, *normal, rect, i, reversed_depth, normals);
        });
        auto gbuffer =
            std::make_unique<ScreenGBuffer>(central_.pinhole, central_.samples.front(), std::move(reversed_depth));
        gbuffer->set_normals(normals);
        return gbuffer;
    }

    /// Adds the curvature and the thickness of the visible surfaces.
    void add_shapes(bool glass, ScreenGBuffer& gbuffer) const {
        gbuffer.set_normal_angles(max_normal_angles(gbuffer, settings_.threads));
        PooledGeometry geometry(*data_.geometries);
        process_back_faces(data_, grid_, central_, settings_, glass, *geometry);
        ImageFloat backs(width(), height());
        for_tiles([&](std::size_t i, const PixelRect& rect) {
            render_depth_tile(*geometry, central_, rect, i, backs);
            for (int y = rect.y0; y < rect.y1; ++y)
                for (int x = rect.x0; x < rect.x1; ++x) {
                    const std::uint32_t object = gbuffer.color_prepass().objects(x, y);
                    const bool closed = object != kNoObject && data_.objects[object].closed && backs(x, y) > 0;
                    backs(x, y) = closed ? max(gbuffer.near() / backs(x, y) - gbuffer.depth(x, y), 0.0f) : 0;
                }
        });
        gbuffer.set_thickness(std::move(backs));
    }

    /// Renders the radiance at the pixels' centers, with all components but screen-space reflections. `known` is the
    /// G-buffer's own or another color prepass from which pixels with matching keys are copied; or null. Glass needs
    /// ScreenGBuffer::behind. So the pass without `known` marks the tiles with glass, and a pass with `known` copies
    /// all other tiles.
    void color_prepass(const Geometry& geometry, const ScreenGBuffer::ColorPrepass* known, ScreenGBuffer& gbuffer) {
        PassView pass = central_;
        pass.gbuffer = &gbuffer;
        const RasterSettings settings = prepass_settings();
        ColorPrepassImage picture = known != nullptr ? ColorPrepassImage(*known) : ColorPrepassImage(width(), height());
        for_tiles([&](std::size_t i, const PixelRect& rect) {
            if (known != nullptr && tiles_with_glass_[i] == 0) return;
            DepthTile depths;
            rasterize_tile(geometry, pass, pass.samples.front(), rect, i, depths);
            const HitTile tile(depths, geometry, pass);
            for (int y = rect.y0; y < rect.y1; ++y)
                for (int x = rect.x0; x < rect.x1; ++x) {
                    const Hit& hit = tile.hit(x, y);
                    const bool later = gbuffer.behind() == nullptr && hit.valid() && is_glass(data_, hit.object);
                    if (later) tiles_with_glass_[i] = 1;
                    const std::uint32_t key = later ? 0 : ColorPrepassImage::key(data_.scene, hit);
                    const Rgb* same = known != nullptr ? matching_radiance(*known, key, x, y) : nullptr;
                    picture.set(data_, x, y, hit,
                                same != nullptr ? *same : shade_sample(data_, settings, tile, x, y).radiance, key);
                }
        });
        gbuffer.set_color_prepass(std::move(picture).finish());
    }
    RasterSettings prepass_settings() const {
        RasterSettings settings = settings_;
        settings.screen_reflections = false;
        settings.components = {};
        settings.aovs = {};
        return settings;
    }

    /// Renders the scene without glass and, over it from back to front, the glass objects behind other glass.
    void render_behind_glass(ScreenGBuffer& gbuffer) {
        PooledGeometry geometry(*data_.geometries), glass(*data_.geometries);
        process_without_glass(data_, grid_, central_, settings_, *geometry);
        const std::shared_ptr<ScreenGBuffer> bare = depths_and_normals(*geometry);
        add_occlusion(data_, settings_, *bare);
        color_prepass(*geometry, &gbuffer.color_prepass(), *bare);
        add_shapes(false, *bare);
        set_flat_radiance(*bare);
        process_glass_back_faces(data_, grid_, central_, settings_, true, *glass);
        const std::shared_ptr<const ScreenGBuffer> backs = depths_and_normals(*glass);
        process_glass(data_, grid_, central_, settings_, *glass);
        const std::vector<GlassLayer> layers = further_glass(gbuffer, *geometry, *glass);
        process_glass_back_faces(data_, grid_, central_, settings_, false, *glass);
        std::vector<std::shared_ptr<ScreenGBuffer>> gbuffers(layers.size() + 1, bare);
        for (std::size_t i = layers.size(); i-- > 0;)
            gbuffers[i] = glass_screen(layers[i], *bare, gbuffers[i + 1], *glass, gbuffer);
        gbuffer.set_glass(gbuffers.front(), backs);
        for (std::size_t i = layers.size(); i-- > 0;) shade_glass(*geometry, layers[i].hits, *gbuffers[i]);
    }

    /// A layer holds glass behind other glass, and invalid hits elsewhere.
    struct GlassLayer {
        Image<Hit> hits;
        ImageFloat reversed_depth;
    };

    /// Returns the front surfaces of the second, third, … glass object along each pixel's ray.
    std::vector<GlassLayer> further_glass(const ScreenGBuffer& front, const Geometry& bare_geometry,
                                          const Geometry& glass) const {
        std::vector<GlassLayer> layers(kMaxGlassDepth - 1,
                                       GlassLayer{Image<Hit>(width(), height()), ImageFloat(width(), height())});
        std::atomic<std::size_t> found{0};
        for_glass_tiles(&bare_geometry, glass, [&](HitTile& tile, HitLists& lists) {
            lists.for_each([&](int x, int y, const Hit& hit) {
                if (hit.object == front.color_prepass().objects(x, y)) return false;
                std::size_t i = 0;
                for (; layers[i].hits(x, y).valid(); ++i)
                    if (layers[i].hits(x, y).object == hit.object) return false;
                const Hit bare = tile.exchange(x, y, hit);
                layers[i].hits(x, y) = hit, layers[i].reversed_depth(x, y) = tile.reversed_depth(x, y);
                tile.exchange(x, y, bare);
                ++i;
                for (std::size_t before = found; before < i && !found.compare_exchange_weak(before, i);) {
                }
                return i == layers.size();
            });
        });
        layers.resize(found);
        return layers;
    }

    /// Builds the G-buffer of such a layer in front of `behind`, except for its radiance. `backs` has the back faces of
    /// all glass.
    std::shared_ptr<ScreenGBuffer> glass_screen(const GlassLayer& layer, const ScreenGBuffer& bare,
                                                std::shared_ptr<const ScreenGBuffer> behind, const Geometry& backs,
                                                const ScreenGBuffer& front) const {
        ImageFloat reversed_depth = bare.reversed_depth(), thickness(width(), height());
        ImageRgb normals(width(), height());
        Image<std::uint32_t> objects = bare.color_prepass().objects;
        for (int y = 0; y < height(); ++y)
            for (int x = 0; x < width(); ++x) {
                const Hit& hit = layer.hits(x, y);
                normals(x, y) = as_color(hit.valid() ? normal_of(hit, x, y) : bare.normal(x, y));
                if (hit.valid())
                    reversed_depth(x, y) = layer.reversed_depth(x, y), objects(x, y) = hit.object;
                else
                    thickness(x, y) = bare.thickness(x, y);
            }
        auto gbuffer =
            std::make_shared<ScreenGBuffer>(central_.pinhole, central_.samples.front(), std::move(reversed_depth));
        gbuffer->set_normals(normals);
        gbuffer->set_thickness(std::move(thickness));
        gbuffer->set_color_prepass({{}, std::move(objects), {}, {}, {}});
        gbuffer->set_normal_angles(max_normal_angles(*gbuffer, settings_.threads));
        gbuffer->set_glass(std::move(behind), render_back_faces_of(layer.hits, backs));
        gbuffer->set_front(front);
        return gbuffer;
    }

    Vec3 normal_of(const Hit& hit, int x, int y) const {
        return hit_normal(data_.scene, central_, hit, central_.samples.front().position(x, y), 1);
    }
    static Rgb as_color(Vec3 n) { return Rgb(n.x + 1, n.y + 1, n.z + 1) * 0.5f; }

    /// Renders the nearest back face of the object of each hit.
    std::shared_ptr<const ScreenGBuffer> render_back_faces_of(const Image<Hit>& hits, const Geometry& backs) const {
        ImageFloat reversed_depth(width(), height());
        ImageRgb normals(width(), height());
        for_glass_tiles(nullptr, backs, [&](HitTile& tile, HitLists& lists) {
            lists.for_each([&](int x, int y, const Hit& hit) {
                if (!hits(x, y).valid()) return true;
                if (hit.object != hits(x, y).object) return false;
                tile.exchange(x, y, hit);
                reversed_depth(x, y) = tile.reversed_depth(x, y);
                normals(x, y) = as_color(normal_of(hit, x, y));
                return true;
            });
        });
        auto gbuffer =
            std::make_shared<ScreenGBuffer>(central_.pinhole, central_.samples.front(), std::move(reversed_depth));
        gbuffer->set_normals(normals);
        return gbuffer;
    }

    /// Renders the color prepass of such a layer, which sees what is behind it.
    void shade_glass(const Geometry& bare_geometry, const Image<Hit>& hits, ScreenGBuffer& gbuffer) {
        ScreenGBuffer::ColorPrepass prepass_of_layer = gbuffer.behind()->color_prepass();
        prepass_of_layer.objects = gbuffer.color_prepass().objects; // object IDs must be set before shading
        gbuffer.set_color_prepass(std::move(prepass_of_layer));
        PassView pass = central_;
        pass.gbuffer = &gbuffer;
        const RasterSettings settings = prepass_settings();
        ColorPrepassImage picture(gbuffer.behind()->color_prepass());
        for_tiles([&](std::size_t i, const PixelRect& rect) {
            if (tiles_with_glass_[i] == 0) return;
            DepthTile depths;
            rasterize_tile(bare_geometry, pass, pass.samples.front(), rect, i, depths);
            HitTile tile(depths, bare_geometry, pass);
            for (int y = rect.y0; y < rect.y1; ++y)
                for (int x = rect.x0; x < rect.x1; ++x) {
                    if (!hits(x, y).valid()) continue;
                    tile.exchange(x, y, hits(x, y));
                    picture.set(data_, x, y, hits(x, y), shade_sample(data_, settings, tile, x, y).radiance, 0);
                }
        });
        gbuffer.set_color_prepass(std::move(picture).finish());
        set_flat_radiance(gbuffer);
    }

    /// Calls visit for each tile with glass, with the tile's hits of `seen`, or none if it is null, and the lists of
    /// the hits of `listed` in front of them.
    template <typename F> void for_glass_tiles(const Geometry* seen, const Geometry& listed, const F& visit) const {
        for_tiles([&](std::size_t i, const PixelRect& rect) {
            if (tiles_with_glass_[i] == 0) return;
            const SampleOffset offset = central_.samples.front();
            DepthTile depths;
            if (seen != nullptr) {
                rasterize_tile(*seen, central_, offset, rect, i, depths);
            } else {
                depths.reset(rect, offset, central_.viewport);
                depths.clear_undrawn();
            }
            HitTile tile(depths, seen != nullptr ? *seen : listed, central_);
            HitLists lists(listed, central_, offset, i, tile);
            visit(tile, lists);
        });
    }

    const RasterSceneData& data_;
    const RasterSettings& settings_;
    const TileGrid& grid_;
    const PassView& central_;
    const Control& control_;
    const std::vector<std::uint8_t> reflective_objects_;
    std::vector<std::uint8_t> tiles_with_glass_; ///< of each tile
};

} // namespace

std::uint32_t ColorPrepassImage::key(const Scene& scene, const Hit& hit) {
    if (!hit.valid()) return 0;
    const Material& material = scene.materials[material_index(scene, hit.object, hit.primitive)];
    if (may_reflect_image(material) || std::holds_alternative<Dielectric>(material)) return 0;
    return high_bits(hash_combine(hit.object, hit.primitive)) | 1u;
}

void ColorPrepassImage::set(const RasterSceneData& data, int x, int y, const Hit& hit, Rgb radiance,
                            std::uint32_t key) {
    radiance_(x, y) = radiance;
    keys_(x, y) = key;
    objects_(x, y) = hit.object;
    const std::int64_t light = hit.valid() ? surface_light_index(data.scene, hit.object, hit.primitive) : -1;
    light_mask_(x, y) = light >= 0 && std::binary_search(data.reflected_lights.begin(), data.reflected_lights.end(),
                                                         static_cast<std::size_t>(light));
}

ColorPrepassImage::ColorPrepassImage(const ScreenGBuffer::ColorPrepass& prepass)
    : radiance_(prepass.radiance.finest()), keys_(prepass.keys), objects_(prepass.objects),
      light_mask_(prepass.light_mask) {}

ScreenGBuffer::ColorPrepass ColorPrepassImage::finish() && {
    ImageRgb dark = radiance_;
    for (std::size_t i = 0; i < dark.size(); ++i)
        if (light_mask_[i] != 0) dark[i] = Rgb();
    return {std::move(keys_), std::move(objects_), std::move(light_mask_), RadiancePyramid(std::move(radiance_)),
            RadiancePyramid(std::move(dark))};
}

const Rgb* prepass_radiance(const RasterSceneData& data, const RasterSettings& settings, const HitTile& tile, int x,
                            int y) {
    if (tile.gbuffer() == nullptr || tile.gbuffer()->color_prepass().radiance.empty() || settings.aovs.any() ||
        !settings.components.all())
        return nullptr;
    const ScreenGBuffer::ColorPrepass& prepass = tile.gbuffer()->color_prepass();
    return matching_radiance(prepass, ColorPrepassImage::key(data.scene, tile.hit(x, y)), x, y);
}

std::unique_ptr<ScreenGBuffer> render_screen_gbuffer(const RasterSceneData& data, const RasterSettings& settings,
                                                     const TileGrid& grid, const PassView& pass,
                                                     const Control& control) {
    if (!needs_screen_gbuffer(data, settings)) return nullptr;
    const std::vector<SampleOffset> centers(1);
    const PassView central{.pinhole = pass.pinhole, .time = pass.time, .viewport = pass.viewport, .samples = centers};
    return ScreenGBufferPass(data, settings, grid, central, control).run();
}

} // namespace duet::raster
