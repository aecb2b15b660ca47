#include "raytrace/aov.h"

#include "raytrace/integrator/vertex.h"

namespace duet::raytrace {

AovBuffers::AovBuffers(const RenderPlan& plan, const View& view, const PathTracerSettings& settings)
    : plan_(plan), forward_(CameraModel(view).pinhole().forward), requested_(settings.aovs),
      first_sample_(settings.first_sample) {
    if (requested_.depth || requested_.normal || requested_.albedo) sums_ = Image<Sums>(view.width, view.height);
    if (requested_.hit) hits_ = Image<Hit>(view.width, view.height);
}

void AovBuffers::add(int x, int y, std::uint32_t index, const Ray& ray, const Hit& hit) {
    if (requested_.hit && index == first_sample_) hits_(x, y) = hit;
    if (sums_.empty() || !hit.valid()) return;
    Sums& sums = sums_(x, y);
    ++sums.hits;
    sums.depth += static_cast<double>(hit.t) * dot(Vec3d(ray.direction), forward_);
    if (!requested_.normal && !requested_.albedo) return;
    const SurfacePoint point = camera_surface_point(plan_, ray, hit, index);
    sums.normal += Vec3d(dot(point.ng, ray.direction) > 0 ? -point.ns : point.ns);
    if (requested_.albedo)
        sums.albedo += Rgbd(base_color(plan_.scene.materials[point.material], plan_.scene.textures, point));
}

void AovBuffers::finish(const Film& film, Rendering& rendering) {
    const int width = film.width(), height = film.height();
    if (requested_.depth) rendering.depth = ImageFloat(width, height, kInfinity);
    if (requested_.normal) rendering.normal = Image<Vec3>(width, height);
    if (requested_.albedo) rendering.albedo = ImageRgb(width, height);
    for (std::size_t i = 0; i < sums_.size(); ++i) {
        const Sums& sums = sums_[i];
        if (sums.hits == 0) continue;
        const double n = sums.hits;
        if (requested_.depth) rendering.depth[i] = static_cast<float>(sums.depth / n);
        if (requested_.normal) rendering.normal[i] = Vec3(sums.normal / n);
        if (requested_.albedo) rendering.albedo[i] = Rgb(sums.albedo / n);
    }
    if (requested_.hit) rendering.hit = std::move(hits_);
    if (requested_.variance) rendering.variance = film.variance_image();
    if (requested_.samples) rendering.samples = film.samples_image();
}

std::int64_t AovBuffers::memory_bytes() const {
    return static_cast<std::int64_t>(sums_.size() * sizeof(Sums) + hits_.size() * sizeof(Hit));
}

} // namespace duet::raytrace
