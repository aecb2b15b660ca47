#include "raster/display.h"

#include "raster/light/environment_light.h"
#include "raster/shade.h"
#include "raster/shader/strip_shader.h"
#include "raster/visibility/strip_samples.h"

#include "common/image/srgb.h"
#include "common/system/parallel.h"

#include <algorithm>
#include <array>
#include <optional>

namespace duet::raster {
namespace {

Rgba8 encoded(const SrgbEncoder& encode, Rgb c) { return {encode(c.r), encode(c.g), encode(c.b), 255}; }

bool is_empty(const Geometry& geometry, std::size_t index) {
    return geometry.outlines.tile(index).empty() && geometry.patches.tile(index).empty() &&
           geometry.fragments.tile(index).empty() &&
           (geometry.spheres.empty() || geometry.sphere_bins.tile(index).empty());
}

constexpr int kBlock = DepthTile::kBlock;

/// Copies a row of a tile's blocks to the image, from pixel row y on. row_of(block, row) returns the address of
/// eight pixels of a block. Whole cache lines are written with non-temporal stores, because a frame is larger than
/// what caches retain until the next one.
template <typename Pixel, typename RowOf>
void copy_blocks(const PixelRect& rect, int y, const RowOf& row_of, Image<Pixel>& picture) {
    static_assert(2 * kBlock * sizeof(Pixel) == 64);
    for (int row = 0; row < std::min(kBlock, rect.y1 - y); ++row) {
        Pixel* to = &picture(rect.x0, y + row);
        const auto block = [&](int column) {
            return row_of(static_cast<std::size_t>(column), static_cast<std::size_t>(row));
        };
        int column = 0, left = rect.width();
        if (begins_line(to))
            for (; left >= 2 * kBlock; left -= 2 * kBlock, column += 2)
                stream_line(block(column), block(column + 1), to + column * kBlock);
        for (; left >= kBlock; left -= kBlock, ++column) std::copy_n(block(column), kBlock, to + column * kBlock);
        if (left > 0) std::copy_n(block(column), left, to + column * kBlock);
    }
}

/// Fills the pixels of an empty tile.
template <typename Pixel> void fill(const PixelRect& rect, const Pixel& pixel, Image<Pixel>& picture) {
    std::array<Pixel, kBlock> eight;
    eight.fill(pixel);
    for (int y = rect.y0; y < rect.y1; y += kBlock)
        copy_blocks(rect, y, [&](std::size_t, std::size_t) { return eight.data(); }, picture);
    finish_streams();
}

void copy_nearness(const DepthTile& tile, ImageFloat& picture) {
    static constexpr std::array<float, kBlock> kNothing{};
    const PixelRect& rect = tile.rect();
    for (int y = rect.y0; y < rect.y1; y += kBlock) {
        const std::size_t first = tile.place(rect.x0, y) / kBlockSamples;
        const auto row_of = [&](std::size_t column, std::size_t row) {
            return tile.drawn(first + column) ? tile.nearness() + (first + column) * kBlockSamples + row * kBlock
                                              : kNothing.data();
        };
        copy_blocks(rect, y, row_of, picture);
    }
    finish_streams();
}

/// Shades a tile's pixels and stores them in the image: packet by packet with a program, else one by one.
class TileDisplay {
public:
    TileDisplay(const PreparedData& data, const Settings& settings, const Program* program, const Geometry& geometry,
                const PassView& view, const DepthTile& tile, std::optional<Rgba8> background, Image<Rgba8>& picture)
        : data_(data), settings_(settings), geometry_(geometry), view_(view), tile_(tile), picture_(picture),
          shader_(program != nullptr ? program->for_tile(data, geometry, view, tile.rect()) : nullptr),
          background_(background) {
        if (background_) empty_strip_.fill(*background_);
    }

    void run() {
        const PixelRect& rect = tile_.rect();
        for (int y = rect.y0; y < rect.y1; y += kBlock) {
            std::uint32_t place = tile_.place(rect.x0, y);
            std::size_t slot = 0;
            for (int x = rect.x0; x < rect.x1; x += kBlock, place += kBlockSamples, slot += kStrips)
                block(x, y, place, slot);
            shade_together();
            const auto row_of = [&](std::size_t column, std::size_t row) {
                constexpr std::size_t kRows = kStripRows;
                return codes_[column * kStrips + row / kRows].at(row % kRows * kStripWidth);
            };
            copy_blocks(rect, y, row_of, picture_);
        }
        finish_streams();
    }

private:
    static constexpr int kStripRows = DepthTile::kStripRows;
    static constexpr std::size_t kStrips = kBlock / kStripRows; ///< per block

    /// Queues the packets of the block whose first pixel is (x, y), or fills them with the background.
    void block(int x, int y, std::uint32_t place, std::size_t slot) {
        if (background_ && !tile_.drawn(place / kBlockSamples)) {
            std::fill_n(codes_.begin() + static_cast<std::ptrdiff_t>(slot), kStrips, empty_strip_);
            return;
        }
        for (std::size_t s = 0; s < kStrips; ++s, y += kStripRows, place += kStrip, ++slot) {
            if (background_ && samples_seen(tile_.ids() + place) == 0)
                codes_[slot] = empty_strip_;
            else
                strip(x, y, place, slot);
        }
    }

