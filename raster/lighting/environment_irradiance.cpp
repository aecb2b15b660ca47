#include "raster/lighting/environment_irradiance.h"

#include "common/system/parallel.h"
#include "raster/lighting/latlong_grid.h"

#include <vector>

namespace duet::raster {
namespace {

/// Projects one row of the environment map: the sum of radiance × harmonics over its pixels, weighted by solid angle.
std::array<Rgbd, 9> project_row(const Environment& environment, const EnvironmentSun* sun, const LatlongGrid& grid,
                                int row) {
    std::array<Rgbd, 9> sums{};
    for (int column = 0; column < grid.width; ++column) {
        const Vec3d w = grid.direction(column, row);
        const Rgb arriving = radiance(environment, Vec3(w));
        const Rgbd light = Rgbd(sun != nullptr ? sun->without_sun(Vec3(w), arriving) : arriving);
        const std::array<double, 9> y = harmonics(w);
        for (std::size_t i = 0; i < 9; ++i) sums[i] += light * y[i];
    }
    for (Rgbd& sum : sums) sum *= grid.solid_angle(row);
    return sums;
}

} // namespace

IrradianceHarmonics environment_irradiance(const Environment& environment, const EnvironmentSun* sun, int threads) {
    IrradianceHarmonics result{};
    if (const auto up = irradiance_closed_form(environment, Vec3(0, 1, 0))) {
        const Rgb down = *irradiance_closed_form(environment, Vec3(0, -1, 0));
        result[0] = (*up + down) * 0.5f, result[1] = (*up - down) * 0.5f; // the irradiance is linear in n.y
        return result;
    }
    const ImageRgb& image = std::get<ImageEnvironment>(environment).image;
    std::vector<std::array<Rgbd, 9>> rows(static_cast<std::size_t>(image.height()));
    parallel_for(rows.size(), threads, [&](std::size_t row) {
        rows[row] = project_row(environment, sun, {image.width(), image.height()}, static_cast<int>(row));
    });
    std::array<Rgbd, 9> sums{};
    for (const auto& row : rows)
        for (std::size_t i = 0; i < 9; ++i) sums[i] += row[i];
    for (std::size_t i = 0; i < 9; ++i) result[i] = Rgb(sums[i] * kIrradianceFactors[i]);
    return result;
}

} // namespace duet::raster
