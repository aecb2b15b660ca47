// Lesson 11: tiles and SIMD. Draws one picture in five ways, each faster than the one before, and all the same.
#include "common/image/image_file.h"
#include "common/image/plot.h"
#include "raster/lessons/01-lines/figures.h"
#include "raster/lessons/04-camera/mesh.h"
#include "raster/lessons/11-tiles-and-simd/tiles.h"

#include <ctime>

using namespace duet;
using namespace duet::lesson;

constexpr int kSize = 768, kTile = 8, kTiles = kSize / kTile;

struct Prepared {
    Vec3 a, b, c; ///< corners in pixels, clockwise. The whole triangle has the depth of a: smaller is nearer
    std::array<Edge, 3> edges;
    int x0, y0, x1, y1, id; ///< the pixels that may be covered, and the number of the triangle
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

void steps(Target& target, const Prepared& t) {
    const auto& [e0, e1, e2] = t.edges;
    for (int y = t.y0; y < t.y1; ++y) {
        int w0 = e0.at(t.x0, y), w1 = e1.at(t.x0, y), w2 = e2.at(t.x0, y);
        for (int x = t.x0; x < t.x1; ++x, w0 += e0.a, w1 += e1.a, w2 += e2.a)
            if ((w0 | w1 | w2) >= 0) target.write(t, x, y); // the sign bit of none is set
    }
}

template <typename Draw> void for_each_tile(const Prepared& t, int tested, const Draw& draw) {
    for (int y = t.y0 / kTile * kTile; y < t.y1; y += kTile)
        for (int x = t.x0 / kTile * kTile; x < t.x1; x += kTile)
            if (const Tile tile = test_tile(t.edges, x, y, tested); tile != Tile::kOutside)
                draw(Prepared{t.a, t.b, t.c, t.edges, x, y, x + kTile, y + kTile, t.id, t.color}, tile);
}

template <int kTested> void tiles(Target& target, const Prepared& t) {
    for_each_tile(t, kTested, [&](const Prepared& part, Tile) { steps(target, part); });
}

template <bool kByDepth> void eights(Target& target, const Prepared& whole) {
    using Int8 [[gnu::vector_size(32)]] = int; // eight numbers in one register
    using Float8 [[gnu::vector_size(32)]] = float;
    for_each_tile(whole, kTile, [&](const Prepared& t, Tile tile) {
        float& farthest = target.farthest(t.x0 / kTile, t.y0 / kTile);
        if (kByDepth && t.a.z >= farthest) return;
        Float8 most = Float8{} - kInfinity;
        for (int y = t.y0; y < t.y1; ++y) {
            Int8 signs{};
            if (tile == Tile::kPartial)
                for (const Edge& edge : t.edges) signs |= edge.at(t.x0, y) + edge.a * Int8{0, 1, 2, 3, 4, 5, 6, 7};
            auto& depth = reinterpret_cast<Float8&>(target.depth(t.x0, y));
            auto& id = reinterpret_cast<Int8&>(target.id(t.x0, y));
            const Int8 pass = (signs >= 0) & (t.a.z < depth);
            depth = pass ? t.a.z - Float8{} : depth, id = pass ? t.id - Int8{} : id;
            most = most > depth ? most : depth;
        }
        for (int i = 0; i < 8; ++i) farthest = i == 0 ? most[0] : max(farthest, most[i]);
    });
}

int main() {
    std::vector<Prepared> scene;
    const auto add = [&](Vec3 corner0, Vec3 corner1, Vec3 corner2, Rgb color) { // y points up, counter-clockwise
        const auto place = [](Vec3 p) { return Vec3{384 + 800 * p.x, 752 - 800 * p.y, -p.z}; };
        const Vec3 a = place(corner0), b = place(corner2), c = place(corner1);
        const FixedPoint p = snap({a.x, a.y}), q = snap({b.x, b.y}), r = snap({c.x, c.y});
        const std::array<Edge, 3> edges{make_edge(p, q), make_edge(q, r), make_edge(r, p)};
        const Vec3T<int> low(min(a, min(b, c))), high(max(a, max(b, c)));
        if (edge_function(p, q, r) > 0) // its front is seen
            scene.push_back({a, b, c, edges, low.x, low.y, high.x + 1, high.y + 1, int(scene.size()), color});
    };
    const Mesh mesh = read_obj(DUET_MODELS "meshes/amphora.obj");
    for (std::size_t i = 0; i < mesh.size(); i += 3)
        add(mesh[i].p, mesh[i + 1].p, mesh[i + 2].p, Rgb(1, 0.38f, 0.12f) * (0.55f + 0.45f * mesh[i].n.x));
    const std::array<float, 8> side{0, 1, 1, 1, 0, -1, -1, -1}; // behind it, eight large triangles fill the picture
    const auto at = [&](std::size_t k) { return Vec3{0.48f * side[k % 8], 0.46f + 0.48f * side[(k + 2) % 8], -1}; };
    for (std::size_t i = 0; i < 8; ++i) add({0, 0.46f, -1}, at(i + 1), at(i), rainbow(float(i) / 8) * 0.5f);
    const std::array ways{naive, steps, tiles<kTile>, eights<false>, eights<true>, tiles<1>}; // the last is a mistake
    const std::array names{"lesson 02", "32-bit steps", "tiles", "eight at once", "depth of tiles"};
    Plot plot{"One picture, five ways", "way", "milliseconds", false, true, {}, true};
    ImageRgb right, image(kSize, kSize), work(kTiles, kTiles);
    for (std::size_t way = 0; way < ways.size(); ++way) {
        Target target;
        const std::clock_t start = std::clock();
        for (const Prepared& t : scene) ways[way](target, t);
        const double milliseconds = 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
        for (std::size_t k = 0; k < image.size(); ++k) image[k] = scene[static_cast<std::size_t>(target.id[k])].color;
        if (way == 0) right = image;
        if (way == names.size()) break;
        if (image.pixels() != right.pixels()) throw std::runtime_error(names[way]);
        plot.series.push_back({names[way], {{static_cast<double>(way + 1), milliseconds}}});
    }
    for (const Prepared& t : scene)
        for_each_tile(t, kTile, [&](const Prepared& part, Tile tile) {
            work(part.x0 / kTile, part.y0 / kTile) += tile == Tile::kInside ? Rgb(0, 0.3f, 0.1f) : Rgb(0.1f, 0.04f, 0);
        });
    write_plot("steps.svg", plot);
    write_image("evidence.png", beside({right, magnify(work, kTile)}));
    write_image("corner.png", image);
}
