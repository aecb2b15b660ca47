// What the intersection tests shoot at: shapes and scenes of them, and the answer of testing every primitive.
#pragma once

#include "common/scene/scene.h"
#include "raytrace/acceleration/accelerator.h"

#include <memory>

namespace duet::compare {

/// A scene of shapes with one grey material: each placed once, or as often as there are matrices for it.
Scene make_scene(std::vector<Shape> shapes);
Scene make_scene(Shape shape, const std::vector<Mat4>& placements);

/// A scene with the path tracer's accelerator over it; the scene stays where it is.
struct Stage {
    explicit Stage(Scene scene_) : scene(std::make_unique<const Scene>(std::move(scene_))), accelerator(*scene, 1) {}
    std::unique_ptr<const Scene> scene;
    raytrace::Accelerator accelerator;
};

/// The first hit by testing every primitive in turn, in the library's own way and order: what an accelerator must find.
Hit hit_by_testing_all(const Scene& scene, const Ray& ray);

/// A triangle mesh around the origin, closed, of 20·4^levels triangles with common vertices: a sphere of radius 1, or
/// with bumps of up to ± `bump`, so that it is concave and its triangles differ in form.
Mesh ball(int levels, float bump = 0);
/// Its vertices scaled, then moved.
Mesh placed(Mesh mesh, float scale, Vec3 shift);

} // namespace duet::compare
