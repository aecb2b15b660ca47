#include "raytrace/integrator/integrator.h"

#include "common/system/error.h"

#include <array>
#include <utility>

namespace duet::raytrace {

Integrator integrator(std::string_view name) {
    constexpr std::array<std::pair<std::string_view, Integrator>, 6> kNames{{{"path", Integrator::kPath},
                                                                             {"naive", Integrator::kNaive},
                                                                             {"direct", Integrator::kDirect},
                                                                             {"unshadowed", Integrator::kUnshadowed},
                                                                             {"normal", Integrator::kNormal},
                                                                             {"albedo", Integrator::kAlbedo}}};
    for (const auto& [known, value] : kNames)
        if (known == name) return value;
    throw Error(message("unknown integrator '", name, "': expected path, naive, direct, unshadowed, normal or albedo"));
}

RadianceFunction radiance_function(Integrator integrator) {
    switch (integrator) {
    case Integrator::kUnshadowed:
        return unshadowed_radiance;
    case Integrator::kNormal:
        return normal_color;
    case Integrator::kAlbedo:
        return albedo_color;
    case Integrator::kPath:
    case Integrator::kNaive:
    case Integrator::kDirect:
        break;
    }
    return path_radiance;
}

} // namespace duet::raytrace
