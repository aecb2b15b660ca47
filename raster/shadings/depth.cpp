// Shows depth: white at the camera, half as bright at the distance of the look-at point, black at infinity.
#include "raster/shader/program.h"
#include "raster/shadings/shadings.h"

namespace duet::raster {
namespace {

struct DepthShader : NoVaryings {
    float half = 1; ///< distance of half brightness, meters

    template <typename T, typename F> RgbT<T> fragment(const F& f) const {
        return RgbT<T>(T(half) / (T(half) + f.depth));
    }
};

} // namespace

std::unique_ptr<Program> depth_program(const Camera& camera) {
    DepthShader shader;
    shader.half = static_cast<float>(length(camera.look_at - camera.eye));
    return std::make_unique<ProgramOf<DepthShader>>(shader);
}

} // namespace duet::raster
