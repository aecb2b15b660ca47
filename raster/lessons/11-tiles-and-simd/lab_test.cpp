// The examiner of raster lab 11. Values of edges are computed in 64 bits, coverage by the triangle of lesson 02, and
// the state of a tile by a test of all its pixels.
#include "raster/lessons/02-triangles/triangle.h"
#include "raster/lessons/11-tiles-and-simd/lab.h"
#include "tests/grading/judge.h"

#include <algorithm>
#include <cmath>
#include <functional>

using namespace duet;
using namespace duet::grading;
using lab::Edge, lab::Edges, lab::GridPoint, lab::Tile;

LAB_TITLE("raster-11", "Tiles, steps and masks")

namespace {

using Corners = std::array<GridPoint, 3>;

lesson::FixedPoint fixed(GridPoint p) { return {p.x, p.y}; }
std::int64_t doubled_area(const Corners& p) { return lesson::edge_function(fixed(p[0]), fixed(p[1]), fixed(p[2])); }

/// An edge, or what a mistake makes of it.
struct Way {
    bool rule = true, floor = true, half = true, flipped = false;
};
Edge edge_by(GridPoint from, GridPoint to, Way way = {}) {
    std::int64_t w =
        lesson::edge_function(fixed(from), fixed(to), way.half ? lesson::pixel_center(0, 0) : lesson::FixedPoint{0, 0});
    if (way.rule && !lesson::is_top_left(fixed(from), fixed(to))) --w;
    const std::int64_t c = way.floor ? w >> 8 : w / 256;
    const int sign = way.flipped ? -1 : 1;
    return {sign * (from.y - to.y), sign * (to.x - from.x), static_cast<int>(sign * c)};
}
Edges edges_of(const Corners& p) { return {edge_by(p[0], p[1]), edge_by(p[1], p[2]), edge_by(p[2], p[0])}; }

std::int64_t value(const Edge& e, std::int64_t x, std::int64_t y) { return e.a * x + e.b * y + e.c; }
bool covered(const Edges& edges, int x, int y) {
    return std::all_of(edges.begin(), edges.end(), [&](const Edge& e) { return value(e, x, y) >= 0; });
}

GridPoint random_point(Rng& rng, int width, int height) {
    return {rng.integer(0, width * 256), rng.integer(0, height * 256)};
}
/// A clockwise triangle in an image.
Corners random_triangle(Rng& rng, int width, int height) {
    for (;;) {
        Corners p{random_point(rng, width, height), random_point(rng, width, height), random_point(rng, width, height)};
        if (doubled_area(p) < 0) std::swap(p[1], p[2]);
        if (doubled_area(p) > 0) return p;
    }
}

/// The state of a tile by its pixels, one by one.
Tile tile_by_pixels(const Edges& edges, int x, int y, int size) {
    bool all = true;
    for (const Edge& e : edges) {
        int inside = 0;
        for (int i = 0; i < size * size; ++i) inside += value(e, x + i % size, y + i / size) >= 0;
        if (inside == 0) return Tile::kOutside;
        all = all && inside == size * size;
    }
    return all ? Tile::kInside : Tile::kPartial;
}

/// What a mistake makes of it: the corners at which each edge is tested for the rejection and for the acceptance.
using Corner = std::function<std::pair<int, int>(const Edge&, int)>;
Tile tile_by_corners(const Edges& edges, int x, int y, int size, const Corner& reject, const Corner& accept) {
    bool all = true;
    for (const Edge& e : edges) {
        const auto [rx, ry] = reject(e, size);
        const auto [ax, ay] = accept(e, size);
        if (value(e, x + rx, y + ry) < 0) return Tile::kOutside;
        all = all && value(e, x + ax, y + ay) >= 0;
    }
    return all ? Tile::kInside : Tile::kPartial;
}

/// What comes out if only the four corner pixels are looked at, each against the whole triangle.
Tile tile_by_four(const Edges& edges, int x, int y, int size) {
    int inside = 0;
    for (int i = 0; i < 4; ++i) inside += covered(edges, x + i % 2 * (size - 1), y + i / 2 * (size - 1));
    return inside == 0 ? Tile::kOutside : inside == 4 ? Tile::kInside : Tile::kPartial;
}

/// What comes out if a tile counts as outside wherever no pixel of it is in the triangle.
Tile tile_by_triangle(const Edges& edges, int x, int y, int size) {
    int inside = 0;
    for (int i = 0; i < size * size; ++i) inside += covered(edges, x + i % size, y + i / size);
    return inside == 0 ? Tile::kOutside : inside == size * size ? Tile::kInside : Tile::kPartial;
}

const char* name_of(Tile tile) {
    return tile == Tile::kOutside ? "kOutside" : tile == Tile::kInside ? "kInside" : "kPartial";
}

std::string text_of(const Edges& edges) {
    std::string text;
    for (const Edge& e : edges) text += (text.empty() ? "" : ", ") + describe(e);
    return "the edges " + text;
}

Image<int> coverage(const Corners& p, int width, int height) {
    Image<int> image(width, height, 0);
    const auto pixels = [](GridPoint q) { return Vec2{static_cast<float>(q.x) / 256, static_cast<float>(q.y) / 256}; };
    lesson::for_each_pixel(pixels(p[0]), pixels(p[1]), pixels(p[2]), width, height,
                           [&](int x, int y, Vec3) { image(x, y) = 1; });
    return image;
}

/// What is left if tiles for which lost(x, y) is true are missing.
Image<int> without(Image<int> image, const std::function<bool(int, int)>& lost) {
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            if (lost(x / 8 * 8, y / 8 * 8)) image(x, y) = 0;
    return image;
}

void check_cover(Item& item, const std::string& name, const Corners& p, int width, int height) {
    const Edges edges = edges_of(p);
    const Image<int> expected = coverage(p, width, height);
    std::vector<Mistake<Image<int>>> mistakes{
        {without(expected, [&](int x, int y) { return !covered(edges, x, y); }),
         "The tiles whose upper left pixel is outside of the triangle are missing: a tile can be left out only if an "
         "edge "
         "has even its best corner outside."},
        {without(expected, [&](int x, int y) { return tile_by_four(edges, x, y, 8) == Tile::kOutside; }),
         "Tiles of which no corner pixel is in the triangle are missing: the triangle may cover pixels between the "
         "corners. Leave out a tile only if one edge has all four corners outside."},
        {without(expected, [&](int x, int y) { return x + 8 > width || y + 8 > height; }),
         "The tiles at the right and lower border, of which only a part is in the image, are missing."},
        {without(expected, [&](int x, int y) { return tile_by_pixels(edges, x, y, 8) == Tile::kInside; }),
         "The tiles that are wholly inside of the triangle are missing: all of their pixels must be filled."},
        {without(expected, [&](int x, int y) { return tile_by_pixels(edges, x, y, 8) == Tile::kPartial; }),
         "Only the tiles that are wholly inside are drawn: in the others each pixel must be tested."},
        {without(expected,
                 [&](int x, int y) {
                     const auto edge = [](int a, int b, int c) { return std::min({a, b, c}) / 256; };
                     return x < edge(p[0].x, p[1].x, p[2].x) || y < edge(p[0].y, p[1].y, p[2].y);
                 }),
         "The first tile column or row is missing: begin at a multiple of 8, at or before the first pixel of the box."},
    };
    Image<int> filled = expected;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            if (tile_by_pixels(edges, x / 8 * 8, y / 8 * 8, 8) != Tile::kOutside) filled(x, y) = 1;
    mistakes.push_back({filled, "Partial tiles are filled whole: test each of their pixels."});
    item.coverage(name, STUDENT(cover)(p, width, height), expected, mistakes);
}

} // namespace

