// What a pipeline is asked for and what it returns: the same types for both.
#pragma once

#include "common/geometry/hit.h"
#include "common/image/image.h"

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace duet {

/// Auxiliary pictures, made on request only.
struct AovSet {
    bool depth = false, normal = false, albedo = false, hit = false, variance = false, samples = false;
    bool any() const { return depth || normal || albedo || hit || variance || samples; }
};

/// What may be left out because it cannot change the expected picture (`compare skip` proves it). All are on; a
/// pipeline reads those that it has, once, before its loops.
struct Skips {
    bool lens = true;          ///< lens points of a pinhole
    bool motion = true;        ///< moments where nothing moves
    bool environment = true;   ///< one that is black
    bool frustum = true;       ///< primitives and objects that no pixel can see (rasterizer, as the next three)
    bool back_faces = true;    ///< of closed, opaque meshes seen from outside
    bool subpixel = true;      ///< triangles between the samples
    bool degenerate = true;    ///< triangles of no area on the sub-pixel grid
    bool textures = true;      ///< BSDFs anew at each hit, where no texture varies them (path tracer, as all below)
    bool light_samples = true; ///< where nothing emits, or no material can take them
    bool mirror_light = true;  ///< light samples at mirrors and glass
    bool emission = true;      ///< of the surfaces hit, where none emits
    bool last_bounce = true;   ///< rays that could only find a light, where none can be found
    bool shadow_rays = true;   ///< to light that the surface would not reflect
};

/// Settings that both pipelines have.
struct RenderSettings {
    int samples_per_pixel = 1;
    int threads = 0; ///< 0: all
    std::uint64_t seed = 0;
    AovSet aovs;
    Skips skips;
};

/// Something left out because the scene doesn't need it: why, or how many.
struct Skipped {
    std::string what, why;
    std::int64_t count = -1; ///< −1: `why` says it; else how many were skipped
};

/// The path tracer's bounding volume hierarchies, all together.
struct HierarchyStatistics {
    std::string quality;         ///< "default" or "high"; empty: there are none
    std::int64_t nodes = 0;      ///< wide ones
    std::int64_t references = 0; ///< primitives and instances in leaves; one that is cut counts in each
};

/// A sample whose radiance is NaN, infinite or negative: `raytrace --pixel x,y,sample` tells its path.
struct InvalidSample {
    std::uint32_t sample = 0;
    int y = 0, x = 0;

    /// The first is that of the lowest number, in the uppermost row, farthest to the left.
    friend auto operator<=>(const InvalidSample&, const InvalidSample&) = default;
};
/// The earlier of two; either may be none.
inline std::optional<InvalidSample> first_of(std::optional<InvalidSample> a, std::optional<InvalidSample> b) {
    return !a || (b && *b < *a) ? b : a;
}

/// What a rendering cost and what it did.
struct RenderStatistics {
    std::vector<std::pair<std::string, double>> seconds; ///< by stage, in order ("transform", "cover", "shade" …)
    int samples_per_pixel = 0;                           ///< as rendered; where interrupted, of the finished passes
    int passes = 0;
    std::int64_t camera_rays = 0, indirect_rays = 0, shadow_rays = 0;
    std::int64_t triangles = 0;       ///< triangles, quads and spheres of the flattened scene
    std::int64_t memory_bytes = 0;    ///< of what `prepare` built and the render kept
    std::int64_t invalid_samples = 0; ///< NaN, infinite or negative: dropped from the film, and reported
    std::optional<InvalidSample> first_invalid; ///< of those that this render took (path tracer)
    double estimated_relmse = -1;     ///< mean over pixels of variance / (mean² + 0.01); −1: not estimated
    HierarchyStatistics bvh;
    std::vector<Skipped> skipped;
    std::vector<std::string> approximations; ///< what is not the path tracer's truth, each named in a sentence
    bool interrupted = false;
};

struct Rendering {
    ImageRgb radiance; ///< linear
    // Auxiliary pictures, empty unless asked for. Depth, normal and albedo are means over the samples that hit; hit is
    // of sample 0.
    ImageFloat depth;   ///< camera-space −z in metres; infinity where nothing is seen
    Image<Vec3> normal; ///< shading normal in the world, facing the camera; (0, 0, 0) where nothing is seen
    ImageRgb albedo;    ///< base colour; black where nothing is seen
    Image<Hit> hit;
    ImageRgb variance;            ///< of the pixel's mean; of replicates (see Film)
    Image<std::uint32_t> samples; ///< number of samples taken
    // Instead of radiance, where the rasterizer is asked for them (raster::Output).
    Image<Rgba8> srgb;   ///< 8 bits a channel, encoded by the sRGB curve, opaque
    ImageFloat nearness; ///< near / depth, in (0, 1]; 0 where nothing is seen
    RenderStatistics statistics;
};

} // namespace duet
