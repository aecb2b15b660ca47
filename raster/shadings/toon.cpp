// Toon shading: each light comes in bands, by the cosine at which it arrives, and highlights are spots of even light with
// a sharp edge (Lake, Marshall, Harris and Blackstein 2000, «Stylized Rendering Techniques for Scalable Real-Time 3D
// Animation»). From band to band it goes within a pixel, by the normal's screen derivatives, so that borders do not
// stair-step.
#include "raster/shader/phong.h"
#include "raster/shader/program.h"
#include "raster/shadings/shadings.h"

namespace duet::raster {
namespace {

/// 1 where x is beyond a border, 0 where it is not, and between within half a pixel: x changes by `width` a pixel.
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
        constexpr std::array kBorders{0.0f, 0.25f, 0.5f, 0.75f}; // a quarter of the light more beyond each
        constexpr float kSpot = 0.97f;                           // cosine to the mirror direction
        const Vec3T<T> n = f.normal(f.at.n).unit(), wo = f.wo().unit();
        // Change of the unit normal: what is across it of the change of the interpolated one, over that one's length.
        const T scale = Direction<T>::of(f.object.normal(f.at.n)).scale;
        const auto turn = [&](Vec3T<T> change) {
            const Vec3T<T> d = f.object.normal(change) * scale;
            return d - n * dot(d, n);
        };
        const Vec3T<T> along = turn(f.dx.n), down = turn(f.dy.n);
        PhongLight<T> sum{RgbT<T>(T(0)), RgbT<T>(T(0))};
        for_each_incident(f.lights(), [&] { return f.p(); }, [&](const IncidentT<T>& arriving) {
            const auto width = [&](Vec3T<T> towards) { return abs(dot(along, towards)) + abs(dot(down, towards)); };
            T band(0);
            const T cosine = dot(n, arriving.wi), cosine_width = width(arriving.wi);
            for (const float border : kBorders) band += T(1.0f / kBorders.size()) * beyond(cosine, border, cosine_width);
            // The mirror direction turns twice as far as the normal.
            const T spot = beyond(dot(reflect(arriving.wi, n), wo), kSpot, T(2) * width(wo));
            sum.irradiance += arriving.irradiance * band;
            sum.highlights += arriving.irradiance * (band * spot * T(0.5f * kPhongSpecular));
        });
        return f.with_emitted(phong(sum, f.object.data.ambient, f.base_color()));
    }
};

} // namespace

std::unique_ptr<Program> toon_program() { return std::make_unique<ProgramOf<ToonShader>>(ToonShader{}); }

} // namespace duet::raster
