// Lesson 12: one mesh by both pipelines. Writes what differs, why, and what each way costs.
#include "common/image/image_file.h"
#include "common/image/plot.h"
#include "common/system/parameters.h"
#include "compare/lessons/12-both-ways/both.h"
#include "raster/lessons/01-lines/figures.h"

#include <ctime>

using namespace duet;
using namespace duet::lesson;

constexpr int kWidth = 216, kHeight = 162;
const View kView{.eye = {0.75f, 0.85f, 2.1f}, .look_at = {-0.06f, 0.42f, 0}, .fov_degrees = 30};
const Vec3 kToSun = normalize(Vec3{0.8f, 0.6f, 0.5f});
const Rgb kSky(0.25f, 0.3f, 0.4f), kBlue(0.08f, 0.3f, 0.42f), kStone(0.7f, 0.65f, 0.55f), kBlack(0.03f),
    kClay(0.75f, 0.25f, 0.08f);

/// The light that goes to the eye: the sun's, of which the fraction `sun` arrives, and that from all around.
Rgb shade(const Hit& at, float sun, Rgb around) {
    const bool black = std::sin(38 * at.p.y) > 0.55f || std::abs(at.p.y - 0.4f) > 0.33f;
    const Rgb room = at.p.x < -0.44f ? kBlue : kStone, color = at.index >= 4872 ? room : black ? kBlack : kClay;
    return color * (Rgb(1.3f, 1.15f, 0.9f) * (sun * max(dot(at.n, kToSun), 0.0f)) + around);
}
/// The same by rays: one to the sun, and `count` in random directions for what is around. With none, that is the sky.
Rgb shade_by_rays(const Bvh& tree, const Hit& at, int count, Random& random) {
    const Vec3 from = at.p + at.n * 1e-4f;
    Rgb around = count == 0 ? kSky : Rgb(0);
    for (int i = 0; i < count; ++i) {
        const auto next = closest_hit(tree, {from, random_diffuse_direction(at.n, random)});
        around += (next ? shade_by_rays(tree, *next, 0, random) : kSky) / float(count);
    }
    return shade(at, closest_hit(tree, {from, kToSun}) ? 0 : 1, around);
}

/// The lines of all headers of a room's lessons that this program includes, without blank lines and comments.
int count_lines(const std::string& room) {
    std::vector<std::string> files{"compare/lessons/12-both-ways/both.h"};
    int lines = 0;
    for (std::size_t i = 0; i < files.size(); ++i) {
        std::ifstream text(DUET_MODELS "../" + files[i]);
        for (std::string line; std::getline(text >> std::ws, line); lines += i > 0 && !line.starts_with("//"))
            if (line.starts_with("#include \"" + room) && !std::ranges::count(files, line.substr(10, line.size() - 11)))
                files.push_back(line.substr(10, line.size() - 11));
    }
    return lines;
}

int main(int argc, char** argv) {
    int count = 32, texels = 512;
    read_parameters(argc, argv, {{"rays", count, 1, 256}, {"map size", texels, 32, 2048, "texels"}});
    Mesh world = read_obj(DUET_MODELS "meshes/amphora.obj");
    const std::array<Vec3, 4> edge{Vec3{3, 0, 0}, {0, 2, 0}, {0, 0, 2.4f}, {3, 0, 0}}; // of two walls and the floor
    for (std::size_t k = 0; k < 3; ++k)
        for (const Vec2 q : {Vec2{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}})
            world.push_back({Vec3{-0.45f, 0, -0.4f} + edge[k] * q.x + edge[k + 1] * q.y, {}, {}});
    std::vector<Object> objects;
    for (std::size_t i = 0; i < world.size(); i += 3)
        objects.push_back(triangle_object(world[i].p, world[i + 1].p, world[i + 2].p, i / 3));
    const Bvh tree = build(objects);
    const ShadowMap map = draw_shadow_map(world, sun_matrix(kToSun, {0.3f, 0.4f, 0.4f}, 2.2f), 4.4f, texels);
    const auto lit = [&](const Hit& at) { return lit_fraction(map, at.p, slope_bias(map, kToSun, at.n, 0), 0); };
    Random random(1);
    const auto by_rays = [&](int n) { return [&, n](const Hit& at) { return shade_by_rays(tree, at, n, random); }; };
    const auto index = [](const Hit& at) { return Rgb(float(at.index)); };
    const auto way1 = [&](const auto& color) { return rasterize(world, kView, kWidth, kHeight, color); };
    const auto way2 = [&](const auto& color) { return trace(tree, kView, kWidth, kHeight, color); };
    const ImageRgb raster = way1([&](const Hit& at) { return shade(at, lit(at), kSky); });
    const ImageRgb rays = way2(by_rays(0)), index1 = way1(index), index2 = way2(index);
    write_image("evidence.png", beside({raster, rays, signed_difference(raster, rays, 0.5f)}));
    ImageRgb full = way2(by_rays(count)), noisy = way2(by_rays(1)), causes(kWidth, kHeight, Rgb(0.9f));
    const auto differ = [](Rgb a, Rgb b) { return std::abs(luminance(a - b)) > 0.03f; };
    for (std::size_t i = 0; i < causes.size(); ++i)
        causes[i] += Rgb(index1[i] != index2[i], differ(raster[i], rays[i]), 0.6f * differ(rays[i], full[i])) * -0.8f;
    write_image("causes.png", beside({full, signed_difference(raster, full, 0.3f), causes}));
    for (const Vec3d& e : {errors(raster, rays), errors(raster, full), errors(noisy, full)})
        std::printf("mean %9.6f, MSE %.6f, relMSE %.4f\n", e.x, e.y, e.z);
    std::vector<ImageRgb> wrong;
    for (const Vec3 m : {Vec3{1, 1, 0}, {0.75f, 0.75f, 0.5f}, {1, -1, 0.5f}, {-1, 1, 0.5f}}) // scale and half a pixel
        wrong.push_back(trace(tree, kView, kWidth, kHeight, by_rays(0), m, m.z));
    for (ImageRgb& image : wrong) image = signed_difference(image, rays, 0.5f);
    write_image("mistakes.png", beside(wrong));
    const auto blocks = [&] { return magnify(signed_difference(shrink(noisy, 9), shrink(full, 9), 0.05f), 9); };
    const ImageRgb linear = beside({noisy, blocks()});
    for (ImageRgb* image : {&noisy, &full})
        for (Rgb& p : image->pixels()) p = {std::sqrt(p.r), std::sqrt(p.g), std::sqrt(p.b)};
    write_image("encoded.png", beside({linear, blocks()}));
    Plot plot{"The time of one image", "pixels", "seconds", true, true, {{"rasterizer", {}}, {"rays", {}}}, true};
    for (int side = 4; side <= 512; side *= 2)
        for (std::size_t way = 0; way < 2; ++way) {
            const std::clock_t start = std::clock();
            way == 0 ? rasterize(world, kView, side, side, index) : trace(tree, kView, side, side, index);
            plot.series[way].points.push_back({double(side * side), double(std::clock() - start) / CLOCKS_PER_SEC});
        }
    write_plot("time.svg", plot);
    std::printf("lines: rasterizer %d, ray tracer %d\n", count_lines("raster/"), count_lines("raytrace/"));
}
