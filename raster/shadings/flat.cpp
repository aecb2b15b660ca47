// Flat shading: light is worked out once a triangle, at its centroid, for its geometric normal (Bouknight 1970, «A
// Procedure for Generation of Three-dimensional Half-toned Computer Graphics Presentations»). A sphere has no
// triangles: each of its samples is a facet of its own. The base colour is each sample's own.
#include "raster/phong.h"
#include "raster/program.h"
#include "raster/shadings/shadings.h"

namespace duet::raster {
namespace {

struct FlatShader {
    static constexpr bool kTextureCoordinates = false;
    template <typename T> using Varyings = PhongLight<T>;

    template <typename T> Varyings<T> vertex(const VertexInput<T>& v) const {
        const Vec3T<T> p = v.world_middle();
        return phong_light(std::span(v.object.data.scene.lights), [&] { return p; }, v.world_ng(), v.object.to_viewer(p));
    }
    template <typename T, typename F> RgbT<T> fragment(const F& f) const {
        return phong(f.at, f.object.data.ambient, f.base_color());
    }
};

} // namespace

std::unique_ptr<Program> flat_program() { return std::make_unique<ProgramOf<FlatShader>>(FlatShader{}); }

} // namespace duet::raster
