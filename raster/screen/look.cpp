#include "raster/screen/look.h"

#include "raster/display.h"
#include "raster/screen/glass.h"
#include "raster/screen/mirrored.h"
#include "raster/screen/needs.h"
#include "raster/screen/occlusion_image.h"
#include "raster/screen/screen_reflection.h"
#include "raster/shade.h"
#include "raster/shader/one_sample.h"
#include "raster/shader/strip_shader.h"
#include "raster/shadings/shadings.h"
#include "raster/visibility/hit_lists.h"

#include "common/sampling/hash.h"
#include "common/system/control.h"
#include "common/system/parallel.h"

#include <algorithm>
#include <atomic>

namespace duet::raster {
namespace {

/// Returns the prepass radiance of a pixel if its key matches, else null.
const Rgb* known_radiance(const Screen::FirstLook& look, std::uint32_t key, int x, int y) {
    return key != 0 && key == look.keys(x, y) ? &look.radiance.finest()(x, y) : nullptr;
}

/// Returns, for each object, whether all of its materials satisfy is_mirror.
std::vector<std::uint8_t> mirrors(const Scene& scene) {
    const auto of_mirror = [&](std::uint32_t material) { return is_mirror(scene.materials[material]); };
    std::vector<std::uint8_t> result;
    for (const Object& object : scene.objects)
        result.push_back(std::all_of(object.materials.begin(), object.materials.end(), of_mirror));
    return result;
}

/// Computes the ambient occlusion if shading needs it.
void add_occlusion(const PreparedData& data, const Settings& settings, Screen& screen) {
    if (needs_occlusion(data, settings))
        screen.set_occlusion(std::make_shared<const OcclusionImage>(
            screen, settings.ambient_occlusion, static_cast<float>(occlusion_radius(data, settings)),
            settings.threads));
}

/// Renders the G-buffer and the prepasses of one view.
class Looker {
public:
    Looker(const PreparedData& data, const Settings& settings, const TileGrid& grid, const PassView& central,
           const Control& control)
        : data_(data), settings_(settings), grid_(grid), central_(central), control_(control),
          mirrors_(mirrors(data.scene)),
          with_glass_(grid.size(), 0) {}

    std::unique_ptr<Screen> look() {
        GeometryLoan geometry(*data_.geometries);
        process_geometry(data_, grid_, central_, settings_, *geometry);
        std::unique_ptr<Screen> screen = depths_and_normals(*geometry);
        add_occlusion(data_, settings_, *screen);
        const bool glass = needs_screen_behind(data_, settings_);
        if (!glass && !needs_screen_radiance(data_, settings_)) return screen;
        first_look(*geometry, nullptr, *screen);
        add_shapes(true, *screen);
        set_flat_look(*screen);
        if (!glass) return screen;
        look_behind_glass(*screen);
        first_look(*geometry, &screen->first_look(), *screen);
        set_flat_look(*screen);
        return screen;
    }

private:
    int width() const { return grid_.region.width(); }
    int height() const { return grid_.region.height(); }
    template <typename F> void for_tiles(const F& visit) const {
        parallel_for(grid_.size(), settings_.threads, [&](std::size_t i) {
            if (!control_.stopped()) visit(i, grid_.tile(i));
        });
    }

    void set_flat_look(Screen& screen) const { screen.set_flat_look(flat_look(screen, mirrors_, settings_.threads)); }

    /// Renders the depths and normals at the pixels' centers.
    std::unique_ptr<Screen> depths_and_normals(const Geometry& geometry) const {
        ImageFloat nearness(width(), height());
        ImageRgb normals(width(), height());
        const std::unique_ptr<Program> normal = normal_program();
        for_tiles([&](std::size_t i, const PixelRect& rect) {
            keep_nearness_and_colors(data_, geometry, central_, *normal, rect, i, nearness, normals);
        });
        auto screen = std::make_unique<Screen>(central_.pinhole, central_.samples.front(), std::move(nearness));
        screen->set_normals(normals);
        return screen;
    }

