#include "compare/stress/coverage_meshes.h"

#include <algorithm>
#include <cmath>

namespace duet::compare {

using raster::FixedPoint, raster::kSubpixels;

namespace {

constexpr int kImageSide = 16384; // the largest side that the rasterizer accepts
/// This is the greatest coordinate that the guard band allows for the largest image.
constexpr std::int64_t kFarthest = (static_cast<std::int64_t>(raster::kGuardBand) + kImageSide) * kSubpixels;

std::int32_t within_guard(std::int64_t x) {
    return static_cast<std::int32_t>(
        std::clamp<std::int64_t>(x, -static_cast<std::int64_t>(raster::kGuardBand) * kSubpixels, kFarthest));
}
FixedPoint guarded(std::int64_t x, std::int64_t y) { return {within_guard(x), within_guard(y)}; }

/// Returns a uniform integer in [−reach, reach].
std::int64_t about(TrialRandom& random, std::int64_t reach) {
    return static_cast<std::int64_t>(random.below(static_cast<std::uint32_t>(2 * reach + 1))) - reach;
}
FixedPoint near(TrialRandom& random, FixedPoint p, std::int64_t reach) {
    const std::int64_t dx = about(random, reach);
    return guarded(p.x + dx, p.y + about(random, reach));
}
/// Returns a distance in grid points, of a random order of magnitude from 1 to the whole guard band.
std::int64_t any_reach(TrialRandom& random) {
    return std::lround(random.log_uniform(1, static_cast<float>(kFarthest)));
}

/// Returns a uniform point within the guard band.
FixedPoint anywhere(TrialRandom& random) { return near(random, {kFarthest / 2, kFarthest / 2}, kFarthest); }

/// Returns a point beyond `through`, seen from `from`. The line between the two passes through or close to `through`.
FixedPoint beyond(TrialRandom& random, FixedPoint from, FixedPoint through) {
    const auto times = static_cast<std::int64_t>(1 + random.below(8));
    return guarded(through.x + (std::int64_t{through.x} - from.x) * times,
                   through.y + (std::int64_t{through.y} - from.y) * times);
}

/// A Border is a rectangle that surrounds all samples of the window at a random distance.
struct Border {
    std::int32_t left, top, right, bottom;

