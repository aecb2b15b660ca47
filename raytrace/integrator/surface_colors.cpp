// Implements the integrators that show surfaces without light: their normals and their base colors.
#include "raytrace/integrator/integrator.h"
#include "raytrace/integrator/vertex.h"

namespace duet::raytrace {

Rgb normal_color(const RenderPlan& plan, const Ray& ray, const Hit& hit, Sampler& sampler, RayCounts&) {
    if (!hit.valid()) return Rgb();
    const SurfacePoint point = camera_surface_point(plan, ray, hit, sampler.sample());
    const Vec3 n = dot(point.ng, ray.direction) > 0 ? -point.ns : point.ns; // this side faces the camera
    return direction_color(n);
}

Rgb albedo_color(const RenderPlan& plan, const Ray& ray, const Hit& hit, Sampler& sampler, RayCounts&) {
    if (!hit.valid()) return Rgb();
    const SurfacePoint point = camera_surface_point(plan, ray, hit, sampler.sample());
    return base_color(plan.scene.materials[point.material], plan.scene.textures, point);
}

} // namespace duet::raytrace
