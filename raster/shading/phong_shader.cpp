// Implements Phong shading: normals are interpolated, and light is computed per sample (Phong 1975, "Illumination for
// Computer Generated Images").
#include "raster/shading/built_in_shaders.h"
#include "raster/shading/phong_model.h"
#include "raster/shader/shader_program.h"

namespace duet::raster {
namespace {

struct PhongShader : NormalVaryings {
    template <typename T, typename F> RgbT<T> fragment(const F& f) const {
        const RasterSceneData& data = f.object.data;
        // The point is computed lazily, because lights seldom need it.
        const auto position = [origin = f.origin, direction = f.direction, depth = f.depth] {
            return origin + direction * depth;
        };
        return f.with_emitted(phong(f.lights(), data.ambient, f.base_color(), position, f.normal(f.at.n), f.wo()));
    }
};

} // namespace

std::unique_ptr<ShaderProgram> phong_program() { return std::make_unique<ShaderProgramOf<PhongShader>>(PhongShader{}); }

} // namespace duet::raster
