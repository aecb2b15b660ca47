// Your lines. Write the functions from the top down.
#include "raster/lessons/01-lines/lab.h"

#include <cstdlib>

namespace duet::lab {

int pixel_count(Pixel a, Pixel b) {
    not_attempted(); // Remove this line when you start.
    (void)a, (void)b;
    // A line from column 2 to column 5 has pixels in how many columns? std::abs helps with lines that run to the left.
    return 0;
}

std::int64_t line_error(Pixel a, Pixel b, Pixel p) {
    not_attempted(); // Remove this line when you start.
    (void)a, (void)b, (void)p;
    // The formula is in lab.h. The differences fit into 32 bits. Do their products?
    return 0;
}

std::vector<Pixel> line_pixels(Pixel a, Pixel b) {
    not_attempted(); // Remove this line when you start.
    // Begin with lines that run to the right and gently down. Then the other seven directions. Then think of the rule
    // for two pixels that are equally near: which comparison decides, and does it see which end you began at?
    return {a, b};
}

ImageRgb draw_lines(const std::vector<Line>& lines, int width, int height, Rgb background) {
    not_attempted(); // Remove this line when you start.
    // For now each line is its two ends.
    ImageRgb image(width, height, background);
    for (const Line& line : lines)
        for (const Pixel p : {line.a, line.b})
            if (p.x >= 0 && p.x < width && p.y >= 0 && p.y < height) image(p.x, p.y) = line.color;
    return image;
}

} // namespace duet::lab
