// Lesson 08: normal maps. Writes a smooth and a hammered amphora under two lights, and what goes wrong.
#include "common/image/image_file.h"
#include "common/image/srgb.h"
#include "common/system/parameters.h"
#include "raster/lessons/01-lines/figures.h"
#include "raster/lessons/07-textures/pipeline.h"
#include "raster/lessons/08-normal-maps/normal_map.h"

using namespace duet;
using namespace duet::lesson;

/// Makes an image of heights from a function of column and row, both counted from the lower left corner.
template <typename F> ImageFloat heights(int size, const F& height) {
    ImageFloat image(size, size);
    for (int j = 0; j < size; ++j)
        for (int i = 0; i < size; ++i) image(i, size - 1 - j) = height(static_cast<float>(i), static_cast<float>(j));
    return image;
}

/// Hammered metal: each of 8 × 8 blows leaves a round dent near its place, and the deepest one counts. It repeats.
float hammered(float x, float y) {
    float nearest = 1e9f;
    const int column = static_cast<int>(x) / 16, row = static_cast<int>(y) / 16;
    for (int j = row - 2; j <= row + 2; ++j)
        for (int i = column - 2; i <= column + 2; ++i) {
            const float number = static_cast<float>((i + 8) % 8 + 8 * ((j + 8) % 8)); // the same beyond the edge
            const float dx = 5 * std::sin(12.9f * number), dy = 5 * std::sin(78.2f * number);
            const Vec2 d{16.0f * static_cast<float>(i) + 8 + dx - x, 16.0f * static_cast<float>(j) + 8 + dy - y};
            nearest = min(nearest, dot(d, d));
        }
    return 0.018f * nearest;
}

/// A shield: a rim, a ring of studs, and a dome in the middle.
float shield(float x, float y) {
    const Vec2 p{x - 63.5f, y - 63.5f};
    const float distance = std::sqrt(dot(p, p)), step = kPi / 6, angle = step * std::round(std::atan2(p.y, p.x) / step);
    const Vec2 to_stud{p.x - 43 * std::cos(angle), p.y - 43 * std::sin(angle)};
    const auto dome = [](float radius, float d2) { return std::sqrt(max(radius * radius - d2, 0.0f)); };
    return max(dome(8, dot(to_stud, to_stud)), 0.6f * dome(28, distance * distance)) + dome(4, sqr(distance - 56));
}

struct Object {
    std::vector<Triangle> triangles;
    const ImageRgb& map; ///< of normals
    float repeat;        ///< how often the map repeats as u goes from 0 to 1
    Surface surface;
};

/// Draws objects under a light source. The mistakes: frames that are right-handed everywhere, and vectors of length 2.
enum class Frames { kRight, kRightHanded, kTooLong };
ImageRgb view(const std::vector<Object>& objects, Vec3 eye, Vec3 light, Vec2T<int> size, Frames frames = {}) {
    Framebuffer large(4 * size.x, 4 * size.y, Rgb(0.02f, 0.024f, 0.035f));
    for (const Object& o : objects)
        draw_triangles(large, o.triangles, [&](const Fragment& f) {
            TangentFrame frame = tangent_frame(f.triangle, f.n);
            if (frames == Frames::kRightHanded) frame.b = cross(f.n, frame.t);
            if (frames == Frames::kTooLong) frame = {frame.t * 2.0f, frame.b * 2.0f};
            const Vec3 n = perturb(f.n, frame, decode_normal(bilinear(o.map, f.uv * o.repeat)));
            return o.surface.diffuse * 0.05f + blinn_phong(n, normalize(light - f.p), normalize(eye - f.p), o.surface);
        });
    return shrink(large.color, 4);
}

/// An image as if its numbers were encoded by the curve of sRGB: so write_image writes them as they are.
ImageRgb decoded(ImageRgb image) {
    for (Rgb& c : image.pixels()) c = {srgb_decode(c.r), srgb_decode(c.g), srgb_decode(c.b)};
    return image;
}

/// Heights as gray, beside their normal map as a file would hold it.
ImageRgb both_images(const ImageFloat& relief, const ImageRgb& map) {
    ImageRgb gray(relief.width(), relief.height());
    const float greatest = *std::max_element(relief.pixels().begin(), relief.pixels().end());
    for (std::size_t i = 0; i < gray.pixels().size(); ++i) gray.pixels()[i] = Rgb(relief.pixels()[i] / greatest);
    return beside({gray, decoded(map)});
}

int main(int argc, char** argv) {
    float n = 3, lx = -2.5f;
    Surface copper{{0.55f, 0.2f, 0.09f}, 0.9f, 40}, bronze{{0.42f, 0.27f, 0.07f}, 0.6f, 30};
    read_parameters(argc, argv, {{"repeat", n, 1, 12}, {"light x", lx, -5, 5, "meters"},
                                 {"shininess", copper.shininess, 1, 300}});
    const ImageFloat dents = heights(128, hammered), studs = heights(128, shield);
    ImageRgb dented = normal_map(dents), studded = normal_map(studs), flipped = studded, flat(1, 1, Rgb(0.5f, 0.5f, 1));
    write_image("maps.png", beside({both_images(dents, dented), both_images(studs, studded)}));
    const Mesh amphora = read_obj(DUET_MODELS "meshes/amphora.obj");
    const Vec3 eye{0, 0.8f, 3};
    const Mat4 camera = perspective(0.36f, 1.32f, 0.1f, 20) * look_at(eye, {0, 0.45f, 0}, {0, 1, 0});
    const std::vector<Object> pair{{place_mesh(amphora, translation(Vec3{-0.32f, 0, 0}), camera), flat, 1, copper},
                                   {place_mesh(amphora, translation(Vec3{0.32f, 0, 0}), camera), dented, n, copper}};
    const ImageRgb from_left = view(pair, eye, {lx, 2, 2}, {316, 240});
    write_image("evidence.png", beside({from_left, view(pair, eye, {2.5f, 1, 1}, {316, 240})}));
    const Mat4 front = perspective(0.66f, 1, 0.1f, 20) * look_at({0, 1, 3}, {0, 1, 0}, {0, 1, 0});
    const auto plate = [&](const ImageRgb& map, float u_left, Frames frames = {}) { // two squares side by side
        const auto corner = [](float x, float y, float u) { return MeshVertex{{x, y, 0}, {0, 0, 1}, {u, y / 2}}; };
        const MeshVertex a = corner(-1, 0, u_left), b = corner(0, 0, 0.5f), c = corner(0, 2, 0.5f),
                         d = corner(-1, 2, u_left), e = corner(1, 0, 1), f = corner(1, 2, 1);
        const auto triangles = place_mesh({a, b, c, a, c, d, b, e, f, b, f, c}, Mat4(), front);
        return view({{triangles, map, 1, bronze}}, {0, 1, 3}, {-1, 3.5f, 2}, {164, 164}, frames);
    };
    for (Rgb& c : flipped.pixels()) c.g = 1 - c.g;
    write_image("wrong.png", beside({plate(studded, 0), plate(decoded(studded), 0), plate(flipped, 0)}));
    const ImageRgb mirrored = plate(studded, 1, Frames::kRightHanded), steep = plate(studded, 0, Frames::kTooLong);
    write_image("mirrored.png", beside({plate(studded, 1), mirrored, steep}));
}
