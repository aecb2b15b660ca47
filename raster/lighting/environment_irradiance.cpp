#include "raster/lighting/environment_irradiance.h"

#include "common/system/parallel.h"

#include <cmath>
#include <vector>

namespace duet::raster {
namespace {

/// Projects one row of the environment map: the sum of radiance × harmonics over its pixels, weighted by solid angle.
std::array<Rgbd, 9> project_row(const Environment& environment, int row, int width, int height) {
    std::array<Rgbd, 9> sums{};
    const double top = kPiDouble * row / height, bottom = kPiDouble * (row + 1) / height; // angles from +y
    const double solid_angle = 2 * kPiDouble / width * (std::cos(top) - std::cos(bottom));
    const double theta = (top + bottom) / 2;
    for (int column = 0; column < width; ++column) {
        const double longitude = 2 * kPiDouble * ((column + 0.5) / width - 0.5);
        const Vec3d w(std::sin(theta) * std::sin(longitude), std::cos(theta), -std::sin(theta) * std::cos(longitude));
        const Rgbd light = Rgbd(radiance(environment, Vec3(w))) * solid_angle;
        const std::array<double, 9> y = harmonics(w);
        for (std::size_t i = 0; i < 9; ++i) sums[i] += light * y[i];
    }
    return sums;
}

} // namespace

IrradianceHarmonics environment_irradiance(const Environment& environment, int threads) {
    IrradianceHarmonics result{};
    if (const auto up = irradiance_closed_form(environment, Vec3(0, 1, 0))) {
        const Rgb down = *irradiance_closed_form(environment, Vec3(0, -1, 0));
        result[0] = (*up + down) * 0.5f, result[1] = (*up - down) * 0.5f; // the irradiance is linear in n.y
        return result;
    }
    const ImageRgb& image = std::get<ImageEnvironment>(environment).image;
    std::vector<std::array<Rgbd, 9>> rows(static_cast<std::size_t>(image.height()));
    parallel_for(rows.size(), threads, [&](std::size_t row) {
        rows[row] = project_row(environment, static_cast<int>(row), image.width(), image.height());
    });
    std::array<Rgbd, 9> sums{};
    for (const auto& row : rows)
        for (std::size_t i = 0; i < 9; ++i) sums[i] += row[i];
    for (std::size_t i = 0; i < 9; ++i) result[i] = Rgb(sums[i] * kIrradianceFactors[i]);
    return result;
}

} // namespace duet::raster
