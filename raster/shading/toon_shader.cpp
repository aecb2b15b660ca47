// Implements toon shading: each light is quantized into bands by its incident cosine, and highlights are uniform
// spots with a sharp edge (Lake, Marshall, Harris and Blackstein 2000, "Stylized Rendering Techniques for Scalable
// Real-Time 3D Animation"). The borders of bands are one pixel wide, by the normal's screen-space derivatives, which
// antialiases them.
#include "raster/shading/built_in_shaders.h"
#include "raster/shading/phong_model.h"
#include "raster/shader/shader_program.h"

namespace duet::raster {
namespace {

/// Returns 1 if x is beyond a border and 0 if not, with a linear ramp of one pixel between. `width` is the change of x
/// per pixel.
template <typename T> T beyond(T x, float border, T width) {
    return clamp((x - T(border)) / max(width, T(1e-6f)) + T(0.5f), T(0), T(1));
}

struct ToonShader {
    static constexpr bool kTextureCoordinates = false;
    static constexpr bool kDerivatives = true;
    template <typename T> struct Varyings {
        Vec3T<T> n;
    };
    template <typename T> Varyings<T> vertex(const VertexInput<T>& v) const {
        return {v.object.smooth ? v.n : v.ng};
    }
    template <typename T, typename F> RgbT<T> fragment(const F& f) const {
        constexpr std::array kBorders{0.0f, 0.25f, 0.5f, 0.75f}; // each adds a quarter of the light
        constexpr float kSpot = 0.97f;                           // cosine between the mirror direction and wo
        const Vec3T<T> n = f.normal(f.at.n).unit(), wo = f.wo().unit();
        // The derivative of the unit normal is the perpendicular component of the interpolated normal's derivative,
        // divided by the interpolated normal's length.
        const T scale = Direction<T>::of(f.object.normal(f.at.n)).scale;
        const auto turn = [&](Vec3T<T> change) {
            const Vec3T<T> d = f.object.normal(change) * scale;
            return d - n * dot(d, n);
        };
        const Vec3T<T> along = turn(f.dx.n), down = turn(f.dy.n);
        PhongLight<T> sum{RgbT<T>(T(0)), RgbT<T>(T(0))};
        for_each_incident(f.lights(), [&] { return f.p(); }, [&](const IncidentT<T>& arriving) {
            const auto width = [&](Vec3T<T> toward) { return abs(dot(along, toward)) + abs(dot(down, toward)); };
            T band(0);
            const T cosine = dot(n, arriving.wi), cosine_width = width(arriving.wi);
            for (const float border : kBorders)
                band += T(1.0f / kBorders.size()) * beyond(cosine, border, cosine_width);
            // The mirror direction turns by twice the angle of the normal.
            const T spot = beyond(dot(reflect(arriving.wi, n), wo), kSpot, T(2) * width(wo));
            sum.irradiance += arriving.irradiance * band;
            sum.highlights += arriving.irradiance * (band * spot * T(0.5f * kPhongSpecular));
        });
        return f.with_emitted(phong(sum, f.object.data.ambient, f.base_color()));
    }
};

} // namespace

std::unique_ptr<ShaderProgram> toon_program() { return std::make_unique<ShaderProgramOf<ToonShader>>(ToonShader{}); }

} // namespace duet::raster
