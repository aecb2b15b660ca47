// Flat shading: light is worked out once a triangle, at its centroid, for its geometric normal (Bouknight 1970, «A
// Procedure for Generation of Three-dimensional Half-toned Computer Graphics Presentations»). A sphere has no
// triangles: each of its samples is a facet of its own. The base colour is each sample's own.
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
