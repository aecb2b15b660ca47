// This file declares the shapes and scenes of the intersection tests, and the reference hit from testing every
// primitive.
#pragma once

#include "common/scene/scene.h"
#include "raytrace/acceleration/accelerator.h"

#include <memory>

namespace duet::compare {

/// Returns a scene of shapes with one gray material. Each shape is placed once, or once per matrix.
Scene make_scene(std::vector<Shape> shapes);
Scene make_scene(Shape shape, const std::vector<Mat4>& placements);

/// Returns a static object of a shape and a material.
Object object_of(std::uint32_t shape, const Mat4& to_world);

/// Owns a scene at a stable address, with the path tracer's accelerator.
struct AcceleratedScene {
    explicit AcceleratedScene(Scene scene_)
        : scene(std::make_unique<const Scene>(std::move(scene_))), accelerator(*scene, 1) {}
    std::unique_ptr<const Scene> scene;
    raytrace::Accelerator accelerator;
};

/// Returns the first hit by testing every primitive in order with the library's own routines; an accelerator must
/// find the same hit.
Hit brute_force_hit(const Scene& scene, const Ray& ray);

/// Returns a closed triangle mesh around the origin, with 20·4^levels triangles and shared vertices. It is a sphere
/// of radius 1, or one with bumps of up to ± `bump`, which make it concave and vary its triangles.
Mesh icosphere(int levels, float bump = 0);
/// Scales and then translates the vertices.
Mesh scaled_and_moved(Mesh mesh, float scale, Vec3 shift);

} // namespace duet::compare
