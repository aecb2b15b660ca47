// Your textures. The picture shows a floor, drawn by your draw_quad. For now it has only its corners.
#include "raster/lessons/07-textures/lab.h"

namespace duet::lab {

Vec3 perspective_weights(Vec3 weights, Vec3 w) {
    not_attempted(); // Remove this line when you start.
    (void)w;
    // Divide each weight by its w. What must the three results sum to?
    return weights;
}

int wrap(int i, int size) {
    not_attempted(); // Remove this line when you start.
    (void)size;
    // What is -1 % 4 in C++? What should it be here?
    return i;
}

Rgb nearest(const ImageRgb& image, Vec2 uv) {
    not_attempted(); // Remove this line when you start.
    (void)uv;
    // Find the column and the row, both counted from the lower left corner. Then wrap them, and turn the row around.
    return image(0, 0);
}

Rgb bilinear(const ImageRgb& image, Vec2 uv) {
    not_attempted(); // Remove this line when you start.
    (void)uv;
    // Where is the center of a texel? Subtract that first, then find the texel to the lower left.
    return image(0, 0);
}

ImageRgb draw_quad(const std::array<Corner, 4>& corners, const ImageRgb& texture, int width, int height,
                   Rgb background) {
    not_attempted(); // Remove this line when you start.
    // For now each corner is one pixel. Draw two triangles instead: lesson::for_each_pixel finds their pixels.
    ImageRgb image(width, height, background);
    for (const Corner& corner : corners) {
        const Vec4 p = lesson::to_image(corner.clip, width, height);
        const int x = static_cast<int>(p.x), y = static_cast<int>(p.y);
        if (x >= 0 && x < width && y >= 0 && y < height) image(x, y) = bilinear(texture, corner.uv);
    }
    return image;
}

} // namespace duet::lab
