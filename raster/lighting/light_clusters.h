// Lists the lights that reach a tile of the image, by slices of depth (Olsson, Billeter and Assarsson 2012, "Clustered
// Deferred and Forward Shading": clusters with explicit bounds of positions and normals; as bits per tile after Harada
// 2012, "A 2.5D Culling for Forward+").
#pragma once

#include "raster/gbuffer/gbuffer.h"
#include "raster/lighting/frame_lights.h"

namespace duet::raster {

/// Holds the lights of one tile. It may be reused for other tiles.
struct TileLights {
    struct Entry {
        std::uint32_t light;  ///< index into the frame's lights
        std::uint32_t slices; ///< bits of the slices that the light reaches
    };
    std::vector<Entry> entries; ///< one per light
    std::array<std::uint32_t, 64> batch_slices; ///< bits of the slices in which each batch of the tile has surfaces
    // Scratch memory, one number per light.
    std::vector<float, CacheAligned<float>> most;
    std::vector<std::uint32_t> slices;
};

/// Finds the lights of tiles. Every surface of a tile is in one of the slices of the tile's depth range, each with
/// exact bounds of its points and normals. A light that lies behind all of a slice's surfaces, that faces away from all
/// of them, or whose cone misses them is culled exactly: it gives no light there.
///
/// Point and area lights have no end, so distant ones are dropped where they do not matter: the bounds of all dropped
/// lights' irradiance sum to at most kDropped of the irradiance (without shadows) at the slice's center. Lights
/// are not dropped where a surface is smooth enough to show their highlights.
class LightClusters {
public:
    static constexpr int kTileSide = 16, kSlices = 4;
    static constexpr float kDropped = 1.0f / 64;
    /// Surfaces whose lobes are at least this wide reflect at most about 1 / (4 alpha²) = 4 times as much of a light as
    /// a white diffuse surface.
    static constexpr float kSmoothest = 0.25f;
    /// For so few lights, a list takes longer than it saves.
    static constexpr std::size_t kFewLights = 4;

    explicit LightClusters(std::span<const FrameLight> lights);

    /// Lists the lights of the tile whose first pixel is (x0, y0), multiples of kTileSide.
    void list(const GBuffer& gbuffer, int x0, int y0, TileLights& result) const;

private:
    struct Slice;
    void list_all(TileLights& result) const;
    void cull(const Slice& slice, std::uint32_t bit, TileLights& result) const;

    /// Rows of bounds_, which has one column per light.
    enum Row {
        kLowX, kLowY, kLowZ, kHighX, kHighY, kHighZ,   ///< box around the light
        kAxisX, kAxisY, kAxisZ, kPlane,                ///< front: axis·p > plane
        kConeCosine, kConeSine,                        ///< of a spot's outer angle; both 0 for others
        kIntensity,                                    ///< W/sr, as in common/light/light_bounds.h
        kMost,                                         ///< greatest irradiance, W/m²
        kRows
    };
    std::size_t count_;
    PlaneFloat bounds_;
};

} // namespace duet::raster
