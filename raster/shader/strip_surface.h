// What a strip's fragments ask of textures and maps: base colours, side by side where one texture says them, and normals.
#pragma once

#include "raster/shader/shader.h"
#include "raster/shader/texels.h"
#include "raster/visibility/strip_samples.h"

namespace duet::raster {

/// Where a strip's samples lie on their triangles: SolvedStrip's.
struct StripBarycentrics {
    const StripOf<float>*b1 = nullptr, *b2 = nullptr;
    const std::array<StripOf<float>, 2>*b1_steps = nullptr, *b2_steps = nullptr;
};

/// The surface that the samples of a strip see: triangles of one object, or a sphere. Goes from strip to strip.
class StripSurface final : public ColorSource {
public:
    StripSurface(const PreparedData& data, const Geometry& geometry, const PassView& view)
        : data_(data), geometry_(geometry), view_(view) {}

    /// All three must outlive the questions. Of a sphere barycentrics may be any.
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
