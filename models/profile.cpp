#include "models/profile.h"

#include <algorithm>
#include <iterator>

namespace duet::models {

std::vector<Vec2d> sample_profile(std::span<const Vec2d> points, int count) {
    const auto at = [&](std::ptrdiff_t i) {
        return points[static_cast<std::size_t>(clamp<std::ptrdiff_t>(i, 0, std::ssize(points) - 1))];
    };
    std::vector<Vec2d> fine;
    constexpr int kSteps = 64;
    for (std::ptrdiff_t i = 0; i + 1 < std::ssize(points); ++i) {
        for (int k = 0; k < kSteps; ++k) {
            const double f = static_cast<double>(k) / kSteps;
            const Vec2d a = at(i - 1), b = at(i), c = at(i + 1), d = at(i + 2);
            fine.push_back(catmull_rom(a, b, c, d, f));
        }
    }
    fine.push_back(points.back());
    std::vector<double> along{0};
    for (std::size_t i = 1; i < fine.size(); ++i) {
        const Vec2d step = fine[i] - fine[i - 1];
        along.push_back(along.back() + std::sqrt(dot(step, step)));
    }
    std::vector<Vec2d> result;
    for (int i = 0; i <= count; ++i) {
        const double wanted = along.back() * i / count;
        const auto next = static_cast<std::size_t>(std::ranges::lower_bound(along, wanted) - along.begin());
        if (next == 0)
            result.push_back(fine.front());
        else {
            const double f = (wanted - along[next - 1]) / (along[next] - along[next - 1]);
            result.push_back(fine[next - 1] * (1 - f) + fine[std::min(next, fine.size() - 1)] * f);
        }
    }
    return result;
}

} // namespace duet::models
