// Declares the interface of the path tracer: prepare() is called once per scene, and render() once per view.
#pragma once

#include "common/camera/camera.h"
#include "common/scene/scene.h"
#include "common/system/control.h"
#include "raytrace/settings.h"

#include <memory>

namespace duet::raytrace {

struct PathTracerSceneData; // raytrace/path_tracer_scene.h

/// Holds a scene prepared for any number of views. It refers to the scene, which must outlive it.
class PathTracerScene {
public:
    explicit PathTracerScene(std::shared_ptr<const PathTracerSceneData> data) : data_(std::move(data)) {}
    const PathTracerSceneData& data() const { return *data_; }

private:
    std::shared_ptr<const PathTracerSceneData> data_;
};

/// Builds the hierarchies and the light tree of a scene, on PathTracerSettings::threads threads.
PathTracerScene prepare(const Scene& scene, const PathTracerSettings& settings);
/// Prepares an edited scene fast, for a preview. Both scenes should be read with Transforms::kKept. Then the
/// hierarchies of meshes that both share are not built again. Hits may differ by rounding from those of a scene that
/// was baked.
PathTracerScene prepare_edited(const Scene& scene, const PathTracerSettings& settings, const PathTracerScene& before);
/// Renders one image. If `control` stops it, it returns the mean of the samples taken so far. With
/// PathTracerSettings::film it continues that film, bit-equal to a single run. Throws Error for invalid settings, for a
/// film of another image, and for a film that cannot be written. With PathTracerSettings::denoise it also returns
/// Rendering::denoised, even if `control` stops it.
Rendering render(const PathTracerScene& prepared, const View& view, const PathTracerSettings& settings,
                 Control& control);

/// Returns the first hit of one ray, for reference comparisons and tests. It is bit-equal to the hits of render()'s
/// camera rays.
Hit trace(const PathTracerScene& prepared, const Ray& ray);

} // namespace duet::raytrace
