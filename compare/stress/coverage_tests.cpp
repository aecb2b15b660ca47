// These tests compare the coverage of single triangles, and of meshes whose triangles share every edge, with exact
// integers.
#include "compare/stress/coverage_meshes.h"
#include "compare/stress/textbook_rasterizer.h"

namespace duet::compare {

namespace {

using raster::kSubpixels;

constexpr int kSide = 12; // pixels per side of a trial's window

TextbookTriangle as_textbook(const GridTriangle& t) {
    const auto vertex = [](raster::FixedPoint p) {
        return TextbookVertex{Vec2(Vec2d(p.x, p.y) * (1.0 / kSubpixels)), 1};
    };
    return {vertex(t[0]), vertex(t[1]), vertex(t[2])};
}

std::string describe(const GridTriangle& t) {
    return message('(', t[0].x, ", ", t[0].y, "), (", t[1].x, ", ", t[1].y, "), (", t[2].x, ", ", t[2].y, ')');
}

void note_window(Trial& trial, const Window& window) {
    trial.note("samples at (", window.offset.x, ", ", window.offset.y, ") in 1/256 of the pixels from (",
               window.rect.x0, ", ", window.rect.y0, ")");
}

void exact_integers(Trial& trial) {
    const Window window = random_window(trial.random, kSide);
    const auto kind = static_cast<std::uint32_t>(trial.number() % kTriangleKinds);
    const GridTriangle triangle = random_triangle(trial.random, window, kind);
    CoverageProbe probe(window);
    probe.draw(triangle);
    const TextbookTriangle textbook = as_textbook(triangle);
    int wrong = 0, textbook_wrong = 0;
    window.for_each([&](int x, int y) {
        const bool covered = covers(triangle, window.grid_x(x), window.grid_y(y));
        wrong += probe.covers(x, y) != covered;
        textbook_wrong += textbook_covers(textbook, Vec2(window.offset.position(x, y))) != covered;
    });
    note_window(trial, window);
    trial.note("triangle of 1/256 pixel: ", describe(triangle));
    trial.record(wrong);
    trial.record_naive(textbook_wrong);
}

/// Counts the samples of the window whose coverage by the mesh is not exactly one. Counter-clockwise triangles count
/// as −1.
struct NotOnce {
    int library = 0, naive = 0;
};
NotOnce count_not_once(const std::vector<GridTriangle>& mesh, const Window& window) {
    Image<int> sums(kSide, kSide, 0), textbook_sums(kSide, kSide, 0);
    CoverageProbe probe(window);
    for (const GridTriangle& triangle : mesh) {
        const int turn = winding(triangle);
        if (turn == 0) continue;
        probe.draw(triangle);
        const TextbookTriangle textbook = as_textbook(triangle);
        window.for_each([&](int x, int y) {
            const int column = x - window.rect.x0, row = y - window.rect.y0;
            if (probe.covers(x, y)) sums(column, row) += turn;
            if (textbook_covers(textbook, Vec2(window.offset.position(x, y)))) textbook_sums(column, row) += turn;
        });
    }
    NotOnce result;
    for (const int sum : sums) result.library += sum != 1;
    for (const int sum : textbook_sums) result.naive += sum != 1;
    return result;
}

template <std::vector<GridTriangle> (*make)(TrialRandom&, const Window&)> void covered_once(Trial& trial) {
    const Window window = random_window(trial.random, kSide);
    const std::vector<GridTriangle> mesh = make(trial.random, window);
    const NotOnce wrong = count_not_once(mesh, window);
    note_window(trial, window);
    trial.note(mesh.size(), " triangles, the first of them ", describe(mesh.front()));
    trial.record(wrong.library);
    trial.record_naive(wrong.naive);
}

constexpr std::string_view kTextbookMethod = "barycentrics >= 0 in float, as tinyrenderer";
constexpr std::string_view kOnce = "the mesh's border runs around every sample once: so must the sum of its triangles";

constexpr StressTest kTests[] = {
    {.name = "coverage/exact-integers",
     .what = "a triangle covers the samples it should: of any size, slivers, edges and corners on samples, in images "
             "of up to 16384 pixels a side and vertices as far as the guard band lets them be",
     .bound = 0,
     .unit = "wrong samples",
     .source = "the rule's definition in 128-bit integers: the sample moved right by an infinitely small step",
     .naive = kTextbookMethod,
     .trials = 1'000'000,
     .run = trials_of<exact_integers>},
    {.name = "coverage/once-fans",
     .what = "fans of 4 to 64 triangles around a jittered vertex cover each sample exactly once",
     .bound = 0,
     .unit = "wrong samples",
     .source = kOnce,
     .naive = kTextbookMethod,
     .trials = 20'000,
     .run = trials_of<covered_once<random_fan>>},
    {.name = "coverage/once-strips",
     .what = "strips of slivers, many of them thinner than a hundredth of a pixel, cover each sample exactly once",
     .bound = 0,
     .unit = "wrong samples",
     .source = kOnce,
     .naive = kTextbookMethod,
     .trials = 20'000,
     .run = trials_of<covered_once<random_strip>>},
    {.name = "coverage/once-grids",
     .what = "meshes of jittered or folded vertices cover each sample exactly once, back faces counted as minus one",
     .bound = 0,
     .unit = "wrong samples",
     .source = kOnce,
     .naive = kTextbookMethod,
     .trials = 20'000,
     .run = trials_of<covered_once<random_grid>>},
};

} // namespace

std::span<const StressTest> coverage_tests() { return kTests; }

} // namespace duet::compare
