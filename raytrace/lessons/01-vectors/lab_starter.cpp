// Your vectors, colors and files. Begin with dot. The picture of the result page is a gradient from orange to blue:
// lerp makes its colors.
#include "raytrace/lessons/01-vectors/lab.h"

#include <cmath>

namespace duet::lab {

float dot(Vector a, Vector b) {
    not_attempted(); // Remove this line when you start.
    (void)a, (void)b;
    return 0;
}

Vector cross(Vector a, Vector b) {
    not_attempted(); // Remove this line when you start.
    (void)a, (void)b;
    return {0, 0, 0};
}

Vector normalize(Vector a) {
    not_attempted(); // Remove this line when you start.
    return a;        // How long is it?
}

Vector lerp(Vector a, Vector b, float t) {
    not_attempted(); // Remove this line when you start.
    (void)b, (void)t;
    return a; // The gradient is one color.
}

int to_byte(float linear) {
    not_attempted();                       // Remove this line when you start.
    return static_cast<int>(255 * linear); // What is 255 * 0.5, and what should it be? And for linear = 1.6?
}

std::string ppm_text(const ImageRgb& image) {
    not_attempted(); // Remove this line when you start.
    (void)image;
    return "P3\n"; // std::to_string(17) is "17".
}

std::string ppm_binary(const ImageRgb& image) {
    not_attempted(); // Remove this line when you start.
    (void)image;
    return "P6\n"; // static_cast<char>(200) is one byte.
}

} // namespace duet::lab