    FixedPoint at(double turn) const { // `turn` runs clockwise from the upper left corner, one unit per side
        const double side = std::floor(turn), along = turn - side;
        const auto between = [&](std::int32_t from, std::int32_t to) {
            return static_cast<std::int32_t>(std::lround(lerp(double{1} * from, double{1} * to, along)));
        };
        switch (static_cast<int>(side)) {
        case 0:
            return {between(left, right), top};
        case 1:
            return {right, between(top, bottom)};
        case 2:
            return {between(right, left), bottom};
        default:
            return {left, between(bottom, top)};
        }
    }
};
Border around(TrialRandom& random, const Window& window) {
    const auto margin = [&] { return any_reach(random); };
    const raster::PixelRect& r = window.rect;
    return {within_guard(std::int64_t{r.x0} * kSubpixels - margin()),
            within_guard(std::int64_t{r.y0} * kSubpixels - margin()),
            within_guard(std::int64_t{r.x1} * kSubpixels + margin()),
            within_guard(std::int64_t{r.y1} * kSubpixels + margin())};
}

} // namespace

Window random_window(TrialRandom& random, int side) {
    const auto start = [&] {
        return static_cast<int>(random.below(static_cast<std::uint32_t>(kImageSide - side + 1)));
    };
    const int x = start(), y = start();
    Window window{.rect = {x, y, x + side, y + side}, .offset = {}};
    const auto place = [&] { return static_cast<std::int32_t>(random.below(kSubpixels + 1)); };
    if (random.below(4) != 0) window.offset = {place(), place()};
    return window;
}

FixedPoint point_in(TrialRandom& random, const Window& window) {
    const raster::PixelRect& r = window.rect;
    const auto pick = [&](int from, int to, std::int32_t offset, bool on_sample) {
        const int pixel = from + static_cast<int>(random.below(static_cast<std::uint32_t>(to - from)));
        return pixel * kSubpixels + (on_sample ? offset : static_cast<std::int32_t>(random.below(kSubpixels)));
    };
    const bool on_sample = random.coin();
    const std::int32_t x = pick(r.x0, r.x1, window.offset.x, on_sample);
    return {x, pick(r.y0, r.y1, window.offset.y, on_sample)};
}

GridTriangle random_triangle(TrialRandom& random, const Window& window, std::uint32_t kind) {
    const FixedPoint p = point_in(random, window);
    const auto corner = [&](std::int64_t reach) { return near(random, p, reach); };
    switch (kind) {
    case 0: // smaller than a pixel
        return {corner(200), corner(200), corner(200)};
    case 1: // about the window's size
        return {corner(3000), corner(3000), corner(3000)};
    case 2: { // any size, with one corner at the point
        const std::int64_t reach = any_reach(random);
        return {p, corner(reach), corner(reach)};
    }
    case 3: // the largest possible
        return {anywhere(random), anywhere(random), anywhere(random)};
    case 4: { // with an edge through the window
        const FixedPoint a = corner(any_reach(random));
        return {a, beyond(random, a, p), anywhere(random)};
    }
    case 5: { // a sliver through the window
        const FixedPoint a = corner(any_reach(random)), b = beyond(random, a, p);
        return {a, b, near(random, random.coin() ? b : p, 3)};
    }
    case 6: { // with corners on samples
        const auto on_sample = [&] {
            const FixedPoint q = point_in(random, window);
            return FixedPoint{(q.x & -kSubpixels) + window.offset.x, (q.y & -kSubpixels) + window.offset.y};
        };
        return {on_sample(), on_sample(), on_sample()};
    }
    default: { // with edges along a row and a column of samples
        const FixedPoint a = corner(any_reach(random));
        return {p, {a.x, p.y}, {p.x, a.y}};
    }
    }
}

std::vector<GridTriangle> random_fan(TrialRandom& random, const Window& window) {
    const Border border = around(random, window);
    const std::size_t count = 4 + random.below(61);
    std::vector<double> turns{0, 1, 2, 3}; // the border's corners are needed to surround the window
    for (std::size_t i = 4; i < count; ++i) turns.push_back(4 * static_cast<double>(random.uniform()));
    std::sort(turns.begin(), turns.end());
    const FixedPoint hub = point_in(random, window);
    std::vector<GridTriangle> fan;
    for (std::size_t i = 0; i < turns.size(); ++i)
        fan.push_back({hub, border.at(turns[i]), border.at(turns[(i + 1) % turns.size()])});
    return fan;
}

std::vector<GridTriangle> random_strip(TrialRandom& random, const Window& window) {
    const Border border = around(random, window);
    const std::size_t columns = 2 + random.below(40);
    // Returns x coordinates along the upper or lower border: most are above or below the window, and many are
    // close together.
    const auto edge = [&] {
        std::vector<std::int32_t> xs{border.left, border.right};
        while (xs.size() < columns)
            xs.push_back(random.coin() ? point_in(random, window).x : within_guard(xs.back() + about(random, 3)));
        for (std::int32_t& x : xs) x = std::clamp(x, border.left, border.right);
        std::sort(xs.begin(), xs.end());
        return xs;
    };
    const std::vector<std::int32_t> upper = edge(), lower = edge();
    std::vector<GridTriangle> strip;
    for (std::size_t i = 0; i + 1 < upper.size(); ++i) {
        const FixedPoint a{upper[i], border.top}, b{upper[i + 1], border.top};
        const FixedPoint c{lower[i + 1], border.bottom}, d{lower[i], border.bottom};
        strip.push_back({a, b, c});
        strip.push_back({a, c, d});
    }
    return strip;
}

std::vector<GridTriangle> random_grid(TrialRandom& random, const Window& window) {
    const Border border = around(random, window);
    constexpr int kCells = 4;
    const std::int64_t reach = random.coin() ? 0 : any_reach(random); // 0: half of the vertices are on samples
    std::array<std::array<FixedPoint, kCells + 1>, kCells + 1> p;
    for (int row = 0; row <= kCells; ++row)
        for (int column = 0; column <= kCells; ++column) {
            const bool inner = row > 0 && row < kCells && column > 0 && column < kCells;
            const double u = static_cast<double>(column) / kCells, v = static_cast<double>(row) / kCells;
            FixedPoint& q = p[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)];
            if (inner)
                q = near(random, point_in(random, window), reach);
            else
                q = {
                    static_cast<std::int32_t>(std::lround(lerp(double{1} * border.left, double{1} * border.right, u))),
                    static_cast<std::int32_t>(std::lround(lerp(double{1} * border.top, double{1} * border.bottom, v)))};
        }
    std::vector<GridTriangle> grid;
    for (std::size_t row = 0; row < kCells; ++row)
        for (std::size_t column = 0; column < kCells; ++column) {
            const FixedPoint a = p[row][column], b = p[row][column + 1], c = p[row + 1][column + 1],
                             d = p[row + 1][column];
            const bool other_diagonal = random.coin();
            grid.push_back(other_diagonal ? GridTriangle{a, b, d} : GridTriangle{a, b, c});
            grid.push_back(other_diagonal ? GridTriangle{b, c, d} : GridTriangle{a, c, d});
        }
    return grid;
}

} // namespace duet::compare
