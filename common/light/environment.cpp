#include "common/light/environment.h"

#include "common/geometry/sphere.h"

#include <algorithm>
#include <cmath>

namespace duet {

namespace {

bool black(const ConstantEnvironment& e) { return is_black(e.radiance); }
bool black(const SkyEnvironment& e) { return is_black(e.down) && is_black(e.up); }

// In an image, `rotation` turns the mapping about +y by shifting u. Within a row of the distribution the height y of a
// direction is uniform, not its latitude. The density by solid angle is therefore constant in each cell, also at the
// poles, where sin θ vanishes.

float wrap(double u) { return std::min(static_cast<float>(u - std::floor(u)), kOneMinusEpsilon); }

/// Returns the image's texture coordinates for direction w, in [0, 1)².
Vec2 image_uv(const ImageEnvironment& e, Vec3 w) {
    const Vec2 uv = latlong_uv(w);
    return {wrap(static_cast<double>(uv.x) + static_cast<double>(e.rotation) / (2 * kPiDouble)),
            clamp(uv.y, 0.0f, kOneMinusEpsilon)};
}

/// A Band is the range of y that a row of the image covers. The function band() returns the one of row k of `rows`,
/// counted from the bottom.
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

/// Looks up the image bilinearly between pixel centers. The lookup wraps around in longitude and clamps beyond the
/// centers of the top and bottom rows.
Rgb radiance(const ImageEnvironment& e, Vec3 w) {
    if (e.image.empty()) return {};
    const int width = e.image.width(), rows = e.image.height();
    const Vec2 uv = image_uv(e, w);
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
bool black(const ImageEnvironment& e) { return e.scale == 0 || e.all_black; }
float cell_density(const ImageEnvironment& e, float pdf_uv, float v) {
    const int rows = e.image.height();
    const double extent = band(band_index(v, rows), static_cast<std::size_t>(rows)).extent;
    return static_cast<float>(static_cast<double>(pdf_uv) / (2 * kPiDouble * static_cast<double>(rows) * extent));
}
float density(const ImageEnvironment& e, Vec3 w) {
    if (black(e) || e.excess == 0) return 0;
    const Vec2 uv = image_uv(e, w);
    return cell_density(e, e.distribution.pdf(uv), uv.y);
}
std::optional<EnvironmentSample> draw(const ImageEnvironment& e, Vec2 u) {
    if (black(e) || e.excess == 0) return std::nullopt;
    const Distribution2D::Sample s = e.distribution.sample(u);
    const auto rows = static_cast<std::size_t>(e.image.height());
    const std::size_t k = band_index(s.uv.y, e.image.height());
    const Band row = band(k, rows);
    const double within = static_cast<double>(s.uv.y) * static_cast<double>(rows) - static_cast<double>(k);
    const double y = std::clamp(row.low + within * row.extent, -1.0, 1.0), ring_radius = std::sqrt((1 - y) * (1 + y));
    const double longitude = (static_cast<double>(s.uv.x) - 0.5) * 2 * kPiDouble - static_cast<double>(e.rotation);
    const Vec3 wi(Vec3d(ring_radius * std::sin(longitude), y, -ring_radius * std::cos(longitude)));
    const float pdf = cell_density(e, s.pdf, s.uv.y);
    if (!(pdf > 0) || !std::isfinite(pdf)) return std::nullopt;
    return EnvironmentSample{wi, radiance(e, wi), pdf};
}

/// Returns the luminance of each pixel's cell, integrated over solid angle up to a constant factor. Rows are counted
/// from the bottom. The mean of a bilinear function over a pixel weights the three nearest pixels of each axis by
/// 1/8, 6/8 and 1/8.
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

/// An image is only sampled where the fraction of its light above the mean exceeds this.
constexpr double kMinExcessFraction = 0.25;

/// Builds the distribution of the luminance above the mean, where there is enough of it to justify a shadow ray.
void build_excess_distribution(ImageEnvironment& e) {
    std::vector<double> weights = cell_weights(e.image);
    const int width = e.image.width();
    const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(e.image.height());
    const double cells = 2 * static_cast<double>(w); // the bands' extents add up to 2
    double mean = 0, excess = 0;
    for (const double weight : weights) mean += weight / cells;
    for (std::size_t k = 0; k < h; ++k) {
        const double mean_of_cell = mean * band(k, h).extent;
        for (std::size_t x = 0; x < w; ++x) {
            double& weight = weights[k * w + x];
            weight = std::max(weight - mean_of_cell, 0.0);
            excess += weight / cells;
        }
    }
    if (!(excess > kMinExcessFraction * mean)) return;
    e.excess = static_cast<float>(excess);
    e.distribution = Distribution2D(weights, width, e.image.height());
}

} // namespace

ImageEnvironment make_image_environment(ImageRgb image, float scale, float rotation) {
    if (image.empty()) throw Error("the environment's image is empty");
    if (!(scale >= 0) || !std::isfinite(scale))
        throw Error(message("the environment's scale is ", scale, ": expected a finite number, not negative"));
    if (!std::isfinite(rotation)) throw Error("the environment's rotation is not a finite number");
    for (Rgb& c : image.pixels()) {
        if (!is_finite(c)) throw Error("the environment's image has a pixel that is infinite or not a number");
        c = {max(c.r, 0.0f), max(c.g, 0.0f), max(c.b, 0.0f)};
    }
    ImageEnvironment e;
    e.all_black = std::all_of(image.pixels().begin(), image.pixels().end(), [](Rgb c) { return is_black(c); });
    e.image = std::move(image);
    e.scale = scale;
    e.rotation = rotation;
    build_excess_distribution(e);
    return e;
}

Rgb radiance(const Environment& environment, Vec3 w) {
    return std::visit([&](const auto& e) { return radiance(e, w); }, environment);
}
std::optional<EnvironmentSample> sample(const Environment& environment, Vec2 u) {
    const auto* map = std::get_if<ImageEnvironment>(&environment);
    return map != nullptr ? draw(*map, u) : std::nullopt;
}
float pdf(const Environment& environment, Vec3 w) {
    const auto* map = std::get_if<ImageEnvironment>(&environment);
    return map != nullptr ? density(*map, w) : 0.0f;
}
float sampled_irradiance(const Environment& environment) {
    const auto* map = std::get_if<ImageEnvironment>(&environment);
    return map != nullptr && !black(*map) ? kPi * map->scale * map->excess : 0.0f;
}
bool is_black(const Environment& environment) {
    return std::visit([](const auto& e) { return black(e); }, environment);
}

std::optional<Rgb> irradiance_closed_form(const Environment& environment, Vec3 n) {
    if (const auto* constant = std::get_if<ConstantEnvironment>(&environment)) return constant->radiance * kPi;
    if (const auto* sky = std::get_if<SkyEnvironment>(&environment)) {
        // The radiance is L = c₀ + c₁·y. Over the hemisphere, ∫ cos = π, and ∫ w cos = n·2π/3 by
        // symmetry.
        const Rgb mean = (sky->down + sky->up) * 0.5f, slope = (sky->up - sky->down) * 0.5f;
        return mean * kPi + slope * (2 * kPi / 3 * n.y);
    }
    return std::nullopt;
}

Rgb mean_radiance(const Environment& environment) {
    if (const auto* constant = std::get_if<ConstantEnvironment>(&environment)) return constant->radiance;
    if (const auto* sky = std::get_if<SkyEnvironment>(&environment)) return (sky->down + sky->up) * 0.5f;
    const auto& map = std::get<ImageEnvironment>(environment);
    Rgbd sum;
    const auto rows = static_cast<std::size_t>(map.image.height());
    for (int y = 0; y < map.image.height(); ++y) {
        const double extent = band(rows - 1 - static_cast<std::size_t>(y), rows).extent;
        for (int x = 0; x < map.image.width(); ++x) sum += Rgbd(map.image(x, y)) * extent;
    }
    const double cells = 2 * static_cast<double>(max(map.image.width(), 1)); // the bands' extents add up to 2
    return Rgb(sum * (static_cast<double>(map.scale) / cells));
}

} // namespace duet
