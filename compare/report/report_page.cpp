#include "compare/report/report_page.h"

#include "compare/report/assets.h"
#include "compare/report/encode.h"

#include <functional>
#include <map>
#include <nlohmann/json.hpp>

namespace duet::compare {

namespace {

using nlohmann::json;

template <typename Pixel, typename Value>
std::string plane(const Image<Pixel>& image, int bytes, const Value& value_at) {
    std::vector<std::uint32_t> values(image.size());
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = value_at(i);
    return encode_plane(values, image.width(), bytes);
}

json picture_planes(const ImageRgb& image) {
    json planes = json::array();
    for (std::size_t c = 0; c < 3; ++c)
        planes.push_back(plane(image, 2, [&](std::size_t i) { return std::uint32_t{half_bits(image[i][c])}; }));
    return planes;
}

// The difference has planes of its own: that of two rounded numbers would be mostly rounding where they are close.
json difference_planes(const ImageRgb& a, const ImageRgb& b) {
    ImageRgb difference(a.width(), a.height());
    for (std::size_t i = 0; i < a.size(); ++i) difference[i] = a[i] - b[i];
    return picture_planes(difference);
}

// Objects are stored plus one: none becomes 0. The path tracer's hits are stored as what differs (exclusive or) from
// the rasterizer's, which is next to nothing.
std::uint32_t object_code(const Hit& hit) { return hit.object + 1; }
std::uint32_t primitive_code(const Hit& hit) { return hit.valid() ? hit.primitive : 0; }

json hit_planes(const ReportPage& page) {
    const auto &a = page.raster_hits, &b = page.raytrace_hits;
    return {
        {"object", plane(a, 4, [&](std::size_t i) { return object_code(a[i]); })},
        {"primitive", plane(a, 4, [&](std::size_t i) { return primitive_code(a[i]); })},
        {"object_change", plane(a, 4, [&](std::size_t i) { return object_code(a[i]) ^ object_code(b[i]); })},
        {"primitive_change", plane(a, 4, [&](std::size_t i) { return primitive_code(a[i]) ^ primitive_code(b[i]); })},
        {"verdict", plane(page.agreement.verdicts, 1,
                          [&](std::size_t i) { return static_cast<std::uint32_t>(page.agreement.verdicts[i]); })}};
}

/// What each object is called on the page: its name, or what it is made of.
json object_labels(const Scene& scene) {
    static constexpr const char* kKinds[] = {"sphere", "quad", "mesh"};
    json labels = json::array();
    for (const Object& object : scene.objects) {
        const std::size_t kind = scene.shapes[object.shape].index();
        const bool box = kind == 1 && primitive_count(scene.shapes[object.shape]) == 6;
        const std::string shape = box ? "box" : kKinds[kind];
        const std::uint32_t material = object.materials.empty() ? 0 : object.materials[0];
        std::string label = object.name.empty() ? shape : object.name;
        if (object.name.empty() && material < scene.material_names.size() && !scene.material_names[material].empty())
            label += " of " + scene.material_names[material];
        labels.push_back(label);
    }
    return labels;
}

/// The stages in the order they ran: [[name, seconds], …].
json stages(const Rendering& rendering) {
    json list = json::array();
    for (const auto& [name, seconds] : rendering.statistics.seconds) list.push_back({name, seconds});
    return list;
}

/// What was left out, in order: [[what, why, count or −1], …].
json skipped(const Rendering& rendering) {
    json list = json::array();
    for (const Skipped& s : rendering.statistics.skipped) list.push_back({s.what, s.why, s.count});
    return list;
}

/// The page's template with each {{mark}} replaced by its value, in one pass: what a value holds is no mark.
std::string fill_in(std::string_view page, const std::map<std::string_view, std::string_view>& values) {
    std::string text;
    for (std::size_t at = 0;;) {
        const std::size_t open = page.find("{{", at);
        text += page.substr(at, open - at);
        if (open == std::string_view::npos) return text;
        const std::size_t close = page.find("}}", open);
        DUET_CHECK(close != std::string_view::npos);
        text += values.at(page.substr(open + 2, close - open - 2));
        at = close + 2;
    }
}

std::string escape_html(const std::string& text) {
    std::string escaped;
    for (const char c : text) switch (c) {
        case '&':
            escaped += "&amp;";
            break;
        case '<':
            escaped += "&lt;";
            break;
        case '>':
            escaped += "&gt;";
            break;
        default:
            escaped += c;
        }
    return escaped;
}

/// JSON that can stand in a script element: no text in it can end the element.
std::string script_json(const json& value) {
    std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
    for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at))
        text.replace(at, 1, "\\u003c");
    return text;
}

} // namespace

std::string report_page(const ReportPage& page) {
    DUET_CHECK_EQ(page.raster.radiance.size(), page.raytrace.radiance.size());
    DUET_CHECK_EQ(page.raster.radiance.size(), page.raster_hits.size());
    DUET_CHECK_EQ(page.raster.radiance.size(), page.raytrace_hits.size());
    DUET_CHECK_EQ(page.raster.radiance.size(), page.agreement.verdicts.size());
    const std::string title = page.scene.path.filename().string();
    const json data = {{"title", title},
                       {"width", page.raster.radiance.width()},
                       {"height", page.raster.radiance.height()},
                       {"objects", object_labels(page.scene)},
                       {"raster", picture_planes(page.raster.radiance)},
                       {"raytrace", picture_planes(page.raytrace.radiance)},
                       {"difference", difference_planes(page.raster.radiance, page.raytrace.radiance)},
                       {"hits", hit_planes(page)},
                       {"stages", {{"raster", stages(page.raster)}, {"raytrace", stages(page.raytrace)}}},
                       {"skipped", {{"raster", skipped(page.raster)}, {"raytrace", skipped(page.raytrace)}}},
                       {"report", page.report}};
    const std::string escaped_title = escape_html(title), embedded = script_json(data);
    return fill_in(kReportHtml, {{"title", escaped_title}, {"css", kReportCss}, {"data", embedded}, {"js", kReportJs}});
}

} // namespace duet::compare