LAB_ITEM(0, "the picture") {
    Image<int> sum(160, 120, 0);
    ImageRgb image(160, 120);
    for (int i = 0; i < 12; ++i) {
        const auto rim = [&](int k) {
            const double angle = kPiDouble / 12 * k, r = k % 2 ? 58 : 25;
            return GridPoint{static_cast<int>(256 * (80 + r * std::sin(angle))),
                             static_cast<int>(256 * (60 - r * std::cos(angle)))};
        };
        const Image<int> part = STUDENT(cover)(Corners{rim(2 * i), rim(2 * i + 1), rim(2 * i + 2)}, 160, 120);
        if (part.size() != sum.size()) continue;
        for (std::size_t k = 0; k < sum.size(); ++k)
            if (part[k])
                image[k] += Rgb(0.5f + 0.05f * static_cast<float>(i), 0.7f - 0.04f * static_cast<float>(i), 0.2f);
    }
    item.show("the points of your star", image);
}

LAB_ITEM(15, "an edge in 32 bits") {
    const auto check = [&](const std::string& name, GridPoint from, GridPoint to) {
        const auto with_sign = [&](int a, int b) {
            const Edge e = edge_by(from, to);
            return Edge{a * e.a, b * e.b, e.c};
        };
        item.near(
            "the edge " + name, STUDENT(make_edge)(from, to), edge_by(from, to), 0,
            {{edge_by(from, to, {.half = false}),
              "This is the value at the corner of pixel (0, 0): its center is at (128, 128)."},
             {edge_by(from, to, {.rule = false}),
              "The fill rule is missing: a center on an edge that is not a left or top one is outside. Subtract 1 "
              "from the edge function before you divide."},
             {edge_by(from, to, {.floor = false}),
              "The division rounded toward zero: negative numbers must be rounded down, too (w >> 8)."},
             {edge_by(from, to, {.rule = false, .floor = false}),
              "The fill rule is missing, and the division rounded toward zero: subtract 1 for edges that are not "
              "left or top ones, then shift by 8."},
             {edge_by(from, to, {.flipped = true}), "All signs are turned around: inside is to the right."},
             {with_sign(-1, 1), "a has the wrong sign: from.y - to.y."},
             {with_sign(1, -1), "b has the wrong sign: to.x - from.x."}});
    };
    // By hand: w at (128, 128) for (0, 0) to (256, 0) is 256 · 128 = 128 · 256, and this is a top edge.
    item.near("the edge from (0, 0) to (256, 0)", STUDENT(make_edge)(GridPoint{0, 0}, GridPoint{256, 0}),
              Edge{0, 256, 128}, 0,
              {{Edge{0, -256, -129}, "All signs are turned around: inside is to the right of the way."},
               {Edge{0, -256, -128}, "All signs are turned around: inside is to the right of the way."},
               {Edge{0, 256, 32768}, "c must be divided by 256, as x and y count pixels and not steps of 1/256."},
               {Edge{0, 256, 0}, "The center of pixel (0, 0) is at (128, 128): its value is c."},
               {Edge{0, 65536, 32768}, "All three must be divided by 256: the function counts pixels, not steps."}});
    check("from (300, 40) to (20, 700), which runs down", {300, 40}, {20, 700});
    check("from (20, 700) to (300, 40), which runs up", {20, 700}, {300, 40});
    check("from (384, 128) to (128, 128), which runs left through centers", {384, 128}, {128, 128});
    check("from (128, 128) to (384, 128), which runs right through centers", {128, 128}, {384, 128});
    check("of a large triangle, from (500000, 3) to (7, 524288)", {500000, 3}, {7, 524288});
    for (int i = 0; i < 200; ++i) {
        const GridPoint from = random_point(item.random(), 2048, 2048), to = random_point(item.random(), 2048, 2048);
        if (from.x == to.x && from.y == to.y) continue;
        check(message("from ", describe(from), " to ", describe(to)), from, to);
    }
}

