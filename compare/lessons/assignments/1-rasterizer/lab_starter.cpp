// Your rasterizer. Write the functions from the top down; `draw` joins them.
#include "compare/lessons/assignments/1-rasterizer/lab.h"

namespace duet::lab {

Mesh parse_obj(const std::string& text) {
    not_attempted(); // Remove this line when you start.
    (void)text;
    // A std::istringstream of the text gives you lines, and one of a line gives you words.
    return {};
}

Vec4 to_clip(Vec3 p, const Camera& camera, float aspect) {
    not_attempted(); // Remove this line when you start.
    (void)camera, (void)aspect;
    // For now the camera stands 2 meters before the origin, and sees everything as from infinitely far away.
    return {p.x, p.y, 2 - p.z, 1};
}

std::vector<Triangle> clip_near(const Triangle& triangle) {
    not_attempted();   // Remove this line when you start.
    return {triangle}; // Nothing is cut off.
}

std::vector<Fragment> rasterize(Vec2 a, Vec2 b, Vec2 c, int width, int height) {
    not_attempted(); // Remove this line when you start.
    (void)a, (void)b, (void)c, (void)width, (void)height;
    return {};
}

Vec3 perspective_weights(Vec3 weights, Vec3 w) {
    not_attempted(); // Remove this line when you start.
    (void)w;
    return weights; // As if all corners had the same distance.
}

Rgb sample(const ImageRgb& texture, Vec2 uv) {
    not_attempted(); // Remove this line when you start.
    (void)uv;
    return texture.empty() ? Rgb(0) : texture(0, 0);
}

ImageRgb draw(const Mesh& mesh, const Camera& camera, const ImageRgb& texture, int width, int height, Rgb background) {
    not_attempted(); // Remove this line when you start.
    // For now each point of the mesh is one pixel. Draw triangles with depth and texture instead.
    ImageRgb image(width, height, background);
    const float aspect = static_cast<float>(width) / static_cast<float>(height);
    for (const Vec3& p : mesh.points) {
        const Vec4 clip = to_clip(p, camera, aspect);
        const int x = static_cast<int>((1 + clip.x / clip.w) / 2 * static_cast<float>(width));
        const int y = static_cast<int>((1 - clip.y / clip.w) / 2 * static_cast<float>(height));
        if (x >= 0 && x < width && y >= 0 && y < height) image(x, y) = sample(texture, {0, 0});
    }
    return image;
}

} // namespace duet::lab