    /// Adds the curvature and the thickness of the visible surfaces.
    void add_shapes(bool glass, Screen& screen) const {
        screen.set_turns(normal_turns(screen, settings_.threads));
        GeometryLoan geometry(*data_.geometries);
        process_backs(data_, grid_, central_, settings_, glass, *geometry);
        ImageFloat backs(width(), height());
        for_tiles([&](std::size_t i, const PixelRect& rect) {
            keep_nearness(*geometry, central_, rect, i, backs);
            for (int y = rect.y0; y < rect.y1; ++y)
                for (int x = rect.x0; x < rect.x1; ++x) {
                    const std::uint32_t object = screen.first_look().objects(x, y);
                    const bool closed = object != kNoObject && data_.objects[object].closed && backs(x, y) > 0;
                    backs(x, y) = closed ? max(screen.near() / backs(x, y) - screen.depth(x, y), 0.0f) : 0;
                }
        });
        screen.set_thickness(std::move(backs));
    }

    /// Renders the radiance at the pixels' centers, with all components but screen-space reflections. `known` is the
    /// screen's own or another color prepass from which pixels with matching keys are copied; or null. Glass needs
    /// Screen::behind. So the pass without `known` marks the tiles with glass, and a pass with `known` copies all
    /// other tiles.
    void first_look(const Geometry& geometry, const Screen::FirstLook* known, Screen& screen) {
        PassView pass = central_;
        pass.screen = &screen;
        const Settings settings = plain_settings();
        FirstLookPicture picture = known != nullptr ? FirstLookPicture(*known) : FirstLookPicture(width(), height());
        for_tiles([&](std::size_t i, const PixelRect& rect) {
            if (known != nullptr && with_glass_[i] == 0) return;
            DepthTile depths;
            cover(geometry, pass, pass.samples.front(), rect, i, depths);
            const HitTile tile(depths, geometry, pass);
            for (int y = rect.y0; y < rect.y1; ++y)
                for (int x = rect.x0; x < rect.x1; ++x) {
                    const Hit& hit = tile.hit(x, y);
                    const bool later = screen.behind() == nullptr && hit.valid() && is_glass(data_, hit.object);
                    if (later) with_glass_[i] = 1;
                    const std::uint32_t key = later ? 0 : FirstLookPicture::key(data_.scene, hit);
                    const Rgb* same = known != nullptr ? known_radiance(*known, key, x, y) : nullptr;
                    picture.set(data_, x, y, hit,
                                same != nullptr ? *same : shade(data_, settings, tile, x, y).radiance, key);
                }
        });
        screen.set_first_look(std::move(picture).finish());
    }
    Settings plain_settings() const {
        Settings settings = settings_;
        settings.screen_reflections = false;
        settings.parts = {};
        settings.aovs = {};
        return settings;
    }

    /// Renders the scene without glass and, over it from back to front, the glass objects behind other glass.
    void look_behind_glass(Screen& screen) {
        GeometryLoan geometry(*data_.geometries), glass(*data_.geometries);
        process_without_glass(data_, grid_, central_, settings_, *geometry);
        const std::shared_ptr<Screen> bare = depths_and_normals(*geometry);
        add_occlusion(data_, settings_, *bare);
        first_look(*geometry, &screen.first_look(), *bare);
        add_shapes(false, *bare);
        set_flat_look(*bare);
        process_backs_of_glass(data_, grid_, central_, settings_, true, *glass);
        const std::shared_ptr<const Screen> backs = depths_and_normals(*glass);
        process_glass(data_, grid_, central_, settings_, *glass);
        const std::vector<GlassLayer> layers = further_glass(screen, *geometry, *glass);
        process_backs_of_glass(data_, grid_, central_, settings_, false, *glass);
        std::vector<std::shared_ptr<Screen>> screens(layers.size() + 1, bare);
        for (std::size_t i = layers.size(); i-- > 0;)
            screens[i] = glass_screen(layers[i], *bare, screens[i + 1], *glass, screen);
        screen.set_glass(screens.front(), backs);
        for (std::size_t i = layers.size(); i-- > 0;) shade_glass(*geometry, layers[i].hits, *screens[i]);
    }

    /// A layer holds glass behind other glass, and invalid hits elsewhere.
    struct GlassLayer {
        Image<Hit> hits;
        ImageFloat nearness;
    };

