// This header declares the screen-space tracer for reflections on metal and refraction in glass.
#pragma once

#include "common/geometry/hit.h"
#include "common/vec/box.h"
#include "raster/screen_space/flat_surfaces.h"

#include <algorithm>
#include <optional>

namespace duet::raster {

/// This is a reflection source: the image, with the layer behind the object itself where the object would be in the
/// direction.
struct ReflectionSource {
    const ScreenGBuffer& image; ///< has a color prepass
    /// This is the same view without the front surface of each pixel, or null if nothing is transparent.
    const ScreenGBuffer* behind_object = nullptr;
    std::uint32_t object = kNoObject; ///< the object that reflects or refracts

    bool is_own(int x, int y) const { return image.color_prepass().objects(x, y) == object; }
    const ScreenGBuffer& at(int x, int y) const {
        return behind_object != nullptr && is_own(x, y) ? *behind_object : image;
    }
    /// Returns the greatest lookup width, in pixels, up to `width`, that covers a single object; at least 1.
    float max_width_on_object(float x, float y, float width) const;
    /// Returns whether the pixel at a position and four pixels at the offset `reach` along each axis show one object.
    bool shows_one_object(float x, float y, float reach) const;
    /// Returns whether a lookup of this reach includes the mirror itself, whose reflections are missing in the color
    /// prepass.
    bool includes_own(float x, float y, float reach) const;
    /// Returns the greatest lookup width, in pixels, up to `width`, that excludes the object itself; at least 1. It
    /// is `width` if the position is on the object.
    float max_width_without_own(float x, float y, float width) const;
    /// Returns the layer for a lookup of `width` pixels, so that it excludes the object itself.
    const ScreenGBuffer& about(float x, float y, float width) const {
        const float reach = std::max(1.0f, 0.5f * width);
        for (const float dx : {-reach, 0.0f, reach})
            for (const float dy : {-reach, 0.0f, reach}) {
                const auto [column, row] = image.pixel_at({x + dx, y + dy, 0});
                if (const ScreenGBuffer& gbuffer = at(column, row); &gbuffer != &image) return gbuffer;
            }
        return image;
    }
};

/// This is the intersection of a ray with the visible scene.
struct ScreenHit {
    float x, y;     ///< in pixels
    float distance; ///< from the ray's origin, in meters
    /// The distance between the pixel's surface and the hit if the color is a guess, in meters, is scaled up for
    /// hidden hits.
    float gap = 0;
    bool hidden = false; ///< the hit is on an extrapolated flat surface (flat_surface_radiance) rather than on the
                         ///< visible surface
};

/// This is a ray to trace in gbuffer space.
struct ScreenRay {
    Vec3 p; ///< relative to the eye, inside or outside the image
    Vec3 n, direction;                ///< unit: normal of its surface; direction
    bool from_visible_surface = true; ///< p is on a visible surface, which the ray cannot hit at once
    /// Lights that rays intersect directly (ScreenGBuffer::ColorPrepass::light_mask) are ignored, as none is on the ray.
    bool ignore_lights = false;
};

/// Traces a ray through the image, pixel by pixel (McGuire and Mara 2014, "Efficient GPU Screen-Space Ray Tracing"),
/// until it is behind the visible surface. A closed object has the thickness to its nearest back face
/// (ScreenGBuffer::thickness), so it is also hit from behind; its visible side then gives the color. The thickness of
/// other objects is unknown. A ray passes behind such an object if it is farther behind than twice its own depth change
/// over a pixel, and than kThickness of the object's depth.
///
/// Hidden surfaces are extrapolated:
/// - If the ray emerges from behind an occluder and has already crossed the plane of the flat surface there, it hits
/// that plane. A flat surface that was behind the ray before it became hidden continues behind the occluder.
/// - A ray hidden up to its end, inside the image, hits the first flat surface beyond the occluder whose plane it
/// crosses, or the background. Otherwise the pixel at the image's edge gives the color.
/// - Flat surfaces continue beyond the image's edge up to the bounds of the scene (relative to the eye). This applies
/// to the surface where the ray leaves. If that is the mirror itself, or is not hit, it applies to the surfaces along
/// the edge that extend to the hit.
/// - A hit behind a curved object is looked up at its own projection in the flat-surface pyramid, which is filled
/// from all sides.
/// - Lights do not continue. Glass that the ray approaches from behind is ignored, since its color is valid for the
/// viewer only.
/// The result is empty if the ray hits nothing by these rules.
std::optional<ScreenHit> march_ray(const ReflectionSource& source, const Box3& scene, const ScreenRay& ray);

inline constexpr float kThickness = 0.02f; ///< relative to the depth: least thickness of an object that is not closed
/// A guessed color is blurred by this fraction of ScreenHit::gap.
inline constexpr float kGuessBlur = 0.25f;

} // namespace duet::raster
