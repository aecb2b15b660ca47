// Lesson 11: tiles and SIMD. Draws one image in six ways, each faster than the one before, and all the same.
#include "common/image/image_file.h"
#include "common/image/plot.h"
#include "common/system/parameters.h"
#include "raster/lessons/01-lines/figures.h"
#include "raster/lessons/03-z-buffer/framebuffer.h"
#include "raster/lessons/04-camera/mesh.h"
#include "raster/lessons/11-tiles-and-simd/tiles.h"

#include <ctime>

using namespace duet;
using namespace duet::lesson;

constexpr int kSize = 768, kTile = 8, kTiles = kSize / kTile;
struct Prepared {
    Vec3 a, b, c; ///< corners in pixels, clockwise. The whole triangle has the depth of a: smaller is nearer
    std::array<Edge, 3> edges;
    int x0, y0, x1, y1, id; ///< only pixels from (x0, y0) to (x1 - 1, y1 - 1) can be covered; the triangle's number
    Rgb color;
};
struct Target {
    ImageFloat depth{kSize, kSize, kInfinity}, farthest{kTiles, kTiles, kInfinity}; // of pixels, and in each tile
    Image<int> id{kSize, kSize};                                                    // of the nearest triangle
    void write(const Prepared& t, int x, int y) {
        if (t.a.z < depth(x, y)) depth(x, y) = t.a.z, id(x, y) = t.id;
    }
};

void naive(Target& target, const Prepared& t) {
    const auto visit = [&](int x, int y, Vec3) { target.write(t, x, y); };
    for_each_pixel({t.a.x, t.a.y}, {t.b.x, t.b.y}, {t.c.x, t.c.y}, kSize, kSize, visit);
}
void steps_in_box(Target& target, const Prepared& t, int x0, int y0, int x1, int y1) {
    const auto& [e0, e1, e2] = t.edges;
    for (int y = y0; y < y1; ++y) {
        int w0 = e0.at(x0, y), w1 = e1.at(x0, y), w2 = e2.at(x0, y);
        for (int x = x0; x < x1; ++x, w0 += e0.a, w1 += e1.a, w2 += e2.a)
            if ((w0 | w1 | w2) >= 0) target.write(t, x, y); // the sign bit of none is set
    }
}
void steps(Target& target, const Prepared& t) { steps_in_box(target, t, t.x0, t.y0, t.x1, t.y1); }

template <typename Visit> void for_each_tile(const Prepared& t, const Visit& visit) {
    for (int y = t.y0 / kTile * kTile; y < t.y1; y += kTile)
        for (int x = t.x0 / kTile * kTile; x < t.x1; x += kTile) visit(x, y);
}
template <int kTested> void tiles(Target& target, const Prepared& t) {
    for_each_tile(t, [&](int x, int y) {
        if (test_tile(t.edges, x, y, kTested) != Tile::kOutside) steps_in_box(target, t, x, y, x + kTile, y + kTile);
    });
}

template <int kWay> void eights(Target& target, const Prepared& t) {
    using Int8 [[gnu::vector_size(32)]] = int; // eight numbers in one register
    using Float8 [[gnu::vector_size(32)]] = float;
    const Edge &e0 = t.edges[0], &e1 = t.edges[1], &e2 = t.edges[2];
    const auto row = [](const Edge& e, int x, int y) { return e.at(x, y) + e.a * Int8{0, 1, 2, 3, 4, 5, 6, 7}; };
    for_each_tile(t, [&](int x, int y0) {
        float& farthest = target.farthest(x / kTile, y0 / kTile);
        if ((kWay >= 5 && t.a.z >= farthest) || test_tile(t.edges, x, y0, kTile) == Tile::kOutside) return;
        Int8 w0 = row(e0, x, y0), w1 = row(e1, x, y0), w2 = row(e2, x, y0);
        Float8 most = Float8{} - kInfinity;
        for (int y = y0; y < y0 + kTile; ++y, w0 += e0.b, w1 += e1.b, w2 += e2.b) {
            if (kWay < 6) w0 = row(e0, x, y), w1 = row(e1, x, y), w2 = row(e2, x, y);
            auto& depth = reinterpret_cast<Float8&>(target.depth(x, y));
            auto& id = reinterpret_cast<Int8&>(target.id(x, y));
            const Int8 pass = ((w0 | w1 | w2) >= 0) & (t.a.z < depth);
            depth = pass ? t.a.z - Float8{} : depth, id = pass ? t.id - Int8{} : id;
            most = most > depth ? most : depth;
        }
        farthest = std::max({most[0], most[1], most[2], most[3], most[4], most[5], most[6], most[7]});
    });
}

