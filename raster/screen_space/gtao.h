// Implements ground-truth ambient occlusion (GTAO), which estimates how much of the environment the surfaces in the
// image hide from each pixel (Jimenez et al. 2016, "Practical Realtime Strategies for Accurate Indirect Occlusion",
// §4). Horizons are searched at half resolution, averaged over 7 × 7 neighbors on the same surface, and upsampled along
// depths and normals.
#pragma once

#include "raster/gbuffer/gbuffer.h"
#include "raster/geometry/lane_math.h"
#include "raster/screen_space/sky_visibility.h"

namespace duet::raster {

/// Holds the occlusion of a G-buffer, and optionally its irradiance, at half resolution. Its memory is reused from
/// frame to frame.
class GtaoImage {
public:
    /// Searches for occluders up to `radius` meters away; with radius 0 there are none. The G-buffer must outlive the
    /// use of this object.
    void compute(const GBuffer& gbuffer, float radius, int threads);
    /// Computes irradiance(p, n, lanes) at every half-resolution pixel: p is relative to the eye, n unit. The results
    /// overwrite the hidden directions.
    template <typename Irradiance> void add_irradiance(int threads, const Irradiance& irradiance);

    /// Returns the visibility of a batch of the G-buffer's pixels, upsampled along depths and normals.
    SkyVisibility<Floats> at(int x, int y) const { return upsampled(x, y).sky; }
    /// Returns the visible fraction and the irradiance of a batch, after add_irradiance(). `found` marks the lanes
    /// whose surface has a pixel at half resolution nearby; the others have no irradiance.
    struct Lit {
        Floats visible;
        RgbT<Floats> irradiance;
        xsimd::batch_bool<float> found;
    };
    Lit lit_at(int x, int y) const {
        const auto [s, found] = upsampled(x, y);
        return {s.visible, {s.hidden.x, s.hidden.y, s.hidden.z}, found};
    }

    std::size_t memory_bytes() const {
        return depth_.memory_bytes() + normal_.memory_bytes() + lines_.memory_bytes() + column_sums_.memory_bytes() +
               smooth_.visible.memory_bytes() + smooth_.hidden.memory_bytes();
    }

    static constexpr int kSteps = 10; ///< depth samples on each side of a pixel

private:
    struct Planes {
        PlaneFloat visible;
        Planes3 hidden;
    };
    struct Upsampled {
        SkyVisibility<Floats> sky;
        xsimd::batch_bool<float> found;
    };
    /// Stores the occluded part of the hemisphere along one line through each pixel (`lost`, `directions`), and the
    /// line's whole part (`all`); or sums of these over neighbors. Sums are divided by sums, because a line's share of
    /// the hemisphere depends on its direction.
    struct Lines {
        PlaneFloat lost, all;
        Planes3 directions;

        std::size_t memory_bytes() const {
            return lost.memory_bytes() + all.memory_bytes() + directions.memory_bytes();
        }
    };
    Upsampled upsampled(int x, int y) const;
    void search_row(int y, float radius);
    template <typename Use> void sum_neighbors(const Lines& from, int y, int step_x, int step_y, const Use& use) const;
    void sum_columns(int y);
    void finish_row(int y);
    void reset(int width, int height);
    Vec3T<Floats> point(int x, int y, const Floats& depth) const;

    const GBuffer* gbuffer_ = nullptr;
    PlaneFloat depth_;      ///< reversed depth of every second pixel of every second row
    Planes3 normal_;        ///< normals of the same pixels
    Lines lines_;           ///< search results of single pixels
    Lines column_sums_;     ///< sums along columns
    Planes smooth_; ///< averaged over neighbors
};

template <typename Irradiance> void GtaoImage::add_irradiance(int threads, const Irradiance& irradiance) {
    for_each_batch(depth_.width(), depth_.height(), threads, [&](int x, int y) {
        const Floats depth = load(depth_, x, y);
        const auto seen = depth > Floats(0.0f);
        if (!xsimd::any(seen)) return;
        const RgbT<Floats> e = irradiance(point(x, y, depth), normal_.vector(x, y), seen);
        smooth_.hidden.set(x, y, blend(seen, e, RgbT<Floats>(Floats(0.0f))));
    });
}

} // namespace duet::raster
