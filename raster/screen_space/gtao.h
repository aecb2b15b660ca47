// Implements ground-truth ambient occlusion (GTAO), which estimates how much of the environment the surfaces in the
// image hide from each pixel (Jimenez et al. 2016, "Practical Realtime Strategies for Accurate Indirect Occlusion",
// §4), and how much light those surfaces send there instead (Ritschel, Grosch and Seidel 2009, "Approximating Dynamic
// Global Illumination in Image Space"). Horizons are searched at half resolution, averaged over 7 × 7 neighbors on the
// same surface, and upsampled along depths and normals.
#pragma once

#include "raster/gbuffer/gbuffer.h"
#include "raster/geometry/lane_math.h"
#include "raster/screen_space/horizon_search.h"
#include "raster/screen_space/sky_visibility.h"

namespace duet::raster {

/// Holds the occlusion of a G-buffer, and optionally its irradiance, at half resolution. Its memory is reused from
/// frame to frame.
class GtaoImage {
public:
    /// Takes the surfaces of a G-buffer, which must outlive the use of this object.
    void start(const GBuffer& gbuffer, int threads);
    /// Searches for occluders up to `radius` meters away, and the directions that they hide. With radius 0 there are
    /// none.
    void find_hidden(float radius, int threads) { search(radius, nullptr, threads); }
    /// Computes irradiance(p, n, lanes), without occluders, at every half-resolution pixel: p is relative to the eye, n
    /// unit.
    template <typename Irradiance> void set_irradiance(int threads, const Irradiance& irradiance);
    /// Searches for occluders up to `radius` meters away, and the light that they send, after set_irradiance(). Their
    /// direct light is that which the viewer sees, direct(x, y) of the G-buffer's pixels; they reflect the irradiance,
    /// too.
    template <typename Direct> void find_light(float radius, int threads, const Direct& direct);

    /// Returns the visibility of a batch of the G-buffer's pixels, upsampled along depths and normals.
    SkyVisibility<Floats> at(int x, int y) const { return upsampled(x, y).sky; }
    /// Holds the visible fraction of the hemisphere, the irradiance from all of it, without occlusion, and that from
    /// the occluders. `found` marks the lanes whose surface has a pixel at half resolution nearby; the others have no
    /// irradiance.
    struct Lit {
        Floats visible;
        RgbT<Floats> irradiance, from_occluders;
        xsimd::batch_bool<float> found;
    };
    /// Returns the light of a batch, after set_irradiance() and find_light().
    Lit lit_at(int x, int y) const {
        const auto [s, irradiance, found] = upsampled(x, y);
        return {s.visible, irradiance, RgbT<Floats>{s.hidden.x, s.hidden.y, s.hidden.z} * Floats(kPi), found};
    }

    std::size_t memory_bytes() const {
        return depth_.memory_bytes() + lines_.memory_bytes() + column_sums_.memory_bytes() +
               smooth_.visible.memory_bytes() + smooth_.hidden.memory_bytes() + irradiance_.memory_bytes() +
               occluders_.normals.memory_bytes() + occluders_.front.memory_bytes() + occluders_.back.memory_bytes();
    }

private:
    struct Planes {
        PlaneFloat visible;
        Planes3 hidden;
    };
    struct Upsampled {
        SkyVisibility<Floats> sky;
        RgbT<Floats> irradiance;
        xsimd::batch_bool<float> found;
    };
    /// Stores the occluded part of the hemisphere along one line through each pixel (`lost`), its directions or light
    /// (`directions`), and the line's whole part (`all`); or sums of these over neighbors. Sums are divided by sums,
    /// because a line's share of the hemisphere depends on its direction.
    struct Lines {
        PlaneFloat lost, all;
        Planes3 directions;

        std::size_t memory_bytes() const {
            return lost.memory_bytes() + all.memory_bytes() + directions.memory_bytes();
        }
    };
    Upsampled upsampled(int x, int y) const;
    void set_light(int x, int y, Rgb direct);
    void search(float radius, const Occluders* occluders, int threads);
    void search_row(int y, float radius, const Occluders* occluders);
    template <typename Use> void sum_neighbors(const Lines& from, int y, int step_x, int step_y, const Use& use) const;
    void sum_columns(int y);
    void finish_row(int y);
    void reset(int width, int height);
    Vec3T<Floats> point(int x, int y, const Floats& depth) const;

    const GBuffer* gbuffer_ = nullptr;
    PlaneFloat depth_;      ///< reversed depth of every second pixel of every second row
    Occluders occluders_;   ///< surfaces of the same pixels
    Lines lines_;           ///< search results of single pixels
    Lines column_sums_;     ///< sums along columns
    Planes smooth_;         ///< averaged over neighbors
    Planes3 irradiance_;    ///< of the same pixels, without occluders
};

template <typename Irradiance> void GtaoImage::set_irradiance(int threads, const Irradiance& irradiance) {
    for_each_batch(depth_.width(), depth_.height(), threads, [&](int x, int y) {
        const Floats depth = load(depth_, x, y);
        const auto seen = depth > Floats(0.0f);
        if (!xsimd::any(seen)) return;
        const RgbT<Floats> e = irradiance(point(x, y, depth), occluders_.normals.vector(x, y), seen);
        irradiance_.set(x, y, blend(seen, e, RgbT<Floats>(Floats(0.0f))));
    });
}

template <typename Direct> void GtaoImage::find_light(float radius, int threads, const Direct& direct) {
    parallel_for(static_cast<std::size_t>(depth_.height()), threads, [&](std::size_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < depth_.width(); ++x) set_light(x, y, direct(2 * x, 2 * y));
    });
    search(radius, &occluders_, threads);
}

} // namespace duet::raster
