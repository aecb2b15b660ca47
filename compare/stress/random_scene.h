// Scenes made by chance, on which the two pipelines are set against each other.
#pragma once

#include "common/camera/camera.h"
#include "common/scene/scene.h"
#include "compare/stress/trials.h"

namespace duet::compare {

/// What a scene is made of, in a ball of about 2 metres.
struct SceneParts {
    bool soup = false;      ///< triangles of all sizes and slivers, through each other, before the eye and behind it
    bool meshes = false;    ///< closed tori with shared vertices, whose back faces may be culled
    bool spheres = false;   ///< of radii 0.01 to 1
    bool quads = false;     ///< boxes and walls
    bool instances = false; ///< of each shape so far: turned, stretched, mirrored
};

/// Where the whole stands: the ball's centre and its scale; the view goes with it, a perspective one where the centre
/// is not the world's origin.
struct Placement {
    Vec3 offset;
    float scale = 1;
};

struct TrialScene {
    Scene scene;
    View view; ///< from outside or from within, perspective or (one in eight) orthographic
};

/// All objects of one grey material; finished.
TrialScene random_scene(TrialRandom& random, const SceneParts& parts, const Placement& placement, int width,
                        int height);

/// As random_scene with all parts, but of all materials, with all kinds of light, a moving object and a lens.
TrialScene random_lit_scene(TrialRandom& random, int width, int height);

} // namespace duet::compare