    void strip(int x, int y, std::uint32_t place, std::size_t slot) {
        if (shader_ == nullptr)
            return shade_one_by_one(intersect(tile_.rect(), {x, y, x + kBlock, y + kStripRows}), codes_[slot]);
        const std::size_t next = count_++;
        codes_of_[next] = &codes_[slot];
        places_[next] = strip_place(tile_, x, y, place);
    }

    /// Shades the queued packets of a row of blocks.
    void shade_together() {
        if (count_ == 0) return;
        shader_->shade(std::span(places_).first(count_), colors_.data(), seen_.data());
        // A program implies a background.
        encode_strips(std::span(colors_).first(count_), seen_.data(), *background_, codes_of_.data());
        count_ = 0;
    }

    void shade_one_by_one(const PixelRect& r, StripCodes& codes) {
        if (!hits_) hits_.emplace(tile_, geometry_, view_);
        for (int y = r.y0; y < r.y1; ++y)
            for (int x = r.x0; x < r.x1; ++x)
                codes[static_cast<std::size_t>(y - r.y0) * kStripWidth + static_cast<std::size_t>(x - r.x0)] =
                    encoded(srgb_encoder(), shade(data_, settings_, *hits_, x, y).radiance);
    }

    const PreparedData& data_;
    const Settings& settings_;
    const Geometry& geometry_;
    const PassView& view_;
    const DepthTile& tile_;
    Image<Rgba8>& picture_;
    std::unique_ptr<StripShader> shader_;
    static constexpr std::size_t kMost = DepthTile::kBlocks * kStrips;
    std::array<StripCodes, kMost> codes_;  ///< of a row of blocks
    std::array<StripPlace, kMost> places_; ///< queued packets
    std::array<StripCodes*, kMost> codes_of_{}; ///< destinations of the queued packets
    std::array<StripColors, kMost> colors_;
    std::array<std::uint32_t, kMost> seen_{};
    std::size_t count_ = 0;
    std::optional<HitTile> hits_; ///< created on first use
    std::optional<Rgba8> background_;
    StripCodes empty_strip_; ///< filled with the background
};

} // namespace

void display_tile(const PreparedData& data, const Settings& settings, const Program* program, const Geometry& geometry,
                  const PassView& view, const PixelRect& rect, std::size_t index, Image<Rgba8>& picture) {
    const std::optional<Rgb> color = constant_background(data, settings);
    std::optional<Rgba8> background;
    if (color) background = encoded(srgb_encoder(), *color);
    if (background && is_empty(geometry, index)) {
        fill(rect, *background, picture);
        return;
    }
    DepthTile tile;
    draw_tile(geometry, view, view.samples.front(), rect, index, tile);
    if (!background || program == nullptr) tile.empty_undrawn(); // undrawn blocks are read as well
    TileDisplay(data, settings, program, geometry, view, tile, background, picture).run();
}

namespace {

/// Does the same as keep_nearness(), and leaves the depth buffer in `depths`. Returns false if the tile is empty.
bool keep_depths(const Geometry& geometry, const PassView& view, const PixelRect& rect, std::size_t index,
                 DepthTile& depths, ImageFloat& picture) {
    if (is_empty(geometry, index)) {
        fill(rect, 0.0f, picture);
        return false;
    }
    draw_tile(geometry, view, view.samples.front(), rect, index, depths);
    copy_nearness(depths, picture);
    return true;
}

} // namespace

void keep_nearness(const Geometry& geometry, const PassView& view, const PixelRect& rect, std::size_t index,
                   ImageFloat& picture) {
    DepthTile depths;
    keep_depths(geometry, view, rect, index, depths, picture);
}

void keep_nearness_and_colors(const PreparedData& data, const Geometry& geometry, const PassView& view,
                              const Program& program, const PixelRect& rect, std::size_t index, ImageFloat& nearness,
                              ImageRgb& colors) {
    DepthTile depths;
    if (!keep_depths(geometry, view, rect, index, depths, nearness)) return;
    depths.empty_undrawn(); // undrawn blocks are read as well
    const auto shader = program.for_tile(data, geometry, view, rect);
    for (int y0 = rect.y0; y0 < rect.y1; y0 += DepthTile::kStripRows)
        for (int x0 = rect.x0; x0 < rect.x1; x0 += static_cast<int>(kStripWidth)) {
            StripColors strip;
            const std::uint32_t seen = shader->shade(strip_place(depths, x0, y0), strip);
            for (std::size_t i = 0; i < kStrip; ++i) {
                const int x = x0 + static_cast<int>(i % kStripWidth), y = y0 + static_cast<int>(i / kStripWidth);
                if (x < rect.x1 && y < rect.y1 && (seen >> i & 1))
                    colors(x, y) = Rgb(strip.r[i], strip.g[i], strip.b[i]);
            }
        }
}

void encode(const ImageRgb& radiance, int threads, Image<Rgba8>& picture) {
    picture = Image<Rgba8>(radiance.width(), radiance.height());
    const SrgbEncoder& encoder = srgb_encoder();
    parallel_for(static_cast<std::size_t>(radiance.height()), threads, [&](std::size_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < radiance.width(); ++x) picture(x, y) = encoded(encoder, radiance(x, y));
    });
}

} // namespace duet::raster
