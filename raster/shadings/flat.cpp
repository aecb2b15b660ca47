// Implements flat shading: light is computed once per triangle, at its centroid with its geometric normal (Bouknight
// 1970, "A Procedure for Generation of Three-dimensional Half-toned Computer Graphics Presentations"). On a sphere,
// which has no triangles, each sample is its own facet. The base color is evaluated per sample.
#include "raster/shader/phong.h"
#include "raster/shader/program.h"
#include "raster/shadings/shadings.h"

namespace duet::raster {
namespace {

struct FlatShader : LightAtVertices {
    template <typename T> Varyings<T> vertex(const VertexInput<T>& v) const {
        return light(v, v.world_middle(), v.world_ng());
    }
};

} // namespace

std::unique_ptr<Program> flat_program() { return std::make_unique<ProgramOf<FlatShader>>(FlatShader{}); }

} // namespace duet::raster
