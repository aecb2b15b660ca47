#include "compare/skip/skip_cases.h"

#include "raster/render.h"
#include "raytrace/render.h"

namespace duet::compare {

namespace {

// These are all AOVs except the variance, for which the path tracer would draw its samples differently.
constexpr AovSet kAllAovs{
    .depth = true, .normal = true, .albedo = true, .hit = true, .variance = false, .samples = true};

/// A SkipSwitch is a skip that a member of SkipFlags controls.
struct SkipSwitch {
    const char* name;
    bool SkipFlags::*member;
    const char* omitted;
    const char* statistic = "";
    SkipProof proof = SkipProof::kSameBits;
};

// At a silhouette, a sample that only the snapped triangles cover belongs to a front face and a back face, and rounding
// decides which is nearer. Without culling, about one pixel in 100,000 of a dense mesh may therefore show the back
// face, at the same position and distance. The bits are mostly the same; if not, the image is tested for bias.
constexpr SkipSwitch kRaster[] = {
    {"frustum", &SkipFlags::frustum, "objects and triangles that no pixel can see", "outside the frustum"},
    {"back_faces", &SkipFlags::back_faces, "back faces of closed, opaque meshes", "backfaces", SkipProof::kNoBias},
    {"subpixel", &SkipFlags::subpixel, "triangles between the samples", "sub-pixel"},
    {"degenerate", &SkipFlags::degenerate, "triangles of no area on the grid", "degenerate"},
    {"lens", &SkipFlags::lens, "a pass for each point of the lens", "lens"},
    {"motion", &SkipFlags::motion, "a pass for each moment", "motion"},
    {"environment", &SkipFlags::environment, "light of a black environment", "environment"},
};

constexpr SkipSwitch kRaytrace[] = {
    {"textures", &SkipFlags::textures, "making a material's BSDF anew at each hit", "textures"},
    {"lens", &SkipFlags::lens, "sampling the lens", "lens samples"},
    {"motion", &SkipFlags::motion, "sampling the time", "time samples"},
    {"environment", &SkipFlags::environment, "looking up a black environment", "environment"},
    {"light_samples", &SkipFlags::light_samples, "light samples that nothing sends or takes", "light samples"},
    {"mirror_light", &SkipFlags::mirror_light, "light samples at mirrors and glass"},
    {"emission", &SkipFlags::emission, "emission of surfaces where none emits"},
    {"last_bounce", &SkipFlags::last_bounce, "last rays that can find no light", "last bounce"},
    {"shadow_rays", &SkipFlags::shadow_rays, "shadow rays to light that is not reflected"},
};

/// Returns a case. set(settings, with) turns the skip on or off.
template <typename Settings, typename Prepared, typename Set>
SkipCase make_case(const char* pipeline, const SkipSwitch& s, const Prepared& prepared, const Settings& settings,
                   const Set& set) {
    return {pipeline,
            s.name,
            s.omitted,
            s.statistic,
            s.proof,
            [prepared, settings, set](const View& view, std::uint64_t seed, bool with, Control& control) {
                Settings one = settings;
                one.seed = seed;
                set(one, with);
                return render(prepared, view, one, control);
            }};
}

/// Adds the pipeline's switches and the AOVs, which are rendered only on request.
template <typename Settings, typename Prepared, std::size_t N>
void add_cases(std::vector<SkipCase>& cases, const char* pipeline, const SkipSwitch (&switches)[N],
               const Prepared& prepared, const Settings& settings) {
    for (const SkipSwitch& s : switches)
        cases.push_back(make_case(pipeline, s, prepared, settings,
                                  [member = s.member](Settings& one, bool with) { one.skips.*member = with; }));
    constexpr SkipSwitch kAuxiliary{"auxiliary", nullptr, "auxiliary images that are not requested"};
    cases.push_back(make_case(pipeline, kAuxiliary, prepared, settings,
                              [](Settings& one, bool with) { one.aovs = with ? AovSet{} : kAllAovs; }));
}

} // namespace

std::vector<SkipCase> skip_cases(const Scene& scene, const ComparisonSettings& settings) {
    std::vector<SkipCase> cases;
    const raster::RasterSettings raster = raster_settings(settings);
    add_cases(cases, "raster", kRaster, raster::prepare(scene, raster), raster);
    const raytrace::PathTracerSettings raytrace = path_tracer_settings(settings);
    const raytrace::PathTracerScene prepared = raytrace::prepare(scene, raytrace);
    add_cases(cases, "raytrace", kRaytrace, prepared, raytrace);
    constexpr SkipSwitch kRoulette{"russian_roulette", nullptr, "most of the dim paths", "", SkipProof::kNoBias};
    cases.push_back(make_case("raytrace", kRoulette, prepared, raytrace,
                              [](raytrace::PathTracerSettings& one, bool with) { one.russian_roulette = with; }));
    return cases;
}

} // namespace duet::compare
