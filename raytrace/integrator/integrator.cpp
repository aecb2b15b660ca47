#include "raytrace/integrator/integrator.h"

#include "common/system/name_table.h"

namespace duet::raytrace {

namespace {

constexpr NameTable<Integrator, 14> kNames{"integrator",
                                           {{{"path", Integrator::kPath},
                                             {"naive", Integrator::kNaive},
                                             {"bidirectional", Integrator::kBidirectional},
                                             {"vcm", Integrator::kVcm},
                                             {"photons", Integrator::kPhotons},
                                             {"metropolis", Integrator::kMetropolis},
                                             {"whitted", Integrator::kWhitted},
                                             {"direct", Integrator::kDirect},
                                             {"unshadowed", Integrator::kUnshadowed},
                                             {"lights", Integrator::kLights},
                                             {"environment", Integrator::kEnvironment},
                                             {"reflection", Integrator::kReflection},
                                             {"normal", Integrator::kNormal},
                                             {"albedo", Integrator::kAlbedo}}}};

} // namespace

Integrator integrator(std::string_view name) { return kNames.value(name); }

std::string_view integrator_name(Integrator integrator) { return kNames.name(integrator); }

RadianceFunction radiance_function(Integrator integrator) {
    switch (integrator) {
    case Integrator::kWhitted:
        return whitted_radiance;
    case Integrator::kUnshadowed:
        return unshadowed_radiance;
    case Integrator::kLights:
        return lights_radiance;
    case Integrator::kEnvironment:
        return environment_radiance;
    case Integrator::kReflection:
        return reflection_radiance;
    case Integrator::kNormal:
        return normal_color;
    case Integrator::kAlbedo:
        return albedo_color;
    case Integrator::kPath:
    case Integrator::kNaive:
    case Integrator::kDirect:
        return path_radiance;
    case Integrator::kBidirectional:
    case Integrator::kVcm:
    case Integrator::kPhotons:
    case Integrator::kMetropolis: // light paths reach other pixels; see render_bidirectional_pass()
        break;
    }
    throw Error(message("the integrator ", integrator_name(integrator),
                        " renders whole images only: expected another for a single sample"));
}

void radiances(Integrator integrator, const RenderPlan& plan, std::span<Ray> rays, std::span<Hit> hits,
               std::span<Sampler> samplers, std::span<Rgb> radiances, RayCounts& counts) {
    const RadianceFunction function = radiance_function(integrator);
    if (function == path_radiance) return path_radiances(plan, rays, hits, samplers, radiances, counts);
    for (std::size_t i = 0; i < rays.size(); ++i) radiances[i] = function(plan, rays[i], hits[i], samplers[i], counts);
}

} // namespace duet::raytrace
