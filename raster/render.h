// The rasterizer: prepare once a scene, render once a view.
#pragma once

#include "common/camera/camera.h"
#include "common/film/rendering.h"
#include "common/scene/scene.h"
#include "common/system/control.h"

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace duet::raster {

enum class Shading {
    kLit,       ///< materials and lights: direct light in closed form where there is one, environment irradiance
    kPhong,     ///< Phong's model: highlights and diffuse light of the scene's lights, the environment's mean for ambient
    kGouraud,   ///< the same, worked out at vertices and interpolated
    kFlat,      ///< the same, once a triangle
    kToon,      ///< the same, in bands
    kWireframe, ///< edges, hidden ones removed
    kLines,     ///< edges as lines of single pixels, white on black, and nothing hides another
    kEdges,     ///< ink on paper: Settings::edges alone
    kNormal,    ///< the shading normal as a colour: (n + 1)/2
    kAlbedo,    ///< base colours
    kDepth,     ///< d / (d + depth), d the distance from the camera to what it looks at
};
/// "lit", "phong" …, as shading_names() lists them; throws Error for another name.
Shading shading(std::string_view name);
/// "lit, phong … or depth".
std::string shading_names();

/// How the environment's occlusion is guessed from the picture's depths (raster/screen/ambient_occlusion.h).
enum class AmbientOcclusion { kNone, kSsao, kGtao };
/// "none", "ssao", "gtao"; throws Error for another name.
AmbientOcclusion ambient_occlusion(std::string_view name);

/// The parts of Shading::kLit (LightParts in raster/split.h): one that is left out is not computed.
struct PartSet {
    bool emission = true, direct = true, environment = true, reflection = true;

    bool all() const { return emission && direct && environment && reflection; }
};

/// What is made of a picture's samples.
enum class Output {
    kRadiance, ///< Rendering::radiance, and the auxiliary pictures asked for
    kSrgb8,    ///< Rendering::srgb: each pixel encoded as soon as it is shaded, as a display takes it
    kNearness, ///< Rendering::nearness: depths alone, as a shadow map takes them; nothing is shaded
};

struct Settings : RenderSettings {
    Shading shading = Shading::kLit;
    Output output = Output::kRadiance; ///< others: of the first sample a pixel, without auxiliary pictures
    bool front_faces_only = false;     ///< draw no back faces of any mesh or quad, as real-time renderers do
    /// Multisampling (raster/visibility/multisample.h): 2, 4, 8 or 16 samples a pixel for coverage and depth, shaded once a primitive;
    /// 0: none. Together with samples_per_pixel = 1 only; through the lens's centre, as the shutter opens.
    int multisamples = 0;
    bool sample_shading = false; ///< with it: shade each of its samples, which is supersampling by its pattern
    bool edges = false; ///< ink lines over the picture where depth, normals or objects change (raster/overlay/edges.h)
    PartSet parts; ///< all, but for a look at one, and for its price
    bool shadows = true; ///< Shading::kLit: shadow maps, made by prepare(), which must be asked for them, too
    int shadow_map_side = 2048; ///< texels along a side, in [64, 8192]; of each face of a cube of maps half as many,
                                ///< of a surface light's a quarter; fewer where there would be too many for memory
    int shadow_cells = 2; ///< rectangular lights are cut into as many pieces along each side, in [1, 8], a map each
    AmbientOcclusion ambient_occlusion = AmbientOcclusion::kGtao; ///< Shading::kLit: of diffuse surfaces
    /// How far what occludes the environment may be, metres; 0: half (of ssao: an eighth) of the lesser of the scene's
    /// diagonal and the way from its camera's eye to what that looks at.
    double occlusion_radius = 0;
    bool prefiltered_environment = true;  ///< Shading::kLit: rough metal mirrors it blurred, not as if it were smooth
    bool screen_reflections = true;  ///< Shading::kLit: smooth and moderately rough metal mirrors what the picture shows
    bool screen_refractions = true;  ///< Shading::kLit: glass shows what the picture shows without it
    bool transformed_cosines = true; ///< Shading::kLit: of surface lights on rough metal; off: as from their centres
    bool environment =
        true; ///< light surfaces by the environment, and show it; off: surface, point, spot and sun light only
};

struct PreparedData; // raster/prepare.h
class Program;       // raster/shader/strip_shader.h

/// What one scene needs for any number of views. Refers to the scene, which must outlive it.
class Prepared {
public:
    explicit Prepared(std::shared_ptr<const PreparedData> data) : data_(std::move(data)) {}
    const PreparedData& data() const { return *data_; }

private:
    std::shared_ptr<const PreparedData> data_;
};

Prepared prepare(const Scene& scene, const Settings& settings);
/// Each way in which the pictures of these settings differ from the path tracer's, as a sentence; none that does not
/// apply to the scene and the parts asked for.
std::vector<std::string> approximations(const Prepared& prepared, const Settings& settings);
/// One picture. Stopped by `control`, it returns what is finished, the rest black.
Rendering render(const Prepared& prepared, const View& view, const Settings& settings, Control& control);
/// The same into an earlier rendering: pictures of the right size are drawn over. So that who draws frame after frame
/// takes memory once.
void render(const Prepared& prepared, const View& view, const Settings& settings, Control& control, Rendering& result);
/// The same by a program in place of Settings::shading. draw() (raster/draw.h) makes one of a shader.
void render(const Prepared& prepared, const View& view, const Settings& settings, const Program& program, Control& control,
            Rendering& result);

} // namespace duet::raster
