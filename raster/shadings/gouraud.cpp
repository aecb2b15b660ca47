// Gouraud shading: light is worked out at vertices and interpolated; the base colour is each sample's own (Gouraud 1971,
// «Continuous Shading of Curved Surfaces»).
#include "raster/phong.h"
#include "raster/program.h"
#include "raster/shadings/shadings.h"

namespace duet::raster {
namespace {

struct GouraudShader {
    static constexpr bool kTextureCoordinates = false;
    template <typename T> using Varyings = PhongLight<T>;

    template <typename T> Varyings<T> vertex(const VertexInput<T>& v) const {
        const Vec3T<T> p = v.world_p();
        return phong_light(std::span(v.object.data.scene.lights), [&] { return p; }, v.world_n(), v.object.to_viewer(p));
    }
    template <typename T, typename F> RgbT<T> fragment(const F& f) const {
        return phong(f.at, f.object.data.ambient, f.base_color());
    }
};

} // namespace

std::unique_ptr<Program> gouraud_program() { return std::make_unique<ProgramOf<GouraudShader>>(GouraudShader{}); }

} // namespace duet::raster
