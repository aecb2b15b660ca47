#include "raster/shading/built_in_shaders.h"
#include "common/system/error.h"

#include <array>

namespace duet::raster {
namespace {

struct BuiltInShader {
    std::string_view name;
    Shading shading;
    std::unique_ptr<ShaderProgram> (*program)(const Camera&);
};
// Adapts a program that does not depend on the camera.
template <std::unique_ptr<ShaderProgram> (*make)()> std::unique_ptr<ShaderProgram> without_camera(const Camera&) {
    return make();
}

// In the order of Shading.
constexpr std::array kAll{BuiltInShader{"lit", Shading::kLit, nullptr},
                          BuiltInShader{"phong", Shading::kPhong, without_camera<phong_program>},
                          BuiltInShader{"gouraud", Shading::kGouraud, without_camera<gouraud_program>},
                          BuiltInShader{"flat", Shading::kFlat, without_camera<flat_program>},
                          BuiltInShader{"toon", Shading::kToon, without_camera<toon_program>},
                          BuiltInShader{"wireframe", Shading::kWireframe, without_camera<wireframe_program>},
                          // The overlay replaces the colors of "lines" and "edges".
                          BuiltInShader{"lines", Shading::kLines, depth_program},
                          BuiltInShader{"edges", Shading::kEdges, depth_program},
                          BuiltInShader{"normal", Shading::kNormal, without_camera<normal_program>},
                          BuiltInShader{"albedo", Shading::kAlbedo, without_camera<albedo_program>},
                          BuiltInShader{"depth", Shading::kDepth, depth_program}};

} // namespace

std::vector<std::string> shading_names() {
    std::vector<std::string> names;
    for (const BuiltInShader& shader : kAll) names.emplace_back(shader.name);
    return names;
}

std::string shading_list() {
    std::string names;
    for (const BuiltInShader& shader : kAll)
        names += (shader.name == kAll.front().name  ? ""
                  : shader.name == kAll.back().name ? " or "
                                                    : ", ") +
                 std::string(shader.name);
    return names;
}

Shading parse_shading(std::string_view name) {
    for (const BuiltInShader& shader : kAll)
        if (shader.name == name) return shader.shading;
    throw Error(message("shading: found ", name, ", expected ", shading_list()));
}

std::unique_ptr<ShaderProgram> built_in_program(Shading shading, const Camera& camera) {
    for (const BuiltInShader& shader : kAll)
        if (shader.shading == shading && shader.program != nullptr) return shader.program(camera);
    return nullptr;
}

} // namespace duet::raster
