#include "raytrace/integrator/path_log.h"

#include "common/system/error.h"

#include <iomanip>

namespace duet::raytrace {

namespace {

std::string text_of(float x, float y, float z) {
    std::ostringstream out;
    out << std::setprecision(7) << '(' << x << ", " << y << ", " << z << ')';
    return out.str();
}
std::string text_of(Vec3 v) { return text_of(v.x, v.y, v.z); }
std::string text_of(Rgb c) { return text_of(c.r, c.g, c.b); }

std::string object_name(const Scene& scene, std::uint32_t object) {
    const std::string& name = scene.objects[object].name;
    return name.empty() ? message("object ", object) : message("object ", object, " «", name, "»");
}

std::string light_name(const Scene& scene, std::int64_t index) {
    if (index < 0) return "the environment";
    struct {
        const Scene& scene;
        std::string operator()(const PointLight&) const { return "a point light"; }
        std::string operator()(const SpotLight&) const { return "a spot light"; }
        std::string operator()(const SunLight&) const { return "a sun"; }
        std::string operator()(const SurfaceLight& light) const {
            return message(object_name(scene, light.object), ", primitive ", light.primitive);
        }
    } const name{scene};
    return message("light ", index, " (", std::visit(name, scene.lights[static_cast<std::size_t>(index)]), ')');
}

} // namespace

void PathLog::vertex(const Vertex& vertex, const Hit& hit, int depth) {
    const SurfacePoint& point = vertex.point;
    out_ << "\nvertex " << depth << ": " << object_name(scene_, hit.object) << ", primitive " << hit.primitive
         << ", material «" << scene_.material_names[point.material] << "»\n"
         << "  hit          t " << hit.t << ", u " << hit.u << ", v " << hit.v << "\n"
         << "  point        " << text_of(point.p) << ", off by at most " << text_of(point.p_error) << "\n"
         << "  normals      geometric " << text_of(point.ng) << ", shading " << text_of(point.ns) << "\n"
         << "  seen from    " << (vertex.wo.z < 0 ? "the back" : "the front") << ", cosine " << vertex.wo.z << "\n";
}

void PathLog::medium_vertex(const MediumVertex& vertex, int depth) {
    out_ << "\nvertex " << depth << ": in a medium\n"
         << "  point        " << text_of(vertex.p) << "\n";
}

void PathLog::walk(const SolidExit& exit) {
    out_ << "\nthe path leaves the solid after " << exit.collisions
         << (exit.collisions == 1 ? " collision\n" : " collisions\n");
}

void PathLog::escape(const Ray& ray, int depth) {
    out_ << "\nvertex " << depth << ": none, the ray escapes toward " << text_of(ray.direction) << "\n";
}

void PathLog::light_found(Rgb emission, float weight, Rgb light) {
    out_ << "  emits        " << text_of(emission) << ", weight " << weight << ": adds " << text_of(light) << "\n";
}

void PathLog::no_light_sample(const char* why) { out_ << "  light sample none: " << why << "\n"; }

void PathLog::light_sample(const LightLiSample& light_sample, Rgb scattered, bool visible, float weight, Rgb light) {
    out_ << "  light sample " << light_name(scene_, light_sample.light) << " toward " << text_of(light_sample.wi)
         << ", distance " << light_sample.distance << ", density " << light_sample.pdf
         << (light_sample.delta ? " (from this direction only)" : "") << "\n               scatters "
         << text_of(scattered)
         << (visible ? message(", weight ", weight, ": adds ", text_of(light)) : ", hidden: adds nothing") << "\n";
}

void PathLog::scattered(const BsdfSample& sample, const Ray& next, const PathState& state) {
    out_ << "  scatters     toward " << text_of(next.direction) << (sample.transmitted ? ", through the surface" : "")
         << (sample.specular ? ", as a mirror or lens does" : message(", density ", sample.pdf)) << "\n"
         << "               weight " << text_of(sample.weight) << ", throughput " << text_of(state.throughput)
         << ", next ray from " << text_of(next.origin) << "\n";
}

void PathLog::roulette(float probability, bool survived) {
    out_ << "  roulette     " << (survived ? "survives" : "ends") << " with a chance of "
         << (survived ? probability : 1 - probability) << "\n";
}

void PathLog::end(const char* why) { out_ << "  the path ends: " << why << "\n"; }

} // namespace duet::raytrace
