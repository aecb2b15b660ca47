#include "raster/display.h"

#include "raster/encode_strip.h"
#include "raster/shade.h"
#include "raster/strip_samples.h"

#include "common/image/srgb.h"
#include "common/system/parallel.h"

#include <algorithm>
#include <cstring>
#include <optional>

namespace duet::raster {
namespace {

Rgba8 encoded(const SrgbEncoder& encode, Rgb c) { return {encode(c.r), encode(c.g), encode(c.b), 255}; }

bool is_empty(const Geometry& geometry, std::size_t index) {
    return geometry.outlines.tile(index).empty() && geometry.fragments.tile(index).empty() &&
           (geometry.spheres.empty() || geometry.sphere_bins.tile(index).empty());
}

template <typename Pixel> void fill(const PixelRect& rect, const Pixel& pixel, Image<Pixel>& picture) {
    for (int y = rect.y0; y < rect.y1; ++y) std::fill_n(&picture(rect.x0, y), rect.width(), pixel);
}

void copy_nearness(const DepthTile& tile, ImageFloat& picture) {
    const PixelRect& rect = tile.rect();
    for (int y = rect.y0; y < rect.y1; ++y) {
        int x = rect.x0;
        for (; x + DepthTile::kBlock <= rect.x1; x += DepthTile::kBlock)
            std::memcpy(&picture(x, y), tile.nearness() + tile.place(x, y), sizeof(float) * DepthTile::kBlock);
        for (; x < rect.x1; ++x) picture(x, y) = tile.nearness(x, y);
    }
}

/// A tile's pixels, strip by strip: by the program, or one at a time.
class TileDisplay {
public:
    TileDisplay(const PreparedData& data, const Settings& settings, const Program* program, const Geometry& geometry,
                const PassView& view, const DepthTile& tile, Image<Rgba8>& picture)
        : data_(data), settings_(settings), geometry_(geometry), view_(view), tile_(tile), picture_(picture),
          shader_(program != nullptr ? program->for_tile(data, geometry, view, tile.rect()) : nullptr),
          background_(one_background(data, settings)) {}

    void run() {
        const PixelRect& rect = tile_.rect();
        for (int y = rect.y0; y < rect.y1; y += kStripRows)
            for (int x = rect.x0; x < rect.x1; x += static_cast<int>(kStripWidth)) strip(x, y);
    }

private:
    static constexpr int kStripRows = DepthTile::kStripRows;

    void strip(int x, int y) {
        const StripPlace place = strip_place(tile_, x, y);
        const bool drawn = tile_.drawn(static_cast<std::size_t>(place.ids - tile_.ids()) / kBlockSamples);
        std::array<Rgba8, kStrip> codes;
        if (!drawn && background_)
            codes.fill(*background_);
        else if (shader_ != nullptr)
            shade_together(place, codes);
        else if (background_ && samples_seen(place.ids) == 0)
            codes.fill(*background_);
        else
            return shade_one_by_one(x, y);
        for (int row = 0; row < std::min(kStripRows, tile_.rect().y1 - y); ++row) {
            const auto from = codes.begin() + row * static_cast<int>(kStripWidth);
            const int width = std::min(static_cast<int>(kStripWidth), tile_.rect().x1 - x);
            if (width == kStripWidth)
                std::copy_n(from, kStripWidth, &picture_(x, y + row));
            else
                std::copy_n(from, width, &picture_(x, y + row));
        }
    }

    void shade_together(const StripPlace& place, std::array<Rgba8, kStrip>& codes) {
        StripColors colors;
        const std::uint32_t seen = shader_->shade(place, colors);
        if (seen == 0) return codes.fill(*background_); // a program has one
        encode_strip(colors, codes);
        if (seen != (1u << kStrip) - 1)
            for (std::size_t i = 0; i < kStrip; ++i)
                if (!(seen >> i & 1)) codes[i] = *background_;
    }

    void shade_one_by_one(int x0, int y0) {
        if (!hits_) hits_.emplace(tile_, geometry_, view_);
        const PixelRect r = intersect(tile_.rect(), {x0, y0, x0 + static_cast<int>(kStripWidth), y0 + kStripRows});
        for (int y = r.y0; y < r.y1; ++y)
            for (int x = r.x0; x < r.x1; ++x)
                picture_(x, y) = encoded(srgb_encoder(), shade(data_, settings_, *hits_, x, y).radiance);
    }

    static std::optional<Rgba8> one_background(const PreparedData& data, const Settings& settings) {
        const std::optional<Rgb> color = constant_background(data, settings);
        if (!color) return std::nullopt;
        return encoded(srgb_encoder(), *color);
    }

    const PreparedData& data_;
    const Settings& settings_;
    const Geometry& geometry_;
    const PassView& view_;
    const DepthTile& tile_;
    Image<Rgba8>& picture_;
    std::unique_ptr<StripShader> shader_;
    std::optional<HitTile> hits_; ///< where one is needed
    std::optional<Rgba8> background_;
};

} // namespace

void display_tile(const PreparedData& data, const Settings& settings, const Program* program, const Geometry& geometry,
                  const PassView& view, const PixelRect& rect, std::size_t index, Image<Rgba8>& picture) {
    if (const auto background = constant_background(data, settings); background && is_empty(geometry, index)) {
        fill(rect, encoded(srgb_encoder(), *background), picture);
        return;
    }
    DepthTile tile;
    cover(geometry, view, view.samples.front(), rect, index, tile);
    TileDisplay(data, settings, program, geometry, view, tile, picture).run();
}

void keep_nearness(const Geometry& geometry, const PassView& view, const PixelRect& rect, std::size_t index,
                   ImageFloat& picture) {
    if (is_empty(geometry, index)) {
        fill(rect, 0.0f, picture);
        return;
    }
    DepthTile depths;
    cover(geometry, view, view.samples.front(), rect, index, depths);
    copy_nearness(depths, picture);
}

void keep_nearness_and_colors(const PreparedData& data, const Geometry& geometry, const PassView& view, const Program& program,
                              const PixelRect& rect, std::size_t index, ImageFloat& nearness, ImageRgb& colors) {
    if (is_empty(geometry, index)) {
        fill(rect, 0.0f, nearness);
        return;
    }
    DepthTile depths;
    cover(geometry, view, view.samples.front(), rect, index, depths);
    copy_nearness(depths, nearness);
    const auto shader = program.for_tile(data, geometry, view, rect);
    for (int y0 = rect.y0; y0 < rect.y1; y0 += DepthTile::kStripRows)
        for (int x0 = rect.x0; x0 < rect.x1; x0 += static_cast<int>(kStripWidth)) {
            StripColors strip;
            const std::uint32_t seen = shader->shade(strip_place(depths, x0, y0), strip);
            for (std::size_t i = 0; i < kStrip; ++i) {
                const int x = x0 + static_cast<int>(i % kStripWidth), y = y0 + static_cast<int>(i / kStripWidth);
                if (x < rect.x1 && y < rect.y1 && (seen >> i & 1)) colors(x, y) = Rgb(strip.r[i], strip.g[i], strip.b[i]);
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
