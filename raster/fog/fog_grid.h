// Renders fog in real time. The light that media scatter toward the viewer is computed in froxels, the cells of a grid
// that is aligned with the view, and summed from front to back (Wronski 2014, "Volumetric Fog: Unified Compute Shader
// Based Solution to Atmospheric Scattering").
#pragma once

#include "raster/fog/light_in_space.h"
#include "raster/gbuffer/gbuffer.h"
#include "raster/raster_scene.h"

#include <functional>

namespace duet::raster {

/// Returns the mean radiance that arrives from all directions, apart from Scene::lights, at points relative to the eye.
/// It approximates all multiple scattering.
using AmbientLight = std::function<RgbT<Floats>(const Vec3T<Floats>& p)>;

/// Returns the mean radiance of the environment, attenuated by the mean transmittance along the six axis directions.
/// The function is empty if the settings or the scene have no environment.
AmbientLight environment_in_fog(const RasterSceneData& data, const RasterSettings& settings,
                                const ScreenProjection& projection);

struct PixelRays; // raster/fog/pixel_rays.h

/// Holds the settings of a FogGrid.
struct FogOptions {
    float time = 0;         ///< time of the shadow maps
    bool background = true; ///< false: fog only in front of surfaces
    int side = 8;           ///< width of a froxel, in pixels
    int slices = 64;        ///< froxels along each ray
    int threads = 0;        ///< 0: all CPUs
};

/// Holds the light that the media of one view scatter and emit, for the rays through the middles of its froxels. The
/// first ray passes through the first pixel. The ends of slices have equal distances from the eye on all rays.
class FogGrid {
public:
    /// Computes the light of the scene's media in front of the G-buffer's surfaces
    /// (raster/fog/compute_fog_grid.cpp). Memory of an earlier call is reused. `ambient` may be empty.
    void compute(const RasterSceneData& data, const RasterSettings& settings, const GBuffer& gbuffer,
                 const AmbientLight& ambient, const FogOptions& options);

    /// Multiplies the radiance of the surfaces and of the background by the transmittance of the media in front of
    /// them, which is exact in every pixel. With `scattered`, adds the light that the media scatter and emit.
    void apply(const GBuffer& gbuffer, int threads, bool scattered, Planes3& radiance) const;
    /// Returns, for each pixel, the radiance that the media scatter to the viewer if radiance 1 arrives from all
    /// directions. It is exact if all media have the same albedo.
    Planes3 haze(const GBuffer& gbuffer, int threads) const;
    std::size_t memory_bytes() const { return light_.memory_bytes() + stopped_.memory_bytes(); }

    static constexpr std::size_t kMostLights = 64; ///< number of lights sampled for a cluster of froxels

private:
    struct Columns;
    class Lighter;

    void find_distances(const GBuffer& gbuffer, const FogOptions& options);
    Columns columns(int x, int y) const;
    RgbT<Floats> light_before(int x, int y, const PixelRays& rays, const RgbT<Floats>& depth) const;
    RgbT<Floats> interpolate(const Planes3& planes, int x, int y, const Ints& slices, const RgbT<Floats>& within) const;
    int row(int y, int slice) const { return y * (slices_ + 1) + slice; }

    std::vector<Medium> media_; ///< relative to the eye
    std::optional<ScreenProjection> projection_;
    int side_ = 8, slices_ = 0, columns_ = 0, rows_ = 0;
    PlaneFloat farthest_;          ///< distance of the farthest surface in a froxel's column of pixels
    std::vector<float> distances_; ///< distances of the slices' ends, from the nearest
    float nearest_ = 0, scale_ = 1, slices_per_log_ = 0;
    Planes3 light_;   ///< radiance up to each slice's end; row(y, slice) holds a row of froxels
    Planes3 stopped_; ///< opacity up to each slice's end; empty unless a density varies
};

} // namespace duet::raster
