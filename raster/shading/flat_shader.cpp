// Implements flat shading: light is computed once per triangle, at its centroid with its geometric normal (Bouknight
// 1970, "A Procedure for Generation of Three-dimensional Half-toned Computer Graphics Presentations"). On a sphere,
// which has no triangles, each sample is its own facet. The base color is evaluated per sample.
#include "raster/shading/built_in_shaders.h"
#include "raster/shading/phong_model.h"
#include "raster/shader/shader_program.h"

namespace duet::raster {
namespace {

struct FlatShader : VertexLighting {
    template <typename T> Varyings<T> vertex(const VertexInput<T>& v) const {
        return light(v, v.world_middle(), v.world_ng());
    }
};

} // namespace

std::unique_ptr<ShaderProgram> flat_program() { return std::make_unique<ShaderProgramOf<FlatShader>>(FlatShader{}); }

} // namespace duet::raster
