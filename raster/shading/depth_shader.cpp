// Shows depth. The image is white at the camera, half as bright at the distance of the look-at point, and black at
// infinity.
#include "raster/shading/built_in_shaders.h"
#include "raster/shader/shader_program.h"

namespace duet::raster {
namespace {

struct DepthShader : NoVaryings {
    float half = 1; ///< distance of half brightness, meters

    template <typename T, typename F> RgbT<T> fragment(const F& f) const {
        return RgbT<T>(T(half) / (T(half) + f.depth));
    }
};

} // namespace

std::unique_ptr<ShaderProgram> depth_program(const Camera& camera) {
    DepthShader shader;
    shader.half = static_cast<float>(length(camera.look_at - camera.eye));
    return std::make_unique<ShaderProgramOf<DepthShader>>(shader);
}

} // namespace duet::raster
