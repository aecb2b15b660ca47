// Your antialiasing. Begin with mean_light and sample_in_cell: draw needs both.
#include "raytrace/lessons/04-antialiasing/lab.h"

#include <cmath>

namespace duet::lab {

Rgb mean_light(const std::vector<Rgb>& samples) {
    not_attempted(); // Remove this line when you start.
    return samples.empty() ? Rgb(0) : samples[0];
}

Vec2 sample_in_cell(int i, int n, Vec2 u) {
    not_attempted(); // Remove this line when you start.
    (void)i, (void)n;
    return u; // Anywhere in the pixel.
}

ImageRgb draw(const std::vector<Disk>& disks, int width, int height, int n, std::uint64_t seed) {
    not_attempted(); // Remove this line when you start.
    (void)n, (void)seed;
    ImageRgb image(width, height);
    for (int row = 0; row < height; ++row)
        for (int column = 0; column < width; ++column) {
            const Vec2 center{static_cast<float>(column) + 0.5f, static_cast<float>(row) + 0.5f};
            image(column, row) = light_at(disks, center); // One sample: the edges are jagged.
        }
    return image;
}

double rms_error(const ImageRgb& a, const ImageRgb& b) {
    not_attempted(); // Remove this line when you start.
    (void)a, (void)b;
    return 0;
}

int samples_needed(int samples, double error, double wanted) {
    not_attempted(); // Remove this line when you start.
    (void)error, (void)wanted;
    return samples;
}

} // namespace duet::lab
