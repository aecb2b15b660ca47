#include "raytrace/pixel_debug.h"

#include "common/system/error.h"
#include "raytrace/integrator/integrator.h"
#include "raytrace/integrator/path_log.h"
#include "raytrace/render_pass.h"

#include <charconv>
#include <iomanip>

namespace duet::raytrace {

namespace {

std::string text_of(Vec3 v) {
    std::ostringstream out;
    out << std::setprecision(9) << '(' << v.x << ", " << v.y << ", " << v.z << ')';
    return out.str();
}

bool is_path(Integrator integrator) {
    return integrator == Integrator::kPath || integrator == Integrator::kNaive || integrator == Integrator::kDirect;
}

} // namespace

SampleId parse_sample_id(const std::string& text) {
    std::array<std::uint32_t, 3> values{};
    const char* at = text.data();
    const char* const end = at + text.size();
    std::size_t count = 0;
    for (; count < values.size(); ++count) {
        const auto [next, error] = std::from_chars(at, end, values[count]);
        if (error != std::errc() || values[count] > 1u << 24) break;
        at = next;
        if (at == end || *at != ',') {
            ++count;
            break;
        }
        ++at;
    }
    if (at != end || text.empty() || text.back() == ',' || count < 2)
        throw Error(message("--pixel: found ", text, ", expected x,y or x,y,sample such as 12,34,0"));
    return {static_cast<int>(values[0]), static_cast<int>(values[1]), values[2]};
}

std::string debug_pixel(const PathTracerScene& prepared, const View& view, const PathTracerSettings& settings,
                        const SampleId& id) {
    const auto [x, y, index] = id;
    if (x >= view.width || y >= view.height)
        throw Error(message("--pixel: found ", x, ',', y, ", expected a pixel of the image of ", view.width, " x ",
                            view.height));
    const RenderPlan plan(prepared.data(), view, settings);
    Sampler sampler = settings.make_sampler();
    sampler.start(x, y, index);
    const Ray ray = camera_ray(plan, CameraModel(view), x, y, sampler);
    const Hit hit = plan.prepared.accelerator.closest(ray);
    std::ostringstream out;
    out << "pixel " << x << "," << y << ", sample " << index << " of " << sampler_name(settings.sampler) << ", seed "
        << settings.seed << "\ncamera ray from " << text_of(ray.origin) << " toward " << text_of(ray.direction)
        << ", from t " << ray.t_min << " on, time " << ray.time << "\n";
    Rgb radiance;
    if (is_path(settings.integrator)) {
        PathLog log(plan.scene);
        radiance = logged_path_radiance(plan, ray, hit, sampler, log);
        out << log.text();
    } else {
        RayCounts counts;
        if (hit.valid())
            out << "hits object " << hit.object << ", primitive " << hit.primitive << " at t " << hit.t << "\n";
        else
            out << "hits nothing\n";
        radiance = radiance_function(settings.integrator)(plan, ray, hit, sampler, counts);
    }
    out << "\n" << integrator_name(settings.integrator) << ": " << std::setprecision(9) << radiance.r << ' '
        << radiance.g << ' ' << radiance.b << "\n";
    if (!is_valid_radiance(radiance)) out << "invalid: the image leaves this sample out\n";
    return out.str();
}

} // namespace duet::raytrace
