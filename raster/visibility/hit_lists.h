// Builds per-pixel lists of surfaces in front of the visible surface, sorted by depth.
#pragma once

#include "raster/visibility/hit_tile.h"

#include "common/image/image.h"
#include "common/scene/scene.h"

#include <array>

namespace duet::raster {

/// Returns whether surfaces of the transmittance `left` block a pixel. They block as many pixels as they stop of the
/// light, in an ordered dither (stochastic transparency).
bool blocks_in_dither(int x, int y, float left);

/// Holds lists of Hits in front of the visible surface of each pixel, sorted front to back, one sample per pixel
/// (Carpenter 1984, "The A-buffer, an Antialiased Hidden Surface Method"). A list stores the kStored nearest hits. If
/// more are needed, the tile is drawn again for the hits behind these, so memory does not grow with the number of
/// surfaces.
class HitLists {
public:
    /// `geometry` holds the surfaces of the lists, `offset` is that of the tile's samples. The references must
    /// outlive the object.
    HitLists(const Geometry& geometry, const PassView& view, SampleOffset offset, std::size_t tile_index,
             const HitTile& tile);

    bool empty() const { return pixels_.empty(); } ///< whether no primitive overlaps the tile

    /// Calls take(x, y, hit) for the hits of each pixel, front to back, until it returns true for the pixel.
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

    /// Calls take(x, y, hit) for the first hit of each pixel that stops its light. stops(x, y, left) decides this
    /// from the transmittance `left` of the surfaces up to and including this hit.
    template <typename Stops, typename Take>
    void for_each_blocking_hit(const Scene& scene, const Stops& stops, const Take& take) {
        if (empty()) return;
        const PixelRect& r = tile_.rect();
        ImageFloat transmittance(r.width(), r.height(), 1.0f);
        for_each([&](int x, int y, const Hit& hit) {
            float& left = transmittance(x - r.x0, y - r.y0);
            left *= 1 - opacity(scene, tile_.ray(x, y), hit);
            if (!stops(x, y, left)) return false;
            take(x, y, hit);
            return true;
        });
    }

private:
    static constexpr std::size_t kStored = 8; ///< hits of a pixel in one pass over the tile
    struct Pixel {
        std::array<Hit, kStored> nearest;
        std::uint32_t count = 0;
        bool more = false, done = false;
        Hit last{.t = -1}; ///< this hit and all nearer ones are processed
    };

    /// Represents a triangle whose hits are to be listed.
    struct ListedTriangle {
        UnclippedTriangle whole;
        Geometry::Primitive primitive;
    };

    ListedTriangle listed(std::uint32_t id) const;
    void draw();
    void draw_triangle(const DrawTriangle& triangle);
    void draw_sphere(const DrawSphere& sphere);
    void add(int x, int y, const ListedTriangle& triangle);
    void add(int x, int y, const Hit& hit);
    Pixel& pixel(int x, int y) { return pixels_(x - tile_.rect().x0, y - tile_.rect().y0); }

    const Geometry& geometry_;
    const PassView& view_;
    SampleOffset offset_;
    std::size_t tile_index_;
    const HitTile& tile_;
    Image<Pixel> pixels_; ///< pixels of the tile
};

} // namespace duet::raster
