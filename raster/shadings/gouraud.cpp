// Implements Gouraud shading: light is computed at the vertices and interpolated. The base color is evaluated per
// sample (Gouraud 1971, "Continuous Shading of Curved Surfaces").
#include "raster/shader/phong.h"
#include "raster/shader/program.h"
#include "raster/shadings/shadings.h"

namespace duet::raster {
namespace {

struct GouraudShader : LightAtVertices {
    template <typename T> Varyings<T> vertex(const VertexInput<T>& v) const {
        return light(v, v.world_p(), v.world_n());
    }
};

} // namespace

std::unique_ptr<Program> gouraud_program() { return std::make_unique<ProgramOf<GouraudShader>>(GouraudShader{}); }

} // namespace duet::raster
