// The report: one HTML file with everything in it, that asks the network for nothing.
#pragma once

#include "common/film/rendering.h"
#include "common/scene/scene.h"
#include "compare/hits/hit_agreement.h"

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace duet::compare {

/// What the page shows. All pictures are of one size.
struct ReportPage {
    const Scene& scene;                 ///< for the names of its objects and materials
    const Rendering &raster, &raytrace; ///< radiance is kept in half precision
    const Image<Hit>&raster_hits, &raytrace_hits;
    const HitAgreement& agreement;
    const nlohmann::json& report; ///< report.json: its figures fill the tables
};

/// The page's text: two pictures to split, flicker, subtract and zoom into, and the tables. Its state can be linked to
/// (`#mode=difference&zoom=8&x=120&y=40`). Some 8 MB at 960 × 540.
std::string report_page(const ReportPage& page);

} // namespace duet::compare
