// This header declares which visible surfaces are flat, and so are assumed to continue behind occluders.
#pragma once

#include "raster/gbuffer/screen_gbuffer.h"

#include <cstdint>
#include <span>

namespace duet::raster {

/// Neighboring pixels of one surface differ in depth by at most this fraction of the depth.
inline constexpr float kSameSurface = 0.05f;
/// In radians: a larger angle is an edge rather than curvature. An isolated pixel also has this value.
inline constexpr float kMaxSmoothAngle = 0.5f;

/// Returns the largest angle in radians between the normal of pixel (x, y) and those of adjacent pixels on the same
/// surface. Reflected rays diverge by twice that angle. The G-buffer must have object IDs. The result is
/// half a radian if no neighbor is on the same surface.
float max_normal_angle(const ScreenGBuffer& gbuffer, int x, int y);
/// Returns the angles of all pixels for ScreenGBuffer::set_normal_angles.
ImageFloat max_normal_angles(const ScreenGBuffer& gbuffer, int threads);
/// Returns the radiance of flat surfaces and of the background from the color prepass (`color_prepass`), for
/// ScreenGBuffer::set_flat_radiance; the angles must be set. It is empty where there is neither. The background is
/// included so that the color changes gradually behind an occluder next to a flat surface's border; otherwise pixels at
/// the border flicker while the camera moves. Objects with a nonzero entry in `reflective_objects` are excluded,
/// because the prepass does not contain their reflections.
RadiancePyramid flat_surface_radiance(const ScreenGBuffer& gbuffer, std::span<const std::uint8_t> reflective_objects,
                                      int threads);

/// Returns whether the surface at a pixel is flat enough to continue as its plane. In a perspective view its radius of
/// curvature must exceed its depth, independent of the resolution. In an orthographic view it must exceed the height of
/// the view.
bool is_flat(const ScreenGBuffer& gbuffer, int x, int y);

} // namespace duet::raster
