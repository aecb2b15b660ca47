// Computes edge lines where the visible surface changes, in image space.
#pragma once

#include "raster/geometry/geometry.h"
#include "raster/shader/packet_shader.h"
#include "raster/visibility/depth_tile.h"
#include "raster/visibility/hit_tile.h"

#include "common/image/image.h"

namespace duet::raster {

/// Stores the G-buffer of edge detection, with one sample per pixel.
struct EdgeBuffer {
    ImageFloat reversed_depth;   ///< reversed depth, near / depth; 0 on a miss
    Image<Vec3> normal;          ///< shading normal n, stored as (n + 1)/2
    Image<std::uint32_t> object; ///< kNoObject on a miss

    EdgeBuffer(int width, int height) : reversed_depth(width, height), normal(width, height), object(width, height) {}
    /// Adds a tile. `normals` must come from smooth_normal_program() and be made for that tile.
    void add(const DepthTile& tile, const Geometry& geometry, PacketShader& normals);
    /// Adds the alpha-masked and alpha-blended surfaces of process_layers in front of a tile. Each pixel stores the
    /// nearest surface at which the transmittance falls below one half. `tile` holds the surfaces behind them, and
    /// `offset` is that of its samples.
    void add_layers(const RasterSceneData& data, const Geometry& layers, const PassView& view, SampleOffset offset,
                    std::size_t tile_index, const HitTile& tile, const ShaderProgram& normals);
};

/// Returns the edge strength of a pixel, in [0, 1]: the maximum of three criteria, which are a different object in
/// a neighboring pixel, a depth discontinuity, and a crease.
///
/// Depth discontinuities are detected by the second difference of reversed depth, which is linear in the image over
/// any plane at any inclination. (The first difference of depth would mark every floor at a grazing angle.) The
/// strength rises from 0 at 2 % of the reversed depth to 1 at 4 %. Creases are detected by the Sobel operator on
/// the three components of the normal, scaled to the change across an edge. The strength rises from 0 at 0.5 (about
/// 29°) to 1 at 0.8 (47°). (Saito and Takahashi 1990, "Comprehensible Rendering of 3-D Shapes", apply the Sobel
/// operator to depth for profiles and second differences for inner edges; Decaudin 1996, "Cartoon-Looking Rendering
/// of 3D-Scenes", adds the normals.)
float edge_strength(const EdgeBuffer& edge_buffer, int x, int y);

} // namespace duet::raster
