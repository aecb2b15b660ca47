// Vectors, and files written number by number.
#include "raytrace/lessons/01-vectors/lab.h"

#include <cmath>

namespace duet::lab {

float dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

Vector cross(Vector a, Vector b) {
    Vector c;
    c.x = a.y * b.z - a.z * b.y;
    c.y = a.z * b.x - a.x * b.z;
    c.z = a.x * b.y - a.y * b.x;
    return c;
}

Vector normalize(Vector a) {
    const float length = std::sqrt(dot(a, a));
    return {a.x / length, a.y / length, a.z / length};
}

Vector lerp(Vector a, Vector b, float t) {
    const float s = 1 - t;
    return {s * a.x + t * b.x, s * a.y + t * b.y, s * a.z + t * b.z};
}

int to_byte(float linear) {
    if (linear < 0) linear = 0;
    if (linear > 1) linear = 1;
    const float encoded = srgb_encode(linear);
    return static_cast<int>(255 * encoded + 0.5f);
}

static std::string header(const std::string& kind, const ImageRgb& image) {
    const std::string width = std::to_string(image.width()), height = std::to_string(image.height());
    return kind + "\n" + width + " " + height + "\n255\n";
}

std::string ppm_text(const ImageRgb& image) {
    std::string file = header("P3", image);
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x) {
            const Rgb color = image(x, y);
            file += std::to_string(to_byte(color.r)) + " ";
            file += std::to_string(to_byte(color.g)) + " ";
            file += std::to_string(to_byte(color.b)) + "\n";
        }
    }
    return file;
}

std::string ppm_binary(const ImageRgb& image) {
    std::string file = header("P6", image);
    for (int row = 0; row < image.height(); ++row) {
        for (int column = 0; column < image.width(); ++column) {
            const Rgb pixel = image(column, row);
            file.push_back(static_cast<char>(to_byte(pixel.r)));
            file.push_back(static_cast<char>(to_byte(pixel.g)));
            file.push_back(static_cast<char>(to_byte(pixel.b)));
        }
    }
    return file;
}

} // namespace duet::lab
