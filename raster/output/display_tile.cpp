#include "raster/output/display_tile.h"

#include "raster/lighting/environment_light.h"
#include "raster/shading/packet_shader.h"
#include "raster/shading/shade_sample.h"
#include "raster/visibility/packet_primitives.h"

#include "common/image/srgb.h"
#include "common/system/parallel.h"

#include <algorithm>
#include <array>
#include <optional>

namespace duet::raster {
namespace {

Rgba8 encoded(const SrgbEncoder& encode, Rgb c) { return {encode(c.r), encode(c.g), encode(c.b), 255}; }

bool is_empty(const Geometry& geometry, std::size_t index) {
    return geometry.triangle_lists.tile(index).empty() && geometry.mask_lists.tile(index).empty() &&
           geometry.fragment_lists.tile(index).empty() &&
           (geometry.spheres.empty() || geometry.sphere_bins.tile(index).empty());
}

constexpr int kBlock = DepthTile::kBlock;

/// Copies a row of a tile's blocks to the image, from pixel row y on. row_of(block, row) returns the address of
/// eight pixels of a block. Whole cache lines are written with non-temporal stores, because a frame is larger than
/// what caches retain until the next one.
template <typename Pixel, typename RowOf>
void copy_blocks(const PixelRect& rect, int y, const RowOf& row_of, Image<Pixel>& image) {
    static_assert(2 * kBlock * sizeof(Pixel) == 64);
    for (int row = 0; row < std::min(kBlock, rect.y1 - y); ++row) {
        Pixel* to = &image(rect.x0, y + row);
        const auto block = [&](int column) {
            return row_of(static_cast<std::size_t>(column), static_cast<std::size_t>(row));
        };
        int column = 0, left = rect.width();
        if (is_line_start(to))
            for (; left >= 2 * kBlock; left -= 2 * kBlock, column += 2)
                stream_line(block(column), block(column + 1), to + column * kBlock);
        for (; left >= kBlock; left -= kBlock, ++column) std::copy_n(block(column), kBlock, to + column * kBlock);
        if (left > 0) std::copy_n(block(column), left, to + column * kBlock);
    }
}

/// Fills the pixels of an empty tile.
template <typename Pixel> void fill(const PixelRect& rect, const Pixel& pixel, Image<Pixel>& image) {
    std::array<Pixel, kBlock> eight;
    eight.fill(pixel);
    for (int y = rect.y0; y < rect.y1; y += kBlock)
        copy_blocks(
            rect, y, [&](std::size_t, std::size_t) { return eight.data(); }, image);
    finish_streams();
}

void copy_depth(const DepthTile& tile, ImageFloat& image) {
    static constexpr std::array<float, kBlock> kNothing{};
    const PixelRect& rect = tile.rect();
    for (int y = rect.y0; y < rect.y1; y += kBlock) {
        const std::size_t first = tile.sample_index(rect.x0, y) / kBlockSamples;
        const auto row_of = [&](std::size_t column, std::size_t row) {
            return tile.drawn(first + column) ? tile.reversed_depth() + (first + column) * kBlockSamples + row * kBlock
                                              : kNothing.data();
        };
        copy_blocks(rect, y, row_of, image);
    }
    finish_streams();
}

/// Shades a tile's pixels and stores them in the image: packet by packet with a program, else one by one.
class TileDisplay {
public:
    TileDisplay(const RasterSceneData& data, const RasterSettings& settings, const ShaderProgram* program,
                const Geometry& geometry, const PassView& view, const DepthTile& tile, std::optional<Rgba8> background,
                Image<Rgba8>& image)
        : data_(data), settings_(settings), geometry_(geometry), view_(view), tile_(tile), image_(image),
          shader_(program != nullptr ? program->for_tile(data, geometry, view, tile.rect()) : nullptr),
          background_(background) {
        if (background_) background_packet_.fill(*background_);
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
    static constexpr std::size_t kPacketsPerBlock = kBlock / kPacketRows; ///< per block

    /// Queues the packets of the block whose first pixel is (x, y), or fills them with the background.
    void block(int x, int y, std::uint32_t sample_index, std::size_t slot) {
        if (background_ && !tile_.drawn(sample_index / kBlockSamples)) {
            std::fill_n(codes_.begin() + static_cast<std::ptrdiff_t>(slot), kPacketsPerBlock, background_packet_);
            return;
        }
        for (std::size_t s = 0; s < kPacketsPerBlock; ++s, y += kPacketRows, sample_index += kPacketSize, ++slot) {
            if (background_ && visible_lanes(tile_.ids() + sample_index) == 0)
                codes_[slot] = background_packet_;
            else
                queue_packet(x, y, sample_index, slot);
        }
    }

    void queue_packet(int x, int y, std::uint32_t sample_index, std::size_t slot) {
        if (shader_ == nullptr)
            return shade_one_by_one(intersect(tile_.rect(), {x, y, x + kBlock, y + kPacketRows}), codes_[slot]);
        const std::size_t next = count_++;
        destinations_[next] = &codes_[slot];
        packets_[next] = sample_packet(tile_, x, y, sample_index);
    }

    /// Shades the queued packets of a row of blocks.
    void shade_queued() {
        if (count_ == 0) return;
        shader_->shade(std::span(packets_).first(count_), colors_.data(), visible_.data());
        // A program implies a background.
        encode_packets(std::span(colors_).first(count_), visible_.data(), *background_, destinations_.data());
        count_ = 0;
    }

    void shade_one_by_one(const PixelRect& r, SrgbPacket& codes) {
        if (!hits_) hits_.emplace(tile_, geometry_, view_);
        for (int y = r.y0; y < r.y1; ++y)
            for (int x = r.x0; x < r.x1; ++x)
                codes[static_cast<std::size_t>(y - r.y0) * kPacketWidth + static_cast<std::size_t>(x - r.x0)] =
                    encoded(srgb_encoder(), shade_sample(data_, settings_, *hits_, x, y).radiance);
    }

    const RasterSceneData& data_;
    const RasterSettings& settings_;
    const Geometry& geometry_;
    const PassView& view_;
    const DepthTile& tile_;
    Image<Rgba8>& image_;
    std::unique_ptr<PacketShader> shader_;
    static constexpr std::size_t kMaxPackets = DepthTile::kBlocks * kPacketsPerBlock;
    std::array<SrgbPacket, kMaxPackets> codes_;           ///< of a row of blocks
    std::array<SamplePacket, kMaxPackets> packets_;       ///< queued packets
    std::array<SrgbPacket*, kMaxPackets> destinations_{}; ///< destinations of the queued packets
    std::array<ColorPacket, kMaxPackets> colors_;
    std::array<std::uint32_t, kMaxPackets> visible_{};
    std::size_t count_ = 0;
    std::optional<HitTile> hits_; ///< created on first use
    std::optional<Rgba8> background_;
    SrgbPacket background_packet_; ///< filled with the background
};

} // namespace

void display_tile(const RasterSceneData& data, const RasterSettings& settings, const ShaderProgram* program,
                  const Geometry& geometry, const PassView& view, const PixelRect& rect, std::size_t index,
                  Image<Rgba8>& image) {
    const std::optional<Rgb> color = constant_background(data, settings);
    std::optional<Rgba8> background;
    if (color) background = encoded(srgb_encoder(), *color);
    if (background && is_empty(geometry, index)) {
        fill(rect, *background, image);
        return;
    }
    DepthTile tile;
    rasterize_drawn_blocks(geometry, view, view.samples.front(), rect, index, tile);
    if (!background || program == nullptr) tile.clear_undrawn(); // undrawn blocks are read as well
    TileDisplay(data, settings, program, geometry, view, tile, background, image).run();
}

namespace {

/// Does the same as render_depth_tile(), and leaves the depth buffer in `depths`. Returns false if the tile is empty.
bool render_depths(const Geometry& geometry, const PassView& view, const PixelRect& rect, std::size_t index,
                   DepthTile& depths, ImageFloat& image) {
    if (is_empty(geometry, index)) {
        fill(rect, 0.0f, image);
        return false;
    }
    rasterize_drawn_blocks(geometry, view, view.samples.front(), rect, index, depths);
    copy_depth(depths, image);
    return true;
}

} // namespace

void render_depth_tile(const Geometry& geometry, const PassView& view, const PixelRect& rect, std::size_t index,
                       ImageFloat& image) {
    DepthTile depths;
    render_depths(geometry, view, rect, index, depths, image);
}

void render_depth_and_color_tile(const RasterSceneData& data, const Geometry& geometry, const PassView& view,
                                 const ShaderProgram& program, const PixelRect& rect, std::size_t index,
                                 ImageFloat& reversed_depth, ImageRgb& colors) {
    DepthTile depths;
    if (!render_depths(geometry, view, rect, index, depths, reversed_depth)) return;
    depths.clear_undrawn(); // undrawn blocks are read as well
    const auto shader = program.for_tile(data, geometry, view, rect);
    for (int y0 = rect.y0; y0 < rect.y1; y0 += DepthTile::kPacketRows)
        for (int x0 = rect.x0; x0 < rect.x1; x0 += static_cast<int>(kPacketWidth)) {
            ColorPacket packet_colors;
            const std::uint32_t visible = shader->shade(sample_packet(depths, x0, y0), packet_colors);
            for (std::size_t i = 0; i < kPacketSize; ++i) {
                const int x = x0 + static_cast<int>(i % kPacketWidth), y = y0 + static_cast<int>(i / kPacketWidth);
                if (x < rect.x1 && y < rect.y1 && (visible >> i & 1))
                    colors(x, y) = Rgb(packet_colors.r[i], packet_colors.g[i], packet_colors.b[i]);
            }
        }
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
