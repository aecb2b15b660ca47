// Implements Gouraud shading: light is computed at the vertices and interpolated. The base color is evaluated per
// sample (Gouraud 1971, "Continuous Shading of Curved Surfaces").
#include "raster/shading/built_in_shaders.h"
#include "raster/shading/phong_model.h"
#include "raster/shader/shader_program.h"

namespace duet::raster {
namespace {

struct GouraudShader : VertexLighting {
    template <typename T> Varyings<T> vertex(const VertexInput<T>& v) const {
        return light(v, v.world_p(), v.world_n());
    }
};

} // namespace

std::unique_ptr<ShaderProgram> gouraud_program() {
    return std::make_unique<ShaderProgramOf<GouraudShader>>(GouraudShader{});
}

} // namespace duet::raster
