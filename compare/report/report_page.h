// This file builds the report page: one self-contained HTML file that makes no network requests.
#pragma once

#include "common/program/statistics.h"
#include "common/rendering.h"
#include "common/scene/scene.h"
#include "compare/hits/hit_agreement.h"
#include "compare/metrics/image_metrics.h"

#include <optional>
#include <string>

namespace duet::compare {

/// Holds what is known about an image that a pipeline rendered.
struct ReportRendering {
    const RenderContext& context;
    const RenderStatistics& statistics;
};

/// A ReportImage is one of the two images of the page.
struct ReportImage {
    std::string name;                              ///< name on the page: "Rasterizer", or a file name
    const ImageRgb& image;                         ///< linear; stored on the page in half precision
    std::optional<ReportRendering> rendering = {}; ///< times, approximations and skips of its rendering
};

/// Holds the primitive that each image shows in each pixel.
struct ReportHits {
    const Scene& scene; ///< provides the names of objects and materials
    const Image<Hit>&a, &b;
    const HitAgreement& agreement;
};

/// Holds the contents of the page. All images have the same size. The page omits what is not present: image files have
/// neither hits nor times.
struct ReportPage {
    std::string title;
    ReportImage a, b;                      ///< B is the reference
    const ImageMetrics& metrics;           ///< page/metrics.js describes each metric
    Encoding encoding = Encoding::kLinear; ///< encoding of the compared values; kEncoded: the page also shows 8-bit
                                           ///< values
    std::optional<ReportHits> hits = {};
    ViewTransform view = {}; ///< initial view transform; the page's controls change exposure and tone
};

/// Returns the page: two images to split, flicker, subtract and zoom, and the tables. The URL's fragment links to the
/// page's state (`#mode=difference&zoom=8&x=120&y=40`). The page takes about 9 MB for images of 960 × 540 pixels.
std::string report_page(const ReportPage& page);

} // namespace duet::compare
