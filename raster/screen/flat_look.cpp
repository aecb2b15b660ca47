#include "raster/screen/flat_look.h"

#include "common/system/parallel.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace duet::raster {
namespace {

/// This is the confidence that the background continues behind a foreground object; see RadiancePyramid.
constexpr float kNothing = 0.95f;

} // namespace

float normal_turn(const Screen& screen, int x, int y) {
    const Vec3 n = screen.normal(x, y);
    const float depth = screen.depth(x, y);
    if (!(depth < kInfinity)) return 0; // background
    const Image<std::uint32_t>& objects = screen.first_look().objects;
    float most = -1;
    for (const auto& [dx, dy] : {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)}) {
        const int i = x + dx, k = y + dy;
        if (i < 0 || k < 0 || i >= screen.width() || k >= screen.height()) continue;
        if (objects(i, k) != objects(x, y) || !(std::abs(screen.depth(i, k) - depth) <= kSameSurface * depth)) continue;
        const float turn = length(screen.normal(i, k) - n);
        if (turn < kSmallTurn) most = std::max(most, turn);
    }
    return most < 0 ? kSmallTurn : most; // an isolated pixel is small, and its curvature unknown
}

ImageFloat normal_turns(const Screen& screen, int threads) {
    ImageFloat turns(screen.width(), screen.height());
    parallel_for(static_cast<std::size_t>(screen.height()), threads, [&](std::size_t row) {
        for (int x = 0; x < screen.width(); ++x)
            turns(x, static_cast<int>(row)) = normal_turn(screen, x, static_cast<int>(row));
    });
    return turns;
}

RadiancePyramid flat_look(const Screen& screen, std::span<const std::uint8_t> mirrors, int threads) {
    const Screen::FirstLook& look = screen.first_look();
    ImageFloat known(screen.width(), screen.height());
    parallel_for(static_cast<std::size_t>(screen.height()), threads, [&](std::size_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < screen.width(); ++x) {
            const bool nothing = !(screen.depth(x, y) < kInfinity);
            const bool flat = !nothing && mirrors[look.objects(x, y)] == 0 && is_flat(screen, x, y);
            known(x, y) = look.lamps(x, y) != 0 ? 0.0f : nothing ? kNothing : flat ? 1.0f : 0.0f;
        }
    });
    return RadiancePyramid(look.radiance.finest(), std::move(known), threads);
}

bool is_flat(const Screen& screen, int x, int y) {
    const float depth = screen.depth(x, y);
    if (!(depth < kInfinity)) return false;
    const float pixel = screen.pixel_size(depth);
    return screen.turn(x, y) * (screen.perspective() ? depth : pixel * static_cast<float>(screen.height())) < pixel;
}

} // namespace duet::raster
