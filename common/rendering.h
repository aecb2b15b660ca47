// This file defines the settings and the results of a render. Both pipelines use the same types.
#pragma once

#include "common/geometry/hit.h"
#include "common/image/image.h"

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace duet {

/// Selects the auxiliary images (arbitrary output variables, AOVs) that a render produces.
struct AovSet {
    bool depth = false, normal = false, albedo = false, hit = false, variance = false, samples = false;
    bool any() const { return depth || normal || albedo || hit || variance || samples; }
};
/// Selects all auxiliary images.
inline constexpr AovSet kAllAovs{.depth = true, .normal = true, .albedo = true, .hit = true, .variance = true,
                                 .samples = true};

/// Each flag enables a shortcut that skips work which cannot change the expected image; `compare skip` verifies this.
/// All shortcuts are on by default. A pipeline reads the flags that it supports once, before its loops.
struct SkipFlags {
    bool lens = true;          ///< skips lens samples for a pinhole camera
    bool motion = true;        ///< skips time samples where nothing moves
    bool environment = true;   ///< skips a black environment
    bool frustum = true;       ///< culls primitives and objects outside the view frustum (rasterizer)
    bool back_faces = true;    ///< culls back faces of closed, opaque meshes seen from outside (rasterizer)
    bool subpixel = true;      ///< culls triangles that cover no sample (rasterizer)
    bool degenerate = true;    ///< culls triangles of zero area on the subpixel grid (rasterizer)
    bool textures = true;      ///< reuses BSDFs that no texture varies (path tracer, as all flags below)
    bool light_samples = true; ///< skips light samples where nothing emits or no material can use them
    bool mirror_light = true;  ///< skips light samples at mirrors and glass
    bool emission = true;      ///< skips the emission of hit surfaces where no surface emits
    bool last_bounce = true;   ///< skips the last ray of a path, which can only find a light, if none can be hit
    bool shadow_rays = true;   ///< skips shadow rays to light that the surface does not reflect
};

/// These settings apply to both pipelines.
struct RenderSettings {
    int samples_per_pixel = 1;
    int threads = 0; ///< number of threads; 0: all available
    std::uint64_t seed = 0;
    AovSet aovs;
    SkipFlags skips;
};

/// Reports work that a render skipped because the scene does not need it. Either `why` or `count` describes it.
struct SkippedWork {
    std::string what, why;
    std::int64_t count = -1; ///< number of skipped items; −1: not counted, `why` gives the reason
};

/// These statistics are sums over all bounding volume hierarchies (BVHs) of the path tracer.
struct BvhStatistics {
    std::int64_t nodes = 0;      ///< number of wide nodes
    std::int64_t references = 0; ///< primitives and instances in leaves
};

/// Returns whether a sample can be kept: no component is NaN, infinite or negative.
inline bool is_valid_radiance(Rgb c) { return is_finite(c) && c.r >= 0 && c.g >= 0 && c.b >= 0; }

/// Identifies a sample whose radiance is not valid. `raytrace --pixel x,y,sample` prints its path.
struct InvalidSample {
    std::uint32_t sample = 0;
    int y = 0, x = 0;

    /// Samples are ordered by sample index, then by row from the top, then by column from the left.
    friend auto operator<=>(const InvalidSample&, const InvalidSample&) = default;
};
/// Returns the earlier of two samples. If one of them is empty, returns the other.
inline std::optional<InvalidSample> earlier_sample(std::optional<InvalidSample> a, std::optional<InvalidSample> b) {
    return !a || (b && *b < *a) ? b : a;
}

/// These statistics describe the cost and the work of a render.
struct RenderStatistics {
    std::vector<std::pair<std::string, double>> seconds; ///< time of each stage, in order ("transform", "cover", …)
    int samples_per_pixel = 0;                           ///< samples taken; if interrupted, in the finished passes
    int passes = 0;
    std::int64_t camera_rays = 0, indirect_rays = 0, shadow_rays = 0;
    std::int64_t triangles = 0;                 ///< number of triangles, quads and spheres of the flattened scene
    std::int64_t memory_bytes = 0;              ///< bytes of the data that `prepare` built and of the render's buffers
    std::int64_t invalid_samples = 0;           ///< dropped samples: NaN, infinite or negative
    std::optional<InvalidSample> first_invalid; ///< first invalid sample of this render (path tracer only)
    double estimated_relmse = -1;               ///< see Film::estimated_relmse; −1: not estimated
    BvhStatistics bvh;
    std::vector<SkippedWork> skipped;
    std::vector<std::string> approximations; ///< differences from the path-traced reference, one sentence each
    bool interrupted = false;
};

/// A Rendering is what a pipeline returns: the image, the requested auxiliary images, and statistics.
struct Rendering {
    ImageRgb radiance; ///< linear radiance
    ImageRgb denoised; ///< radiance without most of its noise; empty unless denoising was requested (path tracer)
    // Auxiliary images are empty unless requested. Depth, normal and albedo are means over the samples that hit a
    // surface; hit is the hit of the first sample.
    ImageFloat depth;   ///< camera-space −z in meters; infinity on a miss
    Image<Vec3> normal; ///< shading normal in world space, facing the camera; (0, 0, 0) on a miss
    ImageRgb albedo;    ///< base color; black on a miss
    Image<Hit> hit;
    ImageRgb variance;            ///< variance of the pixel's mean, estimated from the replicates (see Film)
    Image<std::uint32_t> samples; ///< number of samples taken
    // The rasterizer fills these images instead of radiance where raster::Output requests them.
    Image<Rgba8> srgb;         ///< 8 bits per channel, sRGB-encoded, opaque
    ImageFloat reversed_depth; ///< reversed depth near / depth, in (0, 1]; 0 on a miss
    RenderStatistics statistics;
};

} // namespace duet
