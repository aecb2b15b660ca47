// This header declares random scenes for comparing the two pipelines.
#pragma once

#include "common/camera/camera.h"
#include "common/scene/scene.h"
#include "compare/stress/trials.h"

namespace duet::compare {

/// Selects the contents of a scene, within a sphere of about 2 meters.
struct SceneContents {
    bool soup = false; ///< intersecting triangles of all sizes, and slivers, in front of and behind the eye
    bool meshes = false; ///< closed tori with shared vertices, whose back faces may be culled
    bool spheres = false;   ///< of radii 0.01 to 1
    bool quads = false;     ///< boxes and walls
    bool instances = false; ///< instances of each shape so far, rotated, stretched or mirrored
};

/// Holds the placement of a scene: the sphere's center and scale. The view moves with the scene, and is perspective if
/// the center is not the world's origin.
struct Placement {
    Vec3 offset;
    float scale = 1;
};

/// Holds a random scene and a view of it.
struct TrialScene {
    Scene scene;
    View view; ///< from outside or inside; perspective or (one in eight) orthographic
};

/// Returns a finished scene; all its objects have one gray material.
TrialScene random_scene(TrialRandom& random, const SceneContents& contents, const Placement& placement, int width,
                        int height);

/// Returns a random scene with all contents, all materials, all kinds of lights, a moving object and a thin lens.
TrialScene random_lit_scene(TrialRandom& random, int width, int height);

} // namespace duet::compare
