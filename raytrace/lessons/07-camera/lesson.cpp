// One scene from three places, at three angles of view, through a lens, and with axes of the wrong sign.
#include "common/image/image_file.h"
#include "raytrace/lessons/06-metal-and-glass/materials.h"
#include "raytrace/lessons/07-camera/camera.h"

using namespace duet;
using namespace duet::lesson;

struct World {
    std::vector<Sphere> spheres{{{0, -300, 0}, 300}};
    std::vector<Material> materials{matte({0.5f, 0.48f, 0.44f})};
    World();
};

// The word RAY in spheres that stand on the ground, for a reader who looks along -z. Each letter is 3 spheres wide and
// 5 high, and stands farther back than the one before it.
World::World() {
    const char* const rows[5] = {"##. .#. #.#", "#.# #.# #.#", "##. ### .#.", "#.# #.# .#.", "#.# #.# .#."};
    const Material letters[3] = {matte({0.8f, 0.13f, 0.1f}), metal({0.95f, 0.72f, 0.35f}, 0.05f),
                                 matte({0.08f, 0.33f, 0.75f})};
    for (int row = 0; row < 5; ++row)
        for (int column = 0; column < 11; ++column)
            if (rows[row][column] == '#') {
                const int letter = column / 4;
                const Vec3 center{static_cast<float>(column) - 5, 4.5f - static_cast<float>(row),
                                  2 - 2 * static_cast<float>(letter)};
                spheres.push_back({center * 0.5f, 0.25f}), materials.push_back(letters[letter]);
            }
    spheres.push_back({{2.6f, 0.45f, 0.8f}, 0.45f}), materials.push_back(glass(1.5f));
}

// The picture that a camera takes. The signs are those of its axes: -1 is the classic mistake.
ImageRgb render(const View& view, int width, int height, int samples, float sign_right = 1, float sign_up = 1) {
    static const World world;
    const Camera camera(view, width, height);
    const auto closest = [&](const Ray& ray) { return closest_hit(world.spheres, ray); };
    const float x0 = 0.5f * static_cast<float>(width), y0 = 0.5f * static_cast<float>(height);
    return average_samples(width, height, samples, [&](float x, float y, Random& random) {
        const Ray ray = camera.ray(x0 + sign_right * (x - x0), y0 + sign_up * (y - y0), random);
        return path_color(closest, world.materials, ray, 20, random);
    });
}

// Pictures of one height side by side, with a white gap of 4 pixels between them.
ImageRgb side_by_side(const std::vector<ImageRgb>& images) {
    const int width = images[0].width(), step = width + 4;
    ImageRgb row(step * static_cast<int>(images.size()) - 4, images[0].height(), Rgb(1));
    for (int y = 0; y < row.height(); ++y)
        for (int x = 0; x < row.width(); ++x)
            if (x % step < width) row(x, y) = images[static_cast<std::size_t>(x / step)](x % step, y);
    return row;
}

int main() {
    const Vec3 middle{0, 1.2f, 0};
    View front{.eye = {0, 1.6f, 10}, .look_at = middle, .fov_degrees = 26};
    View left = front, above = front;
    left.eye = {-7, 0.6f, 7.5f};
    above.eye = {3, 8, 7.5f};
    write_image("evidence.png", side_by_side({render(front, 204, 136, 100), render(left, 204, 136, 100),
                                              render(above, 204, 136, 100)}));

    std::vector<ImageRgb> zooms, depths;
    for (const float fov : {15.0f, 35.0f, 60.0f}) {
        const float distance = 2.2f / std::tan(static_cast<float>(radians(fov)) / 2); // 4.4 high at the middle letter
        zooms.push_back(
            render({.eye = {0, 1.4f, distance}, .look_at = {0, 1.4f, 0}, .fov_degrees = fov}, 164, 104, 100));
    }
    write_image("zoom.png", side_by_side(zooms));

    View lens{.eye = {-3.2f, 1.5f, 7}, .look_at = {0, 1.2f, 0}, .fov_degrees = 31};
    for (const auto& [radius, distance] : {std::pair{0.0f, 1.0f}, {0.25f, 6.0f}, {0.25f, 9.0f}}) {
        lens.aperture_radius = radius, lens.focus_distance = distance;
        depths.push_back(render(lens, 164, 104, 150));
    }
    write_image("focus.png", side_by_side(depths));
    write_image("axes.png", side_by_side({render(front, 164, 104, 100), render(front, 164, 104, 100, -1),
                                          render(front, 164, 104, 100, -1, -1)}));
}
