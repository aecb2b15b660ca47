#include "raster/screen_space/gtao.h"

#include "raster/gbuffer/neighbors.h"

#include <algorithm>
#include <cmath>

namespace duet::raster {
namespace {

/// Pixels of half resolution count as lying on other surfaces if their total likeness is below this.
constexpr float kLeastLikeness = 0.02f;

using Mask = Floats::batch_bool_type;
using Vec3s = Vec3T<Floats>;

/// Occluders do not receive all of the irradiance, because the points hide some of it from them, too. Of models/,
/// hall.json and demo.json have the least error with 0.6 of it, cornell.json and open-sky.json with 0.4.
constexpr float kOccluderVisibility = 0.5f;

} // namespace

void GtaoImage::reset(int width, int height) {
    if (depth_.width() == width && depth_.height() == height) return;
    depth_ = PlaneFloat(width, height);
    lines_ = column_sums_ = {PlaneFloat(width, height), PlaneFloat(width, height), Planes3(width, height)};
    occluders_ = {Planes3(width, height), Planes3(width, height), Planes3(width, height)};
    irradiance_ = Planes3(width, height);
    smooth_.visible = PlaneFloat(width, height), smooth_.hidden = Planes3(width, height);
}

void GtaoImage::start(const GBuffer& gbuffer, int threads) {
    gbuffer_ = &gbuffer;
    reset((gbuffer.width() + 1) / 2, (gbuffer.height() + 1) / 2);
    parallel_for(static_cast<std::size_t>(depth_.height()), threads, [&](std::size_t row) {
        const int y = static_cast<int>(row);
        const auto halved = [&](const PlaneFloat& from, PlaneFloat& to) {
            for (int x = 0; x < to.width(); ++x) to(x, y) = from(2 * x, 2 * y);
        };
        halved(gbuffer.reversed_depth, depth_);
        Planes3& normals = occluders_.normals;
        halved(gbuffer.normal.x, normals.x), halved(gbuffer.normal.y, normals.y), halved(gbuffer.normal.z, normals.z);
    });
}

void GtaoImage::search(float radius, const Occluders* occluders, int threads) {
    if (radius == 0) {
        smooth_.visible.fill(1), smooth_.hidden.fill(0);
        return;
    }
    const auto for_each_row = [&](const auto& use) {
        parallel_for(static_cast<std::size_t>(depth_.height()), threads,
                     [&](std::size_t y) { use(static_cast<int>(y)); });
    };
    for_each_row([&](int y) { search_row(y, radius, occluders); });
    for_each_row([&](int y) { sum_columns(y); });
    for_each_row([&](int y) { finish_row(y); });
}

/// Returns the points of a batch of half-resolution pixels, relative to the eye.
Vec3s GtaoImage::point(int x, int y, const Floats& depth) const {
    return gbuffer_->projection.point(Floats(static_cast<float>(2 * x)) + load(kLanesAsFloats, 0) * Floats(2.0f),
                                      Floats(static_cast<float>(2 * y)), max(depth, Floats(1e-30f)));
}

/// Sets the light that an occluder sends: its direct light, and the irradiance that it reflects. Surfaces without a
/// diffuse lobe send none: emitters, whose light is direct light, and metal, which sends it in one direction. The side
/// that the viewer does not see has no direct light, as far as is known.
void GtaoImage::set_light(int x, int y, Rgb direct) {
    const Rgb albedo = gbuffer_->diffuse.color_at(2 * x, 2 * y);
    const Rgb reflected = irradiance_.color_at(x, y) * albedo * (kInvPi * kOccluderVisibility);
    const bool sends = depth_(x, y) > 0 && !is_black(albedo); // other pixels may hold any number
    occluders_.front.set_at(x, y, sends ? direct + reflected : Rgb());
    occluders_.back.set_at(x, y, sends ? reflected : Rgb());
}

void GtaoImage::search_row(int y, float radius, const Occluders* occluders) {
    for (int x = 0; x < depth_.width(); x += static_cast<int>(Floats::size)) {
        const Floats depth = load(depth_, x, y);
        const Mask seen = depth > Floats(0.0f);
        OccludedLine found;
        if (xsimd::any(seen)) {
            found = search_line(*gbuffer_, depth_, occluders, point(x, y, depth), occluders_.normals.vector(x, y),
                                radius, x, y);
        }
        // Lanes without a surface may hold any number. They are set to 0 here, so that neighbors may read them with
        // weight 0.
        const auto valid = [&](const Floats& value) { return xsimd::select(seen, value, Floats(0.0f)); };
        store(lines_.lost, x, y, valid(found.lost));
        store(lines_.all, x, y, valid(found.all));
        const Vec3s& w = found.directions;
        lines_.directions.set(x, y, Vec3s{valid(w.x), valid(w.y), valid(w.z)});
    }
}

/// Calls use(x, lost, all, directions) for the batches of row y that show surfaces, with weighted sums over the
/// neighbors along an axis that are on the same surface. The weights form a tent twice as wide as a block. Each
/// direction thus has the same total weight and is interpolated linearly between the pixels that use it, so linear
/// gradients show no blocks.
template <typename Use>
void GtaoImage::sum_neighbors(const Lines& from, int y, int step_x, int step_y, const Use& use) const {
    const ScreenProjection& projection = gbuffer_->projection;
    for (int x = 0; x < depth_.width(); x += static_cast<int>(Floats::size)) {
        const Floats depth = load(depth_, x, y);
        if (!xsimd::any(depth > Floats(0.0f))) continue;
        const Vec3s p = point(x, y, depth), n = occluders_.normals.vector(x, y);
        const Floats tolerance = plane_tolerance(projection, depth);
        Floats all(0.0f), lost(0.0f);
        Vec3s directions{Floats(0.0f), Floats(0.0f), Floats(0.0f)};
        for (int i = 1 - kDitherSide; i < kDitherSide; ++i) {
            const int at_x = x + i * step_x, at_y = y + i * step_y;
            const Floats other = load_at(depth_, at_x, at_y);
            const Vec3s m = load_at(occluders_.normals, at_x, at_y);
            const Floats alike = likeness(p, n, tolerance, point(at_x, at_y, other), m);
            const Floats share(static_cast<float>(kDitherSide - std::abs(i)) / kDitherSide);
            const Floats weight = xsimd::select(other > Floats(0.0f), alike * share, Floats(0.0f));
            all += weight * load_at(from.all, at_x, at_y);
            lost += weight * load_at(from.lost, at_x, at_y);
            directions += load_at(from.directions, at_x, at_y) * weight;
        }
        use(x, lost, all, directions);
    }
}

void GtaoImage::sum_columns(int y) {
    sum_neighbors(lines_, y, 0, 1, [&](int x, const Floats& lost, const Floats& all, const Vec3s& directions) {
        store(column_sums_.lost, x, y, lost), store(column_sums_.all, x, y, all);
        column_sums_.directions.set(x, y, directions);
    });
}

void GtaoImage::finish_row(int y) {
    sum_neighbors(column_sums_, y, 1, 0, [&](int x, const Floats& lost, const Floats& all, const Vec3s& directions) {
        const Floats over = xsimd::select(all > Floats(0.0f), Floats(1.0f) / all, Floats(0.0f));
        store(smooth_.visible, x, y, clamp(Floats(1.0f) - lost * over, Floats(0.0f), Floats(1.0f)));
        smooth_.hidden.set(x, y, directions * over);
    });
}

GtaoImage::Upsampled GtaoImage::upsampled(int x, int y) const {
    // Pixel 2k has a value of its own at half resolution; pixel 2k + 1 lies between two.
    const Vec3s p = gbuffer_->points(x, y), n = gbuffer_->normal.vector(x, y);
    const ScreenProjection& projection = gbuffer_->projection;
    const Floats depth = load(gbuffer_->reversed_depth, x, y);
    const Floats tolerance = plane_tolerance(projection, depth);
    const Ints column = Ints(x) + load(kLanes, 0), last(depth_.width() - 1);
    Floats sum(0.0f), visible(0.0f);
    Vec3s hidden{Floats(0.0f), Floats(0.0f), Floats(0.0f)}, irradiance = hidden;
    for (int dy = 0; dy < (y % 2 == 0 ? 1 : 2); ++dy)
        for (int dx = 0; dx < 2; ++dx) {
            const int row = std::min(y / 2 + dy, depth_.height() - 1);
            const Ints half = xsimd::min((column + Ints(dx)) >> 1, last);
            const auto read = [&](const PlaneFloat& plane) { return gather(plane.row(row), half); };
            const Floats other = read(depth_);
            const Vec3s q = projection.point(xsimd::batch_cast<float>(half) * Floats(2.0f),
                                             Floats(static_cast<float>(2 * row)), max(other, Floats(1e-30f)));
            const Vec3s m{read(occluders_.normals.x), read(occluders_.normals.y), read(occluders_.normals.z)};
            const Floats alike = max(likeness(p, n, tolerance, q, m), Floats(1e-4f));
            const Floats weight = xsimd::select(other > Floats(0.0f), alike, Floats(0.0f));
            sum += weight;
            visible += weight * read(smooth_.visible);
            const auto read_all = [&](const Planes3& planes) {
                return Vec3s{read(planes.x), read(planes.y), read(planes.z)};
            };
            hidden += read_all(smooth_.hidden) * weight, irradiance += read_all(irradiance_) * weight;
        }
    const Mask any = sum > Floats(0.0f);
    const Floats over = xsimd::select(any, Floats(1.0f) / sum, Floats(0.0f));
    const Vec3s e = irradiance * over;
    return {{xsimd::select(any, visible * over, Floats(1.0f)), hidden * over}, {e.x, e.y, e.z},
            sum > Floats(kLeastLikeness)};
}

} // namespace duet::raster
