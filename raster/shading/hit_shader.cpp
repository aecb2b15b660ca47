#include "raster/shading/hit_shader.h"

#include "raster/gbuffer/gbuffer_pass.h"
#include "raster/raster_scene.h"

#include "common/camera/camera.h"

namespace duet::raster {

HitShader::HitShader(const RasterSceneData& data, const View& view, const RasterSettings& settings)
    : data_(data), settings_(settings), projection_(CameraModel(view).pinhole(), {}),
      time_(static_cast<float>(view.camera.shutter_open)) {
    settings_.fog = false;
    frame_.start(data_.scene, projection_, view.width, view.height);
    frame_.gbuffer->position = Planes3(view.width, view.height);
    clear(*frame_.gbuffer, frame_.radiance);
}

void HitShader::set(int x, int y, const Ray& ray, const SurfacePoint& point, const Bsdf& bsdf) {
    const Vec3 p = projection_.relative(Vec3d(point.p));
    const float near = projection_.near(), depth = projection_.homogeneous(p)[2];
    store_surface(data_.scene, {point, bsdf, -ray.direction, near / max(depth, near)}, settings_.components.emission, x,
                  y, *frame_.gbuffer, frame_.radiance);
    frame_.gbuffer->position.set_at(x, y, p);
}

void HitShader::set(int x, int y, const Ray& ray, const Hit& hit, const RayFootprint* footprint) {
    if (hit.valid()) {
        const SurfacePoint point = surface_point(data_.scene, ray, hit, footprint);
        return set(x, y, ray, point, bsdf_at(data_.scene.materials[point.material], data_.scene.textures, point));
    }
    GBuffer& gbuffer = *frame_.gbuffer;
    gbuffer.reversed_depth(x, y) = 0, gbuffer.object(x, y) = gbuffer.material(x, y) = -1;
    gbuffer.position.set_at(x, y, ray.direction); // the background is sampled in this direction
    frame_.radiance.set_at(x, y, Rgb());
}

LightComponentImages HitShader::shade() {
    frame_.seconds.clear();
    LightComponentImages result;
    shade_gbuffer(data_, settings_, {.time = time_, .components = &result}, frame_);
    if (!settings_.indirect_light) return result;
    RasterSettings sky = settings_;
    sky.indirect_light = false;
    sky.components = {.emission = false, .direct = false, .environment = settings_.components.environment,
                      .reflection = false};
    frame_.radiance.fill(0);
    shade_gbuffer(data_, sky, {.time = time_, .background = false}, frame_);
    result.indirect = Planes3(frame_.radiance.x.width(), frame_.radiance.x.height());
    for_each_batch(result.indirect.x.width(), result.indirect.x.height(), settings_.threads, [&](int x, int y) {
        result.indirect.set(x, y, result.environment.color(x, y) - frame_.radiance.color(x, y));
    });
    result.environment = frame_.radiance;
    return result;
}

} // namespace duet::raster
