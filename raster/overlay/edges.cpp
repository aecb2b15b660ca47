#include "raster/overlay/edges.h"

#include "raster/visibility/hit_lists.h"
#include "raster/visibility/packet_primitives.h"

#include <algorithm>
#include <cmath>

namespace duet::raster {
void EdgeBuffer::add(const DepthTile& tile, const Geometry& geometry, PacketShader& normals) {
    const PixelRect& r = tile.rect();
    ColorPacket colors;
    for (int y0 = r.y0; y0 < r.y1; y0 += DepthTile::kPacketRows)
        for (int x0 = r.x0; x0 < r.x1; x0 += static_cast<int>(kPacketWidth)) {
            const SamplePacket packet = sample_packet(tile, x0, y0);
            normals.shade(packet, colors);
            for (std::size_t i = 0; i < kPacketSize; ++i) {
                const int x = x0 + static_cast<int>(i % kPacketWidth), y = y0 + static_cast<int>(i / kPacketWidth);
                if (x >= r.x1 || y >= r.y1) continue;
                const auto id = static_cast<std::uint32_t>(packet.ids[i]);
                const bool any = id != kNoTriangle;
                reversed_depth(x, y) = any ? packet.reversed_depth[i] : 0;
                normal(x, y) = any ? Vec3(colors.r[i], colors.g[i], colors.b[i]) : Vec3();
                object(x, y) = any ? geometry.primitive(geometry.triangles.run_of(id), id).object : kNoObject;
            }
        }
}

void EdgeBuffer::add_layers(const RasterSceneData& data, const Geometry& layers, const PassView& view,
                            SampleOffset offset, std::size_t tile_index, const HitTile& tile,
                            const ShaderProgram& normals) {
    HitLists lists(layers, view, offset, tile_index, tile);
    const auto mostly_blocked = [](int, int, float left) { return left < 0.5f; };
    lists.for_each_blocking_hit(data.scene, mostly_blocked, [&](int x, int y, const Hit& hit) {
        const Rgb n = normals.shade_hit(data, view, hit, offset.position(x, y));
        reversed_depth(x, y) =
            static_cast<float>(view.pinhole.near * tile.distance_per_depth(x, y) / static_cast<double>(hit.t));
        normal(x, y) = Vec3(n.r, n.g, n.b);
        object(x, y) = hit.object;
    });
}

namespace {

/// Returns a linear ramp from 0 at `low` to 1 at `high`.
float ramp(float x, float low, float high) { return std::clamp((x - low) / (high - low), 0.0f, 1.0f); }

/// Gives access to the neighborhood of a pixel. Beyond the image border, the pixels on the border are repeated.
struct Neighborhood {
    int width, height, x, y;

    template <typename Pixel> const Pixel& at(const Image<Pixel>& image, int dx, int dy) const {
        return image(std::clamp(x + dx, 0, width - 1), std::clamp(y + dy, 0, height - 1));
    }
};

/// Returns the magnitude of the gradient by both Sobel operators, scaled by 1/4. A straight edge between two uniform
/// regions yields their difference.
float sobel(const Image<Vec3>& image, const Neighborhood& neighborhood) {
    Vec3 across, down;
    for (int k = -1; k <= 1; ++k) {
        const float weight = (k == 0 ? 2.0f : 1.0f) / 4;
        across += (neighborhood.at(image, 1, k) - neighborhood.at(image, -1, k)) * weight;
        down += (neighborhood.at(image, k, 1) - neighborhood.at(image, k, -1)) * weight;
    }
    return std::sqrt(dot(across, across) + dot(down, down));
}

/// Returns the larger of the horizontal and the vertical second difference.
float second_difference(const ImageFloat& image, const Neighborhood& neighborhood) {
    const float twice = 2 * neighborhood.at(image, 0, 0);
    return std::max(std::abs(neighborhood.at(image, -1, 0) + neighborhood.at(image, 1, 0) - twice),
                    std::abs(neighborhood.at(image, 0, -1) + neighborhood.at(image, 0, 1) - twice));
}

} // namespace

float edge_strength(const EdgeBuffer& edge_buffer, int x, int y) {
    const Neighborhood neighborhood{edge_buffer.reversed_depth.width(), edge_buffer.reversed_depth.height(), x, y};
    const std::uint32_t own = edge_buffer.object(x, y);
    for (const auto& [dx, dy] : {std::pair(-1, 0), std::pair(1, 0), std::pair(0, -1), std::pair(0, 1)})
        if (neighborhood.at(edge_buffer.object, dx, dy) != own) return 1;
    if (own == kNoObject) return 0;
    const float step = second_difference(edge_buffer.reversed_depth, neighborhood) / edge_buffer.reversed_depth(x, y);
    const float crease = 2 * sobel(edge_buffer.normal, neighborhood); // undoes the factor 1/2 of the stored normals
    return std::max(ramp(step, 0.02f, 0.04f), ramp(crease, 0.5f, 0.8f));
}

} // namespace duet::raster
