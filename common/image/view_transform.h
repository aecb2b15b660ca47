// This file implements the view transform, which maps linear radiance without an upper limit to the 8-bit values of a
// display.
#pragma once

#include "common/image/image.h"
#include "common/system/name_table.h"

#include <array>
#include <cstdint>
#include <vector>

namespace duet {

/// A tone curve compresses radiance into the range of a display, [0, 1].
/// - kNone clips: values above 1 become 1.
/// - kFilmic is Narkowicz's fit of the ACES film curve (2016, "ACES Filmic Tone Mapping Curve"), for each channel by
///   itself. Its argument is scaled so that middle gray, 0.18, stays 0.18.
/// - kAgx is Sobotka's AgX (2022) in the form of Wrensch (2023, "Minimal AgX Implementation"), the default of Blender.
///   It mixes the channels before the curve, so that bright colors become paler, as on film, instead of changing hue.
///   Middle gray becomes half of the display's code range.
enum class Tone { kNone, kFilmic, kAgx };
/// These are the names of the tone curves in scene files and on command lines, in the order of Tone.
inline constexpr NameTable<Tone, 3> kTones{"tone",
                                           {{{"none", Tone::kNone}, {"filmic", Tone::kFilmic}, {"agx", Tone::kAgx}}}};

/// The exposure of a view transform is in [−kMaxExposure, kMaxExposure] stops.
inline constexpr float kMaxExposure = 32;

/// A ViewTransform says how 8-bit files show linear radiance. The default clips radiance to [0, 1].
struct ViewTransform {
    float exposure = 0; ///< in stops: radiance is scaled by 2^exposure
    Tone tone = Tone::kNone;
    bool dither = false; ///< adds noise of one code before rounding, which hides the steps of slow gradients

    friend bool operator==(const ViewTransform&, const ViewTransform&) = default;
};

using ColorMatrix = std::array<std::array<float, 3>, 3>; ///< rows

/// A ToneMapping consists of a matrix, a curve for each channel and another matrix. Its input is linear and scaled by
/// the exposure, its output linear, to be encoded by the sRGB curve. NaN and negative input count as 0.
struct ToneMapping {
    ColorMatrix inset;
    float (*curve)(float linear);
    ColorMatrix outset;

    Rgb operator()(Rgb linear) const;
};
/// Returns the mapping of a tone curve.
const ToneMapping& tone_mapping(Tone tone);

/// Returns the linear color that the display shall show for a radiance, before it is clipped to [0, 1].
Rgb displayed(Rgb radiance, const ViewTransform& view);

/// Returns the bytes of 8-bit files, 3 per pixel with rows from the top: the image after the view transform, encoded by
/// the sRGB curve and rounded to nearest, or dithered. It uses `threads` threads (0: all), whose number does not change
/// the result.
std::vector<std::uint8_t> display_bytes(const ImageRgb& image, const ViewTransform& view, int threads = 0);

} // namespace duet
