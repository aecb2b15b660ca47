// The library's lines (raster/overlay/lines.h), between the centers of pixels. They leave out their right end (or lower
// end, of a steep line), so that a line that goes on as another marks no pixel twice: it is added here.
#include "raster/geometry/cull.h"
#include "raster/lessons/01-lines/lab.h"
#include "raster/overlay/lines.h"

#include <algorithm>

namespace duet::lab {

namespace {

/// Marks the line in an image whose upper left pixel is `corner`.
Image<std::uint8_t> marks_of(Pixel a, Pixel b, Pixel corner, int width, int height) {
    Image<std::uint8_t> marks(width, height, 0);
    const raster::SampleOffset center;
    const auto fixed = [&](Pixel p) {
        return raster::FixedPoint{(p.x - corner.x) * raster::kSubpixels + center.x,
                                  (p.y - corner.y) * raster::kSubpixels + center.y};
    };
    raster::draw_line(fixed(a), fixed(b), center, marks);
    for (const Pixel p : {a, b}) {
        const int x = p.x - corner.x, y = p.y - corner.y;
        if (x >= 0 && x < width && y >= 0 && y < height) marks(x, y) = 1;
    }
    return marks;
}

} // namespace

int pixel_count(Pixel a, Pixel b) { return std::max(std::abs(b.x - a.x), std::abs(b.y - a.y)) + 1; }

std::int64_t line_error(Pixel a, Pixel b, Pixel p) { return raster::doubled_area({a.x, a.y}, {b.x, b.y}, {p.x, p.y}); }

std::vector<Pixel> line_pixels(Pixel a, Pixel b) {
    const Pixel corner{std::min(a.x, b.x), std::min(a.y, b.y)};
    const int width = std::abs(b.x - a.x) + 1, height = std::abs(b.y - a.y) + 1;
    const Image<std::uint8_t> marks = marks_of(a, b, corner, width, height);
    std::vector<Pixel> pixels;
    for (int y = 0; y < height; ++y) // in the order from a to b
        for (int x = 0; x < width; ++x) {
            const Pixel p{b.x >= a.x ? x : width - 1 - x, b.y >= a.y ? y : height - 1 - y};
            if (marks(p.x, p.y)) pixels.push_back({p.x + corner.x, p.y + corner.y});
        }
    return pixels;
}

ImageRgb draw_lines(const std::vector<Line>& lines, int width, int height, Rgb background) {
    ImageRgb image(width, height, background);
    for (const Line& line : lines) {
        const Image<std::uint8_t> marks = marks_of(line.a, line.b, {0, 0}, width, height);
        for (std::size_t i = 0; i < marks.size(); ++i)
            if (marks[i]) image[i] = line.color;
    }
    return image;
}

} // namespace duet::lab