LAB_ITEM(15, "values along a row") {
    item.near("the values of a = 3, b = -2, c = 5 at (4, 1), (5, 1), (6, 1)",
              STUDENT(values_along_row)(Edge{3, -2, 5}, 4, 1, 3), std::vector<int>{15, 18, 21}, 0,
              {{std::vector<int>{15, 13, 11}, "These are steps down: one pixel to the right adds a, not b."},
               {std::vector<int>{18, 21, 24}, "The first value is that of the first pixel: step after it, not before."},
               {std::vector<int>{15, 15, 15}, "The value does not change: add a for each pixel."},
               {std::vector<int>{5, 8, 11}, "The row begins at x = 4, y = 1: c is the value at (0, 0)."},
               {std::vector<int>{15, 12, 9}, "One pixel to the right adds a; it was subtracted."}});
    for (int i = 0; i < 60; ++i) {
        Rng& rng = item.random();
        const Corners p = random_triangle(rng, 2048, 2048);
        const Edge edge = edges_of(p)[static_cast<std::size_t>(rng.integer(0, 2))];
        const int x = i % 3 ? rng.integer(0, 40) : 0, y = rng.integer(0, 2047),
                  count = i % 4 ? 2000 : rng.integer(0, 9);
        const auto found = STUDENT(values_along_row)(edge, x, y, count);
        item.require(found.size() == static_cast<std::size_t>(count),
                     message("Expected ", count, " values, found ", found.size(), "."));
        float drifting = static_cast<float>(value(edge, x, y));
        for (int k = 0; k < count; ++k, drifting += static_cast<float>(edge.a)) {
            const auto expected = static_cast<int>(value(edge, x + k, y));
            const int mine = found[static_cast<std::size_t>(k)];
            if (mine == expected) continue;
            const bool is_float = std::abs(static_cast<double>(mine) - static_cast<double>(expected)) <
                                  1e-4 * (1e6 + std::abs(static_cast<double>(expected)));
            item.require(false,
                         message("The value number ", k, " of the row of ", describe(edge), " from (", x, ", ", y,
                                 ") is wrong. ",
                                 is_float ? "It is off by a little: a float has 24 bits only, and each step adds an "
                                            "error of its own. Step in whole numbers. "
                                          : "",
                                 "Expected ", expected, ", found ", mine, "."));
        }
    }
}

