// Renders the view from a point of the scene in all directions by the rasterizer itself. The G-buffers of the six
// square views are stored, so that light can bounce between probes without rendering again.
#pragma once

#include "raster/fog/fog_grid.h"
#include "raster/gbuffer/gbuffer.h"
#include "raster/lighting/direct_light.h"
#include "raster/raster_scene.h"

#include <vector>

namespace duet::raster {

/// Holds the six faces of a cube about a point. Directions and faces are those of raster/shadows/cube_map.h.
class ProbeCapture {
public:
    struct Face {
        GBuffer gbuffer;
        Planes3 emission; ///< radiance that the visible surfaces emit
        Planes3 direct;   ///< direct light that the surfaces reflect; the background's radiance
        Planes3 haze;     ///< FogGrid::haze toward the probe; empty if there are no media
    };
    /// Selects what a capture shows.
    struct Selection {
        const std::vector<std::uint32_t>& excluded; ///< sorted indices of the objects that are left out
        bool sun = true;                            ///< whether the background includes the environment's sun
        ChosenLights lights{};
    };
    /// Renders side × side pixels for each face, and `guard` more on each side, on the calling thread.
    ProbeCapture(const RasterSceneData& data, const RasterSettings& settings, Vec3d center, int side, int guard,
                 const Selection& selection);

    /// Renders one object alone, without light: its surface as seen from within or from outside.
    ProbeCapture(const RasterSceneData& data, const RasterSettings& settings, Vec3d center, std::uint32_t object,
                 int side);

    /// Attenuates the light and the lobes of the surfaces by the media in front of them; lobes too, because light may
    /// be added to them later. Adds the light that media scatter and emit. `ambient` may be empty.
    void add_fog(const RasterSceneData& data, const RasterSettings& settings, const AmbientLight& ambient);

    std::vector<Face>& faces() { return faces_; }
    const std::vector<Face>& faces() const { return faces_; }
    int side() const { return side_; } ///< pixels along a side of a face, without the guard
    /// Identifies a pixel of the capture by its face, column and row. The guard's pixels count.
    struct Pixel {
        std::size_t face;
        int x, y;
    };
    /// Returns the pixel in a direction of any length except zero.
    Pixel pixel(Vec3 w) const;
    /// Returns the unit direction of a pixel of faces of side × side without a guard.
    static Vec3 direction(const Pixel& pixel, int side);
    /// Returns the solid angle that a pixel subtends.
    static float solid_angle(const Pixel& pixel, int side);
    /// Returns the distance of the surface at a pixel, in meters; infinity for the background.
    float distance(const Pixel& pixel) const;

private:
    int side_, guard_;
    std::vector<Face> faces_; ///< six faces
};

} // namespace duet::raster
