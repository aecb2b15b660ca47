#include "raster/lighting/environment_irradiance.h"

#include "common/system/parallel.h"

#include <cmath>
#include <vector>

namespace duet::raster {
namespace {

using Harmonics = std::array<double, 9>;

/// Returns the real spherical harmonics of orders 0, 1 and 2 in direction w (Ramamoorthi and Hanrahan 2001, eq. 3).
Harmonics harmonics(Vec3d w) {
    return {0.28209479177387814,
            0.4886025119029199 * w.y,
            0.4886025119029199 * w.z,
            0.4886025119029199 * w.x,
            1.0925484305920792 * w.x * w.y,
            1.0925484305920792 * w.y * w.z,
            0.31539156525252005 * (3 * w.z * w.z - 1),
            1.0925484305920792 * w.x * w.z,
            0.5462742152960396 * (w.x * w.x - w.y * w.y)};
}

/// Convolution with the clamped cosine scales each order by these factors (eq. 8).
constexpr Harmonics kCosineLobe = {kPiDouble,         kPiDouble * 2 / 3, kPiDouble * 2 / 3,
                                   kPiDouble * 2 / 3, kPiDouble / 4,     kPiDouble / 4,
                                   kPiDouble / 4,     kPiDouble / 4,     kPiDouble / 4};

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
        const Harmonics y = harmonics(w);
        for (std::size_t i = 0; i < 9; ++i) sums[i] += light * y[i];
    }
    return sums;
}

} // namespace

Irradiance::Irradiance(const Environment& environment, int threads) {
    const auto* shown_image = std::get_if<ImageEnvironment>(&environment);
    if (shown_image == nullptr || shown_image->image.empty()) return;
    closed_form_ = false;
    const int width = shown_image->image.width(), height = shown_image->image.height();
    std::vector<std::array<Rgbd, 9>> rows(static_cast<std::size_t>(height));
    parallel_for(rows.size(), threads,
                 [&](std::size_t row) { rows[row] = project_row(environment, static_cast<int>(row), width, height); });
    for (const auto& row : rows)
        for (std::size_t i = 0; i < 9; ++i) coefficients_[i] += row[i] * kCosineLobe[i];
}

Rgb Irradiance::at(const Environment& environment, Vec3 n, const SkyVisibility& seen) const {
    const float hidden = 1 - seen.visible;
    if (hidden == 0) return at(environment, n);
    const auto positive = [](Rgb c) { return Rgb(max(c.r, 0.0f), max(c.g, 0.0f), max(c.b, 0.0f)); };
    if (const auto* sky = std::get_if<SkyEnvironment>(&environment)) {
        // The sky is down + (up − down) (1 + w·y)/2, integrated over the occluded directions.
        const Rgb lost = (sky->down + sky->up) * (0.5f * hidden) + (sky->up - sky->down) * (0.5f * seen.hidden.y);
        return positive(at(environment, n) - lost * kPi);
    }
    if (closed_form_) return at(environment, n) * seen.visible;
    // Irradiance scales each order of the radiance by the cosine's factor, whereas light from an occluded direction
    // is unscaled. The factor 1.5 = π / (2π/3) converts order 1 of the coefficients back.
    const Harmonics at_n = harmonics(Vec3d(n)), at_hidden = harmonics(Vec3d(seen.hidden));
    Rgbd sum = coefficients_[0] * at_n[0] * static_cast<double>(seen.visible);
    for (std::size_t i = 1; i < 4; ++i) sum += coefficients_[i] * (at_n[i] - 1.5 * at_hidden[i]);
    for (std::size_t i = 4; i < 9; ++i) sum += coefficients_[i] * (at_n[i] * static_cast<double>(seen.visible));
    return positive(Rgb(sum));
}

std::array<Rgb, 9> Irradiance::scaled_coefficients(const Environment& environment) const {
    std::array<Rgb, 9> result{};
    if (closed_form_) {
        const Rgb up = at(environment, Vec3(0, 1, 0)), down = at(environment, Vec3(0, -1, 0));
        result[0] = (up + down) * 0.5f, result[1] = (up - down) * 0.5f; // both forms are linear in the normal's height
        return result;
    }
    const Harmonics constants = {0.28209479177387814, 0.4886025119029199,  0.4886025119029199,
                                 0.4886025119029199,  1.0925484305920792,  1.0925484305920792,
                                 0.31539156525252005, 1.0925484305920792,  0.5462742152960396};
    for (std::size_t i = 0; i < 9; ++i) result[i] = Rgb(coefficients_[i] * constants[i]);
    return result;
}

Rgb Irradiance::at(const Environment& environment, Vec3 n) const {
    if (closed_form_) return irradiance_closed_form(environment, n).value_or(Rgb());
    const Harmonics y = harmonics(Vec3d(n));
    Rgbd sum;
    for (std::size_t i = 0; i < 9; ++i) sum += coefficients_[i] * y[i];
    return {static_cast<float>(max(sum.r, 0.0)), static_cast<float>(max(sum.g, 0.0)),
            static_cast<float>(max(sum.b, 0.0))};
}

} // namespace duet::raster