LAB_ITEM(25, "tiles: outside, partial, inside") {
    const auto best = [](const Edge& e, int size) { return std::pair{e.a > 0 ? size - 1 : 0, e.b > 0 ? size - 1 : 0}; };
    const auto worst = [](const Edge& e, int size) {
        return std::pair{e.a < 0 ? size - 1 : 0, e.b < 0 ? size - 1 : 0};
    };
    const auto first = [](const Edge&, int) { return std::pair{0, 0}; };
    const auto beyond = [](const Edge& e, int size) { return std::pair{e.a > 0 ? size : 0, e.b > 0 ? size : 0}; };
    const auto beyond_worst = [](const Edge& e, int size) { return std::pair{e.a < 0 ? size : 0, e.b < 0 ? size : 0}; };
    struct Guess {
        Corner reject, accept;
        std::string text;
    };
    const std::vector<Guess> guesses{
        {worst, worst,
         "A tile is rejected at its worst corner: then partial tiles go missing. It is outside only if even "
         "the corner with the greatest value is outside."},
        {worst, best,
         "The two corners are exchanged: reject by the corner with the greatest value, accept by the one with "
         "the smallest."},
        {best, best,
         "A tile is accepted at its best corner: then too much is filled. It is inside only if even the corner "
         "with the smallest value is inside."},
        {first, first,
         "Only the upper left pixel is tested, whatever the edge: the right corner depends on the signs of a "
         "and b."},
        {first, worst,
         "Tiles are rejected by their upper left pixel, whatever the edge: the right corner depends on the "
         "signs of a and b."},
        {best, first,
         "Tiles are accepted by their upper left pixel, whatever the edge: the right corner depends on the "
         "signs of a and b."},
        {beyond, beyond_worst, "The last pixel of a tile is at size - 1, not at size."},
        {beyond, worst, "The last pixel of a tile is at size - 1, not at size: some tiles outside are not rejected."},
        {best, beyond_worst,
         "The last pixel of a tile is at size - 1, not at size: some tiles inside are not accepted."},
    };
    struct Case {
        Edges edges;
        int x, y, size;
        Tile expected, found;
    };
    std::vector<Case> cases;
    for (int i = 0; i < 500; ++i) {
        Rng& rng = item.random();
        const int size = std::array{8, 4, 16, 1}[static_cast<std::size_t>(i) % 4];
        const Corners p = random_triangle(rng, 96, 96);
        const Edges edges = edges_of(p);
        const int x = rng.integer(0, 90), y = rng.integer(0, 90);
        cases.push_back({edges, x, y, size, tile_by_pixels(edges, x, y, size), STUDENT(test_tile)(edges, x, y, size)});
    }
    const auto wrong = std::find_if(cases.begin(), cases.end(), [](const Case& c) { return c.found != c.expected; });
    if (wrong != cases.end()) {
        std::string hint = "Compute the greatest and the smallest value of each edge over the four corner pixels.";
        for (const Guess& guess : guesses)
            if (std::all_of(cases.begin(), cases.end(), [&](const Case& c) {
                    return c.found == tile_by_corners(c.edges, c.x, c.y, c.size, guess.reject, guess.accept);
                })) {
                hint = guess.text;
                break;
            }
        const auto explains = [&](const auto& tile) {
            return std::all_of(cases.begin(), cases.end(),
                               [&](const Case& c) { return c.found == tile(c.edges, c.x, c.y, c.size); });
        };
        if (explains(tile_by_four))
            hint = "A tile counts as outside where none of its four corner pixels is in the triangle. But the triangle "
                   "may cover pixels between them. It is outside only if one edge has all four corners outside.";
        if (explains(tile_by_triangle))
            hint = "A tile counts as outside where the triangle has none of its pixels. That needs a test of each "
                   "pixel; here a tile is outside only if one edge has all of its pixels outside, else kPartial.";
        item.require(false, message("The tile of ", wrong->size, " × ", wrong->size, " pixels from (", wrong->x, ", ",
                                    wrong->y, ") on is wrong for ", text_of(wrong->edges), ". ", hint, " Expected ",
                                    name_of(wrong->expected), ", found ", name_of(wrong->found), "."));
    }
    const Edges half{Edge{1, 0, -8}, Edge{0, 1, 1000}, Edge{0, -1, 1000}}; // inside from x = 8 on
    const auto state = [&](int x, int size) { return STUDENT(test_tile)(half, x, 0, size); };
    item.require(state(8, 8) == Tile::kInside,
                 "The edge a = 1, b = 0, c = -8 has its first pixel inside at x = 8. The tile "
                 "from x = 8 on is inside: 0 counts as inside.");
    item.require(
        state(0, 8) == Tile::kOutside,
        "The edge a = 1, b = 0, c = -8 has its first pixel inside at x = 8. The tile with x = 0 to 7 is outside: "
        "the last pixel of a tile is at size - 1, not at size.");
    item.require(state(1, 8) == Tile::kPartial, "The tile with x = 1 to 8 has one column inside: it is partial.");
    const Corners large{GridPoint{0, 0}, {524288, 1000}, {3000, 524288}};
    const Edges edges = edges_of(large);
    for (int i = 0; i < 200; ++i) {
        const int x = item.random().integer(0, 2040), y = item.random().integer(0, 2040);
        item.require(STUDENT(test_tile)(edges, x, y, 8) == tile_by_pixels(edges, x, y, 8),
                     message("The tile from (", x, ", ", y,
                             ") on is wrong for a triangle as large as an image of 2048 × 2048 "
                             "pixels: does a product overflow?"));
    }
}

