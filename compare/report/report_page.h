// The report: one HTML file with everything in it, that asks the network for nothing.
#pragma once

#include "common/film/rendering.h"
#include "common/program/statistics.h"
#include "common/scene/scene.h"
#include "compare/hits/hit_agreement.h"
#include "compare/metrics/image_metrics.h"

#include <optional>
#include <string>

namespace duet::compare {

/// What is known of a picture that a pipeline has made.
struct ReportRendering {
    const RenderContext& context;
    const RenderStatistics& statistics;
};

/// One of the page's two pictures.
struct ReportSide {
    std::string name;                              ///< as the page calls it: "Rasterizer", or a file's name
    const ImageRgb& picture;                       ///< linear; the page keeps it in half precision
    std::optional<ReportRendering> rendering = {}; ///< its times, what it approximated and what it skipped
};

/// Which primitive each picture shows in each pixel.
struct ReportHits {
    const Scene& scene; ///< for the names of its objects and materials
    const Image<Hit>&a, &b;
    const HitAgreement& agreement;
};

/// What the page shows. All pictures are of one size. What isn't there has no place on the page: files have neither
/// hits nor times.
struct ReportPage {
    std::string title;
    ReportSide a, b;                       ///< B is the reference
    const ImageMetrics& metrics;           ///< page/metrics.js says what each figure means
    Encoding encoding = Encoding::kLinear; ///< what the metrics compare; kEncoded: the page shows the 8-bit values too
    std::optional<ReportHits> hits = {};
};

/// The page's text: two pictures to split, flicker, subtract and zoom into, and the tables. Its state can be linked to
/// (`#mode=difference&zoom=8&x=120&y=40`). Some 9 MB at 960 × 540.
std::string report_page(const ReportPage& page);

} // namespace duet::compare
