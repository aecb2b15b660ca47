#include "raster/lighting/environment_sun.h"

#include "common/system/parallel.h"
#include "raster/lighting/latlong_grid.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace duet::raster {
namespace {

constexpr double kRadius = 10; ///< degrees from the sun's center to the edge of its glow in the haze
constexpr double kRing = 12;   ///< degrees to the outer edge of the ring that shows the radiance around the disk
/// A disk is a sun if it adds at least this fraction to the environment's light. Shadows of weaker ones are faint.
constexpr double kLeastShare = 0.03;
/// At least this fraction of the light must come from within half the radius. It is a quarter for a disk of even
/// radiance, whose shadows are not sharp.
constexpr double kLeastInCenter = 0.5;

double cosine_of(double degrees) { return std::cos(radians(degrees)); }

/// Calls visit(w, solid angle) for each direction w of the grid within an angle of `center`.
template <typename Visit>
void visit_disk(const LatlongGrid& grid, const Vec3d& center, double degrees, const Visit& visit) {
    const double middle = std::acos(std::clamp(center.y, -1.0, 1.0)) / kPiDouble * grid.height,
                 reach = degrees / 180 * grid.height;
    const int last = std::min(grid.height - 1, static_cast<int>(middle + reach));
    const double least = cosine_of(degrees);
    for (int row = std::max(0, static_cast<int>(middle - reach)); row <= last; ++row) {
        const double solid_angle = grid.solid_angle(row);
        for (int column = 0; column < grid.width; ++column)
            if (const Vec3d w = grid.direction(column, row); dot(w, center) >= least) visit(w, solid_angle);
    }
}

/// Returns the direction of the brightest pixel.
Vec3d brightest(const Environment& environment, const LatlongGrid& grid, int threads) {
    struct Pixel {
        Vec3d w;
        float luminance = -1;
    };
    std::vector<Pixel> rows(static_cast<std::size_t>(grid.height));
    parallel_for(rows.size(), threads, [&](std::size_t row) {
        for (int column = 0; column < grid.width; ++column) {
            const Vec3d w = grid.direction(column, static_cast<int>(row));
            const float its = luminance(radiance(environment, Vec3(w)));
            if (its > rows[row].luminance) rows[row] = {w, its};
        }
    });
    return std::ranges::max_element(rows, {}, &Pixel::luminance)->w;
}

/// Returns the mean radiance between two angles from `center`; nothing if the image has no pixel there.
std::optional<Rgb> mean_of_ring(const Environment& environment, const LatlongGrid& grid, const Vec3d& center) {
    Rgbd sum;
    double all = 0;
    visit_disk(grid, center, kRing, [&](const Vec3d& w, double solid_angle) {
        if (dot(w, center) > cosine_of(kRadius)) return;
        sum += Rgbd(radiance(environment, Vec3(w))) * solid_angle, all += solid_angle;
    });
    if (!(all > 0)) return {};
    return Rgb(sum / all);
}

/// Represents the light that a disk adds to its surroundings.
struct Excess {
    Rgbd irradiance; ///< on a surface that faces the disk, as if all came from its center
    Vec3d direction; ///< sum of the directions that it comes from, weighted by luminance
};
Excess excess_of_disk(const Environment& environment, const LatlongGrid& grid, const Vec3d& center, double degrees,
                      const Rgb& around) {
    Excess result;
    visit_disk(grid, center, degrees, [&](const Vec3d& w, double solid_angle) {
        const Rgb light = radiance(environment, Vec3(w));
        const auto more = [](float all, float rest) { return static_cast<double>(max(all - rest, 0.0f)); };
        const Rgbd its = Rgbd(more(light.r, around.r), more(light.g, around.g), more(light.b, around.b)) * solid_angle;
        result.irradiance += its, result.direction += w * luminance(its);
    });
    return result;
}

} // namespace

std::optional<EnvironmentSun> find_sun(const Environment& environment, int threads) {
    const auto* image = std::get_if<ImageEnvironment>(&environment);
    if (image == nullptr || image->image.empty() || is_black(environment)) return {};
    const LatlongGrid grid{image->image.width(), image->image.height()};
    const Vec3d peak = brightest(environment, grid, threads);
    const std::optional<Rgb> around_peak = mean_of_ring(environment, grid, peak);
    if (!around_peak) return {};
    const Vec3d sum = excess_of_disk(environment, grid, peak, kRadius, *around_peak).direction;
    if (!(length(sum) > 0)) return {};
    const Vec3d center = normalize(sum);
    const std::optional<Rgb> around = mean_of_ring(environment, grid, center);
    if (!around) return {};
    const Excess all = excess_of_disk(environment, grid, center, kRadius, *around),
                 middle = excess_of_disk(environment, grid, center, kRadius / 2, *around);
    const double added = luminance(all.irradiance);
    if (!(added >= kLeastShare * 4 * kPiDouble * luminance(Rgbd(mean_radiance(environment))))) return {};
    if (luminance(middle.irradiance) < kLeastInCenter * added) return {};
    // The mean of unit vectors that are spread evenly within a small angle r of the center has the length 1 − r²/4.
    const double spread = max(1 - length(all.direction) / added, 0.0);
    const auto sine = static_cast<float>(2 * std::sqrt(spread)), cosine = static_cast<float>(cosine_of(kRadius));
    return EnvironmentSun{{-Vec3(center), Rgb(all.irradiance)}, sine, *around, cosine};
}

} // namespace duet::raster
