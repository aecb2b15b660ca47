#include "common/image/formats.h"
#include "compare/ladder/ladder_report.h"
#include "compare/report/encode.h"
#include "compare/report/false_color.h"
#include "compare/report/html.h"

#include <nlohmann/json.hpp>

namespace duet::compare {

namespace {

using nlohmann::json;

constexpr int kWidest = 640; ///< maximum width of images on the page, in pixels

/// Returns the image reduced by a box filter of `factor` × `factor` pixels, fewer at the right and lower edges.
ImageRgb reduced(const ImageRgb& image, int factor) {
    if (factor == 1) return image;
    ImageRgb small((image.width() + factor - 1) / factor, (image.height() + factor - 1) / factor);
    Image<int> counts(small.width(), small.height(), 0);
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            small(x / factor, y / factor) += image(x, y);
            ++counts(x / factor, y / factor);
        }
    for (std::size_t i = 0; i < small.size(); ++i) small[i] = small[i] / static_cast<float>(counts[i]);
    return small;
}

/// Returns the image as the source of an <img>.
std::string data_url(const ImageRgb& image, int factor) {
    return "data:image/jpeg;base64," + base64(encode_jpeg(reduced(image, factor), {.jpeg_quality = 92}));
}

std::string plane(const Image<std::uint8_t>& image) {
    return encode_plane(std::vector<std::uint32_t>(image.begin(), image.end()), image.width(), 1);
}

json rung_images(const MeasuredRung& rung, int factor) {
    json list = json::array();
    for (const MeasuredQuantity& q : rung)
        list.push_back(
            {{"raster", data_url(q.raster.image, factor)}, {"raytrace", data_url(q.raytrace.image, factor)}});
    return list;
}

json cause_colors() {
    json list = json::array();
    for (std::size_t i = 0; i < kCauseCount; ++i) list.push_back(cause_color(i));
    return list;
}

} // namespace

std::string ladder_page(const LadderResult& result, const json& report) {
    const LadderImages& images = result.images;
    const int factor = (result.view.width + kWidest - 1) / kWidest;
    const double range = difference_range(images.first, images.image(kRungCount));
    json steps = json::array(), changes = json::array(), rungs = json::array();
    for (std::size_t k = 0; k <= kRungCount; ++k) {
        steps.push_back(data_url(images.image(k), factor));
        if (k == 0) continue;
        changes.push_back(data_url(difference_image(images.image(k - 1), images.image(k), range), factor));
        rungs.push_back(rung_images(result.rungs[k - 1], factor));
    }
    const std::string title = result.scene.path.filename().string();
    return make_page(kLadderSource, title,
                     {{"title", title},
                      {"width", result.view.width},
                      {"height", result.view.height},
                      {"factor", factor},
                      {"range", range},
                      {"visible_steps", kVisibleSteps},
                      {"colors", cause_colors()},
                      {"cause", plane(result.map.cause)},
                      {"steps", plane(result.map.steps)},
                      {"pictures", steps},
                      {"changes", changes},
                      {"rungs", rungs},
                      {"report", report}});
}

} // namespace duet::compare
