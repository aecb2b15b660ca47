// Shows shading normals as colors: (n + 1)/2, see direction_color.
#include "raster/shading/built_in_shaders.h"
#include "raster/shader/shader_program.h"

namespace duet::raster {
namespace {

struct NormalShader : NormalVaryings {
    bool maps = true;

    template <typename T, typename F> RgbT<T> fragment(const F& f) const {
        const Vec3T<T> n = (maps ? f.normal(f.at.n) : f.smooth_normal(f.at.n)).unit();
        const auto channel = [](T component) { return max((component + T(1)) * T(0.5f), T(0)); };
        return {channel(n.x), channel(n.y), channel(n.z)};
    }
};

} // namespace

std::unique_ptr<ShaderProgram> normal_program() {
    return std::make_unique<ShaderProgramOf<NormalShader>>(NormalShader{});
}
std::unique_ptr<ShaderProgram> smooth_normal_program() {
    NormalShader shader;
    shader.maps = false;
    return std::make_unique<ShaderProgramOf<NormalShader>>(shader);
}

} // namespace duet::raster
