// Each pixel's surfaces before what it sees, in order of depth.
#pragma once

#include "raster/visibility/cover.h"

#include "common/image/image.h"
#include "common/scene/scene.h"

#include <array>
#include <vector>

namespace duet::raster {

/// Whether anything of a geometry that was set up without patches may be in a tile.
bool touches(const Geometry& geometry, std::size_t tile);

/// The surfaces of a tile's pixels, one sample each, that are nearer than what that sees: lists of Hits, sorted from the front
/// (Carpenter 1984, «The A-buffer, an Antialiased Hidden Surface Method»). Lists hold the kKept nearest; where there are
/// more and they are asked for, the tile is drawn again for those behind them. So memory does not grow with the number of
/// surfaces.
class HitLists {
public:
    /// `geometry`: of the surfaces. `offset`: of the tile's samples. Refers to all.
    HitLists(const Geometry& geometry, const PassView& view, SampleOffset offset, std::size_t tile_index, const HitTile& tile);

    bool empty() const { return pixels_.empty(); } ///< nothing of the geometry touches the tile

    /// Calls take(x, y, hit) for the hits of each pixel, front to back, until that says it has done with the pixel.
    template <typename Take> void for_each(const Take& take) {
        for (bool again = !empty(); again;) {
            draw();
            again = false;
            const PixelRect& r = tile_.rect();
            for (int y = r.y0; y < r.y1; ++y)
                for (int x = r.x0; x < r.x1; ++x) {
                    Pixel& p = pixel(x, y);
                    for (std::uint32_t i = 0; i < p.count && !p.done; ++i) p.done = take(x, y, p.nearest[i]);
                    p.done = p.done || !p.more;
                    if (p.count > 0) p.last = p.nearest[p.count - 1];
                    p.more = false, p.count = 0;
                    again = again || !p.done;
                }
        }
    }

    /// Calls take(x, y, hit) for the first of each pixel's hits that stops its light: stops(x, y, left) says so of the part that it
    /// and those before it let through.
    template <typename Stops, typename Take> void for_each_stop(const Scene& scene, const Stops& stops, const Take& take) {
        if (empty()) return;
        const PixelRect& r = tile_.rect();
        ImageFloat through(r.width(), r.height(), 1.0f);
        for_each([&](int x, int y, const Hit& hit) {
            float& left = through(x - r.x0, y - r.y0);
            left *= 1 - opacity(scene, tile_.ray(x, y), hit);
            if (!stops(x, y, left)) return false;
            take(x, y, hit);
            return true;
        });
    }

private:
    static constexpr std::size_t kKept = 8;
    struct Pixel {
        std::array<Hit, kKept> nearest;
        std::uint32_t count = 0;
        bool more = false, done = false;
        Hit last{.t = -1}; ///< all nearer ones, and it, are dealt with
    };

    void draw();
    void draw_outline(const DrawTriangle& triangle);
    void draw_sphere(const DrawSphere& sphere);
    void add_triangle(std::uint32_t id, int x, int y);
    void add(int x, int y, const Hit& hit);
    Pixel& pixel(int x, int y) {
        const PixelRect& r = tile_.rect();
        return pixels_[static_cast<std::size_t>(y - r.y0) * static_cast<std::size_t>(r.width()) + static_cast<std::size_t>(x - r.x0)];
    }

    const Geometry& geometry_;
    const PassView& view_;
    SampleOffset offset_;
    std::size_t tile_index_;
    const HitTile& tile_;
    std::vector<Pixel> pixels_;
};

} // namespace duet::raster
