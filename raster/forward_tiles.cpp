#include "raster/forward_tiles.h"

#include "raster/shading/alpha_layers.h"
#include "raster/shading/sample_attributes.h"
#include "raster/visibility/hit_tile.h"
#include "raster/visibility/multisample.h"
#include "raster/visibility/packet_primitives.h"
#include "raster/visibility/rasterize_tile.h"

#include "common/system/stopwatch.h"

#include <optional>

namespace duet::raster {
namespace {

/// Shades the samples of a tile with a program, one row of packets at a time.
void shade_tile(const FrameContext& frame, const PassView& view, const DepthTile& depths, Framebuffer& framebuffer) {
    const PixelRect& rect = depths.rect();
    const auto shader = frame.program->for_tile(frame.data, frame.geometry, view, rect);
    constexpr int kColumns = kPacketWidth, kRows = DepthTile::kPacketRows;
    std::array<SamplePacket, TileGrid::kTileSize / kColumns> packets;
    std::array<ColorPacket, TileGrid::kTileSize / kColumns> colors;
    std::array<std::uint32_t, TileGrid::kTileSize / kColumns> visible;
    for (int y0 = rect.y0; y0 < rect.y1; y0 += kRows) {
        std::size_t count = 0;
        for (int x0 = rect.x0; x0 < rect.x1; x0 += kColumns) packets[count++] = sample_packet(depths, x0, y0);
        shader->shade(std::span(packets).first(count), colors.data(), visible.data());
        for (int y = y0; y < std::min(y0 + kRows, rect.y1); ++y)
            for (int x = rect.x0; x < rect.x1; ++x) {
                const auto packet = static_cast<std::size_t>((x - rect.x0) / kColumns);
                const auto i = static_cast<std::size_t>((y - y0) * kColumns + (x - rect.x0) % kColumns);
                const ColorPacket& packet_colors = colors[packet];
                framebuffer.add(
                    x, y,
                    visible[packet] >> i & 1 ? Rgb(packet_colors.r[i], packet_colors.g[i], packet_colors.b[i]) : Rgb());
            }
    }
}

/// Returns true if the tile's samples are visited one by one. Auxiliary images require it, and so do transparent layers
/// in front of a program's surfaces.
bool visits_samples(const FrameContext& frame, std::size_t tile) {
    return frame.settings.aovs.any() || (frame.program != nullptr && frame.has_layers_in(tile));
}

/// Shades one layer of a multisampled tile. Each primitive is shaded once per pixel and weighted by its number of
/// samples.
void shade_layer(const FrameContext& frame, const PassView& view, const LayeredTile& tile, std::size_t layer,
                 Framebuffer& framebuffer) {
    const PixelRect& rect = tile.rect();
    const auto for_each = [&](const auto& visit) { // calls visit(x, y, count) for the pixels in the layer
        for (int y = rect.y0; y < rect.y1; ++y)
            for (int x = rect.x0; x < rect.x1; ++x)
                if (const int count = tile.layer(layer).count(tile.sample_index(x, y)); count > 0) visit(x, y, count);
    };
    if (frame.settings.aovs.any()) {
        const HitTile hits(tile, layer, frame.geometry, view);
        for_each([&](int x, int y, int count) {
            const ShadedSample attributes = sample_attributes(frame.data, frame.settings, hits, x, y);
            for (int i = 0; i < count; ++i) framebuffer.add_aovs(hits, x, y, attributes);
        });
    }
    const auto shader = frame.program->for_tile(frame.data, frame.geometry, view, rect);
    LayeredTile::LayerPacket layer_packet;
    for (int y0 = rect.y0; y0 < rect.y1; y0 += DepthTile::kPacketRows)
        for (int x0 = rect.x0; x0 < rect.x1; x0 += static_cast<int>(kPacketWidth)) {
            tile.layer_packet(layer, x0, y0, layer_packet);
            if (layer_packet.packet.ids == nullptr) continue;
            ColorPacket colors;
            const std::uint32_t visible = shader->shade(layer_packet.packet, colors), first = tile.sample_index(x0, y0);
            for (std::uint32_t i = 0; i < kPacketSize; ++i)
                if (const int count = tile.layer(layer).count(first + i); count > 0) {
                    const int x = x0 + static_cast<int>(i % kPacketWidth), y = y0 + static_cast<int>(i / kPacketWidth);
                    if (x < rect.x1 && y < rect.y1)
                        framebuffer.add(x, y, visible >> i & 1 ? Rgb(colors.r[i], colors.g[i], colors.b[i]) : Rgb(),
                                        count);
                }
        }
}

} // namespace

void visit_samples(const FrameContext& frame, const PassView& view, std::size_t index, const DepthTile& depths,
                   Framebuffer& framebuffer) {
    HitTile tile(depths, frame.geometry, view);
    std::optional<Layers> layers;
    if (frame.has_layers_in(index))
        layers.emplace(frame.data, frame.settings, frame.program, *frame.layers, view, depths.offset(), index, tile);
    const PixelRect& rect = depths.rect();
    for (int y = rect.y0; y < rect.y1; ++y)
        for (int x = rect.x0; x < rect.x1; ++x) {
            ShadedSample shaded = sample_attributes(frame.data, frame.settings, tile, x, y);
            if (layers) {
                if (frame.program != nullptr && tile.hit(x, y).valid())
                    shaded.radiance =
                        frame.program->shade_hit(frame.data, view, tile.hit(x, y), depths.offset().position(x, y));
                shaded = layers->over(x, y, shaded);
            }
            if (frame.settings.aovs.any()) framebuffer.add_aovs(tile, x, y, shaded);
            if (layers && frame.program != nullptr) framebuffer.add(x, y, shaded.radiance);
        }
}

void render_multisampled_tile(const FrameContext& frame, const PassView& view, std::size_t index,
                              Framebuffer& framebuffer) {
    const PixelRect rect = frame.grid.tile(index);
    Stopwatch watch;
    LayeredTile tile(rect, static_cast<int>(view.samples.size()));
    DepthTile depths;
    for (const SampleOffset offset : view.samples) {
        rasterize_tile(frame.geometry, view, offset, rect, index, depths);
        tile.add(depths);
    }
    frame.collector.coverage_work += static_cast<std::int64_t>(watch.lap() * 1e9);
    for (std::size_t layer = 0; layer < tile.layers(); ++layer) shade_layer(frame, view, tile, layer, framebuffer);
    frame.collector.shade_work += static_cast<std::int64_t>(watch.lap() * 1e9);
}

void render_tile(const FrameContext& frame, const PassView& view, std::size_t index, Framebuffer& framebuffer) {
    const PixelRect rect = frame.grid.tile(index);
    DepthTile depths;
    for (const SampleOffset offset : view.samples) {
        Stopwatch watch;
        rasterize_tile(frame.geometry, view, offset, rect, index, depths);
        frame.collector.coverage_work += static_cast<std::int64_t>(watch.lap() * 1e9);
        if (visits_samples(frame, index)) visit_samples(frame, view, index, depths, framebuffer);
        if (!frame.has_layers_in(index)) shade_tile(frame, view, depths, framebuffer);
        frame.collector.shade_work += static_cast<std::int64_t>(watch.lap() * 1e9);
    }
}

} // namespace duet::raster
