#include "raster/probes/probe_capture.h"

#include "raster/gbuffer/gbuffer_pass.h"
#include "raster/lighting/background.h"
#include "raster/lighting/shadow_denoiser.h"
#include "raster/shader/octahedral_map.h"
#include "raster/shadows/cube_map.h"
#include "raster/shadows/light_views.h"
#include "raster/shadows/surface_shadows.h"
#include "raster/visibility/hit_lists.h"

#include "common/system/control.h"

#include <algorithm>
#include <cmath>

namespace duet::raster {
namespace {

/// Selects what a capture renders: all but the given objects, with their light, or these objects alone.
struct Shown {
    const std::vector<std::uint32_t>& objects;
    bool excluded;
    bool sun = true;
    ChosenLights lights{};
};

ProbeCapture::Face capture(const RasterSceneData& data, const RasterSettings& settings, const Camera& camera, int side,
                           const Shown& shown, std::size_t face_index) {
    const PassView pass = center_view({camera, side, side});
    const SampleOffset offset = pass.samples.front();
    const TileGrid grid{{0, 0, side, side}};
    const auto geometry = data.geometries->take(), layers = data.geometries->take();
    const auto selected = [&](std::uint32_t object) {
        return std::binary_search(shown.objects.begin(), shown.objects.end(), object) != shown.excluded;
    };
    process_geometry(data, grid, pass, settings, *geometry, selected);
    if (data.has_layers()) process_layers(data, grid, pass, settings, *layers, selected);
    ProbeCapture::Face face{GBuffer(ScreenProjection(pass.pinhole, offset), side, side, optional_planes(data.scene)),
                            Planes3(side, side), Planes3(side, side), {}};
    const Control control;
    const SampleView sample{data, settings, *geometry, data.has_layers() ? &*layers : nullptr,
                            pass, grid,     offset,    control};
    // The G-buffer has room for one surface, so a surface with alpha replaces what lies behind it in as many pixels as
    // it blocks of the light (stochastic transparency). An object that is rendered alone replaces it in all.
    const auto stops = [&](int x, int y, float left) { return !shown.excluded || blocks_in_dither(x, y, left); };
    fill_gbuffer(sample, face.gbuffer, face.emission, [&](std::size_t, HitTile& tile, HitLists& lists) {
        lists.for_each_blocking_hit(data.scene, stops, [&](int x, int y, const Hit& hit) {
            tile.exchange(x, y, hit);
            store_hit(sample, x, y, hit, tile.reversed_depth(x, y), face.gbuffer, face.emission);
        });
    });
    if (!shown.excluded) return face;
    draw_background(data, settings, face.gbuffer, shown.sun, face.direct);
    ChosenLights chosen = shown.lights;
    chosen.random = std::fmod(chosen.random + 0.381966f * static_cast<float>(face_index), 1.0f);
    const std::vector<FrameLight> lights = scene_lights(data, settings, face.gbuffer.projection);
    std::vector<FrameLight> suns = sun_lights(data, settings, face.gbuffer.projection);
    if (lights.empty() && suns.empty()) return face;
    if (!shown.sun) // then specular lobes do not see the sun in the background
        for (FrameLight& sun : suns) sun.diffuse_only = false;
    const std::optional<SurfaceShadows> shadows = surface_shadows(data, settings, face.gbuffer, pass.time);
    for (const std::span<const FrameLight> some : {std::span(lights), std::span<const FrameLight>(suns)}) {
        if (some.empty()) continue;
        DirectLight light;
        compute_direct_light(data, settings, face.gbuffer, some, shadows ? &*shadows : nullptr, light, chosen);
        add_direct_light(face.gbuffer, light, 1, face.direct);
    }
    return face;
}

std::vector<ProbeCapture::Face> capture_all(const RasterSceneData& data, RasterSettings settings, Vec3d center,
                                            int side, int guard, const Shown& shown) {
    settings.threads = 1;
    settings.components = {};
    settings.skips.back_faces = settings.skips.back_faces && shown.excluded; // one object is seen from within, too
    const double size = static_cast<double>(length(data.scene.bounds.diagonal())) + 1e-30;
    std::vector<ProbeCapture::Face> faces;
    for (Camera view : cube_views(center, {}, size, side, guard)) {
        view.shutter_open = view.shutter_close = data.scene.camera.shutter_open;
        faces.push_back(capture(data, settings, view, side, shown, faces.size()));
    }
    return faces;
}

/// Returns a pixel's center on the face's square at distance 1, in the face's axes.
Vec3 point_on_face(const ProbeCapture::Pixel& p, int side) {
    const auto tangent = [&](int i) { return (2 * static_cast<float>(i) + 1) / static_cast<float>(side) - 1; };
    return {tangent(p.x), -tangent(p.y), 1};
}

} // namespace

ProbeCapture::ProbeCapture(const RasterSceneData& data, const RasterSettings& settings, Vec3d center, int side,
                           int guard, const Selection& selection)
    : side_(side), guard_(guard),
      faces_(capture_all(data, settings, center, side + 2 * guard, guard,
                         {selection.excluded, true, selection.sun, selection.lights})) {}

ProbeCapture::ProbeCapture(const RasterSceneData& data, const RasterSettings& settings, Vec3d center,
                           std::uint32_t object, int side)
    : side_(side), guard_(0), faces_(capture_all(data, settings, center, side, 0, {{object}, false})) {}

void ProbeCapture::add_fog(const RasterSceneData& data, const RasterSettings& settings, const AmbientLight& ambient) {
    if (!settings.fog || data.scene.media.empty()) return;
    FogGrid fog;
    for (Face& face : faces_) {
        GBuffer& gbuffer = face.gbuffer;
        fog.compute(data, settings, gbuffer, ambient,
                    {.time = static_cast<float>(data.scene.camera.shutter_open), .slices = 16, .threads = 1});
        face.haze = fog.haze(gbuffer, 1);
        fog.apply(gbuffer, 1, true, face.direct);
        for (Planes3* image : {&face.emission, &gbuffer.diffuse, &gbuffer.specular})
            fog.apply(gbuffer, 1, false, *image);
    }
}

ProbeCapture::Pixel ProbeCapture::pixel(Vec3 w) const {
    const std::size_t face = cube_face(w);
    const Vec3 f = to_face(face, w);
    return {face, cell_of(f.x / f.z, side_) + guard_, cell_of(-f.y / f.z, side_) + guard_};
}

Vec3 ProbeCapture::direction(const Pixel& p, int side) {
    return normalize(from_face(p.face, point_on_face(p, side)));
}

float ProbeCapture::solid_angle(const Pixel& p, int side) {
    const float distance = length(point_on_face(p, side));
    // The solid angle is dω = cos θ dA / r², and cos θ = 1 / r.
    return 4 / (static_cast<float>(side * side) * distance * distance * distance);
}

float ProbeCapture::distance(const Pixel& p) const {
    const GBuffer& gbuffer = faces_[p.face].gbuffer;
    const float reversed = gbuffer.reversed_depth(p.x, p.y);
    if (!(reversed > 0)) return kInfinity;
    return gbuffer.projection.near() / reversed * length(point_on_face({p.face, p.x - guard_, p.y - guard_}, side_));
}

} // namespace duet::raster