int main(int argc, char** argv) {
    float zoom = 800, z = -1;
    read_parameters(argc, argv, {{"zoom", zoom, 50, 800, "pixels per meter"},
                                 {"large triangles z", z, -1, 1, "meters"}});
    std::vector<Prepared> scene(1); // number 0 is the black background: it covers no pixel
    const auto add = [&](Vec3 corner0, Vec3 corner1, Vec3 corner2, Rgb color) { // y points up, counter-clockwise
        const auto place = [zoom](Vec3 p) { return Vec3{384 + zoom * p.x, 752 - zoom * p.y, -p.z}; };
        const Vec3 a = place(corner0), b = place(corner2), c = place(corner1);
        const FixedPoint p = snap({a.x, a.y}), q = snap({b.x, b.y}), r = snap({c.x, c.y});
        const std::array<Edge, 3> edges{make_edge(p, q), make_edge(q, r), make_edge(r, p)};
        const Vec3T<int> low(min(a, min(b, c))), high(min(max(a, max(b, c)), {kSize - 1, kSize - 1, 0}));
        if (edge_function(p, q, r) > 0) // its front is seen
            scene.push_back({a, b, c, edges, low.x, low.y, high.x + 1, high.y + 1, int(scene.size()), color});
    };
    const Mesh mesh = read_obj(DUET_MODELS "meshes/amphora.obj");
    for (std::size_t i = 0; i < mesh.size(); i += 3)
        add(mesh[i].p, mesh[i + 1].p, mesh[i + 2].p, Rgb(1, 0.38f, 0.12f) * (0.55f + 0.45f * mesh[i].n.x));
    const std::array<float, 8> side{0, 1,  1,  1,
                                    0, -1, -1, -1}; // of eight large triangles that fill the image behind it
    const auto at = [&](std::size_t k) { return Vec3{0.48f * side[k % 8], 0.46f + 0.48f * side[(k + 2) % 8], z}; };
    for (std::size_t i = 0; i < 8; ++i) add({0, 0.46f, z}, at(i + 1), at(i), rainbow(float(i) / 8) * 0.5f);
    const std::array ways{naive, steps, tiles<kTile>, eights<4>, eights<5>, eights<6>, tiles<1>}; // the last is wrong
    const std::array names{"lesson 02", "32-bit steps", "tiles", "eight at once", "depth of tiles", "rows by steps"};
    std::array<ImageRgb, 7> images;
    std::array<double, 7> least{9e9, 9e9, 9e9, 9e9, 9e9, 9e9, 9e9};      // milliseconds
    for (std::size_t run = 0, way = 0; run < 70; ++run, way = run % 7) { // each way ten times
        Target target;
        const std::clock_t start = std::clock();
        for (const Prepared& t : scene) ways[way](target, t);
        least[way] = min(least[way], 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
        images[way] = ImageRgb(kSize, kSize);
        for (std::size_t k = 0; k < target.id.size(); ++k) images[way][k] = scene[std::size_t(target.id[k])].color;
        if (way < 6 && images[way].pixels() != images[0].pixels()) throw std::runtime_error(names[way]);
    }
    Plot plot{"One image, six ways", "way", "milliseconds", false, true, {}, true};
    for (std::size_t i = 0; i < 6; ++i) plot.series.push_back({names[i], {{static_cast<double>(i + 1), least[i]}}});
    write_plot("steps.svg", plot);
    const std::array<Rgb, 3> colors{Rgb(0), {0.1f, 0.04f, 0}, {0, 0.3f, 0.1f}}; // outside, partial, inside
    ImageRgb work(kTiles, kTiles);
    for (const Prepared& t : scene)
        for_each_tile(t, [&](int x, int y) {
            work(x / kTile, y / kTile) += colors[static_cast<std::size_t>(test_tile(t.edges, x, y, kTile))];
        });
    write_image("evidence.png", shrink(beside({images[0], magnify(work, kTile)}), 2));
    write_image("corner.png", shrink(images[6], 2));
}
