#include "raster/shadows/surface_shadows.h"

namespace duet::raster {
namespace {

using Mask = Floats::batch_bool_type;

} // namespace

SurfaceShadows::SurfaceShadows(const RasterSceneData& data, const GBuffer& gbuffer, float time, int threads)
    : shadows_(*data.shadows), maps_(shadows_, gbuffer.projection.eye(), time), gbuffer_(gbuffer),
      eye_(gbuffer.projection.eye()), to_moment_(shadows_.motions(time)), unblocked_(data, gbuffer, threads) {}

bool SurfaceShadows::is_wide_sun(std::size_t source) const {
    constexpr float kWide = 0.01f; // twice that of the sun in the sky, whose shadows are nearly sharp
    return shadows_.sources()[source].sine > kWide;
}

SurfaceShadows::Receivers SurfaceShadows::at_moment(const Receivers& receivers, int x, int y) const {
    PacketOf<float> px, py, pz, nx, ny, nz;
    const auto [p, n] = receivers;
    store(px, 0, p.x), store(py, 0, p.y), store(pz, 0, p.z);
    store(nx, 0, n.x), store(ny, 0, n.y), store(nz, 0, n.z);
    for (std::size_t i = 0; i < Floats::size; ++i) {
        const std::int32_t object =
            x + static_cast<int>(i) < gbuffer_.width() ? gbuffer_.object(x + static_cast<int>(i), y) : -1;
        if (object < 0 || !to_moment_[static_cast<std::size_t>(object)]) continue;
        const Mat4d& m = *to_moment_[static_cast<std::size_t>(object)];
        const Vec3 moved(transform_point(m, Vec3d(Vec3(px[i], py[i], pz[i])) + eye_) - eye_);
        const Vec3 turned(normalize(transform_normal(inverse_affine(m), Vec3d(Vec3(nx[i], ny[i], nz[i])))));
        px[i] = moved.x, py[i] = moved.y, pz[i] = moved.z, nx[i] = turned.x, ny[i] = turned.y, nz[i] = turned.z;
    }
    return {{load(px, 0), load(py, 0), load(pz, 0)}, {load(nx, 0), load(ny, 0), load(nz, 0)}};
}

Floats SurfaceShadows::visibility(std::size_t source, const Vec3T<Floats>& point, const Vec3T<Floats>& normal, int x,
                              int y, const Mask& lanes) const {
    if (unblocked_.contains(source, x, y)) return Floats(1.0f);
    const Receivers at = to_moment_.empty() ? Receivers{point, normal} : at_moment({point, normal}, x, y);
    const auto visibility_in = [&](const SoftShadowMap& map) { return map.visibility(eye_, at.p, at.n, y, lanes); };
    const std::span<const SoftShadowMap> soft = maps_.soft(source);
    // Up to four cells alternate between the rows of a block, so a batch samples one cell only.
    if (!soft.empty() && soft.size() <= 4) return visibility_in(soft[static_cast<std::size_t>(y) % soft.size()]);
    const auto visibility_in_sharp = [&](const SharpShadowMap& map, Mask& inside) {
        return is_wide_sun(source)
                   ? sun_visibility(map, shadows_.sources()[source].sine, at.p, at.n, y, lanes, inside)
                   : map.visibility(at.p, at.n, inside);
    };
    return maps_.visibility(source, visibility_in_sharp, visibility_in);
}

std::optional<SurfaceShadows> surface_shadows(const RasterSceneData& data, const RasterSettings& settings,
                                              const GBuffer& gbuffer, float time) {
    std::optional<SurfaceShadows> result;
    if (settings.shadows && data.shadows) result.emplace(data, gbuffer, time, settings.threads);
    return result;
}

} // namespace duet::raster
