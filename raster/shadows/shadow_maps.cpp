#include "raster/shadows/shadow_maps.h"

#include "raster/gbuffer/screen_projection.h"
#include "raster/prepare_limits.h"
#include "raster/visibility/depth_image.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace duet::raster {
namespace {

constexpr int kVisiblePointsWidth = 256;             ///< width in pixels of the image that finds visible points
constexpr double kGuardTexels = 4;                         ///< texels left around the fitted bounds of a view
constexpr std::int64_t kCubeTexels = 64 * (1 << 20); ///< upper limit for the sum of all cubes
constexpr std::int64_t kViewTexels = 128 * (1 << 20); ///< upper limit for the sum of all other maps
constexpr int kMinSide = 64;                          ///< texels along a side of the smallest maps
constexpr double kNearReach = 6; ///< casters nearer than this multiple of a spherical light's radius are near
constexpr double kFloor = 1e-4; ///< objects may penetrate a floor by this fraction of the scene's size

/// Returns whether the object is a quad with the whole scene and the sun on one side. Such a quad casts no shadow, so
/// views need not cover it.
bool is_floor(const Scene& scene, std::uint32_t object, Vec3 sun_direction) {
    const Object& o = scene.objects[object];
    const auto* list = std::get_if<QuadList>(&scene.shapes[o.shape]);
    if (list == nullptr || list->quads.size() != 1 || o.moving) return false;
    const Quad& quad = list->quads.front();
    const Vec3d p = transform_point(Mat4d(o.to_world), Vec3d(quad.corner));
    const Vec3d u = transform_vector(Mat4d(o.to_world), Vec3d(quad.u)), v =
        transform_vector(Mat4d(o.to_world), Vec3d(quad.v));
    Vec3d n = normalize(cross(u, v));
    if (dot(n, Vec3d(sun_direction)) > 0) n = -n;
    const Box3& box = scene.bounds;
    double lowest = 0;
    for (unsigned corner = 0; corner < 8; ++corner) lowest = min(lowest, dot(n, Vec3d(box.corner(corner)) - p));
    return lowest > -kFloor * length(Vec3d(box.diagonal()));
}

bool is_sun(const Light& light) { return std::holds_alternative<SunLight>(light); }

/// Returns the points that the scene's camera sees, from a low-resolution depth image.
std::vector<VisiblePoint> visible_points(const RasterSceneData& data, int threads) {
    const Scene& scene = data.scene;
    const double aspect = static_cast<double>(scene.height) / scene.width;
    const View view{scene.camera, kVisiblePointsWidth,
                    static_cast<int>(std::clamp(kVisiblePointsWidth * aspect, 1.0, 4.0 * kVisiblePointsWidth))};
    const ScreenProjection projection(CameraModel(view).pinhole(), {});
    const ImageFloat reversed_depth = render_depth(data, view, threads);
    std::vector<VisiblePoint> result;
    for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x)
            if (const float reversed = reversed_depth(x, y); reversed > 0) {
                const Vec3 p = projection.point(static_cast<float>(x), static_cast<float>(y), reversed);
                result.push_back({projection.absolute(p),
                                  static_cast<double>(projection.pixel_size(projection.near() / reversed))});
            }
    return result;
}

std::vector<SurfaceLight> surface_lights(const Scene& scene, const std::vector<std::size_t>& lights) {
    std::vector<SurfaceLight> result;
    for (const std::size_t i : lights) result.push_back(std::get<SurfaceLight>(scene.lights[i]));
    return result;
}

/// Returns the light's plane, rounded, as a key that groups coplanar primitives of one object.
std::array<long, 4> plane_key(const SurfaceLight& light, double scene_size) {
    const Emitter e = Emitter::of(light);
    const auto rounded = [](double x) { return std::lround(x * 1e3); };
    return {rounded(e.normal.x), rounded(e.normal.y), rounded(e.normal.z),
            rounded(dot(e.normal, e.center) / scene_size * 10)};
}

/// Splits a parallelogram into n × n equal ones; a triangle or a sphere stays whole.
std::vector<Emitter> pieces(const Emitter& emitter, int n) {
    if (emitter.kind != Emitter::Kind::kParallelogram || n == 1) return {emitter};
    std::vector<Emitter> result(static_cast<std::size_t>(n * n), emitter);
    for (int i = 0; i < n * n; ++i) {
        Emitter& piece = result[static_cast<std::size_t>(i)];
        piece.center = emitter.center + emitter.u * ((i % n + 0.5) / n - 0.5) + emitter.v * ((i / n + 0.5) / n - 0.5);
        piece.u = emitter.u / static_cast<double>(n), piece.v = emitter.v / static_cast<double>(n);
    }
    return result;
}

} // namespace

