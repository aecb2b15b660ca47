// Tests whether a point lies inside a solid object, where a probe would see nothing of the scene.
#pragma once

#include "raster/raster_scene.h"

namespace duet::raster {

/// Returns whether a world-space point lies inside an object, an index into Scene::objects. Meshes must be oriented
/// outwards; they may have holes (SolidTest).
bool is_inside(const RasterSceneData& data, std::uint32_t object, Vec3d p);

/// Tests whether points lie inside objects: spheres, boxes of quads, and meshes that are oriented outwards. Meshes may
/// have holes: a point is inside if its generalized winding number is above 3/4 (Jacobson et al. 2013, "Robust
/// Inside-Outside Segmentation using Generalized Winding Numbers"). If the camera looks at a point in an object, from
/// within or through an opening, the object counts as a room and not as a solid.
class SolidTest {
public:
    /// Keeps a reference to `data`.
    explicit SolidTest(const RasterSceneData& data) : SolidTest(data, data) {}
    /// Tests the objects of `simplified`, whose shapes may be simpler than those of `data`. Keeps a reference to it.
    SolidTest(const RasterSceneData& data, const RasterSceneData& simplified);
    /// Returns whether the world-space point lies inside an object.
    bool inside(Vec3d p) const;

private:
    const RasterSceneData& data_;
    std::vector<std::uint32_t> solids_;
};

} // namespace duet::raster
