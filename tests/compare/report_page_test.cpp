#include "compare/report/report_page.h"

#include "compare/report/report_json.h"
#include "tests/compare/test_scenes.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>

using namespace duet;
using namespace duet::compare;
using nlohmann::json;

namespace {

/// Returns the data that the page's scripts receive.
json data_of(const std::string& page) {
    const std::string begin = "<script type=\"application/json\" id=\"data\">";
    const std::size_t from = page.find(begin) + begin.size();
    return json::parse(page.substr(from, page.find("</script>", from) - from));
}

struct Page {
    Scene scene = test::empty_scene(8, 6);
    Rendering raster, raytrace;
    Image<Hit> raster_hits{8, 6}, raytrace_hits{8, 6};
    json report;
    std::string text;

    explicit Page(const std::string& object_name = "ball") {
        test::add(scene, Sphere{{0, 0, 0}, 1.0f});
        scene.objects[0].name = object_name;
        raster.radiance = ImageRgb(8, 6, Rgb(0.25f, 0.5f, 1.0f));
        raytrace.radiance = ImageRgb(8, 6, Rgb(0.5f));
        raster.statistics.seconds = {{"transform", 0.5}, {"cover", 0.25}};
        raster.statistics.approximations = {"Direct light is unshadowed."};
        raster.statistics.skipped = {{"textures", "no material has one"}, {"backfaces", "of closed meshes", 17}};
        raster_hits(4, 3) = raytrace_hits(4, 3) = {0, 0, 0, 0, 4};
        raytrace_hits(2, 2) = {0, 0, 0, 0, 4};
        const HitAgreement agreement = compare_hits(scene, {scene.camera, 8, 6}, raster_hits, raytrace_hits);
        const ImageMetrics metrics = image_metrics(raster.radiance, raytrace.radiance, Encoding::kLinear);
        report = {{"hits", hits_json(agreement, scene)}, {"metrics", metrics_json(metrics, "a", "b")}};
        const RenderContext context;
        text = report_page({"balls.json",
                            {"Rasterizer", raster.radiance, ReportRendering{context, raster.statistics}},
                            {"Path tracer", raytrace.radiance, ReportRendering{context, raytrace.statistics}},
                            metrics,
                            Encoding::kLinear,
                            ReportHits{scene, raster_hits, raytrace_hits, agreement}});
    }
    json data() const { return data_of(text); }
};

std::string without_scripts_and_styles(std::string text) {
    for (const char* const name : {"script", "style"}) {
        const std::string close = std::string("</") + name + ">", open = std::string("<") + name;
        for (std::size_t from = text.find(open); from != std::string::npos; from = text.find(open, from)) {
            const std::size_t to = text.find(close, from);
            REQUIRE(to != std::string::npos);
            text.erase(from, to + close.size() - from);
        }
    }
    return text;
}

/// Checks that every element is closed in order. Void and self-closing elements need no end tag. Returns the fault,
/// or "".
std::string tag_fault(const std::string& html) {
    const std::vector<std::string> empty = {"meta", "input", "br", "link"};
    std::vector<std::string> open;
    for (std::size_t at = html.find('<'); at != std::string::npos; at = html.find('<', at + 1)) {
        if (html[at + 1] == '!') continue;
        const std::size_t end = html.find('>', at);
        if (end == std::string::npos) return "a tag is not ended";
        const bool closing = html[at + 1] == '/';
        std::size_t name_end = at + 1 + closing;
        while (std::isalnum(static_cast<unsigned char>(html[name_end])) != 0) ++name_end;
        const std::string name = html.substr(at + 1 + closing, name_end - at - 1 - closing);
        if (std::count(html.begin() + static_cast<std::ptrdiff_t>(at), html.begin() + static_cast<std::ptrdiff_t>(end),
                       '"') %
                2 !=
            0)
            return "an attribute of " + name + " is not ended";
        if (closing) {
            if (open.empty() || open.back() != name)
                return "</" + name + "> closes <" + (open.empty() ? "" : open.back()) + ">";
            open.pop_back();
        } else if (html[end - 1] != '/' && std::find(empty.begin(), empty.end(), name) == empty.end()) {
            open.push_back(name);
        }
    }
    return open.empty() ? "" : "<" + open.back() + "> is not closed";
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("the page holds every figure of the report, the stages in their order, and what was skipped") {
        const Page page;
        const json data = page.data(), side = data["sides"][0];
        CHECK(data["metrics"]["flip"] == page.report["metrics"]["flip"]);
        CHECK(data["metrics"]["relmse"] == page.report["metrics"]["relmse"]);
        CHECK(data["hits"]["figures"] == page.report["hits"]);
        CHECK(data["width"] == 8);
        CHECK(data["height"] == 6);
        CHECK(data["title"] == "balls.json");
        CHECK(side["name"] == "Rasterizer");
        CHECK(side["rendering"]["statistics"]["approximations"] == json::parse(R"(["Direct light is unshadowed."])"));
        CHECK(side["rendering"]["stages"] == json::parse(R"([["transform", 0.5], ["cover", 0.25]])"));
        CHECK(side["rendering"]["skipped"] ==
              json::parse(R"([["textures", "no material has one", -1], ["backfaces", "of closed meshes", 17]])"));
        CHECK(data["hits"]["objects"] == json::parse(R"(["ball"])"));
        CHECK(data["flip"]["name"] == "HDR-FLIP");
        CHECK(data["flip"]["map"].is_string());
        for (const json& one : data["sides"]) CHECK(one["picture"].size() == 3);
        for (const char* const plane : {"object", "primitive", "object_change", "primitive_change", "verdict"})
            CHECK(data["hits"][plane].is_string());
    }

    TEST_CASE("two files have neither hits nor times; 8-bit ones have FLIP, not HDR-FLIP") {
        const ImageRgb a(4, 2, Rgb(0.5f)), b(4, 2, Rgb(0.25f));
        const ImageMetrics metrics = image_metrics(a, b, Encoding::kEncoded);
        const json data =
            data_of(report_page({"a against b", {"a.png", a}, {"b.png", b}, metrics, Encoding::kEncoded}));
        CHECK(data["hits"].is_null());
        CHECK(data["flip"]["name"] == "FLIP");
        CHECK(data["eight_bit"] == true);
        for (const json& side : data["sides"]) CHECK(side["rendering"].is_null());
        CHECK(data["difference_range"] == 0.5);
        CHECK(data["sides"][1]["name"] == "b.png");
    }

    TEST_CASE("the page asks the network for nothing") {
        const std::string text = Page().text;
        for (const char* const trace :
             {"http:", "https:", "src=", "@import", "url(", "fetch(", "XMLHttpRequest", "<link", "import("})
            CHECK_MESSAGE(text.find(trace) == std::string::npos, "found ", trace, " at ", text.find(trace));
    }

    TEST_CASE("the page is well-formed, complete, and has no mark left") {
        const std::string text = Page().text;
        CHECK(tag_fault(without_scripts_and_styles(text)).empty());
        CHECK(text.rfind("<!doctype html>", 0) == 0);
        for (const char* const mark : {"{{title}}", "{{css}}", "{{data}}", "{{js}}"})
            CHECK(text.find(mark) == std::string::npos);
        for (const char* const script : {"base.js", "decode.js", "paint.js", "view.js", "stage.js", "input.js",
                                         "metrics.js", "panels.js", "inspector.js", "histogram.js", "main.js"})
            CHECK_MESSAGE(text.find(script) != std::string::npos, script, " is missing");
        CHECK(tag_fault("<p><b></p>") == "</p> closes <b>"); // the check can fail
    }

    TEST_CASE("every id that the scripts ask for is there, once") {
        const std::string text = Page().text, html = without_scripts_and_styles(text);
        const std::string call = "element(\"";
        int asked = 0;
        for (std::size_t at = text.find(call); at != std::string::npos; at = text.find(call, at + 1)) {
            const std::size_t from = at + call.size();
            const std::string id = "id=\"" + text.substr(from, text.find('"', from) - from) + "\"";
            CHECK_MESSAGE(html.find(id) != std::string::npos, id, " is missing");
            CHECK_MESSAGE(html.find(id) == html.rfind(id), id, " is there twice");
            ++asked;
        }
        CHECK(asked > 20);
    }

    TEST_CASE("names from the scene cannot break out of the page") {
        const Page page("</script><script>alert(1)</script>");
        CHECK(page.text.find("alert(1)</script>") == std::string::npos);
        CHECK(page.data()["hits"]["objects"][0] == "</script><script>alert(1)</script>");
        CHECK(tag_fault(without_scripts_and_styles(page.text)).empty());
        const Page marks("{{js}} {{data}} {{css}}"); // names are data: template marks in them are not replaced
        CHECK(marks.data()["hits"]["objects"][0] == "{{js}} {{data}} {{css}}");
    }

    TEST_CASE("figures that are no numbers are null in JSON") {
        const ImageRgb a(2, 2, Rgb(0.5f));
        const json same = metrics_json(image_metrics(a, a, Encoding::kLinear), "a", "b");
        CHECK(same["psnr"].is_null());
        CHECK(same["mse"] == 0);
        CHECK(same["worst_pixel"] == json::parse("[0, 0]"));
        const ImageRgb nan(2, 2, Rgb(std::numeric_limits<float>::quiet_NaN()));
        const json none = metrics_json(image_metrics(nan, a, Encoding::kLinear), "a", "b");
        CHECK(none["mse"].is_null());
        CHECK(none["worst_pixel"].is_null());
        CHECK(none["non_finite"]["a"] == 4);
    }
}
