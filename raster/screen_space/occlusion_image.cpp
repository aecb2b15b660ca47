#include "raster/screen_space/occlusion_image.h"

#include "common/system/parallel.h"

#include <algorithm>
#include <cmath>

namespace duet::raster {
namespace {

constexpr float kPixels = 2;           ///< largest distance of neighbors from a point's plane, in pixel widths
constexpr float kMinSimilarity = 0.7f; ///< least cosine between normals of one surface
/// At these shorter image sides, in pixels, a filter of 8 pixels is wide, and narrow.
constexpr float kCoarse = 160, kFine = 400;
/// These are filter weights by distance from the center: a box of 4 pixels, and a box of 8 convolved with one of 4,
/// which avoids abrupt changes. Both weight each pixel of a 4 × 4 block equally; the second also weights each pattern
/// equally.
constexpr std::array<float, 7> kBox{0.25f, 0.25f, 0.125f, 0, 0, 0, 0};
constexpr std::array<float, 7> kSoftBox{0.125f, 0.125f, 3.75f / 32, 3.0f / 32, 2.0f / 32, 1.0f / 32, 0.25f / 32};
constexpr int kBatchWidth = static_cast<int>(Floats::size);

/// Blends from the first to the second kernel as the image size grows, so that the result changes continuously with
/// the size.
std::array<float, 7> kernel_of(const ScreenGBuffer& gbuffer) {
    const float side = static_cast<float>(std::min(gbuffer.width(), gbuffer.height()));
    const float soft = clamp((side - kCoarse) / (kFine - kCoarse), 0.0f, 1.0f);
    std::array<float, 7> kernel;
    for (std::size_t i = 0; i < kernel.size(); ++i) kernel[i] = lerp(kBox[i], kSoftBox[i], soft);
    return kernel;
}

/// Returns 1 for points on the same plane with equal normals, falling to 0 off the plane.
template <typename T> T same_surface(Vec3T<T> to, Vec3T<T> n, Vec3T<T> other_n, T tolerance) {
    const T off = T(1) - abs(dot(n, to)) / tolerance,
            facing = (dot(n, other_n) - T(kMinSimilarity)) * T(1 / (1 - kMinSimilarity));
    return max(off, T(0)) * min(max(facing, T(0)), T(1));
}

Floats load_from(const ImageFloat& image, int x, int y) { return Floats::load_unaligned(&image(x, y)); }
Vec3T<Floats> normals_from(const ScreenGBuffer& gbuffer, int x, int y) {
    const auto& [nx, ny, nz] = gbuffer.normals();
    return {load_from(nx, x, y), load_from(ny, x, y), load_from(nz, x, y)};
}

/// Replaces an empty pixel's reversed depth by 1, so that all following values are finite.
Floats depth_or_one(const Floats& reversed_depth) {
    return xsimd::select(reversed_depth > Floats(0.0f), reversed_depth, Floats(1.0f));
}

/// Calls `use` with the start columns of batches that cover a row; the last ones may overlap.
template <typename F> void for_batches(int width, const F& use) {
    for (int x = 0; x < width; x += kBatchWidth) use(std::min(x, width - kBatchWidth));
}

} // namespace

OcclusionImage::OcclusionImage(const ScreenGBuffer& gbuffer, AmbientOcclusion kind, float radius, int threads)
    : gbuffer_(gbuffer), kind_(kind), radius_(radius), kernel_(kernel_of(gbuffer)) {
    if (gbuffer.width() < kBatchWidth) return; // every point is then evaluated separately
    const auto rows = static_cast<std::size_t>(gbuffer.height());
    Planes along_rows;
    for (std::size_t k = 0; k < planes_.size(); ++k)
        planes_[k] = along_rows[k] = ImageFloat(gbuffer.width(), gbuffer.height());
    parallel_for(rows, threads, [&](std::size_t y) { evaluate_row(static_cast<int>(y)); });
    parallel_for(rows, threads, [&](std::size_t y) { filter_row(static_cast<int>(y), false, planes_, along_rows); });
    parallel_for(rows, threads, [&](std::size_t y) { filter_row(static_cast<int>(y), true, along_rows, planes_); });
}

SkyVisibilityT<Floats> OcclusionImage::evaluate(const OcclusionPoints& points, const OcclusionPattern& pattern) const {
    return kind_ == AmbientOcclusion::kSsao ? screen_space_occlusion(gbuffer_, points, pattern, radius_)
                                            : horizon_occlusion(gbuffer_, points, pattern, radius_, kLines, kSteps);
}

void OcclusionImage::evaluate_row(int y) {
    for_batches(gbuffer_.width(), [&](int x) {
        const Floats reversed_depth = load_from(gbuffer_.reversed_depth(), x, y);
        if (xsimd::all(reversed_depth <= Floats(0.0f))) return;
        const Floats column = Floats(static_cast<float>(x)) + load(kLanesAsFloats, 0);
        OcclusionPoints points;
        points.p = gbuffer_.at(column, Floats(static_cast<float>(y)), depth_or_one(reversed_depth));
        points.n = normals_from(gbuffer_, x, y);
        points.to_viewer = gbuffer_.to_viewer(points.p);
        const SkyVisibilityT<Floats> visible = evaluate(points, OcclusionPattern::of_row(x, y));
        const std::array<Floats, 4> numbers{visible.visible, visible.hidden.x, visible.hidden.y, visible.hidden.z};
        for (std::size_t k = 0; k < 4; ++k)
            xsimd::select(reversed_depth > Floats(0.0f), numbers[k], Floats(0.0f)).store_unaligned(&planes_[k](x, y));
    });
}

void OcclusionImage::filter_row(int y, bool down, const Planes& from, Planes& to) const {
    const int width = gbuffer_.width(), height = gbuffer_.height();
    const int reach = static_cast<int>(std::ranges::find(kernel_, 0.0f) - kernel_.begin()) - 1;
    const Floats none(0.0f), last(static_cast<float>(width - 1));
    for_batches(width, [&](int x) {
        const Floats reversed_depth = load_from(gbuffer_.reversed_depth(), x, y);
        if (xsimd::all(reversed_depth <= none)) return;
        const Floats column = Floats(static_cast<float>(x)) + load(kLanesAsFloats, 0);
        const Vec3T<Floats> p = gbuffer_.at(column, Floats(static_cast<float>(y)), depth_or_one(reversed_depth));
        const Vec3T<Floats> n = normals_from(gbuffer_, x, y);
        const Floats tolerance = gbuffer_.pixel_size(Floats(kPixels * gbuffer_.near()) / depth_or_one(reversed_depth));
        Floats weights(0.0f);
        std::array<Floats, 4> sums{none, none, none, none};
        for (int step = -reach; step <= reach; ++step) {
            const int dx = down ? 0 : step, row = down ? y + step : y;
            if (row < 0 || row >= height) continue;
            const Floats at = column + Floats(static_cast<float>(dx));
            const bool within = x + dx >= 0 && x + dx + kBatchWidth <= width;
            const Ints columns = truncated(min(max(at, none), last));
            const auto of = [&](const ImageFloat& image) {
                return within ? load_from(image, x + dx, row) : gather(&image(0, row), columns);
            };
            const Floats other = of(gbuffer_.reversed_depth());
            const Vec3T<Floats> q = gbuffer_.at(at, Floats(static_cast<float>(row)), depth_or_one(other));
            const Vec3T<Floats> other_n{of(gbuffer_.normals()[0]), of(gbuffer_.normals()[1]),
                                        of(gbuffer_.normals()[2])};
            const auto counts = (other > none) & (at >= none) & (at <= last);
            const Floats near(kernel_[static_cast<std::size_t>(std::abs(step))]);
            const Floats weight = xsimd::select(counts, same_surface(q - p, n, other_n, tolerance) * near, none);
            weights += weight;
            for (std::size_t k = 0; k < 4; ++k) sums[k] += xsimd::select(counts, weight * of(from[k]), none);
        }
        const Floats over = Floats(1.0f) / max(weights, Floats(1e-20f));
        for (std::size_t k = 0; k < 4; ++k) (sums[k] * over).store_unaligned(&to[k](x, y));
    });
}

/// Returns the similarity of the surface at pixel (x, y) to that through p.
float OcclusionImage::similarity(int x, int y, Vec3 p, Vec3 n, float tolerance) const {
    const std::optional<Vec3> visible = gbuffer_.visible_point(x, y);
    return visible ? same_surface(*visible - p, n, gbuffer_.normal(x, y), tolerance) : 0.0f;
}

SkyVisibility OcclusionImage::at(int x, int y, Vec3 p, Vec3 n) const {
    if (planes_[0].empty()) return evaluate(p, n);
    const float depth = gbuffer_.homogeneous(p)[2], tolerance = gbuffer_.pixel_size(kPixels * depth);
    const auto found = [&](int column, int row) {
        return SkyVisibility{planes_[0](column, row),
                             {planes_[1](column, row), planes_[2](column, row), planes_[3](column, row)}};
    };
    if (similarity(x, y, p, n, tolerance) > 0.5f) return found(x, y);
    float weights = 0;
    SkyVisibility sum{0, {}};
    for (int row = std::max(y - 1, 0); row <= std::min(y + 1, gbuffer_.height() - 1); ++row)
        for (int column = std::max(x - 1, 0); column <= std::min(x + 1, gbuffer_.width() - 1); ++column) {
            const float weight = similarity(column, row, p, n, tolerance);
            if (!(weight > 0)) continue;
            const SkyVisibility here = found(column, row);
            weights += weight;
            sum.visible += here.visible * weight;
            sum.hidden += here.hidden * weight;
        }
    if (!(weights > 0.25f)) return evaluate(p, n);
    return {sum.visible / weights, sum.hidden / weights};
}

SkyVisibility OcclusionImage::evaluate(Vec3 p, Vec3 n) const {
    const OcclusionPoints points{broadcast<Floats>(p), broadcast<Floats>(n), broadcast<Floats>(gbuffer_.to_viewer(p))};
    SkyVisibility sum{0, {}};
    for (int first = 0; first < OcclusionPattern::kOfPoint; first += kBatchWidth) {
        const SkyVisibilityT<Floats> visible = evaluate(points, OcclusionPattern::of_point(first));
        sum.visible += xsimd::hadd(visible.visible);
        sum.hidden += Vec3(xsimd::hadd(visible.hidden.x), xsimd::hadd(visible.hidden.y), xsimd::hadd(visible.hidden.z));
    }
    return {sum.visible / OcclusionPattern::kOfPoint, sum.hidden / static_cast<float>(OcclusionPattern::kOfPoint)};
}

} // namespace duet::raster
