#include "compare/stress/exact_coverage.h"

namespace duet::compare {

namespace {

__extension__ typedef __int128 Int128; // ISO C++ has no name for it

/// Returns the signed side of the line from a to b on which the point lies; positive is to the right in the image.
Int128 side(raster::FixedPoint a, raster::FixedPoint b, std::int64_t x, std::int64_t y) {
    const Int128 dx = Int128{b.x} - a.x, dy = Int128{b.y} - a.y;
    return dx * (Int128{y} - a.y) - dy * (Int128{x} - a.x);
}

int sign(Int128 value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }

/// Returns the side on which the displaced point lies. If the point is on the line, the first displacement that
/// leaves the line decides.
int displaced_side(raster::FixedPoint a, raster::FixedPoint b, std::int64_t x, std::int64_t y) {
    const Int128 here = side(a, b, x, y), step_right = Int128{a.y} - b.y, step_down = Int128{b.x} - a.x;
    return sign(here != 0 ? here : step_right != 0 ? step_right : step_down);
}

} // namespace

int winding(const GridTriangle& t) { return sign(side(t[0], t[1], t[2].x, t[2].y)); }

bool covers(const GridTriangle& t, std::int64_t x, std::int64_t y) {
    const int turn = winding(t);
    if (turn == 0) return false;
    for (std::size_t i = 0; i < 3; ++i)
        if (displaced_side(t[i], t[(i + 1) % 3], x, y) != turn) return false;
    return true;
}

} // namespace duet::compare
