// Evaluates base colors and mapped normals of a packet's fragments. Base colors of objects with a single texture
// use SIMD.
#pragma once

#include "raster/shader/shader.h"
#include "raster/shader/texels.h"
#include "raster/visibility/strip_samples.h"

namespace duet::raster {

/// Refers to the barycentrics of a packet's samples, as in SolvedStrip.
struct StripBarycentrics {
    const StripOf<float>*b1 = nullptr, *b2 = nullptr;
    const std::array<StripOf<float>, 2>*b1_steps = nullptr, *b2_steps = nullptr;
};

/// Represents the surface visible in a packet: triangles of one object, or a sphere. One instance is reused for
/// successive packets.
class StripSurface final : public ColorSource {
public:
    StripSurface(const PreparedData& data, const Geometry& geometry, const PassView& view)
        : data_(data), geometry_(geometry), view_(view) {}

    /// Selects a packet. All three arguments must outlive the following calls. The barycentrics are not used for a
    /// sphere.
    void move_to(const StripPlace& place, const StripSamples& samples, const StripBarycentrics& at) {
        place_ = &place;
        samples_ = &samples;
        at_ = at;
    }
    Rgb base_color(std::size_t sample) const override;
    RgbT<Floats> base_colors(std::size_t first) const override;
    Vec3 bent_normal(std::size_t sample) const override;
    Rgb emitted(std::size_t sample) const override;

private:
    TexturePlaces texture_places(std::size_t first) const;
    float step_scale() const;

    const PreparedData& data_;
    const Geometry& geometry_;
    const PassView& view_;
    const StripPlace* place_ = nullptr;
    const StripSamples* samples_ = nullptr;
    StripBarycentrics at_;
};

} // namespace duet::raster