LAB_ITEM(20, "eight pixels as a mask") {
    const auto bits = [](int mask) {
        std::string text;
        for (int i = 0; i < 8; ++i) text += mask >> i & 1 ? '1' : '0';
        return text;
    };
    const Edges from_three{Edge{1, 0, -3}, Edge{0, 1, 1000}, Edge{0, -1, 1000}};
    const int found = STUDENT(mask_of_eight)(from_three, 0, 0);
    item.equal("The mask of the pixels x = 0 to 7, of which 3 to 7 are inside,", found, 0b11111000,
               {{0b00011111, "The bits are in the wrong order: pixel x + 0 is the bit of the value 1."},
                {0b11110000, "A value of 0 is inside: test >= 0, not > 0."},
                {0b11111, "Bit i is 1 << i."},
                {0b00000111, "The mask has the pixels that are outside."},
                {5, "This is the number of pixels, not a mask."}});
    int wrong_order = 0, wrong = 0, first_edge = 0, any_edge = 0, begins_at_zero = 0, strict = 0;
    std::string first;
    for (int i = 0; i < 400; ++i) {
        Rng& rng = item.random();
        Corners p = random_triangle(rng, 24, 24);
        if (i % 2)
            for (GridPoint& q : p) q = {q.x / 256 * 256 + 128, q.y / 256 * 256 + 128};
        if (doubled_area(p) <= 0) continue;
        const Edges edges = edges_of(p);
        const int x = rng.integer(0, 20), y = rng.integer(0, 23);
        int expected = 0, turned = 0, one = 0, any = 0, zero = 0, greater = 0;
        for (int k = 0; k < 8; ++k) {
            const auto at = [&](std::size_t e, int px) { return value(edges[e], px, y); };
            expected |= covered(edges, x + k, y) << k;
            turned |= covered(edges, x + k, y) << (7 - k);
            zero |= covered(edges, k, y) << k;
            one |= (at(0, x + k) >= 0) << k;
            any |= (at(0, x + k) >= 0 || at(1, x + k) >= 0 || at(2, x + k) >= 0) << k;
            greater |= (at(0, x + k) > 0 && at(1, x + k) > 0 && at(2, x + k) > 0) << k;
        }
        const int mine = STUDENT(mask_of_eight)(edges, x, y);
        wrong += mine != expected;
        wrong_order += mine != turned, first_edge += mine != one, any_edge += mine != any;
        begins_at_zero += mine != zero, strict += mine != greater;
        if (mine != expected && first.empty())
            first =
                message("For ", text_of(edges), " and the pixels from (", x, ", ", y, ") on, expected ", bits(expected),
                        ", found ", mine >= 0 && mine < 256 ? bits(mine) : std::to_string(mine), " (pixel x first).");
    }
    item.require(wrong == 0,
                 message("The mask is wrong in ", wrong, " of 400 cases. ",
                         wrong_order == 0  ? "The bits are in the wrong order: pixel x + 0 is the bit of the value 1. "
                         : first_edge == 0 ? "Only the first edge is tested: all three must have the pixel inside. "
                         : any_edge == 0   ? "One edge is enough for you: all three must have the pixel inside. "
                         : begins_at_zero == 0 ? "The pixels begin at x, not at 0. "
                         : strict == 0         ? "A value of 0 is inside: test >= 0, not > 0. "
                                               : "",
                         first));
}

