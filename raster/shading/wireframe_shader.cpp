// Draws a wireframe with hidden lines removed: one-pixel antialiased edges of triangles in the base color plus
// emission, on black. The distance of a sample to an edge follows from its barycentric: it is b / |∇b| pixels, which is
// exact on the edge (Bærentzen, Nielsen, Gjøl, Larsen and Christensen 2006, "Single-pass Wireframe Rendering"). A
// quad's diagonal is not an edge, and spheres have none. raster/overlay/lines.h draws lines without hidden-line
// removal.
#include "raster/shading/built_in_shaders.h"
#include "raster/shader/shader_program.h"

namespace duet::raster {
namespace {

struct WireframeShader {
    static constexpr bool kTextureCoordinates = false;
    static constexpr bool kDerivatives = true;
    template <typename T> struct Varyings {
        Vec3T<T> edges;
    };
    template <typename T> Varyings<T> vertex(const VertexInput<T>& v) const { return {v.edges}; }
    template <typename T, typename F> RgbT<T> fragment(const F& f) const {
        T nearest(1e9f);
        for (std::size_t k = 0; k < 3; ++k) {
            const T steep = f.dx.edges[k] * f.dx.edges[k] + f.dy.edges[k] * f.dy.edges[k];
            // Without an edge, the gradient is 0 and the distance becomes very large.
            nearest = min(nearest, f.at.edges[k] * inverse_sqrt(max(steep, T(1e-24f))));
        }
        constexpr float kHalfWidth = 0.5f; // pixels to each side of an edge
        return f.with_emitted(f.base_color()) * clamp(T(kHalfWidth + 0.5f) - nearest, T(0), T(1));
    }
};

} // namespace

std::unique_ptr<ShaderProgram> wireframe_program() {
    return std::make_unique<ShaderProgramOf<WireframeShader>>(WireframeShader{});
}

} // namespace duet::raster
