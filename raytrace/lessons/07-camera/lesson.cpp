// One scene from three places, at three angles of view, through a lens, and with the classic mistakes.
#include "common/image/image_file.h"
#include "common/system/parameters.h"
#include "raytrace/lessons/06-metal-and-glass/materials.h"
#include "raytrace/lessons/07-camera/camera.h"

using namespace duet;
using namespace duet::lesson;
constexpr int kWidth = 140, kHeight = 88; // of the smaller pictures

// The word RAY in spheres that stand on the ground, for a reader who looks along -z. Each letter is 3 spheres wide and
// 5 high, and stands farther back than the one before it.
struct World {
    std::vector<Sphere> spheres{{{0, -300, 0}, 300}, {{2.6f, 0.45f, 0.8f}, 0.45f}};
    std::vector<Material> materials{matte({0.5f, 0.48f, 0.44f}), glass(1.5f)};
    World() {
        const char* const rows[5] = {"##. .#. #.#", "#.# #.# #.#", "##. ### .#.", "#.# #.# .#.", "#.# #.# .#."};
        const Material letters[] = {matte({0.8f, 0.13f, 0.1f}), metal({0.95f, 0.7f, 0.3f}), matte({0.08f, 0.3f, 0.7f})};
        for (int row = 0; row < 5; ++row)
            for (int column = 0; column < 11; ++column) {
                if (rows[row][column] != '#') continue;
                const float x = static_cast<float>(column) - 5, y = 4.5f - static_cast<float>(row);
                spheres.push_back({{0.5f * x, 0.5f * y, 1 - static_cast<float>(column / 4)}, 0.25f});
                materials.push_back(letters[column / 4]);
            }
    }
};

// The picture that a camera takes. The signs are those of its axes: -1 is the classic mistake.
ImageRgb render(const View& view, int width = kWidth, int height = kHeight, int samples = 64, Vec2 signs = {1, 1}) {
    static const World world;
    const Camera camera(view, width, height);
    const auto closest = [&](const Ray& ray) { return closest_hit(world.spheres, ray); };
    const float x0 = 0.5f * static_cast<float>(width), y0 = 0.5f * static_cast<float>(height);
    return average_samples(width, height, samples, [&](float x, float y, Random& random) {
        const Ray ray = camera.ray(x0 + signs.x * (x - x0), y0 + signs.y * (y - y0), random);
        return path_color(closest, world.materials, ray, 20, random);
    });
}

// Lights at night, out of focus. lens(random) chooses a point of the lens.
template <typename Lens> ImageRgb lights(const Lens& lens) {
    std::vector<Sphere> spheres;
    std::vector<Rgb> colors;
    Random place(5);
    for (int i = 0; i < 12; ++i) {
        spheres.push_back({{12 * place.next() - 6, 7 * place.next() - 3.5f, -20 - 4 * place.next()}, 0.25f});
        const float blue = 0.5f * place.next(); // before the green: compilers order arguments as they like
        colors.push_back(Rgb(1, 0.15f + 0.6f * place.next(), blue) * 7.0f);
    }
    const Camera camera({.fov_degrees = 24, .aperture_radius = 0.25f, .focus_distance = 5}, kWidth, kHeight);
    return average_samples(kWidth, kHeight, 400, [&](float x, float y, Random& random) {
        const auto hit = closest_hit(spheres, camera.ray(x, y, lens(random)));
        return hit ? colors[hit->index] : Rgb(0.003f, 0.004f, 0.01f);
    });
}
// Two mistakes: a square lens, and one whose points crowd at the center.
Vec2 in_square(Random& random) { return {2 * random.next() - 1, 2 * random.next() - 1}; }
Vec2 crowded(Random& random) {
    const Vec2 p = random_in_disk(random);
    return p * std::sqrt(dot(p, p));
}

// Pictures of one size side by side, with a white gap of 4 pixels between them.
ImageRgb beside(const std::vector<ImageRgb>& images) {
    const int width = images[0].width(), step = width + 4;
    ImageRgb row(step * static_cast<int>(images.size()) - 4, images[0].height(), Rgb(1));
    for (int y = 0; y < row.height(); ++y)
        for (int x = 0; x < row.width(); ++x)
            if (x % step < width) row(x, y) = images[static_cast<std::size_t>(x / step)](x % step, y);
    return row;
}

int main(int argc, char** argv) {
    float field = 26, radius = 0.25f;
    read_parameters(argc, argv, {{"field of view", field, 5, 120, "degrees"}, {"lens radius", radius, 0, 1}});
    View front{.eye = {0, 1.6f, 10}, .look_at = {0, 1.2f, 0}, .fov_degrees = field}, left = front, above = front;
    left.eye = {-7, 0.6f, 7.5f}, above.eye = {3, 8, 7.5f};
    write_image("evidence.png",
                beside({render(front, 176, 116, 100), render(left, 176, 116, 100), render(above, 176, 116, 100)}));
    std::vector<ImageRgb> zooms, focused;
    for (const float fov : {15.0f, 35.0f, 60.0f}) {
        const float distance = 2.2f / std::tan(static_cast<float>(radians(fov)) / 2); // 4.4 high at the middle letter
        zooms.push_back(render({.eye = {0, 1.4f, distance}, .look_at = {0, 1.4f, 0}, .fov_degrees = fov}));
    }
    for (const Vec2 lens : {Vec2(0, 1), Vec2(radius, 6), Vec2(radius, 9)}) // its radius, and the distance that is sharp
        focused.push_back(render({{-3.2f, 1.5f, 7}, {0, 1.2f, 0}, {0, 1, 0}, 31, lens.x, lens.y}));
    write_image("zoom.png", beside(zooms)), write_image("focus.png", beside(focused));
    write_image("axes.png", beside({render(front), render(front, kWidth, kHeight, 64, {-1, 1}),
                                    render(front, kWidth, kHeight, 64, {-1, -1})}));
    View wide = front, turned = front, down = front, mended = front;
    wide.fov_degrees = 26 * 180 / kPi, turned.fov_degrees = 30 * 180 / kPi; // tan gets 13 and 15, the halves in degrees
    down.eye = mended.eye = {0, 12, 0}, down.look_at = mended.look_at = {0, 0, 0}, mended.up = {0, 0, -1};
    write_image("angles.png", beside({render(wide), render(turned)}));
    write_image("down.png", beside({render(down), render(mended)}));
    write_image("lens.png", beside({lights(random_in_disk), lights(in_square), lights(crowded)}));
}
