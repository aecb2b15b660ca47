// The cameras through which lights see the scene.
#pragma once

#include "common/camera/camera.h"
#include "common/light/light.h"
#include "common/vec/box.h"
#include "common/vec/frame.h"

#include <vector>

namespace duet::raster {

/// A sun's: orthographic, along its light, each with all that lies before and behind it. The last is of all casters;
/// those before it are of the surroundings of what the scene's camera looks at, smaller and smaller down to what it
/// sees: finest first (cascades, after Dimitrov 2007, «Cascaded Shadow Maps», but fixed to the scene, so that they do
/// not crawl as the camera moves around it).
std::vector<Camera> sun_views(const SunLight& sun, const Box3& casters, const Camera& camera);

/// The spot's cone, where it is narrow enough for one picture; else none. `guard`: texels of `side` left around it.
std::vector<Camera> spot_views(const SpotLight& spot, double scene_size, int side, double guard);

/// The faces of a cube about a point, ±s, ±t, ±n of `frame` in this order, each with `guard` texels of its neighbours.
std::vector<Camera> cube_views(Vec3d center, const FrameT<double>& frame, double scene_size, int side, double guard);

} // namespace duet::raster
