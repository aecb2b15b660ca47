#include "raster/probes/reflection_probes.h"

#include "raster/prepare_limits.h"
#include "raster/probes/indirect_light.h"
#include "raster/probes/probe_capture.h"
#include "raster/probes/reflections.h"
#include "raster/probes/solid_test.h"

#include "common/system/parallel.h"

#include <algorithm>
#include <set>

namespace duet::raster {
namespace {

bool any_material(const Scene& scene, const Object& object, bool (*is)(const Material&)) {
    return std::ranges::any_of(object.materials, [&](std::uint32_t material) { return is(scene.materials[material]); });
}

/// Returns whether a material shows bright and sharp reflections: smooth metal or glass. A textured roughness counts as
/// smooth.
bool is_mirror(const Material& material) {
    constexpr float kSmooth = 0.15f; // a rougher lobe is wider than two texels of the smallest maps
    const auto smooth = [](const ScalarSlot& roughness) { return !roughness.constant() || roughness.value < kSmooth; };
    if (const auto* metal = std::get_if<Metal>(&material)) return smooth(metal->roughness);
    if (const auto* glass = std::get_if<Dielectric>(&material)) return glass->thin || smooth(glass->roughness);
    const auto* principled = std::get_if<Principled>(&material);
    return principled != nullptr && smooth(principled->roughness) &&
           (!principled->metallic.constant() || principled->metallic.value > 0);
}

struct Site {
    Vec3d center;
    std::vector<std::uint32_t> excluded; ///< objects that the probe does not see, sorted
    std::uint32_t object = kNoObject;    ///< object that has this probe for itself
    int side = 0;                        ///< texels along a side of its map
};

/// Returns the objects that reflect, the largest first.
std::vector<std::uint32_t> reflecting_objects(const RasterSceneData& data) {
    std::vector<std::uint32_t> objects;
    for (std::uint32_t i = 0; i < data.scene.objects.size(); ++i)
        if (any_material(data.scene, data.scene.objects[i], reflects)) objects.push_back(i);
    const auto size = [&](std::uint32_t i) { return length(data.objects[i].bounds.diagonal()); };
    std::stable_sort(objects.begin(), objects.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return size(a) > size(b); });
    return objects;
}

std::vector<Site> sites_of(const RasterSceneData& data) {
    std::vector<Site> sites;
    const PrepareLimits limits(data.scene);
    const int most = limits.reflection_probes(ReflectionProbes::kMostProbes);
    std::size_t mirrors = 0;
    for (const std::uint32_t object : reflecting_objects(data)) {
        if (sites.size() == static_cast<std::size_t>(most)) break;
        std::set<std::uint32_t> excluded(data.glass.begin(), data.glass.end());
        excluded.insert(object);
        const int finest = any_material(data.scene, data.scene.objects[object], is_mirror)
                               ? ReflectionProbes::mirror_side(mirrors++) : ReflectionProbes::kRoughSide;
        sites.push_back({Vec3d(data.objects[object].bounds.center()), {excluded.begin(), excluded.end()}, object,
                         limits.radiance_map_side(finest)});
    }
    return sites;
}

/// Adds to a capture the indirect light that its surfaces reflect, and the environment's reflections on their specular
/// lobes. If `enclosed`, the object that has the probe encloses its center.
void add_reflected_light(const RasterSceneData& data, RasterSettings settings, bool enclosed, ProbeCapture& capture) {
    settings.threads = 1;
    GtaoImage occlusion;
    for (ProbeCapture::Face& face : capture.faces()) {
        if (data.irradiance_probes) {
            const IrradianceProbes& probes = *data.irradiance_probes;
            face.gbuffer.eye_enclosed = enclosed;
            interpolate_probes(settings, face.gbuffer, probes, occlusion);
            occlusion.find_light(occluder_reach(settings, probes), 1,
                                 [&](int x, int y) { return face.direct.color_at(x, y); });
            add_indirect_light(settings, face.gbuffer, probes, occlusion, face.direct);
        }
        add_reflections(data, settings, face.gbuffer, nullptr, face.direct);
    }
    capture.add_fog(data, settings, ambient_light(data, settings, capture.faces().front().gbuffer.projection));
}

/// Returns the radiance of a capture, with or without the emission of its surfaces.
RadianceMap::Source captured(const ProbeCapture& capture, bool emission) {
    return [&capture, emission](Vec3 w) {
        const ProbeCapture::Pixel pixel = capture.pixel(w);
        const ProbeCapture::Face& face = capture.faces()[pixel.face];
        const Rgb emitted = emission ? face.emission.color_at(pixel.x, pixel.y) : Rgb();
        return RadianceMap::Arriving{face.direct.color_at(pixel.x, pixel.y) + emitted, capture.distance(pixel)};
    };
}

bool shows_light(const ProbeCapture& capture) {
    return std::ranges::any_of(capture.faces(), [](const ProbeCapture::Face& face) {
        for (int y = 0; y < face.emission.x.height(); ++y)
            for (int x = 0; x < face.emission.x.width(); ++x)
                if (!is_black(face.emission.color_at(x, y))) return true;
        return false;
    });
}

/// Renders the maps of one probe, on one thread. Rough surfaces need a map without the lights, because their
/// reflections of lights are direct light, and because a light hides surfaces from the probe that other points see.
RadianceMap render_map(const RasterSceneData& data, const RasterSettings& settings, const Site& site) {
    constexpr int kGuardShare = 8; // of a face's side, so that occlusion has no seam where faces meet
    const int side = site.side;
    const bool enclosed = is_inside(data, site.object, site.center);
    const auto capture = [&](const std::vector<std::uint32_t>& excluded) {
        constexpr std::size_t kMostLights = 16; // per cluster of pixels; models/lanterns.json then takes seconds
        ProbeCapture result(data, settings, site.center, side / 2, side / 2 / kGuardShare,
                            {.excluded = excluded, .lights = {kMostLights}});
        add_reflected_light(data, settings, enclosed, result);
        return result;
    };
    const ProbeCapture all = capture(site.excluded);
    if (!shows_light(all)) return RadianceMap(side, captured(all, false), {}, 1);
    std::set<std::uint32_t> excluded(site.excluded.begin(), site.excluded.end());
    excluded.insert(data.emitters.begin(), data.emitters.end());
    if (excluded.size() == site.excluded.size()) return RadianceMap(side, captured(all, false), captured(all, true), 1);
    const ProbeCapture rest = capture({excluded.begin(), excluded.end()});
    return RadianceMap(side, captured(rest, false), captured(all, true), 1);
}

} // namespace

bool reflects(const Material& material) {
    return !std::holds_alternative<Diffuse>(material) && !std::holds_alternative<Emissive>(material);
}

ReflectionProbes::ReflectionProbes(const RasterSceneData& data, const RasterSettings& settings) {
    const std::vector<Site> sites = sites_of(data);
    probes_.resize(sites.size());
    parallel_for(sites.size(), settings.threads, [&](std::size_t i) {
        probes_[i] = {sites[i].center, render_map(data, settings, sites[i])};
    });
    for (std::uint32_t object = 0; object < data.scene.objects.size(); ++object) {
        const Vec3d center(data.objects[object].bounds.center());
        const auto rank = [&](const Site& site) {
            return std::pair(site.object != object, length(site.center - center));
        };
        const auto nearest = std::min_element(sites.begin(), sites.end(),
                                              [&](const Site& a, const Site& b) { return rank(a) < rank(b); });
        of_object_.push_back(static_cast<std::size_t>(nearest - sites.begin()));
    }
}

} // namespace duet::raster
