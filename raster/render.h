// Defines the interface of the rasterizer: prepare() is called once per scene, and render() once per view.
#pragma once

#include "common/camera/camera.h"
#include "common/scene/scene.h"
#include "common/system/control.h"
#include "raster/settings.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace duet::raster {

struct RasterSceneData; // raster/raster_scene.h
class ShaderProgram;    // raster/shader/packet_shader.h

/// Holds the data computed once per scene, for any number of views. It refers to the scene, which must outlive it.
class RasterScene {
public:
    explicit RasterScene(std::shared_ptr<const RasterSceneData> data) : data_(std::move(data)) {}
    const RasterSceneData& data() const { return *data_; }

private:
    std::shared_ptr<const RasterSceneData> data_;
};

/// Prepares a scene. Throws Error if the shadow settings are out of range.
RasterScene prepare(const Scene& scene, const RasterSettings& settings);
/// Prepares an edited scene fast, for a preview. It reuses the probes of the scene before the edit, so indirect light
/// and reflections lag behind, and the packed meshes that both scenes share (see Transforms). Everything else is
/// computed anew, which takes a small part of the time. Returns nothing if the probes do not fit: the number of objects
/// differs, or objects reflect in only one of the two scenes, or only one of them has the probes that the settings
/// request.
std::optional<RasterScene> prepare_edited(const Scene& scene, const RasterSettings& settings,
                                          const RasterScene& before);
/// Returns one sentence for each approximation in which images with these settings differ from the path tracer's. Only
/// approximations that apply to the scene and the requested components are included.
std::vector<std::string> approximations(const RasterScene& prepared, const RasterSettings& settings);
/// Renders one image. If `control` stops it, the result contains the completed parts, and the rest is unspecified.
Rendering render(const RasterScene& prepared, const View& view, const RasterSettings& settings, Control& control);
/// Renders into an earlier rendering. Images of a display or of depths that have the right size are overwritten, so
/// that an animation at one sample per pixel allocates memory only once.
void render(const RasterScene& prepared, const View& view, const RasterSettings& settings, Control& control,
            Rendering& result);
/// Renders with a program in place of RasterSettings::shading. draw() (raster/draw.h) creates a program from a shader.
void render(const RasterScene& prepared, const View& view, const RasterSettings& settings, const ShaderProgram& program,
            Control& control, Rendering& result);

} // namespace duet::raster
