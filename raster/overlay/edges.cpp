#include "raster/overlay/edges.h"

#include "raster/visibility/hit_lists.h"
#include "raster/visibility/strip_samples.h"

#include <algorithm>
#include <cmath>

namespace duet::raster {
namespace {

/// Returns the object of a primitive id.
std::uint32_t object_of(const Geometry& geometry, std::uint32_t id) {
    const Run& run = geometry.triangles.run_of(id);
    return run.sphere ? geometry.spheres[run.object].object : geometry.triangles.objects[run.object].object;
}

} // namespace

void SeenPicture::add(const DepthTile& tile, const Geometry& geometry, StripShader& normals) {
    const PixelRect& r = tile.rect();
    StripColors colors;
    for (int y0 = r.y0; y0 < r.y1; y0 += DepthTile::kStripRows)
        for (int x0 = r.x0; x0 < r.x1; x0 += static_cast<int>(kStripWidth)) {
            const StripPlace place = strip_place(tile, x0, y0);
            normals.shade(place, colors);
            for (std::size_t i = 0; i < kStrip; ++i) {
                const int x = x0 + static_cast<int>(i % kStripWidth), y = y0 + static_cast<int>(i / kStripWidth);
                if (x >= r.x1 || y >= r.y1) continue;
                const auto id = static_cast<std::uint32_t>(place.ids[i]);
                const bool any = id != kNoTriangle;
                nearness(x, y) = any ? place.nearness[i] : 0;
                normal(x, y) = any ? Vec3(colors.r[i], colors.g[i], colors.b[i]) : Vec3();
                object(x, y) = any ? object_of(geometry, id) : kNoObject;
            }
        }
}

void SeenPicture::add_layers(const PreparedData& data, const Geometry& layers, const PassView& view,
                             SampleOffset offset, std::size_t tile_index, const HitTile& tile, const Program& normals) {
    HitLists lists(layers, view, offset, tile_index, tile);
    const auto mostly = [](int, int, float left) { return left < 0.5f; };
    lists.for_each_stop(data.scene, mostly, [&](int x, int y, const Hit& hit) {
        const Rgb n = normals.shade_hit(data, view, hit, offset.position(x, y));
        nearness(x, y) =
            static_cast<float>(view.pinhole.near * tile.distance_per_depth(x, y) / static_cast<double>(hit.t));
        normal(x, y) = Vec3(n.r, n.g, n.b);
        object(x, y) = hit.object;
    });
}

namespace {

/// Returns a linear ramp from 0 at `low` to 1 at `high`.
float ramp(float x, float low, float high) { return std::clamp((x - low) / (high - low), 0.0f, 1.0f); }

/// Gives access to the neighborhood of a pixel. Beyond the image border, the pixels on the border are repeated.
struct Around {
    int width, height, x, y;

    template <typename Pixel> const Pixel& at(const Image<Pixel>& image, int dx, int dy) const {
        return image(std::clamp(x + dx, 0, width - 1), std::clamp(y + dy, 0, height - 1));
    }
};

/// Returns the magnitude of both Sobel operators, scaled by 1/4. A straight edge between two uniform regions yields
/// their difference.
float sobel(const Image<Vec3>& image, const Around& around) {
    Vec3 across, down;
    for (int k = -1; k <= 1; ++k) {
        const float weight = (k == 0 ? 2.0f : 1.0f) / 4;
        across += (around.at(image, 1, k) - around.at(image, -1, k)) * weight;
        down += (around.at(image, k, 1) - around.at(image, k, -1)) * weight;
    }
    return std::sqrt(dot(across, across) + dot(down, down));
}

/// Returns the larger of the horizontal and the vertical second difference.
float second_difference(const ImageFloat& image, const Around& around) {
    const float twice = 2 * around.at(image, 0, 0);
    return std::max(std::abs(around.at(image, -1, 0) + around.at(image, 1, 0) - twice),
                    std::abs(around.at(image, 0, -1) + around.at(image, 0, 1) - twice));
}

} // namespace

float ink(const SeenPicture& seen, int x, int y) {
    const Around around{seen.nearness.width(), seen.nearness.height(), x, y};
    const std::uint32_t own = seen.object(x, y);
    for (const auto& [dx, dy] : {std::pair(-1, 0), std::pair(1, 0), std::pair(0, -1), std::pair(0, 1)})
        if (around.at(seen.object, dx, dy) != own) return 1;
    if (own == kNoObject) return 0;
    const float step = second_difference(seen.nearness, around) / seen.nearness(x, y);
    const float crease = 2 * sobel(seen.normal, around); // the stored normals are halved
    return std::max(ramp(step, 0.02f, 0.04f), ramp(crease, 0.5f, 0.8f));
}

} // namespace duet::raster
