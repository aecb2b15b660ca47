// Lesson 03: the z-buffer. Writes interlocked rings with their depths, and figures of what goes wrong.
#include "common/image/image_file.h"
#include "common/system/parameters.h"
#include "raster/lessons/01-lines/figures.h"
#include "raster/lessons/03-z-buffer/framebuffer.h"

#include <array>

using namespace duet;
using namespace duet::lesson;

struct Corner {
    Vec3 p; ///< x and y in pixels; z is the depth: how far away, in the same unit
    Rgb color;
};
using Triangle = std::array<Corner, 3>;
using Triangles = std::vector<Triangle>;
const Rgb kDark(0.012f, 0.014f, 0.03f), kRed(0.9f, 0.06f, 0.05f), kGold(0.95f, 0.5f, 0.06f), kBlue(0.05f, 0.22f, 0.9f);

/// Draws triangles, each pixel with its own depth. Given a number of levels, depths from 0 to 1000 are rounded to them.
void draw(Framebuffer& target, const Triangles& triangles, float levels = 0) {
    for (const auto& [a, b, c] : triangles)
        for_each_pixel({a.p.x, a.p.y}, {b.p.x, b.p.y}, {c.p.x, c.p.y}, target.color.width(), target.color.height(),
                       [&, &a = a, &b = b, &c = c](int x, int y, Vec3 w) {
                           float z = dot(w, Vec3{a.p.z, b.p.z, c.p.z});
                           if (levels > 0) z = std::round(z / 1000 * levels);
                           target.write(x, y, z, a.color * w.x + b.color * w.y + c.color * w.z);
                       });
}

/// The painter's algorithm: whole triangles from back to front, by the depth of their middle, each over those before.
void paint(Framebuffer& target, Triangles triangles) {
    const auto depth = [](const Triangle& t) { return t[0].p.z + t[1].p.z + t[2].p.z; };
    const auto is_behind = [&](const Triangle& s, const Triangle& t) { return depth(s) > depth(t); };
    std::stable_sort(triangles.begin(), triangles.end(), is_behind);
    for (const Triangle& t : triangles) {
        target.depth = ImageFloat(target.color.width(), target.color.height(), kInfinity); // forget those before
        draw(target, {t});
    }
}

/// An oval ring around (480, 480, 480), of 60 × 48 × 2 triangles. The vectors u and v are its long and short radius. A
/// corner is brighter where the surface faces a light at the upper left.
void add_ring(Triangles& triangles, Rgb color, Vec3 u, Vec3 v, float thickness, float turn = 2 * kPi) {
    const auto corner = [&](int i, int j) {
        const float a = 2 * kPi * static_cast<float>(i) / 60, b = turn * (static_cast<float>(j) / 48 - 0.5f);
        const Vec3 out = u * std::cos(a) + v * std::sin(a); // from the middle to the core of the ring
        const Vec3 normal = normalize(out) * std::cos(b) + normalize(cross(u, v)) * std::sin(b);
        const float light = 0.08f + max(dot(normal, Vec3{-0.48f, -0.67f, -0.57f}), 0.0f);
        return Corner{Vec3{480, 480, 480} + out + normal * thickness, color * light};
    };
    for (int i = 0; i < 60; ++i)
        for (int j = 0; j < 48; ++j) {
            triangles.push_back({corner(i, j), corner(i + 1, j), corner(i + 1, j + 1)});
            triangles.push_back({corner(i, j), corner(i + 1, j + 1), corner(i, j + 1)});
        }
}
/// The outer half of a ring whose radius is nearly 0.
void add_sphere(Triangles& triangles, Rgb color, float radius) {
    add_ring(triangles, color, {0.01f, 0, 0}, {0, 0, 0.01f}, radius, kPi);
}

/// Three rings that hold each other, and a sphere that pierces them.
Triangles rings(float radius, float thickness) {
    const auto axis = [](float angle) { return Vec3{0.8165f * std::cos(angle), 0.8165f * std::sin(angle), -0.5774f}; };
    const Vec3 u = axis(0.3f), v = axis(0.3f + 2 * kPi / 3), w = axis(0.3f + 4 * kPi / 3); // at right angles
    Triangles triangles;
    add_sphere(triangles, Rgb(0.75f), radius);
    add_ring(triangles, kRed, u * 440.0f, v * 230.0f, thickness);
    add_ring(triangles, kGold, v * 440.0f, w * 230.0f, thickness);
    add_ring(triangles, kBlue, w * 440.0f, u * 230.0f, thickness);
    return triangles;
}

/// A sphere with bands of another color, which are higher by a 500th of the radius.
Triangles banded_sphere() {
    Triangles triangles, bands;
    add_sphere(triangles, kBlue, 450), add_sphere(bands, kGold, 450.9f);
    for (std::size_t i = 0; i < bands.size(); ++i)
        if (i / 2 % 12 >= 6) triangles.push_back(bands[i]);
    return triangles;
}

/// Three triangles, each of which begins over the next one and ends under the one before, and a fourth that pierces
/// them.
Triangles hard_to_sort() {
    const auto triangle = [](Rgb color, Vec3 a, Vec3 b, Vec3 c) {
        return Triangle{Corner{a, color}, {b, color * 0.4f}, {c, color * 0.4f}};
    };
    return {triangle(Rgb(0.9f), {300, 40, -60}, {370, 560, 102}, {230, 560, 102}),
            triangle(kRed, {70, 420, 0}, {540, 330, 100}, {530, 480, 100}),
            triangle(kGold, {311, 41, 0}, {154, 493, 100}, {30, 410, 100}),
            triangle(kBlue, {519, 439, 0}, {206, 77, 100}, {340, 10, 100})};
}

int main(int argc, char** argv) {
    float radius = 205, thickness = 48, coarse = 255;
    read_parameters(argc, argv, {{"sphere radius", radius, 1, 460, "pixels"},
                                 {"ring thickness", thickness, 4, 150, "pixels"}, {"depth levels", coarse, 15, 4095}});
    Framebuffer large(960, 960, kDark);
    draw(large, rings(radius, thickness));
    ImageRgb depths(960, 960, kDark);
    for (std::size_t i = 0; i < depths.size(); ++i)
        if (large.depth[i] < kInfinity) depths[i] = Rgb(sqr(1 - large.depth[i] / 960));
    write_image("evidence.png", beside({shrink(large.color, 3), shrink(depths, 3)}));
    Framebuffer painted(600, 600, kDark), tested = painted;
    paint(painted, hard_to_sort()), draw(tested, hard_to_sort());
    write_image("painter.png", beside({shrink(painted.color, 2), shrink(tested.color, 2)}));
    std::vector<ImageRgb> images;
    for (const float levels : {coarse, 1023.0f, 65535.0f}) {
        Framebuffer target(960, 960, kDark);
        draw(target, banded_sphere(), levels);
        images.push_back(shrink(target.color, 4));
    }
    write_image("fighting.png", beside(images));
    large.color = ImageRgb(960, 960, kDark); // for the next image; but nobody clears the depths
    Triangles moved = rings(radius, thickness);
    for (Triangle& t : moved)
        for (Corner& c : t) c.p = c.p * 0.9f + Vec3{84, 48, 48};
    draw(large, moved);
    write_image("not-cleared.png", shrink(large.color, 4));
}
