// Shows base colors without lighting.
#include "raster/shading/built_in_shaders.h"
#include "raster/shader/shader_program.h"

namespace duet::raster {
namespace {

struct AlbedoShader : NoVaryings {
    template <typename T, typename F> RgbT<T> fragment(const F& f) const { return f.base_color(); }
};

} // namespace

std::unique_ptr<ShaderProgram> albedo_program() {
    return std::make_unique<ShaderProgramOf<AlbedoShader>>(AlbedoShader{});
}

} // namespace duet::raster