    /// Returns the front surfaces of the second, third, … glass object along each pixel's ray.
    std::vector<GlassLayer> further_glass(const Screen& front, const Geometry& bare_geometry,
                                          const Geometry& glass) const {
        std::vector<GlassLayer> layers(kGlassDeep - 1,
                                       GlassLayer{Image<Hit>(width(), height()), ImageFloat(width(), height())});
        std::atomic<std::size_t> found{0};
        for_glass_tiles(&bare_geometry, glass, [&](HitTile& tile, HitLists& lists) {
            lists.for_each([&](int x, int y, const Hit& hit) {
                if (hit.object == front.first_look().objects(x, y)) return false;
                std::size_t i = 0;
                for (; layers[i].hits(x, y).valid(); ++i)
                    if (layers[i].hits(x, y).object == hit.object) return false;
                const Hit bare = tile.exchange(x, y, hit);
                layers[i].hits(x, y) = hit, layers[i].nearness(x, y) = tile.nearness(x, y);
                tile.exchange(x, y, bare);
                ++i;
                for (std::size_t before = found; before < i && !found.compare_exchange_weak(before, i);) {}
                return i == layers.size();
            });
        });
        layers.resize(found);
        return layers;
    }

    /// Builds the screen of such a layer in front of `behind`, except for its radiance. `backs` has the back faces of
    /// all glass.
    std::shared_ptr<Screen> glass_screen(const GlassLayer& layer, const Screen& bare,
                                         std::shared_ptr<const Screen> behind,
                                         const Geometry& backs, const Screen& front) const {
        ImageFloat nearness = bare.nearness(), thickness(width(), height());
        ImageRgb normals(width(), height());
        Image<std::uint32_t> objects = bare.first_look().objects;
        for (int y = 0; y < height(); ++y)
            for (int x = 0; x < width(); ++x) {
                const Hit& hit = layer.hits(x, y);
                normals(x, y) = as_color(hit.valid() ? normal_of(hit, x, y) : bare.normal(x, y));
                if (hit.valid())
                    nearness(x, y) = layer.nearness(x, y), objects(x, y) = hit.object;
                else
                    thickness(x, y) = bare.thickness(x, y);
            }
        auto screen = std::make_shared<Screen>(central_.pinhole, central_.samples.front(), std::move(nearness));
        screen->set_normals(normals);
        screen->set_thickness(std::move(thickness));
        screen->set_first_look({{}, std::move(objects), {}, {}, {}});
        screen->set_turns(normal_turns(*screen, settings_.threads));
        screen->set_glass(std::move(behind), backs_of(layer.hits, backs));
        screen->set_front(front);
        return screen;
    }

    Vec3 normal_of(const Hit& hit, int x, int y) const {
        return hit_normal(data_.scene, central_, hit, central_.samples.front().position(x, y), 1);
    }
    static Rgb as_color(Vec3 n) { return Rgb(n.x + 1, n.y + 1, n.z + 1) * 0.5f; }

    /// Renders the nearest back face of the object of each hit.
    std::shared_ptr<const Screen> backs_of(const Image<Hit>& hits, const Geometry& backs) const {
        ImageFloat nearness(width(), height());
        ImageRgb normals(width(), height());
        for_glass_tiles(nullptr, backs, [&](HitTile& tile, HitLists& lists) {
            lists.for_each([&](int x, int y, const Hit& hit) {
                if (!hits(x, y).valid()) return true;
                if (hit.object != hits(x, y).object) return false;
                tile.exchange(x, y, hit);
                nearness(x, y) = tile.nearness(x, y);
                normals(x, y) = as_color(normal_of(hit, x, y));
                return true;
            });
        });
        auto screen = std::make_shared<Screen>(central_.pinhole, central_.samples.front(), std::move(nearness));
        screen->set_normals(normals);
        return screen;
    }

