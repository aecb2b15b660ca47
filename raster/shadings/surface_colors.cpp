// What a surface is, shown as a colour: its shading normal, its base colour, how near it is.
#include "raster/program.h"
#include "raster/shadings/shadings.h"

namespace duet::raster {
namespace {

/// (n + 1)/2, see direction_color.
struct NormalShader : NormalVaryings {
    bool maps = true;

    template <typename T, typename F> RgbT<T> fragment(const F& f) const {
        const Vec3T<T> n = maps ? f.normal(f.at.n) : f.smooth_normal(f.at.n);
        const auto channel = [](T component) { return max((component + T(1)) * T(0.5f), T(0)); };
        return {channel(n.x), channel(n.y), channel(n.z)};
    }
};

struct AlbedoShader : NoVaryings {
    template <typename T, typename F> RgbT<T> fragment(const F& f) const { return f.base_color(); }
};

/// White at the camera, half as bright as far away as what it looks at, black at infinity.
struct DepthShader : NoVaryings {
    float half = 1; ///< that distance

    template <typename T, typename F> RgbT<T> fragment(const F& f) const { return RgbT<T>(T(half) / (T(half) + f.depth)); }
};

} // namespace

std::unique_ptr<Program> normal_program() { return std::make_unique<ProgramOf<NormalShader>>(NormalShader{}); }
std::unique_ptr<Program> smooth_normal_program() {
    NormalShader shader;
    shader.maps = false;
    return std::make_unique<ProgramOf<NormalShader>>(shader);
}
std::unique_ptr<Program> albedo_program() { return std::make_unique<ProgramOf<AlbedoShader>>(AlbedoShader{}); }
std::unique_ptr<Program> depth_program(const Camera& camera) {
    DepthShader shader;
    shader.half = static_cast<float>(length(camera.look_at - camera.eye));
    return std::make_unique<ProgramOf<DepthShader>>(shader);
}

} // namespace duet::raster
