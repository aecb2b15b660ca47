// This file lists the quantities and integrators that a window and the web page offer.
#pragma once

#include "compare/ladder/rungs.h"

#include <array>
#include <string>
#include <vector>

namespace duet::compare {

/// The whole image is the last of the ladder's quantities.
inline constexpr const char* kWholeImage = "everything";

/// These integrators of the path tracer can be chosen for the whole image.
inline constexpr std::array kIntegrators{raytrace::Integrator::kPath,    raytrace::Integrator::kNaive,
                                         raytrace::Integrator::kWhitted, raytrace::Integrator::kBidirectional,
                                         raytrace::Integrator::kVcm,     raytrace::Integrator::kPhotons,
                                         raytrace::Integrator::kMetropolis};

/// Returns all quantities of plan_rungs() that are colors. They do not depend on the shading and the integrator that
/// the pair's settings choose for the whole image.
std::vector<RungRenderers> color_quantities(const Scene& scene, PreparedPair pair);

} // namespace duet::compare
