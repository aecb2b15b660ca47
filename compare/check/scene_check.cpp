#include "compare/check/scene_check.h"

#include "common/image/bitwise_equal.h"
#include "common/system/error.h"
#include "compare/hits/hit_agreement.h"

namespace duet::compare {

namespace {

bool is_valid(float x) { return x >= 0; } // false for a NaN; a depth may be infinite
bool is_valid(Rgb c) { return is_valid_radiance(c); }
bool is_valid(Vec3 v) { return is_finite(v); }

template <typename Pixel> bool all_valid(const Image<Pixel>& image) {
    for (const Pixel& pixel : image)
        if (!is_valid(pixel)) return false;
    return true;
}

/// Returns the name of an image with an invalid pixel, or an empty string.
std::string invalid_image(const Rendering& rendering) {
    if (!all_valid(rendering.radiance)) return "radiance";
    if (!all_valid(rendering.depth)) return "depth";
    if (!all_valid(rendering.normal)) return "normal";
    if (!all_valid(rendering.albedo)) return "albedo";
    return all_valid(rendering.variance) ? "" : "variance";
}

CheckResult check_samples(const std::string& pipeline, const Rendering& rendering) {
    const RenderStatistics& statistics = rendering.statistics;
    if (statistics.invalid_samples > 0) {
        std::string first;
        if (const auto& sample = statistics.first_invalid)
            first = message(", the first is --pixel ", sample->x, ',', sample->y, ',', sample->sample);
        return {pipeline + ": invalid samples", message(statistics.invalid_samples, " samples", first)};
    }
    const std::string image = invalid_image(rendering);
    return image.empty() ? CheckResult{} : CheckResult{pipeline + ": invalid pixel", "of the " + image + " image"};
}

CheckResult check_hits(const Scene& scene, const View& view, const ComparisonSettings& settings) {
    Control control;
    const ComparisonSettings common{.threads = 1, .seed = settings.seed};
    const Image<Hit> raster = raster_hits(scene, common)(view, control).hit;
    const Image<Hit> raytrace = raytrace_hits(scene, common)(view, control).hit;
    const HitAgreement hits = compare_hits(scene, view, raster, raytrace, 1);
    if (hits.unexplained > 0)
        return {"unexplained hits", message(hits.unexplained, " pixels; ", hits.listed.front().describe())};
    if (hits.distance_violations > 0)
        return {"distances apart", message(hits.distance_violations, " pixels, relative difference up to ",
                                           hits.worst_distance, " at (", hits.worst_x, ", ", hits.worst_y, ")")};
    return {};
}

/// Renders with one and with three threads and checks both images. `settings` is the pipeline's own type.
template <typename Settings>
CheckResult check_rendering(const std::string& pipeline, const Scene& scene, const View& view, Settings settings) {
    settings.aovs = kAllAovs;
    const auto image = [&](int threads) {
        settings.threads = threads;
        Control control;
        return render(prepare(scene, settings), view, settings, control);
    };
    const Rendering one = image(1);
    const CheckResult samples = check_samples(pipeline, one);
    if (samples.failed()) return samples;
    return same_bits(one, image(3)) ? CheckResult{} : CheckResult{pipeline + ": bits depend on threads", "1 and 3"};
}

} // namespace

bool same_bits(const Rendering& a, const Rendering& b) {
    return bitwise_equal(a.radiance, b.radiance) && bitwise_equal(a.depth, b.depth) &&
           bitwise_equal(a.normal, b.normal) && bitwise_equal(a.albedo, b.albedo) && bitwise_equal(a.hit, b.hit) &&
           bitwise_equal(a.variance, b.variance) && bitwise_equal(a.samples, b.samples);
}

CheckResult check_scene(const Scene& scene, const ComparisonSettings& settings) {
    const View view = scene_view(scene);
    CheckResult result = check_hits(scene, view, settings);
    if (result.failed()) return result;
    result = check_rendering("raster", scene, view, raster_settings(settings));
    if (result.failed()) return result;
    return check_rendering("raytrace", scene, view, path_tracer_settings(settings));
}

} // namespace duet::compare
