#include "compare/stress/scenes/scene_files.h"

#include "common/image/image_file.h"
#include "common/system/file.h"
#include "compare/stress/trials.h"

#include <cmath>
#include <sstream>

namespace duet::compare {

namespace {

namespace fs = std::filesystem;

/// Returns a grid of columns × rows quads with texture coordinates; point(u, v) places its vertices.
template <typename Point> std::string grid_mesh(int columns, int rows, bool texture_coordinates, const Point& point) {
    std::ostringstream obj;
    for (int y = 0; y <= rows; ++y)
        for (int x = 0; x <= columns; ++x) {
            const double u = static_cast<double>(x) / columns, v = static_cast<double>(y) / rows;
            const Vec3d p = point(u, v);
            obj << "v " << p.x << ' ' << p.y << ' ' << p.z << "\nvt " << u << ' ' << v << '\n';
        }
    const auto corner = [&](int x, int y) {
        const int index = y * (columns + 1) + x + 1;
        return texture_coordinates ? message(' ', index, '/', index) : message(' ', index);
    };
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x)
            obj << 'f' << corner(x, y) << corner(x + 1, y) << corner(x + 1, y + 1) << corner(x, y + 1) << '\n';
    return obj.str();
}

/// Returns a point of a sphere. In its grid mesh the polar triangles have no area, and rounding alone opens the seam
/// and the poles.
Vec3d on_sphere(double u, double v) {
    const double a = 2 * kPiDouble * u, b = kPiDouble * v;
    return {std::sin(b) * std::cos(a), std::cos(b), -std::sin(b) * std::sin(a)};
}
Vec3d on_waves(double u, double v) { return {2 * u - 1, 0.3 * std::sin(9 * u + 5 * v), 2 * v - 1}; }

/// Returns triangles anywhere: of all sizes, slivers, and some of no area.
std::string triangle_soup(TrialRandom& random) {
    std::ostringstream obj;
    for (int i = 0; i < 40; ++i) {
        const Vec3 a = random.vector(), edge = random.vector() * random.log_uniform(1e-4f, 2);
        const Vec3 b = a + edge, c = i % 4 == 0   ? a + edge * 0.5f + random.vector() * random.log_uniform(1e-9f, 1e-3f)
                                     : i % 9 == 0 ? a
                                                  : a + random.vector();
        for (const Vec3 p : {a, b, c}) obj << "v " << p.x << ' ' << p.y << ' ' << p.z << '\n';
        obj << "f -3 -2 -1\n";
    }
    return obj.str();
}

constexpr const char* kTetrahedron = "v 1 1 1\nv -1 -1 1\nv -1 1 -1\nv 1 -1 -1\nf 1 2 4\nf 1 3 2\nf 1 4 3\nf 2 3 4\n";

std::string mesh_with_materials() {
    const std::string corners = "mtllib materials.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 1\n"
                                "vt 0 0\nvt 2 0\nvt 0 3\n";
    return corners + "usemtl painted\nf 1/1 2/2 5/3\nusemtl glass\nf 2/1 3/2 5/3\nusemtl leaf\nf 3/1 4/2 5/3\n"
                     "usemtl light\nf 4/1 1/2 5/3\nf 4 3 2 1\n";
}
constexpr const char* kMaterials = "newmtl painted\nKd 0.8 0.5 0.2\nmap_Kd colors.png\n"
                                   "newmtl glass\nKd 0 0 0\nillum 7\nNi 1.5\n"
                                   "newmtl leaf\nKd 0.2 0.7 0.1\nmap_d mask.tga\n"
                                   "newmtl light\nKe 3 2 1\n";

/// Returns a TGA file of 4 × 4 pixels with alpha from 0 to 255.
std::string image_with_alpha() {
    std::string tga{0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4, 0, 4, 0, 32, 8};
    for (int i = 0; i < 16; ++i)
        for (const int byte : {40 * i, 255 - 16 * i, 7 * i, 17 * i}) tga.push_back(static_cast<char>(byte & 255));
    return tga;
}

ImageRgb noise(int width, int height, float brightest, TrialRandom& random) {
    ImageRgb image(width, height);
    for (std::size_t i = 0; i < image.size(); ++i) image[i] = Rgb(random.uniform());
    for (std::size_t i = 0; i < image.size(); i += 3) image[i] = {0, random.uniform(), 1};
    image(width / 3, height / 3) *= brightest;
    return image;
}

} // namespace

std::map<std::string, std::vector<std::string>> write_scene_files(const fs::path& folder) {
    TrialRandom random(mix_bits(1)); // the same files for all seeds
    write_file(folder / "sphere.obj", grid_mesh(12, 6, true, on_sphere));
    write_file(folder / "waves.obj", grid_mesh(8, 8, false, on_waves));
    write_file(folder / "soup.obj", triangle_soup(random));
    write_file(folder / "tetrahedron.obj", kTetrahedron);
    write_file(folder / "materials.obj", mesh_with_materials());
    write_file(folder / "materials.mtl", kMaterials);
    write_file(folder / "mask.tga", image_with_alpha());
    write_image(folder / "colors.png", noise(13, 7, 1, random));
    write_image(folder / "pixel.ppm", noise(1, 1, 1, random));
    write_image(folder / "sky.exr", noise(16, 8, 1e5f, random));
    write_image(folder / "dim.hdr", noise(5, 3, 0, random));
    std::string densities;
    for (int i = 0; i < kGridPoints[0] * kGridPoints[1] * kGridPoints[2]; ++i)
        densities.push_back(static_cast<char>(i % 3 == 0 ? 0 : random.below(256)));
    write_file(folder / "smoke.raw", densities);
    return {{"smoke", {"smoke.raw"}},
            {"mesh", {"sphere.obj", "waves.obj", "soup.obj", "tetrahedron.obj", "materials.obj"}},
            {"image_texture", {"colors.png", "mask.tga", "pixel.ppm", "sky.exr"}},
            {"image_environment", {"sky.exr", "dim.hdr", "colors.png"}}};
}

} // namespace duet::compare
