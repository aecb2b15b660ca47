// Reduces every opaque material to the lobes that the G-buffer stores.
#pragma once

#include "common/material/material.h"
#include "raster/geometry/packet.h"

#include <optional>

namespace duet::raster {

/// Holds the G-buffer's material attributes of one pixel (raster/gbuffer/gbuffer.h).
struct SurfaceLobes {
    Rgb diffuse{}, specular{};
    float alpha = 1, coat = 0, coat_alpha = 1;
    Rgb tint{};
};

/// Returns the lobes of a BSDF toward a viewer at this cosine from the normal, in (0, 1]. Glass keeps only its outer
/// reflection; its transmission is a stage of its own.
SurfaceLobes surface_lobes(const Bsdf& bsdf, float cosine);

/// Computes the lobes of a material of which only the base color varies over the surface, from that color and the
/// viewer's cosine alone. It agrees with surface_lobes() up to the interpolation of a table over the cosine.
class LobesOfColor {
public:
    /// Returns nothing if other parameters vary too, or if the lobes are not the functions of the color that diffuse()
    /// and specular() compute.
    static std::optional<LobesOfColor> of(const Material& material);

    /// diffuse() and specular() return the colors of the two lobes. T is float or Floats; cosine is in [0, 1].
    template <typename T> RgbT<T> diffuse(const RgbT<T>& color, const T& cosine) const {
        const T passed = passed_at(cosine);
        const auto channel = [&](const T& c) { return c * T(1 - back_) / (T(1) - c * T(back_)) * passed; };
        return {channel(color.r), channel(color.g), channel(color.b)};
    }
    template <typename T> RgbT<T> specular(const RgbT<T>& color) const {
        const auto channel = [&](const T& c) { return T(dielectric_) + c * T(metallic_); };
        return {channel(color.r), channel(color.g), channel(color.b)};
    }
    float alpha = 1, coat = 0, coat_alpha = 1;

private:
    static constexpr int kSteps = 32; ///< table intervals over the cosine, in which the albedo is smooth
    void tabulate(const LayeredBsdf& layers);
    template <typename T> T passed_at(const T& cosine) const;

    float metallic_ = 0;   ///< factor of the color in the specular lobe
    float dielectric_ = 0; ///< constant part of the specular lobe
    float back_ = 0;       ///< fraction of diffuse light that the boundary above reflects back down (Coated)
    /// The table holds the fraction of the diffuse lobe that leaves through the layers above it, by the cosine.
    std::array<float, kSteps + 2> passed_{};
    bool layered_ = false; ///< whether passed_ depends on the cosine
};

template <> inline float LobesOfColor::passed_at(const float& cosine) const {
    const float at = clamp(cosine, 0.0f, 1.0f) * kSteps, whole = std::floor(at);
    const auto i = static_cast<std::size_t>(whole);
    return passed_[i] + (passed_[i + 1] - passed_[i]) * (at - whole);
}
template <> inline Floats LobesOfColor::passed_at(const Floats& cosine) const {
    if (!layered_) return Floats(passed_[0]);
    const Floats at = clamp(cosine, Floats(0.0f), Floats(1.0f)) * Floats(static_cast<float>(kSteps));
    const Ints whole = truncated(at);
    const Floats low = gather(passed_.data(), whole), high = gather(passed_.data() + 1, whole);
    return low + (high - low) * (at - xsimd::batch_cast<float>(whole));
}

} // namespace duet::raster