LAB_ITEM(25, "the triangle by tiles is the triangle by pixels") {
    check_cover(item, "a triangle over several tiles", {GridPoint{700, 300}, {9800, 2600}, {2600, 7800}}, 40, 32);
    check_cover(item, "a triangle that covers whole tiles", {GridPoint{0, 0}, {12000, 200}, {200, 9000}}, 48, 36);
    check_cover(item, "a triangle in an image of 37 × 29 pixels", {GridPoint{300, 200}, {9400, 900}, {7000, 7300}}, 37,
                29);
    check_cover(item, "a triangle smaller than a pixel, around a center",
                {GridPoint{2600, 2600}, {2800, 2700}, {2650, 2800}}, 24, 24);
    check_cover(item, "a triangle with its edges through centers", {GridPoint{1152, 1152}, {7296, 1152}, {1152, 7296}},
                40, 32);
    for (int i = 0; i < 40; ++i) {
        Rng& rng = item.random();
        const int width = rng.integer(9, 60), height = rng.integer(9, 45);
        check_cover(item, message("the random triangle number ", i + 1, " in ", width, " × ", height, " pixels"),
                    random_triangle(rng, width, height), width, height);
    }
    const Corners sliver{GridPoint{5, 900}, {511990, 1600}, {40, 1300}};
    item.require(
        STUDENT(cover)(sliver, 2000, 8).pixels() == coverage(sliver, 2000, 8).pixels(),
        "A thin triangle 2000 pixels wide has wrong pixels: is a step or a product rounded, or does it overflow?");
}
