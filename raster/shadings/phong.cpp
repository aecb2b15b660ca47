// Implements Phong shading: normals are interpolated, and light is computed per sample (Phong 1975, "Illumination for
// Computer Generated Pictures").
#include "raster/shader/phong.h"
#include "raster/shader/program.h"
#include "raster/shadings/shadings.h"

namespace duet::raster {
namespace {

struct PhongShader : NormalVaryings {
    template <typename T, typename F> RgbT<T> fragment(const F& f) const {
        const PreparedData& data = f.object.data;
        // The point is computed lazily, because lights seldom need it.
        const auto place = [origin = f.origin, way = f.way, depth = f.depth] { return origin + way * depth; };
        return f.with_emitted(phong(f.lights(), data.ambient, f.base_color(), place, f.normal(f.at.n), f.wo()));
    }
};

} // namespace

std::unique_ptr<Program> phong_program() { return std::make_unique<ProgramOf<PhongShader>>(PhongShader{}); }

} // namespace duet::raster