Shadows::Shadows(const RasterSceneData& data, const RasterSettings& settings)
    : scene_(data.scene), scene_size_(static_cast<double>(length(data.scene.bounds.diagonal())) + 1e-30),
      side_(PrepareLimits(data.scene).shadow_map_side(settings.shadow_map_side)), cube_side_(side_ / 2) {
    sources_ = find_sources(data, settings.shadow_cells);
    const Camera& camera = scene_.camera;
    const bool moving = scene_.needs.motion && settings.samples_per_pixel > 1 &&
        camera.shutter_open != camera.shutter_close;
    for (int i = 0; i < (moving ? kMoments : 1); ++i)
        moments_.push_back(moving ? camera.shutter_open + (camera.shutter_close - camera.shutter_open) *
                           (i + 0.5) / kMoments
                                  : camera.shutter_open);
    std::vector<VisiblePoint> visible;
    if (data.sun || std::ranges::any_of(scene_.lights, is_sun)) visible = visible_points(data, settings.threads);
    fit_sides(data, visible);
    source_of_.assign(data.light_count(), sources_.size());
    for (std::size_t i = 0; i < sources_.size(); ++i) {
        for (const std::size_t light : sources_[i].lights) source_of_[light] = i;
        const std::vector<Camera> views = views_of(data, visible, sources_[i]);
        for (const double moment : moments_)
            sources_[i].moments.push_back(draw(data, settings, views, sources_[i], moment));
    }
}

/// Returns the cameras of the maps of suns and of sufficiently narrow spots, which are the same at all moments. Other
/// lights use cubes. A sun without casters has no maps.
std::vector<Camera> Shadows::views_of(const RasterSceneData& data, const std::vector<VisiblePoint>& visible,
                                      const Source& source) const {
    const Light light = data.light(source.lights.front());
    if (const auto* spot = std::get_if<SpotLight>(&light)) return spot_views(*spot, scene_size_, side_, kGuardTexels);
    const auto* sun = std::get_if<SunLight>(&light);
    if (sun == nullptr) return {};
    Box3 bounds;
    for (std::uint32_t i = 0; i < scene_.objects.size(); ++i)
        if (!is_floor(scene_, i, sun->direction)) bounds.extend(data.objects[i].bounds);
    if (bounds.empty()) return {};
    return sun_views(*sun, static_cast<double>(source.sine), bounds, scene_.camera, visible, side_, kGuardTexels);
}

/// Halves the resolution of the maps until they take at most kViewTexels and kCubeTexels.
void Shadows::fit_sides(const RasterSceneData& data, const std::vector<VisiblePoint>& visible) {
    std::size_t views = 0, cubes = 0;
    for (const Source& source : sources_) {
        const std::size_t its_views = views_of(data, visible, source).size();
        views += its_views;
        if (its_views == 0 && !is_sun(data.light(source.lights.front())))
            cubes += std::max<std::size_t>(source.cells.size(), 1);
    }
    const auto fit = [&](int& side, std::size_t maps, std::int64_t most) {
        const auto all = static_cast<std::int64_t>(maps * moments_.size());
        while (side > kMinSide && all * side * side > most) side = std::max(side / 2, kMinSide), coarser_ = true;
    };
    fit(side_, views, kViewTexels);
    fit(cube_side_, 6 * cubes, kCubeTexels);
}

std::vector<Shadows::Source> Shadows::find_sources(const RasterSceneData& data, int cells) {
    const Scene& scene = data.scene;
    const auto only_emits = [&](std::uint32_t object) { return std::ranges::binary_search(data.emitters, object); };
    std::vector<Source> sources;
    std::map<std::pair<std::uint32_t, std::array<long, 4>>, std::vector<std::size_t>> groups;
    for (std::size_t i = 0; i < data.light_count(); ++i) {
        const Light light = data.light(i);
        const auto* surface = std::get_if<SurfaceLight>(&light);
        if (surface == nullptr) {
            sources.push_back({{i}, {}, false, i < scene.lights.size() ? 0 : data.sun->sine, {}});
        } else {
            const bool emits_only = only_emits(surface->object);
            groups[{surface->object, emits_only ? std::array<long, 4>{} : plane_key(*surface, scene_size_)}].push_back(
                i);
        }
    }
    for (auto& [key, lights] : groups) {
        const std::vector<SurfaceLight> surfaces = surface_lights(scene, lights);
        sources.push_back({std::move(lights), pieces(Emitter::of(surfaces), cells), only_emits(key.first), 0, {}});
    }
    if (sources.size() <= kMaxSources) return sources;
    const float radius = static_cast<float>(scene_size_ / 2);
    const auto power = [&](const Source& source) {
        float sum = 0;
        for (const std::size_t i : source.lights) sum += light_power(data.light(i), radius);
        return sum;
    };
    std::stable_sort(sources.begin(), sources.end(),
                     [&](const Source& a, const Source& b) { return power(a) > power(b); });
    for (std::size_t i = kMaxSources; i < sources.size(); ++i) unshadowed_ += sources[i].lights.size();
    sources.resize(kMaxSources);
    return sources;
}