    /// Renders the color prepass of such a layer, which sees what is behind it.
    void shade_glass(const Geometry& bare_geometry, const Image<Hit>& hits, Screen& screen) {
        Screen::FirstLook places = screen.behind()->first_look();
        places.objects = screen.first_look().objects; // object IDs must be set before shading
        screen.set_first_look(std::move(places));
        PassView pass = central_;
        pass.screen = &screen;
        const Settings settings = plain_settings();
        FirstLookPicture picture(screen.behind()->first_look());
        for_tiles([&](std::size_t i, const PixelRect& rect) {
            if (with_glass_[i] == 0) return;
            DepthTile depths;
            cover(bare_geometry, pass, pass.samples.front(), rect, i, depths);
            HitTile tile(depths, bare_geometry, pass);
            for (int y = rect.y0; y < rect.y1; ++y)
                for (int x = rect.x0; x < rect.x1; ++x) {
                    if (!hits(x, y).valid()) continue;
                    tile.exchange(x, y, hits(x, y));
                    picture.set(data_, x, y, hits(x, y), shade(data_, settings, tile, x, y).radiance, 0);
                }
        });
        screen.set_first_look(std::move(picture).finish());
        set_flat_look(screen);
    }

    /// Calls visit for each tile with glass, with the tile's hits of `seen`, or none if it is null, and the lists of
    /// the hits of `listed` in front of them.
    template <typename F> void for_glass_tiles(const Geometry* seen, const Geometry& listed, const F& visit) const {
        for_tiles([&](std::size_t i, const PixelRect& rect) {
            if (with_glass_[i] == 0) return;
            const SampleOffset offset = central_.samples.front();
            DepthTile depths;
            if (seen != nullptr) {
                cover(*seen, central_, offset, rect, i, depths);
            } else {
                depths.reset(rect, offset, central_.viewport);
                depths.empty_undrawn();
            }
            HitTile tile(depths, seen != nullptr ? *seen : listed, central_);
            HitLists lists(listed, central_, offset, i, tile);
            visit(tile, lists);
        });
    }

    const PreparedData& data_;
    const Settings& settings_;
    const TileGrid& grid_;
    const PassView& central_;
    const Control& control_;
    const std::vector<std::uint8_t> mirrors_;
    std::vector<std::uint8_t> with_glass_; ///< of each tile
};

} // namespace

std::uint32_t FirstLookPicture::key(const Scene& scene, const Hit& hit) {
    if (!hit.valid()) return 0;
    const Material& material = scene.materials[material_index(scene, hit.object, hit.primitive)];
    if (may_mirror(material) || std::holds_alternative<Dielectric>(material)) return 0;
    return high_bits(hash_combine(hit.object, hit.primitive)) | 1u;
}

void FirstLookPicture::set(const PreparedData& data, int x, int y, const Hit& hit, Rgb radiance, std::uint32_t key) {
    radiance_(x, y) = radiance;
    keys_(x, y) = key;
    objects_(x, y) = hit.object;
    const std::int64_t light = hit.valid() ? surface_light_index(data.scene, hit.object, hit.primitive) : -1;
    lamps_(x, y) = light >= 0 &&
        std::binary_search(data.lamps.begin(), data.lamps.end(), static_cast<std::size_t>(light));
}

FirstLookPicture::FirstLookPicture(const Screen::FirstLook& look)
    : radiance_(look.radiance.finest()), keys_(look.keys), objects_(look.objects), lamps_(look.lamps) {}

Screen::FirstLook FirstLookPicture::finish() && {
    ImageRgb dark = radiance_;
    for (std::size_t i = 0; i < dark.size(); ++i)
        if (lamps_[i] != 0) dark[i] = Rgb();
    return {std::move(keys_), std::move(objects_), std::move(lamps_), RadiancePyramid(std::move(radiance_)),
            RadiancePyramid(std::move(dark))};
}

const Rgb* seen_before(const PreparedData& data, const Settings& settings, const HitTile& tile, int x, int y) {
    if (tile.screen() == nullptr || tile.screen()->first_look().radiance.empty() || settings.aovs.any() ||
        !settings.parts.all())
        return nullptr;
    const Screen::FirstLook& look = tile.screen()->first_look();
    return known_radiance(look, FirstLookPicture::key(data.scene, tile.hit(x, y)), x, y);
}

std::unique_ptr<Screen> look_at_screen(const PreparedData& data, const Settings& settings, const TileGrid& grid,
                                       const PassView& pass,
                                       const Control& control) {
    if (!needs_screen(data, settings)) return nullptr;
    const std::vector<SampleOffset> centers(1);
    const PassView central{.pinhole = pass.pinhole, .time = pass.time, .viewport = pass.viewport, .samples = centers};
    return Looker(data, settings, grid, central, control).look();
}

} // namespace duet::raster
