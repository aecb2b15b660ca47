#include "compare/report/report_page.h"

#include "compare/report/encode.h"
#include "compare/report/false_color.h"
#include "compare/report/html.h"
#include "compare/report/report_json.h"

#include <algorithm>
#include <cmath>
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

// The difference is encoded by itself, because the difference of two rounded images would be mostly rounding
// error where they are close.
json difference_planes(const ImageRgb& a, const ImageRgb& b) {
    ImageRgb difference(a.width(), a.height());
    for (std::size_t i = 0; i < a.size(); ++i) difference[i] = a[i] - b[i];
    return encode_image(difference);
}

/// Encodes the FLIP map in steps of 1/4095. Twelve bits exceed what the eye distinguishes. The code 4096 stands
/// for NaN.
json flip_json(const ReportPage& page) {
    const ImageFloat& map = page.metrics.flip.map;
    const auto code = [&](std::size_t i) {
        return std::isnan(map[i]) ? 4096u
                                  : static_cast<std::uint32_t>(std::lround(std::clamp(map[i], 0.0f, 1.0f) * 4095));
    };
    return {{"name", page.encoding == Encoding::kEncoded ? "FLIP" : "HDR-FLIP"}, {"map", plane(map, 2, code)}};
}

// Objects are stored plus one, so that a miss becomes 0. B's hits are stored as the exclusive or with A's,
// which is almost always 0.
std::uint32_t object_code(const Hit& hit) { return hit.object + 1; }
std::uint32_t primitive_code(const Hit& hit) { return hit.valid() ? hit.primitive : 0; }

/// Returns a label for each object: its name, or its shape and material.
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

json hits_of(const ReportHits& hits) {
    const auto &a = hits.a, &b = hits.b;
    return {
        {"figures", hits_json(hits.agreement, hits.scene)},
        {"objects", object_labels(hits.scene)},
        {"object", plane(a, 4, [&](std::size_t i) { return object_code(a[i]); })},
        {"primitive", plane(a, 4, [&](std::size_t i) { return primitive_code(a[i]); })},
        {"object_change", plane(a, 4, [&](std::size_t i) { return object_code(a[i]) ^ object_code(b[i]); })},
        {"primitive_change", plane(a, 4, [&](std::size_t i) { return primitive_code(a[i]) ^ primitive_code(b[i]); })},
        {"verdict", plane(hits.agreement.verdicts, 1,
                          [&](std::size_t i) { return static_cast<std::uint32_t>(hits.agreement.verdicts[i]); })}};
}

/// Returns the statistics of a rendering, the stages [[name, seconds], …], and the skips [[what, why, count or
/// −1], …] in the order in which they occurred.
json rendering_json(const ReportRendering& rendering) {
    json stages = json::array(), skipped = json::array();
    for (const auto& [name, seconds] : rendering.statistics.seconds) stages.push_back({name, seconds});
    for (const SkippedWork& s : rendering.statistics.skipped) skipped.push_back({s.what, s.why, s.count});
    return {{"statistics", statistics_json(rendering.context, rendering.statistics)},
            {"stages", stages},
            {"skipped", skipped}};
}

json side_json(const ReportImage& side) {
    return {{"name", side.name},
            {"picture", encode_image(side.image)},
            {"rendering", side.rendering ? rendering_json(*side.rendering) : json(nullptr)}};
}

/// Returns the tone curves by name: the matrices of ToneMapping, and a table of the curve that the page interpolates.
/// Its steps of 1/32 of a stop are finer than a code of the display.
json tones_json() {
    constexpr int kLow = -20, kHigh = 20, kStepsPerStop = 32;
    json tones = json::object();
    for (const auto& [name, tone] : kTones.entries) {
        const ToneMapping& mapping = tone_mapping(tone);
        std::vector<float> curve;
        for (int k = kLow * kStepsPerStop; k <= kHigh * kStepsPerStop; ++k)
            curve.push_back(mapping.curve(std::exp2(static_cast<float>(k) / kStepsPerStop)));
        tones[std::string(name)] = {
            {"inset", mapping.inset}, {"outset", mapping.outset}, {"curve", curve}, {"log2_range", {kLow, kHigh}}};
    }
    return tones;
}

template <typename Pixel> void check_size(const Image<Pixel>& image, const ReportPage& page) {
    DUET_CHECK_EQ(image.width(), page.a.image.width());
    DUET_CHECK_EQ(image.height(), page.a.image.height());
}

} // namespace

std::string report_page(const ReportPage& page) {
    check_size(page.b.image, page);
    check_size(page.metrics.flip.map, page);
    if (page.hits) {
        check_size(page.hits->a, page);
        check_size(page.hits->b, page);
        check_size(page.hits->agreement.verdicts, page);
    }
    const json data = {{"title", page.title},
                       {"width", page.a.image.width()},
                       {"height", page.a.image.height()},
                       {"eight_bit", page.encoding == Encoding::kEncoded},
                       {"tones", tones_json()},
                       {"tone", kTones.name(page.view.tone)},
                       {"exposure", page.view.exposure},
                       {"sides", {side_json(page.a), side_json(page.b)}},
                       {"difference", difference_planes(page.a.image, page.b.image)},
                       {"difference_range", difference_range(page.a.image, page.b.image)},
                       {"metrics", metrics_json(page.metrics, "A", "B")},
                       {"flip", flip_json(page)},
                       {"hits", page.hits ? hits_of(*page.hits) : json(nullptr)}};
    return make_page(kReportSource, page.title, data);
}

} // namespace duet::compare
