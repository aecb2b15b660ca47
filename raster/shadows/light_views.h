// This header declares the cameras that render the shadow maps of lights.
#pragma once

#include "common/camera/camera.h"
#include "common/light/light.h"
#include "common/vec/box.h"
#include "common/vec/frame.h"

#include <span>
#include <vector>

namespace duet::raster {

/// Represents a point that the scene's camera sees, with the width in meters of the pixel there.
struct VisiblePoint {
    Vec3d p;
    double width;
};

/// Returns the views of a sun, finest first. They are orthographic along its light, and each covers the full depth of
/// the scene.
///
/// The last view covers all casters. The views before it surround the target of the scene's camera and shrink down to
/// the camera's own view. They are cascades (after Dimitrov 2007, "Cascaded Shadow Maps"), but fixed to the scene, so
/// that shadow edges do not crawl as the camera orbits the target.
///
/// Where they are finer than these cascades, there are also views fitted to the points in `visible`: one to all of
/// them, and others to the points within successively shorter distances (Lauritzen, Salvi and Lefohn 2011, "Sample
/// Distribution Shadow Maps"). They help in a room, where the nearest surfaces are not at the camera's target. `guard`
/// is the number of texels, of `side`, left around the fitted bounds.
///
/// If the sun is a disk, `sine` is that of its angular radius. The last view then also covers all penumbrae, and what
/// their points see of the disk.
std::vector<Camera> sun_views(const SunLight& sun, double sine, const Box3& casters, const Camera& camera,
                              std::span<const VisiblePoint> visible, int side, double guard);

/// Returns the view of a spot's cone, or none if the cone is too wide for one map. `guard` is the number of texels, of
/// `side`, left around the cone.
std::vector<Camera> spot_views(const SpotLight& spot, double scene_size, int side, double guard);

/// Returns the faces of a cube about a point, ±s, ±t, ±n of `frame` in this order, each with `guard` texels of its
/// neighbors.
std::vector<Camera> cube_views(Vec3d center, const FrameT<double>& frame, double scene_size, int side, double guard);

} // namespace duet::raster
