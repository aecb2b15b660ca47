// These tests compare the visibility and the attributes of triangles with the ray through each pixel in extended
// precision.
#include "compare/stress/errors.h"
#include "compare/stress/projection_runs.h"
#include "compare/stress/projection_scenes.h"
#include "compare/stress/textbook_rasterizer.h"

namespace duet::compare {

namespace {

constexpr int kSide = 12; // pixels per side of a trial's window

using MakeTriangle = std::array<Vec3, 3> (*)(TrialRandom&, const TrialView&);

TextbookTriangle as_textbook(const Pinhole& pinhole, const std::array<Vec3, 3>& corners) {
    const Mat4 matrix(pinhole.world_to_pixel);
    return {textbook_project(matrix, corners[0]), textbook_project(matrix, corners[1]),
            textbook_project(matrix, corners[2])};
}

void note_trial(Trial& trial, const TrialView& v, const std::array<Vec3, 3>& corners) {
    const Camera& camera = v.view.camera;
    trial.note("triangle ", exact(corners[0]), ", ", exact(corners[1]), ", ", exact(corners[2]), " from ",
               exact(Vec3(camera.eye)), " near ", camera.near, ", ", v.view.width, "x", v.view.height,
               " pixels, samples at (", v.window.offset.x, ", ", v.window.offset.y, ") in 1/256 of the pixels from (",
               v.window.rect.x0, ", ", v.window.rect.y0, ")");
}

// Coverage -----------------------------------------------------------------------------------------------------------

/// Returns whether a hit's values are possible: inside the triangle and beyond the near plane.
bool possible(const Hit& hit, double depth, double near) {
    return hit.u >= 0 && hit.v >= 0 && hit.u <= 1 && hit.v <= 1 && depth >= near * (1 - 0x1p-20) && depth < 1e30;
}

template <MakeTriangle make> void displaced(Trial& trial) {
    const TrialView v = random_view(trial.random, kSide);
    const std::array<Vec3, 3> corners = make(trial.random, v);
    const ProjectedTriangle exact_triangle(v.pinhole, corners);
    if (exact_triangle.edge_on()) return;
    const raster::HitTile tile = draw(one_triangle(corners), v.view, v.window);
    const TextbookTriangle textbook = as_textbook(v.pinhole, corners);
    double worst = 0, textbook_worst = 0;
    v.window.for_each([&](int x, int y) {
        const Vec2d pixel = v.window.offset.position(x, y);
        const Hit& hit = tile.hit(x, y);
        worst = max(worst, displacement(exact_triangle, pixel, hit.valid()));
        if (hit.valid() && !possible(hit, tile.depth(x, y), v.pinhole.near))
            worst = std::numeric_limits<double>::infinity();
        textbook_worst =
            max(textbook_worst, displacement(exact_triangle, pixel, textbook_covers(textbook, Vec2(pixel))));
    });
    note_trial(trial, v, corners);
    trial.record(worst);
    trial.record_naive(textbook_worst);
}

// Attributes ---------------------------------------------------------------------------------------------------------

/// Calls judge(x, y, pixel, truth) for the window's samples well inside the triangle. There, vertex snapping has no
/// effect, and the error of double precision is less than a hundredth of a float's roundoff.
template <typename Judge>
void for_each_inside(const TrialView& v, const ProjectedTriangle& triangle, const raster::HitTile& tile,
                     const Judge& judge) {
    v.window.for_each([&](int x, int y) {
        const Vec2d pixel = v.window.offset.position(x, y);
        constexpr double kInsideMargin = 1.0 / 16, kCondition = 1e5; // 1e5 · 2^-53 times a few = 0.001 · 2^-24
        if (triangle.inside(pixel) >= kInsideMargin && triangle.condition(pixel) <= kCondition &&
            tile.hit(x, y).valid())
            judge(x, y, pixel, triangle.at(pixel));
    });
}

template <MakeTriangle make> void barycentrics(Trial& trial) {
    const TrialView v = random_view(trial.random, kSide);
    const std::array<Vec3, 3> corners = make(trial.random, v);
    const ProjectedTriangle exact_triangle(v.pinhole, corners);
    const raster::HitTile tile = draw(one_triangle(corners), v.view, v.window);
    const TextbookTriangle textbook = as_textbook(v.pinhole, corners);
    note_trial(trial, v, corners);
    for_each_inside(v, exact_triangle, tile, [&](int x, int y, Vec2d pixel, const ProjectedPoint& truth) {
        const auto error = [&](float u, float w) {
            return in_roundoffs(
                larger_error(std::abs(static_cast<double>(u) - truth.u), std::abs(static_cast<double>(w) - truth.v)));
        };
        trial.record(error(tile.hit(x, y).u, tile.hit(x, y).v));
        const Vec3 affine = textbook_barycentrics(textbook, Vec2(pixel));
        trial.record_naive(error(affine.y, affine.z));
    });
}

/// Tests the distance of each hit point's projection from its sample, in pixels.
void point_errors(Trial& trial) {
    const TrialView v = random_view(trial.random, kSide);
    const std::array<Vec3, 3> corners = random_sliver(trial.random, v);
    const raster::HitTile tile = draw(one_triangle(corners), v.view, v.window);
    const TextbookTriangle textbook = as_textbook(v.pinhole, corners);
    note_trial(trial, v, corners);
    const auto pixel_error = [&](Vec2d pixel, double u, double w) {
        const Vec3d a(corners[0]), ab = Vec3d(corners[1]) - a, ac = Vec3d(corners[2]) - a;
        const Vec3d seen = v.pinhole.project(a + ab * u + ac * w);
        return std::hypot(seen.x - pixel.x, seen.y - pixel.y);
    };
    v.window.for_each([&](int x, int y) {
        const Hit& hit = tile.hit(x, y);
        if (!hit.valid()) return;
        const Vec2d pixel = v.window.offset.position(x, y);
        trial.record(possible(hit, tile.depth(x, y), v.pinhole.near)
                         ? pixel_error(pixel, static_cast<double>(hit.u), static_cast<double>(hit.v))
                         : std::numeric_limits<double>::infinity());
        const Vec3 affine = textbook_barycentrics(textbook, Vec2(pixel));
        trial.record_naive(pixel_error(pixel, static_cast<double>(affine.y), static_cast<double>(affine.z)));
    });
}

constexpr float kTextbookNear = 0.1f, kTextbookFar = 1e5f;

/// Returns the textbook z-buffer's depth at a pixel: z/w is linear in screen space, from −1 at 0.1 m to 1 at 1e5 m.
double textbook_depth(const TextbookTriangle& t, Vec2 pixel) {
    const Vec3 b = textbook_barycentrics(t, pixel);
    const auto z = [&](std::size_t i) { return textbook_z(t[i].depth, kTextbookNear, kTextbookFar); };
    const float here = b.x * z(0) + b.y * z(1) + b.z * z(2);
    return 2.0 * static_cast<double>(kTextbookFar * kTextbookNear) /
           (static_cast<double>(kTextbookFar + kTextbookNear) -
            static_cast<double>(here) * static_cast<double>(kTextbookFar - kTextbookNear));
}

template <MakeTriangle make> void depths(Trial& trial) {
    const TrialView v = random_view(trial.random, kSide, static_cast<double>(kTextbookNear));
    const std::array<Vec3, 3> corners = make(trial.random, v);
    const ProjectedTriangle exact_triangle(v.pinhole, corners);
    const raster::HitTile tile = draw(one_triangle(corners), v.view, v.window);
    const TextbookTriangle textbook = as_textbook(v.pinhole, corners);
    note_trial(trial, v, corners);
    for_each_inside(v, exact_triangle, tile, [&](int x, int y, Vec2d pixel, const ProjectedPoint& truth) {
        const double distance = truth.depth * v.pinhole.ray(pixel).t_min / v.pinhole.near;
        trial.record(in_roundoffs(relative_error(static_cast<double>(tile.hit(x, y).t), distance)));
        trial.record(
            in_roundoffs(relative_error(static_cast<double>(tile.reversed_depth(x, y)), v.pinhole.near / truth.depth)));
        trial.record_naive(in_roundoffs(relative_error(textbook_depth(textbook, Vec2(pixel)), truth.depth)));
    });
}

constexpr std::string_view kNoClip = "division by any w, then barycentrics >= 0 in float, as tinyrenderer";
constexpr std::string_view kRounding =
    "one rounding to float, of a number up to 1; the volumes in extended precision; 0.01 for double's share";

constexpr StressTest kTests[] = {
    {.name = "projection/near-plane",
     .what = "triangles with corners before the eye, behind it, exactly on its plane and on the near plane cover what "
             "rays see of them, at points beyond the near plane",
     .bound = 0.0029,
     .unit = "pixels",
     .source = "snapping moves an outline by at most sqrt(2)/512 = 0.00276 pixel; double's rounding of corners cut at "
               "the near plane 0.0001; the volumes in extended precision",
     .naive = kNoClip,
     .trials = 50'000,
     .run = trials_of<displaced<random_straddling>>},
    {.name = "projection/guard-band",
     .what = "triangles that reach 1e4 to 1e7 pixels beyond the window cover what rays see of them",
     .bound = 0.00277,
     .unit = "pixels",
     .source = "snapping moves an outline by at most sqrt(2)/512 = 0.00276 pixel; the volumes in extended precision",
     .naive = kNoClip,
     .trials = 50'000,
     .run = trials_of<displaced<random_beyond_guard>>},
    {.name = "projection/once-clipped",
     .what =
         "a floor of folded triangles under the eye and behind it, cut at the near plane and the guard band, covers "
         "each sample that sees it once, or twice more for each fold, and the others not",
     .bound = 0,
     .unit = "wrong samples",
     .source = "parity: as coverage/once-grids, orientation being lost; the floor's outline in extended precision",
     .naive = kNoClip,
     .trials = 10'000,
     .run = trials_of<clipped_floor>},
    {.name = "projection/barycentrics",
     .what = "u and v are perspective-correct on triangles whose corners are up to 1000 times as far as others",
     .bound = 0.51,
     .unit = "2^-24",
     .source = kRounding,
     .naive = "affine: ratios of areas on the screen",
     .trials = 30'000,
     .run = trials_of<barycentrics<random_visible>>,
     .required_fraction = 0.35},
    {.name = "projection/barycentrics-straddling",
     .what = "u and v are perspective-correct on triangles that pass through the near plane and the eye's",
     .bound = 0.51,
     .unit = "2^-24",
     .source = kRounding,
     .naive = "affine: ratios of areas on the screen",
     .trials = 50'000,
     .run = trials_of<barycentrics<random_straddling>>,
     .required_fraction = 0.3},
    {.name = "projection/slivers",
     .what = "a sample that only the snapped outline of a sliver covers gets a point of the sliver next to it",
     .bound = 0.0058,
     .unit = "pixels",
     .source = "the sliver is within snapping's sqrt(2)/512 pixel, and a mirrored sample no farther from it: 0.0055 in "
               "all; u and v rounded to float: 0.0003",
     .naive = "affine: ratios of areas on the screen",
     .trials = 50'000,
     .run = trials_of<point_errors>,
     .required_fraction = 0.15},
    {.name = "projection/depth",
     .what =
         "distance and reversed depth (near/depth) are right on triangles whose corners are up to 1000 times as far as "
         "others",
     .bound = 1.01,
     .unit = "2^-24 of itself",
     .source = "one rounding to float; the volumes in extended precision; 0.01 for double's share",
     .naive = "a float z-buffer, z/w in [-1, 1] between 0.1 and 1e5 meters",
     .trials = 30'000,
     .run = trials_of<depths<random_visible>>,
     .required_fraction = 0.35},
    {.name = "projection/depth-order",
     .what =
         "between 1e-3 and 1e5 meters, of two parallel surfaces a few floats apart the nearer is seen, whichever is "
         "drawn first",
     .bound = 0,
     .unit = "wrong",
     .source = "near/depth rounds monotonically, by 2^-24 of itself at most: depths 2^-23 apart keep their order",
     .naive = "a float z-buffer, z/w in [-1, 1]",
     .trials = 20'000,
     .run = trials_of<depth_order>,
     .required_fraction = 0.7},
    {.name = "projection/draw-order",
     .what = "of triangles at the same place and depth the one of the lowest number is seen, in any order of drawing",
     .bound = 0,
     .unit = "wrong samples",
     .source = "each triangle drawn by itself, and the rule applied by hand: of equal reversed depth the lower number",
     .naive = "nearer replaces, else whoever came first stays",
     .trials = 10'000,
     .run = trials_of<draw_order>},
};

} // namespace

std::span<const StressTest> projection_tests() { return kTests; }

} // namespace duet::compare
