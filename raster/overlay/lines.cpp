#include "raster/overlay/lines.h"

#include "common/system/parallel.h"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace duet::raster {
namespace {

/// Returns a / b rounded down, for b > 0.
std::int64_t floor_divided(std::int64_t a, std::int64_t b) { return a >= 0 ? a / b : -((b - 1 - a) / b); }

/// Rasterizes a line along its major axis u. It calls mark(column, row) once per column, in (u, v) order.
template <typename Mark>
void rasterize_along_axis(std::int64_t u0, std::int64_t v0, std::int64_t u1, std::int64_t v1, int columns,
                          const Mark& mark) {
    if (u0 > u1) std::swap(u0, u1), std::swap(v0, v1);
    const std::int64_t du = u1 - u0, dv = v1 - v0;
    const std::int64_t first = std::max<std::int64_t>(floor_divided(u0 + kSubpixels - 1, kSubpixels), 0),
                       end = std::min<std::int64_t>(floor_divided(u1 + kSubpixels - 1, kSubpixels), columns);
    if (first >= end) return;
    // The line passes nearest to row r where v is in (r − ½, r + ½]. So r = ceil(v − ½), with v = v0 + (u − u0)·dv/du
    // in 1/256 pixel, which equals −floor((128 − v)/256). The numerator decreases by dv·256 per column and is stored as
    // a row and a remainder.
    const std::int64_t divisor = kSubpixels * du;
    std::int64_t numerator = (kSubpixels / 2 - v0) * du - (first * kSubpixels - u0) * dv;
    std::int64_t row = -floor_divided(numerator, divisor);
    std::int64_t rest = numerator + row * divisor; // in [0, divisor)
    for (std::int64_t column = first; column < end; ++column) {
        mark(static_cast<int>(column), row);
        rest -= kSubpixels * dv;
        if (rest < 0) ++row, rest += divisor; // |dv| <= du, so the line moves by at most one row
        if (rest >= divisor) --row, rest -= divisor;
    }
}

} // namespace

void draw_line(FixedPoint a, FixedPoint b, SampleOffset offset, Image<std::uint8_t>& marks) {
    // Coordinates relative to the samples give integer sample positions.
    const std::int64_t ax = a.x - offset.x, ay = a.y - offset.y, bx = b.x - offset.x, by = b.y - offset.y;
    const auto set = [&](std::int64_t x, std::int64_t y) {
        // Threads may mark the same pixel concurrently, with the same value.
        if (x >= 0 && x < marks.width() && y >= 0 && y < marks.height())
            std::atomic_ref(marks(static_cast<int>(x), static_cast<int>(y))).store(1, std::memory_order_relaxed);
    };
    const auto set_steep = [&](std::int64_t y, std::int64_t x) { set(x, y); };
    if (std::abs(bx - ax) >= std::abs(by - ay))
        rasterize_along_axis(ax, ay, bx, by, marks.width(), set);
    else
        rasterize_along_axis(ay, ax, by, bx, marks.height(), set_steep);
}

// The algorithm is that of Liang and Barsky 1984, "A New Concept and Method for Line Clipping", in homogeneous
// pixel coordinates: each clip plane is a linear function of the line parameter and gives a lower or upper bound of
// it.
bool clip_line(const PixelVertex& a, const PixelVertex& b, const Viewport& viewport, FixedPoint& from, FixedPoint& to) {
    double t0 = 0, t1 = 1;
    const auto keep = [&](double at_a, double at_b) { // clips to the part where the function is nonnegative
        if (at_a < 0 && at_b < 0) return false;
        const double t = at_a / (at_a - at_b);
        if (at_a < 0) t0 = std::max(t0, t);
        if (at_b < 0) t1 = std::min(t1, t);
        return true;
    };
    const double right = viewport.width + 1, below = viewport.height + 1;
    const bool visible = keep(a.depth - viewport.near, b.depth - viewport.near) && keep(a.xw + a.w, b.xw + b.w) &&
                         keep(right * a.w - a.xw, right * b.w - b.xw) && keep(a.yw + a.w, b.yw + b.w) &&
                         keep(below * a.w - a.yw, below * b.w - b.yw);
    if (!visible || !(t0 <= t1)) return false;
    from = snap(t0 > 0 ? between(a, b, t0) : a);
    to = snap(t1 < 1 ? between(a, b, t1) : b);
    return true;
}

void draw_lines(const RasterSceneData& data, const PassView& view, SampleOffset offset, int threads,
                Image<std::uint8_t>& marks) {
    std::vector<std::uint32_t> all = data.polygonal;
    all.insert(all.end(), data.alpha_polygonal.begin(), data.alpha_polygonal.end());
    for (const std::uint32_t index : all) {
        const Object& object = data.scene.objects[index];
        const Shape& shape = data.scene.shapes[object.shape];
        TransformedObject placed;
        placed.to_pixel = object_to_pixel(object, view.pinhole, view.time);
        placed.to_pixel_transposed = transpose(placed.to_pixel);
        constexpr std::uint32_t kRun = 4096; // primitives that a thread takes at once
        const std::uint32_t count = primitive_count(shape);
        parallel_for((count + kRun - 1) / kRun, threads, [&](std::size_t run) {
            const auto first = static_cast<std::uint32_t>(run) * kRun;
            for (std::uint32_t i = first; i < std::min(first + kRun, count); ++i) {
                const PrimitiveVertices corners = primitive_vertices(shape, i);
                const auto number = static_cast<std::size_t>(corners.count);
                std::array<PixelVertex, 4> v;
                for (std::size_t k = 0; k < number; ++k) v[k] = pixel_vertex(placed, corners.p[k]);
                for (std::size_t k = 0; k < number; ++k) {
                    FixedPoint from, to;
                    if (clip_line(v[k], v[(k + 1) % number], view.viewport, from, to))
                        draw_line(from, to, offset, marks);
                }
            }
        });
    }
}

} // namespace duet::raster
