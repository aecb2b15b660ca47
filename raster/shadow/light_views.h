// The cameras through which lights see the scene.
#pragma once

#include "common/camera/camera.h"
#include "common/light/light.h"
#include "common/vec/box.h"
#include "common/vec/frame.h"

#include <span>
#include <vector>

namespace duet::raster {

/// Where the scene's camera looks: a point that it sees, and how wide there a pixel of the picture is that found it, metres.
struct SeenPoint {
    Vec3d p;
    double width;
};

/// A sun's: orthographic, along its light, each with all that lies before and behind it; finest first. The last is of all
/// casters. Those before it are of the surroundings of what the scene's camera looks at, smaller and smaller down to what
/// it sees (cascades, after Dimitrov 2007, «Cascaded Shadow Maps», but fixed to the scene, so that they do not crawl as the
/// camera moves around it). Where they are finer than those there are views no wider than what is `seen`,
/// of all of it and up to distances each as many times shorter (Lauritzen, Salvi and Lefohn 2011, «Sample Distribution Shadow
/// Maps»): within a room what is near is not where the camera looks. `guard`: texels of `side` left
/// around what is seen.
std::vector<Camera> sun_views(const SunLight& sun, const Box3& casters, const Camera& camera, std::span<const SeenPoint> seen,
                              int side, double guard);

/// The spot's cone, where it is narrow enough for one picture; else none. `guard`: texels of `side` left around it.
std::vector<Camera> spot_views(const SpotLight& spot, double scene_size, int side, double guard);

/// The faces of a cube about a point, ±s, ±t, ±n of `frame` in this order, each with `guard` texels of its neighbours.
std::vector<Camera> cube_views(Vec3d center, const FrameT<double>& frame, double scene_size, int side, double guard);

} // namespace duet::raster
