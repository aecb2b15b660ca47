// What the rasterizer learns of a scene once, for any number of views.
#pragma once

#include "common/scene/scene.h"
#include "raster/geometry/packed_shape.h"
#include "raster/light/irradiance.h"
#include "raster/render.h"
#include "raster/shader/texels.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace duet::raster {

struct PreparedObject {
    Box3 bounds;        ///< in the world, over all of the object's motion
    std::optional<Rgb> one_color; ///< base colour, where no texture and no second material varies it
    std::optional<RgbSlot> one_texture; ///< where that, filtered, is all of it
    std::optional<MetalBsdf> metal; ///< where that, of one colour and roughness, is all of it
    bool closed = false; ///< a sphere, a box or a mesh that is closed and oriented outwards
    bool solid = false; ///< an opaque mesh, closed and oriented outwards: its back faces can't be seen from outside
};

class GeometryPool; // raster/geometry/geometry.h
class Shadows;      // raster/shadow/shadows.h
class Prefiltered;  // raster/light/prefiltered.h

struct PreparedData {
    const Scene& scene;
    std::vector<PreparedObject> objects;  ///< parallel to Scene::objects
    std::vector<std::uint32_t> polygonal; ///< objects of triangles and quads, in order
    std::vector<std::uint32_t> spheres;   ///< the others
    std::vector<std::uint32_t> open_polygonal{}, open_spheres{}; ///< likewise those that may be seen through: in no list
                                                                 ///< above (raster/visibility/layers.h)
    std::vector<std::uint32_t> glass{};   ///< of those two above, what is of nothing but glass, in order (raster/screen/glass.h)
    std::vector<std::size_t> lamps{};     ///< surface lights that mirrors look for beside the picture: the strongest, in order
    std::size_t unmirrored_lamps = 0;     ///< the others
    std::int64_t primitives = 0;          ///< triangles, quads and spheres over all objects
    Irradiance irradiance;                ///< from the environment
    std::vector<PackedShape> shapes{};    ///< as the scene has them
    std::vector<Texels> texels{};         ///< an image each
    Rgb ambient{};                        ///< the environment's mean radiance: what Shading::kPhong has from all around
    bool unsampled_emitters = false;      ///< surfaces that emit but are no lights: moving ones, stretched spheres
    std::int64_t memory_bytes = 0;
    std::shared_ptr<const Shadows> shadows{};   ///< null where the settings or the scene ask for none
    std::shared_ptr<const Prefiltered> prefiltered{}; ///< likewise
    bool has_layers() const { return !open_polygonal.empty() || !open_spheres.empty(); }
    std::shared_ptr<GeometryPool> geometries{}; ///< memory that frames leave to the next
};

} // namespace duet::raster
