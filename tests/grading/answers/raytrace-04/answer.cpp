// Samples in cells, averaged as light.
#include "raytrace/lessons/04-antialiasing/lab.h"

#include <cmath>

namespace duet::lab {

Rgb mean_light(const std::vector<Rgb>& samples) {
    if (samples.empty()) return Rgb(0);
    Rgb sum;
    for (const Rgb& sample : samples) sum += sample;
    return sum / static_cast<float>(samples.size());
}

Vec2 sample_in_cell(int i, int n, Vec2 u) {
    const float column = static_cast<float>(i % n);
    const float row = static_cast<float>(i / n);
    const float size = 1 / static_cast<float>(n);
    return {(column + u.x) * size, (row + u.y) * size};
}

ImageRgb draw(const std::vector<Disk>& disks, int width, int height, int n, std::uint64_t seed) {
    ImageRgb image(width, height);
    std::uint64_t state = seed;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            std::vector<Rgb> samples;
            for (int i = 0; i < n * n; ++i) {
                Vec2 u;
                u.x = random_number(state);
                u.y = random_number(state);
                const Vec2 offset = sample_in_cell(i, n, u);
                const Vec2 p{static_cast<float>(x) + offset.x, static_cast<float>(y) + offset.y};
                samples.push_back(light_at(disks, p));
            }
            image(x, y) = mean_light(samples);
        }
    }
    return image;
}

double rms_error(const ImageRgb& a, const ImageRgb& b) {
    double sum = 0;
    for (int y = 0; y < a.height(); ++y) {
        for (int x = 0; x < a.width(); ++x) {
            const Rgb d = a(x, y) - b(x, y);
            sum += double{d.r} * double{d.r} + double{d.g} * double{d.g} + double{d.b} * double{d.b};
        }
    }
    return std::sqrt(sum / (3.0 * a.width() * a.height()));
}

int samples_needed(int samples, double error, double wanted) {
    const double ratio = error / wanted;
    const double needed = samples * ratio * ratio;
    return needed < 1 ? 1 : static_cast<int>(std::ceil(needed));
}

} // namespace duet::lab
