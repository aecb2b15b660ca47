// Defines the settings of the path tracer.
#pragma once

#include "common/rendering.h"
#include "raytrace/sampling/pixel_filter.h"
#include "raytrace/sampling/sampler.h"

#include <filesystem>
#include <string_view>

namespace duet::raytrace {

/// This is the version of the values that the estimators of light (path, naive, direct) converge to. It is part of the
/// name under which compare bench stores its references. It must be raised with every change of these values (a
/// material, a light, a filter, a corrected bias), but not for changes of noise or speed alone.
/// tests/raytrace/estimator_version_test.cpp fails if it was forgotten.
inline constexpr int kEstimatorVersion = 7;

enum class Integrator {
    kPath,          ///< light samples and BSDF samples, combined by multiple importance sampling
    kNaive,         ///< BSDF sampling only, as in book 1 of Ray Tracing in One Weekend
    kBidirectional, ///< paths from the camera and from the lights, joined: Veach 1997, §10
    kVcm,           ///< bidirectional, with merging of vertices that nearly meet: Georgiev et al. 2012
    kPhotons,       ///< progressive photon mapping: Hachisuka and Jensen 2009
    kMetropolis,    ///< Markov chains of bidirectional paths: Veach and Guibas 1997, Kelemen et al. 2002
    kWhitted,       ///< mirrors, glass and hard shadows, without light between surfaces: Whitted 1980
    kDirect,        ///< emission and direct light: paths of at most one scattering event
    kUnshadowed,    ///< direct light by light sampling without visibility: the rasterizer's quantity
    kLights,        ///< component of path: emission, direct light of Scene::lights and its shadows (LightComponents)
    kEnvironment,   ///< component of path: the environment's light on diffuse surfaces (LightComponents)
    kReflection,    ///< component of path: light through metal and glass at the first hit (LightComponents)
    kNormal,        ///< the shading normal as a color: (n + 1)/2
    kAlbedo,        ///< base colors
};
/// Returns the integrator named "path", "naive", "bidirectional", "vcm", "photons", "metropolis", "whitted", "direct",
/// "unshadowed", "lights", "environment", "reflection", "normal" or "albedo". Throws Error for any other name.
Integrator integrator(std::string_view name);
/// Returns the name that integrator() accepts for an integrator.
std::string_view integrator_name(Integrator integrator);
/// Returns whether some paths start at the lights, so that a sample may reach other pixels than its own.
inline bool traces_light_paths(Integrator integrator) {
    return integrator == Integrator::kBidirectional || integrator == Integrator::kVcm ||
           integrator == Integrator::kPhotons || integrator == Integrator::kMetropolis;
}
/// Returns whether paths from the camera and from the lights merge where they nearly meet.
inline bool merges(Integrator integrator) {
    return integrator == Integrator::kVcm || integrator == Integrator::kPhotons;
}
/// Returns whether vertices of paths from the camera and from the lights are connected.
inline bool connects(Integrator integrator) {
    return integrator == Integrator::kBidirectional || integrator == Integrator::kVcm ||
           integrator == Integrator::kMetropolis;
}

/// Holds the settings of the path tracer.
struct PathTracerSettings : RenderSettings {
    PathTracerSettings() { samples_per_pixel = 64; }
    Integrator integrator = Integrator::kPath;
    SamplerKind sampler = SamplerKind::kSobol;
    FilterKind filter = FilterKind::kBox;
    /// This is the maximum number of scattering events, in [0, kMostDepth]: 0 = emission only, 1 = direct light.
    int max_depth = 64;
    static constexpr int kMostDepth = 100000;
    bool russian_roulette = true;
    bool environment = true; ///< see raster::RasterSettings::environment
    bool adaptive =
        false; ///< more samples where the error is larger; samples_per_pixel on average (sample_schedule.h)
    std::uint32_t first_sample = 0; ///< first of the samples_per_pixel samples; more than 0 in a shard
    std::filesystem::path film; ///< file of the film, which is continued if it exists (film_checkpoint.h); empty: none
    double film_interval = 60;  ///< seconds between two writes of the film file
    double time_limit = 0;      ///< seconds after which the render ends, between passes; 0: none
    double error_limit = 0;     ///< estimated relMSE at which the render ends, after a pass; 0: none
    bool denoise = false;       ///< Rendering::denoised; needs at least two samples per pixel

    /// Returns whether the film must estimate its error. Samples then fall into two replicates
    /// (raytrace/sampling/sampler.h). Otherwise all samples of a pixel are stratified together, which reduces the
    /// error.
    bool estimates_error() const { return adaptive || error_limit > 0 || aovs.variance || denoise; }
    std::uint32_t replicates() const { return estimates_error() ? 2 : 1; }
    /// Returns the sampler of a render with these settings.
    Sampler make_sampler() const { return {sampler, seed, samples_per_pixel, replicates()}; }
};

} // namespace duet::raytrace
