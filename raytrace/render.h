// The path tracer: prepare once a scene, render once a view.
#pragma once

#include "common/camera/camera.h"
#include "common/film/rendering.h"
#include "common/sampling/pixel_filter.h"
#include "common/sampling/sampler.h"
#include "common/scene/scene.h"
#include "common/system/control.h"
#include "raytrace/acceleration/bvh_quality.h"

#include <filesystem>
#include <memory>
#include <string_view>

namespace duet::raytrace {

/// The version of what the estimators of light (path, naive, direct) converge to: part of the name under which compare
/// bench keeps its references. Raise it with every change of that (a material, a light, a filter, a mended bias), not
/// for changes of noise or speed alone. tests/raytrace/estimator_version_test.cpp notices where it was forgotten.
inline constexpr int kEstimatorVersion = 7;

enum class Integrator {
    kPath,        ///< light and BSDF sampling, combined by multiple importance sampling
    kNaive,       ///< BSDF sampling only, as book 1 of Ray Tracing in One Weekend
    kDirect,      ///< emission and direct light: path of at most one scattering event
    kUnshadowed,  ///< direct light by light sampling without visibility: the rasterizer's quantity
    kLights,      ///< parts of path: LightParts::emission and direct, Scene::lights and their shadows
    kEnvironment, ///< part of path: LightParts::environment, the environment's light on diffuse surfaces
    kReflection,  ///< part of path: LightParts::reflection, what is seen by way of metal and glass
    kNormal,      ///< the shading normal as a colour: (n + 1)/2
    kAlbedo,      ///< base colours
};
/// "path", "naive", "direct", "unshadowed", "lights", "environment", "reflection", "normal", "albedo"; throws Error for
/// another name.
Integrator integrator(std::string_view name);
std::string_view integrator_name(Integrator integrator);

struct Settings : RenderSettings {
    Settings() { samples_per_pixel = 64; }
    Integrator integrator = Integrator::kPath;
    SamplerKind sampler = SamplerKind::kSobol;
    FilterKind filter = FilterKind::kBox;
    int max_depth = 64; ///< scattering events at most: 0 = emission only, 1 = direct light
    bool russian_roulette = true;
    BvhQuality bvh = BvhQuality::kDefault; ///< for prepare(): of the hierarchies; no bit of the picture depends on it
    bool environment = true; ///< as raster::Settings::environment
    bool adaptive = false; ///< more samples where the error is; samples_per_pixel is their mean (raytrace/schedule.h)
    std::uint32_t first_sample = 0; ///< samples first_sample … first_sample + samples_per_pixel − 1: a shard of more
    std::filesystem::path film;     ///< keeps the film, and is continued where it exists (film_keeper.h); empty: none
    double film_interval = 60;      ///< seconds between two writings of it
    double time_limit = 0;   ///< seconds; stops between passes; 0: none
    double error_limit = 0;  ///< estimated relMSE; stops between passes; 0: none

    /// Whether the film has to tell its error: then samples fall into two replicates (common/sampling/sampler.h). Else
    /// all of a pixel's are spread together, which leaves less of it.
    bool knows_error() const { return adaptive || error_limit > 0 || aovs.variance; }
    std::uint32_t replicates() const { return knows_error() ? 2 : 1; }
    /// Of the samples of such a render.
    Sampler make_sampler() const { return {sampler, seed, samples_per_pixel, replicates()}; }
};

struct PreparedData; // raytrace/prepare.h

/// What one scene needs for any number of views. Refers to the scene, which must outlive it.
class Prepared {
public:
    explicit Prepared(std::shared_ptr<const PreparedData> data) : data_(std::move(data)) {}
    const PreparedData& data() const { return *data_; }

private:
    std::shared_ptr<const PreparedData> data_;
};

Prepared prepare(const Scene& scene, const Settings& settings);
/// One picture. Stopped by `control`, it returns the mean of the samples taken so far. With Settings::film it goes on from
/// there, to the same bits as in one go, and throws Error for one of another picture, or that cannot be written.
Rendering render(const Prepared& prepared, const View& view, const Settings& settings, Control& control);

/// The first hit of one ray: what the oracles and tests of hits ask for. Bit-equal to what render's camera rays get.
Hit trace(const Prepared& prepared, const Ray& ray);

} // namespace duet::raytrace
