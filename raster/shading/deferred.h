// Deferred shading of Shading::kLit: each stage is a function over the whole G-buffer, and adds one effect.
#pragma once

#include "raster/gbuffer/gbuffer.h"
#include "raster/geometry/geometry.h"
#include "raster/geometry/tiles.h"
#include "raster/screen_space/gtao.h"

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace duet {
struct Control;
}

namespace duet::raster {

/// Holds the images of a frame. Rendering frame after frame into the same one allocates no memory.
struct DeferredFrame {
    std::optional<GBuffer> gbuffer;
    Planes3 radiance;
    GtaoImage occlusion;
    std::vector<std::pair<std::string, double>> seconds; ///< wall-clock time of each stage, in order

    std::size_t memory_bytes() const { return (gbuffer ? gbuffer->memory_bytes() : 0) + radiance.memory_bytes(); }
};

/// Computes the radiance of one sample per pixel, at `offset` in its pixel.
void shade_deferred(const RasterSceneData& data, const RasterSettings& settings, const Geometry& geometry,
                    const PassView& view, const TileGrid& grid, SampleOffset offset, const Control& control,
                    DeferredFrame& frame);

/// Provides frames whose memory is reused, one for each rendering that runs at the same time.
class DeferredFramePool {
public:
    std::unique_ptr<DeferredFrame> take();
    void give_back(std::unique_ptr<DeferredFrame> frame);

private:
    std::mutex mutex_;
    std::vector<std::unique_ptr<DeferredFrame>> free_;
};

} // namespace duet::raster
