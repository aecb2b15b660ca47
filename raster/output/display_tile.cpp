#include "raster/output/display_tile.h"

#include "raster/shader/packet_shader.h"
#include "raster/visibility/image_blocks.h"
#include "raster/visibility/packet_primitives.h"
#include "raster/visibility/rasterize_tile.h"

#include "common/image/srgb.h"
#include "common/system/parallel.h"

#include <algorithm>
#include <array>

namespace duet::raster {
namespace {

Rgba8 encoded(const SrgbEncoder& encode, Rgb c) { return {encode(c.r), encode(c.g), encode(c.b), 255}; }

constexpr Rgba8 kBackground{0, 0, 0, 255};

/// Shades a tile's pixels packet by packet and stores them in the image. The background is black.
class TileDisplay {
public:
    TileDisplay(const RasterSceneData& data, const ShaderProgram& program, const Geometry& geometry,
                const PassView& view, const DepthTile& tile, Image<Rgba8>& image)
        : tile_(tile), image_(image), shader_(program.for_tile(data, geometry, view, tile.rect())) {
        background_packet_.fill(kBackground);
    }

    void run() {
        const PixelRect& rect = tile_.rect();
        for (int y = rect.y0; y < rect.y1; y += kBlock) {
            std::uint32_t sample_index = tile_.sample_index(rect.x0, y);
            std::size_t slot = 0;
            for (int x = rect.x0; x < rect.x1; x += kBlock, sample_index += kBlockSamples, slot += kPacketsPerBlock)
                block(x, y, sample_index, slot);
            shade_queued();
            const auto row_of = [&](std::size_t column, std::size_t row) {
                constexpr std::size_t kRows = kPacketRows;
                return codes_[column * kPacketsPerBlock + row / kRows].at(row % kRows * kPacketWidth);
            };
            copy_blocks(rect, y, row_of, image_);
        }
        finish_streams();
    }

private:
    static constexpr int kPacketRows = DepthTile::kPacketRows;
    static constexpr std::size_t kPacketsPerBlock = kBlock / kPacketRows;

    /// Queues the packets of the block whose first pixel is (x, y), or fills them with the background.
    void block(int x, int y, std::uint32_t sample_index, std::size_t slot) {
        if (!tile_.drawn(sample_index / kBlockSamples)) {
            std::fill_n(codes_.begin() + static_cast<std::ptrdiff_t>(slot), kPacketsPerBlock, background_packet_);
            return;
        }
        for (std::size_t s = 0; s < kPacketsPerBlock; ++s, y += kPacketRows, sample_index += kPacketSize, ++slot) {
            if (visible_lanes(tile_.ids() + sample_index) == 0)
                codes_[slot] = background_packet_;
            else
                queue_packet(x, y, sample_index, slot);
        }
    }

    void queue_packet(int x, int y, std::uint32_t sample_index, std::size_t slot) {
        const std::size_t next = count_++;
        destinations_[next] = &codes_[slot];
        packets_[next] = sample_packet(tile_, x, y, sample_index);
    }

    /// Shades the queued packets of a row of blocks.
    void shade_queued() {
        if (count_ == 0) return;
        shader_->shade(std::span(packets_).first(count_), colors_.data(), visible_.data());
        encode_packets(std::span(colors_).first(count_), visible_.data(), kBackground, destinations_.data());
        count_ = 0;
    }

    const DepthTile& tile_;
    Image<Rgba8>& image_;
    std::unique_ptr<PacketShader> shader_;
    static constexpr std::size_t kMaxPackets = DepthTile::kBlocks * kPacketsPerBlock;
    std::array<SrgbPacket, kMaxPackets> codes_;           ///< pixels of a row of blocks
    std::array<SamplePacket, kMaxPackets> packets_;       ///< queued packets
    std::array<SrgbPacket*, kMaxPackets> destinations_{}; ///< destinations of the queued packets
    std::array<ColorPacket, kMaxPackets> colors_;
    std::array<std::uint32_t, kMaxPackets> visible_{};
    std::size_t count_ = 0;
    SrgbPacket background_packet_; ///< filled with the background
};

} // namespace

void display_tile(const RasterSceneData& data, const ShaderProgram& program, const Geometry& geometry,
                  const PassView& view, const PixelRect& rect, std::size_t index, Image<Rgba8>& image) {
    if (!geometry.overlaps_tile(index)) {
        fill(rect, kBackground, image);
        return;
    }
    DepthTile tile;
    rasterize_drawn_blocks(geometry, view, view.samples.front(), rect, index, tile);
    TileDisplay(data, program, geometry, view, tile, image).run();
}

void encode(const ImageRgb& radiance, int threads, Image<Rgba8>& image) {
    image = Image<Rgba8>(radiance.width(), radiance.height());
    const SrgbEncoder& encoder = srgb_encoder();
    parallel_for(static_cast<std::size_t>(radiance.height()), threads, [&](std::size_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < radiance.width(); ++x) image(x, y) = encoded(encoder, radiance(x, y));
    });
}

} // namespace duet::raster
