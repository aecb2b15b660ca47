#include "raster/shadows/shadow_map_lookup.h"

namespace duet::raster {
namespace {

using Mask = Floats::batch_bool_type;

} // namespace

SoftShadowMaps::SoftShadowMaps(const Shadows& shadows) {
    for (const Shadows::Source& source : shadows.sources()) {
        auto& moments = maps_.emplace_back();
        for (const Shadows::Maps& maps : source.moments) {
            auto& cells = moments.emplace_back();
            for (std::size_t i = 0; i < maps.cells.size(); ++i) cells.emplace_back(maps.cells[i], source.cells[i]);
        }
    }
}

MapShadows::MapShadows(const RasterSceneData& data, const GBuffer& gbuffer, float time, int threads)
    : shadows_(*data.shadows), soft_(*data.soft_shadows), gbuffer_(gbuffer), eye_(gbuffer.projection.eye()),
      to_moment_(shadows_.motions(time)), moment_(shadows_.moment_at(time)), unblocked_(data, gbuffer, threads) {
    const Vec3d eye = eye_;
    for (const Shadows::Source& from : shadows_.sources()) {
        Source& source = sources_.emplace_back();
        const Shadows::Maps& maps = from.moments[moment_];
        for (const ShadowMap& view : maps.views) source.views.emplace_back(view, eye);
        for (const CubeMap& cube : maps.cubes) {
            auto& faces = source.cubes.emplace_back();
            for (const auto& face : cube.faces) faces.emplace_back(*face, eye);
        }
    }
}

Floats MapShadows::sharp_visibility(const Source& source, const Vec3T<Floats>& p, const Vec3T<Floats>& n) const {
    Floats result(1.0f);
    Mask found = p.x != p.x;
    const auto look = [&](const SharpShadowMap& map) {
        Mask inside;
        const Floats seen = map.visibility(p, n, inside);
        result = xsimd::select((!found) & inside, seen, result);
        found = found | inside;
        return xsimd::all(found);
    };
    for (const SharpShadowMap& view : source.views)
        if (look(view)) return result;
    // The faces of a cube overlap by guard texels, so the first face that contains a point is used.
    for (const auto& cube : source.cubes)
        for (const SharpShadowMap& face : cube)
            if (look(face)) return result;
    return result;
}

MapShadows::Receivers MapShadows::at_moment(const Receivers& receivers, int x, int y) const {
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

Floats MapShadows::visibility(std::size_t source, const Vec3T<Floats>& point, const Vec3T<Floats>& normal, int x,
                              int y, const Mask& lanes) const {
    if (unblocked_.contains(source, x, y)) return Floats(1.0f);
    const Receivers receivers{point, normal};
    const auto [p, n] = to_moment_.empty() ? receivers : at_moment(receivers, x, y);
    const std::span<const SoftShadowMap> cells = soft_.of(source, moment_);
    if (cells.empty()) return sharp_visibility(sources_[source], p, n);
    // Up to four cells alternate between the rows of a block, so a batch samples one cell only.
    if (cells.size() <= 4) return cells[static_cast<std::size_t>(y) % cells.size()].visibility(eye_, p, n, y, lanes);
    Floats sum(0.0f);
    for (const SoftShadowMap& cell : cells) sum += cell.visibility(eye_, p, n, y, lanes);
    return sum * Floats(1 / static_cast<float>(cells.size()));
}

} // namespace duet::raster
