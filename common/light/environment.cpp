#include "common/light/environment.h"

#include "common/geometry/sphere.h"
#include "common/sampling/warp.h"

#include <algorithm>
#include <cmath>

namespace duet {

namespace {

std::optional<EnvironmentSample> checked(Vec3 wi, Rgb radiance, float pdf) {
    if (!(pdf > 0) || !std::isfinite(pdf)) return std::nullopt;
    return EnvironmentSample{wi, radiance, pdf};
}

// Constant -----------------------------------------------------------------------------------------------------------

Rgb look_up(const ConstantEnvironment& e, Vec3) { return e.radiance; }
bool black(const ConstantEnvironment& e) { return is_black(e.radiance); }
float density(const ConstantEnvironment& e, Vec3) { return black(e) ? 0.0f : kUniformSpherePdf; }
std::optional<EnvironmentSample> draw(const ConstantEnvironment& e, Vec2 u) {
    if (black(e)) return std::nullopt;
    return EnvironmentSample{uniform_sphere(u), e.radiance, kUniformSpherePdf};
}

// Sky ----------------------------------------------------------------------------------------------------------------
// A uniform direction has a uniform height h = (y + 1)/2 (Archimedes), so a luminance linear in h is sampled by a
// linear density p(h) = 2·(a(1 − h) + b·h)/(a + b) of the height, p(h)/4π by solid angle.

float height(Vec3 w) { return clamp(0.5f * (w.y + 1), 0.0f, 1.0f); }
Rgb look_up(const SkyEnvironment& e, Vec3 w) { return lerp(e.down, e.up, height(w)); }
bool black(const SkyEnvironment& e) { return is_black(e.down) && is_black(e.up); }
float density(const SkyEnvironment& e, Vec3 w) {
    const float a = luminance(e.down), b = luminance(e.up);
    return a + b > 0 ? 2 * lerp(a, b, height(w)) / (a + b) * kUniformSpherePdf : 0.0f;
}
std::optional<EnvironmentSample> draw(const SkyEnvironment& e, Vec2 u) {
    if (black(e)) return std::nullopt;
    const double a = static_cast<double>(luminance(e.down)), b = static_cast<double>(luminance(e.up));
    // The inverse of (a·h + (b − a)·h²/2)·2/(a + b), its difference rationalised.
    const double x = static_cast<double>(u.y), root = std::sqrt(lerp(a * a, b * b, x));
    const double h = a + root > 0 ? std::min(x * (a + b) / (a + root), 1.0) : 0.0;
    const double ring = 2 * std::sqrt(h * (1 - h)), phi = 2 * kPiDouble * static_cast<double>(u.x);
    const Vec3 wi(Vec3d(ring * std::cos(phi), 2 * h - 1, ring * std::sin(phi)));
    return checked(wi, look_up(e, wi), density(e, wi));
}

// Picture ------------------------------------------------------------------------------------------------------------
// The mapping turns about +y by shifting u. Within a row of the distribution the *height* y of a direction is uniform,
// not its latitude: so the density by solid angle is constant in each cell, also at the poles, where sin θ vanishes.

float wrap(double u) { return std::min(static_cast<float>(u - std::floor(u)), kOneMinusEpsilon); }

/// Where direction w lies in the picture.
Vec2 picture_uv(const ImageEnvironment& e, Vec3 w) {
    const Vec2 uv = sphere_uv(w);
    return {wrap(static_cast<double>(uv.x) + static_cast<double>(e.rotation) / (2 * kPiDouble)),
            clamp(uv.y, 0.0f, kOneMinusEpsilon)};
}

/// Row k of `rows` counted from below: y at its lower end, and its extent.
struct Band {
    double low, extent;
};
Band band(std::size_t k, std::size_t rows) {
    const double step = kPiDouble / static_cast<double>(rows), latitude = step * static_cast<double>(k) - kPiDouble / 2;
    return {std::sin(latitude), 2 * std::cos(latitude + step / 2) * std::sin(step / 2)};
}
std::size_t band_index(float v, int rows) {
    return static_cast<std::size_t>(static_cast<double>(v) * static_cast<double>(rows));
}

/// Bilinear between pixel centres; around the seam, and constant beyond the centres of the top and bottom rows.
Rgb look_up(const ImageEnvironment& e, Vec3 w) {
    if (e.image.empty()) return {};
    const int width = e.image.width(), rows = e.image.height();
    const Vec2 uv = picture_uv(e, w);
    const float x = uv.x * static_cast<float>(width) - 0.5f, y = (1 - uv.y) * static_cast<float>(rows) - 0.5f;
    const float left = std::floor(x), top = std::floor(y);
    const auto pixel = [&](int column, int row) {
        return e.image(((column % width) + width) % width, std::clamp(row, 0, rows - 1));
    };
    const int i = static_cast<int>(left), j = static_cast<int>(top);
    const Rgb upper = lerp(pixel(i, j), pixel(i + 1, j), x - left);
    const Rgb lower = lerp(pixel(i, j + 1), pixel(i + 1, j + 1), x - left);
    return lerp(upper, lower, y - top) * e.scale;
}
bool black(const ImageEnvironment& e) { return e.scale == 0 || e.distribution.integral() == 0; }
float cell_density(const ImageEnvironment& e, float pdf_uv, float v) {
    const int rows = e.image.height();
    const double extent = band(band_index(v, rows), static_cast<std::size_t>(rows)).extent;
    return static_cast<float>(static_cast<double>(pdf_uv) / (2 * kPiDouble * static_cast<double>(rows) * extent));
}
float density(const ImageEnvironment& e, Vec3 w) {
    if (black(e)) return 0;
    const Vec2 uv = picture_uv(e, w);
    return cell_density(e, e.distribution.pdf(uv), uv.y);
}
std::optional<EnvironmentSample> draw(const ImageEnvironment& e, Vec2 u) {
    if (black(e)) return std::nullopt;
    const Distribution2D::Sample s = e.distribution.sample(u);
    const auto rows = static_cast<std::size_t>(e.image.height());
    const std::size_t k = band_index(s.uv.y, e.image.height());
    const Band row = band(k, rows);
    const double within = static_cast<double>(s.uv.y) * static_cast<double>(rows) - static_cast<double>(k);
    const double y = std::clamp(row.low + within * row.extent, -1.0, 1.0), ring = std::sqrt((1 - y) * (1 + y));
    const double longitude = (static_cast<double>(s.uv.x) - 0.5) * 2 * kPiDouble - static_cast<double>(e.rotation);
    const Vec3 wi(Vec3d(ring * std::sin(longitude), y, -ring * std::cos(longitude)));
    return checked(wi, look_up(e, wi), cell_density(e, s.pdf, s.uv.y));
}

/// Luminance of each pixel's cell, integrated over solid angle up to a factor, rows from below. The mean of a bilinear
/// function over a pixel weights the three pixels of each axis by 1/8, 6/8, 1/8; so a cell is positive wherever the
/// interpolated radiance in it is.
std::vector<double> cell_weights(const ImageRgb& image) {
    const int width = image.width(), rows = image.height();
    const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(rows);
    const auto blurred = [&](int x, int y) {
        const double side = static_cast<double>(luminance(image((x + width - 1) % width, y))) +
                            static_cast<double>(luminance(image((x + 1) % width, y)));
        return 0.125 * side + 0.75 * static_cast<double>(luminance(image(x, y)));
    };
    std::vector<double> weights(w * h);
    for (int y = 0; y < rows; ++y) {
        const std::size_t k = h - 1 - static_cast<std::size_t>(y);
        const double extent = band(k, h).extent;
        for (int x = 0; x < width; ++x)
            weights[k * w + static_cast<std::size_t>(x)] =
                extent * (0.125 * (blurred(x, std::max(y - 1, 0)) + blurred(x, std::min(y + 1, rows - 1))) +
                          0.75 * blurred(x, y));
    }
    return weights;
}

} // namespace

ImageEnvironment make_image_environment(ImageRgb image, float scale, float rotation) {
    if (image.empty()) throw Error("the environment's picture is empty");
    if (!(scale >= 0) || !std::isfinite(scale))
        throw Error(message("the environment's scale is ", scale, ": expected a finite number, not negative"));
    if (!std::isfinite(rotation)) throw Error("the environment's rotation is not a finite number");
    for (Rgb& c : image.pixels()) {
        if (!is_finite(c)) throw Error("the environment's picture has a pixel that is infinite or not a number");
        c = {max(c.r, 0.0f), max(c.g, 0.0f), max(c.b, 0.0f)};
    }
    ImageEnvironment e{std::move(image), scale, rotation, {}};
    e.distribution = Distribution2D(cell_weights(e.image), e.image.width(), e.image.height());
    return e;
}

Rgb radiance(const Environment& environment, Vec3 w) {
    return std::visit([&](const auto& e) { return look_up(e, w); }, environment);
}
std::optional<EnvironmentSample> sample(const Environment& environment, Vec2 u) {
    return std::visit([&](const auto& e) { return draw(e, u); }, environment);
}
float pdf(const Environment& environment, Vec3 w) {
    return std::visit([&](const auto& e) { return density(e, w); }, environment);
}
bool is_black(const Environment& environment) {
    return std::visit([](const auto& e) { return black(e); }, environment);
}

std::optional<Rgb> irradiance_closed_form(const Environment& environment, Vec3 n) {
    if (const auto* constant = std::get_if<ConstantEnvironment>(&environment)) return constant->radiance * kPi;
    if (const auto* sky = std::get_if<SkyEnvironment>(&environment)) {
        // L = c₀ + c₁·y; the hemisphere's ∫ cos = π, and ∫ w cos = n·2π/3 by symmetry.
        const Rgb mean = (sky->down + sky->up) * 0.5f, slope = (sky->up - sky->down) * 0.5f;
        return mean * kPi + slope * (2 * kPi / 3 * n.y);
    }
    return std::nullopt;
}

Rgb mean_radiance(const Environment& environment) {
    if (const auto* constant = std::get_if<ConstantEnvironment>(&environment)) return constant->radiance;
    if (const auto* sky = std::get_if<SkyEnvironment>(&environment)) return (sky->down + sky->up) * 0.5f;
    const auto& picture = std::get<ImageEnvironment>(environment);
    Rgbd sum;
    const auto rows = static_cast<std::size_t>(picture.image.height());
    for (int y = 0; y < picture.image.height(); ++y) {
        const double extent = band(rows - 1 - static_cast<std::size_t>(y), rows).extent;
        for (int x = 0; x < picture.image.width(); ++x) sum += Rgbd(picture.image(x, y)) * extent;
    }
    const double cells = 2 * static_cast<double>(max(picture.image.width(), 1)); // the bands' extents add up to 2
    return Rgb(sum * (static_cast<double>(picture.scale) / cells));
}

} // namespace duet