Shadows::Maps Shadows::draw(const RasterSceneData& data, const RasterSettings& settings, std::span<const Camera> views,
                            const Source& source, double moment) const {
    Maps maps;
    for (Camera camera : views) {
        camera.shutter_open = camera.shutter_close = moment;
        maps.sharp.emplace_back(data, camera, side_, settings.threads, kNoObject);
    }
    for (const Emitter& cell : source.cells)
        maps.soft.emplace_back(draw_cell(data, source, cell, moment, settings.threads), cell);
    const Light light = data.light(source.lights.front());
    const auto* spot = std::get_if<SpotLight>(&light);
    const auto* point = std::get_if<PointLight>(&light);
    if (!views.empty() || (spot == nullptr && point == nullptr)) return maps;
    const Vec3d center(spot != nullptr ? spot->position : point->position);
    CubeMap cube = draw_cube(data, kNoObject, center, nullptr, true, moment, cube_side_, 0, settings.threads);
    for (auto& face : cube.faces) maps.sharp.push_back(std::move(*face));
    return maps;
}

std::int64_t Shadows::memory_bytes() const {
    std::size_t sum = 0;
    for (const Source& source : sources_)
        for (const Maps& maps : source.moments) {
            for (const ShadowMap& map : maps.sharp) sum += map.reversed_depth().size() * sizeof(float);
            for (const SoftShadowMap& map : maps.soft) sum += map.memory_bytes();
        }
    return static_cast<std::int64_t>(sum);
}

CellMaps Shadows::draw_cell(const RasterSceneData& data, const Source& source, const Emitter& cell,
                            double moment, int threads) const {
    const auto& surface = std::get<SurfaceLight>(scene_.lights[source.lights.front()]);
    const bool flat = cell.kind != Emitter::Kind::kSphere;
    // Other objects may lie in the light's plane, so the camera is placed slightly in front of it.
    const double before = flat && !surface.two_sided ? 1e-3 * std::sqrt(length(cross(cell.u, cell.v))) : 0;
    const auto draw_from = [&](Vec3d offset, int side, double near) {
        return draw_cube(data, source.emits_only ? surface.object : kNoObject,
                         cell.center + cell.normal * before + offset, flat ? &cell : nullptr, surface.two_sided, moment,
                         side, near, threads);
    };
    CellMaps maps{draw_from({}, cube_side_ / 2, 0), {}, {}, static_cast<float>(kNearReach * cell.radius)};
    if (flat || !near_casters_surround(maps.all, maps.reach)) return maps;
    maps.distant = draw_from({}, cube_side_ / 2, static_cast<double>(maps.reach));
    maps.near_visibility =
        near_visibility(cell.radius, maps.reach, [&](Vec3d offset) { return draw_from(offset, kMinSide, 0); });
    return maps;
}

CubeMap Shadows::draw_cube(const RasterSceneData& data, std::uint32_t excluded, Vec3d center, const Emitter* plane,
                           bool back, double moment, int side, double near, int threads) const {
    CubeMap cube;
    cube.center = Vec3d(Vec3(center)); // rounded in the same way as in the camera
    if (plane != nullptr) cube.frame = frame_from_normal(plane->normal);
    std::vector<Camera> views = cube_views(cube.center, cube.frame, scene_size_, side, CubeMap::kGuard);
    for (std::size_t i = 0; i < views.size(); ++i) {
        if (i == 5 && plane != nullptr && !back) continue;
        views[i].shutter_open = views[i].shutter_close = moment;
        views[i].near = near;
        cube.faces[i] = std::make_unique<ShadowMap>(data, views[i], side, threads, excluded);
    }
    cube.near = static_cast<float>(cube.faces[0]->near());
    cube.middle = static_cast<float>(side) / 2;
    cube.scale = cube.middle - static_cast<float>(CubeMap::kGuard);
    return cube;
}

std::vector<std::optional<Mat4d>> Shadows::motions(float time) const {
    if (moments_.size() == 1) return {};
    std::vector<std::optional<Mat4d>> result(scene_.objects.size());
    const auto moment = static_cast<float>(moments_[moment_at(time)]);
    for (std::size_t i = 0; i < result.size(); ++i) {
        if (!scene_.objects[i].moving) continue;
        const ObjectTransform now = object_transform(scene_.objects[i], time),
                              then = object_transform(scene_.objects[i], moment);
        result[i] = Mat4d(then.to_world) * Mat4d(now.to_object);
    }
    return result;
}

std::size_t Shadows::moment_at(float time) const {
    if (moments_.size() == 1) return 0;
    const double open = scene_.camera.shutter_open, close = scene_.camera.shutter_close;
    return static_cast<std::size_t>(
        std::clamp((static_cast<double>(time) - open) / (close - open) * kMoments, 0.0, kMoments - 1.0));
}

MapsAtTime::MapsAtTime(const Shadows& shadows, const Vec3d& eye, float time)
    : shadows_(shadows), moment_(shadows.moment_at(time)) {
    for (const Shadows::Source& source : shadows.sources()) {
        std::vector<SharpShadowMap>& maps = sharp_.emplace_back();
        for (const ShadowMap& map : source.moments[moment_].sharp) maps.emplace_back(map, eye);
    }
}

} // namespace duet::raster
