#include "common/system/error.h"
#include "raster/shadings/shadings.h"

#include <array>

namespace duet::raster {
namespace {

struct Known {
    std::string_view name;
    Shading shading;
    std::unique_ptr<Program> (*program)(const Camera&);
};
// Adapts a program that does not depend on the camera.
template <std::unique_ptr<Program> (*make)()> std::unique_ptr<Program> any(const Camera&) { return make(); }

constexpr std::array kAll{Known{"lit", Shading::kLit, nullptr},
                          Known{"phong", Shading::kPhong, any<phong_program>},
                          Known{"gouraud", Shading::kGouraud, any<gouraud_program>},
                          Known{"flat", Shading::kFlat, any<flat_program>},
                          Known{"toon", Shading::kToon, any<toon_program>},
                          Known{"wireframe", Shading::kWireframe, any<wireframe_program>},
                          // The overlay replaces the colors of "lines" and "edges".
                          Known{"lines", Shading::kLines, depth_program},
                          Known{"edges", Shading::kEdges, depth_program},
                          Known{"normal", Shading::kNormal, any<normal_program>},
                          Known{"albedo", Shading::kAlbedo, any<albedo_program>},
                          Known{"depth", Shading::kDepth, depth_program}};

} // namespace

std::string shading_names() {
    std::string names;
    for (const Known& known : kAll)
        names += (known.name == kAll.front().name  ? ""
                  : known.name == kAll.back().name ? " or "
                                                   : ", ") +
                 std::string(known.name);
    return names;
}

Shading shading(std::string_view name) {
    for (const Known& known : kAll)
        if (known.name == name) return known.shading;
    throw Error(message("shading: found ", name, ", expected ", shading_names()));
}

std::unique_ptr<Program> program(Shading shading, const Camera& camera) {
    for (const Known& known : kAll)
        if (known.shading == shading && known.program != nullptr) return known.program(camera);
    return nullptr;
}

Quality quality(std::string_view name) {
    if (name == "realtime") return Quality::kRealtime;
    if (name == "high") return Quality::kHigh;
    throw Error(message("quality: found ", name, ", expected realtime or high"));
}

AmbientOcclusion ambient_occlusion(std::string_view name) {
    if (name == "none") return AmbientOcclusion::kNone;
    if (name == "ssao") return AmbientOcclusion::kSsao;
    if (name == "gtao") return AmbientOcclusion::kGtao;
    throw Error(message("ambient occlusion: found ", name, ", expected none, ssao or gtao"));
}

} // namespace duet::raster
