// The examiner of assignment 6. A rasterizer must see what a ray through the center of the pixel sees
// (reference_hits.h), or a ray that is displaced by less than its grid.
#include "compare/lessons/assignments/6-comparison/reference_hits.h"
#include "compare/metrics/error_metrics.h"

#include <algorithm>

using namespace duet;
using namespace duet::grading;

LAB_TITLE("assignment-6", "Two pipelines and their difference")

namespace {

Rgb triangle_color(int triangle) {
    if (triangle < 0) return Rgb(0.02f);
    Rng rng(static_cast<std::uint64_t>(triangle));
    return {static_cast<float>(rng.uniform(0.2, 1)), static_cast<float>(rng.uniform(0.2, 1)),
            static_cast<float>(rng.uniform(0.2, 1))};
}

void require_sizes(Item& item, const Rendering& found) {
    const bool all = found.color.width() == kWidth && found.color.height() == kHeight &&
                     found.triangle.width() == kWidth && found.triangle.height() == kHeight &&
                     found.distance.width() == kWidth && found.distance.height() == kHeight;
    item.require(all, message("All three images of a rendering have ", kWidth, " x ", kHeight, " pixels."));
}

/// Each pixel sees a triangle that a ray within `by` pixels of its center sees.
void check_triangles(Item& item, const std::string& name, const Rendering& found, const Scene& scene,
                     const Camera& camera, double by) {
    require_sizes(item, found);
    const View view(camera, kWidth, kHeight);
    const ImageRgb expected = each_pixel(kWidth, kHeight, [&](int x, int y) {
        const int answer = found.triangle(x, y);
        const bool fine = triangles_nearby(scene, view, x + 0.5, y + 0.5, by).contains(answer);
        return triangle_color(fine ? answer : trace_pixel(scene, view, x + 0.5, y + 0.5).triangle);
    });
    const auto twisted = [&](const HitMistakes& mistakes) {
        const View other(camera, kWidth, kHeight, mistakes.horizontal_fov);
        return each_pixel(kWidth, kHeight, [&](int x, int y) {
            return triangle_color(trace_pixel(scene, other, x + 0.5, y + 0.5, mistakes).triangle);
        });
    };
    item.image(
        name, each_pixel(kWidth, kHeight, [&](int x, int y) { return triangle_color(found.triangle(x, y)); }), expected,
        1e-3,
        {{twisted({.upside_down = true}), "It is upside down: row 0 is the top row."},
         {twisted({.mirrored = true}), "It is mirrored: right = cross(forward, up), in this order."},
         {twisted({.corners = true}), "It is displaced by half a pixel: a pixel's center is at (x + 0.5, y + 0.5)."},
         {twisted({.horizontal_fov = true}), "The angle of view is the vertical one; here it was used for the width."},
         {twisted({.farthest = true}), "The farthest triangle is seen: keep the nearest."},
         {twisted({.painter = true}), "The last triangle of the list is seen: compare distances."},
         {twisted({.no_near = true}), "Triangles nearer than the near plane are seen: rays start where they cross it."},
         {twisted({.one_sided = true}), "Triangles are seen from one side alone: they are seen from both."},
         {twisted({.drops_clipped = true}),
          "A triangle with one corner behind the near plane is dropped as a whole: clip it, "
          "and draw the part in front."},
         {ImageRgb(kWidth, kHeight, triangle_color(-1)), "Nothing is drawn."}});
}

std::vector<int> as_list(const HitCounts& counts) { return {counts.same, counts.edge, counts.tie, counts.unexplained}; }

ImageRgb random_image(Rng& rng, int width, int height) {
    return each_pixel(width, height, [&](int, int) {
        return Rgb(static_cast<float>(rng.uniform(0, 1.5)), static_cast<float>(rng.uniform(0, 0.3)),
                   static_cast<float>(rng.uniform(0.2, 3)));
    });
}

} // namespace

LAB_ITEM(0, "your images") {
    Rng rng(4);
    const Scene scene = random_scene(rng);
    const Rendering raster = STUDENT(rasterize)(scene, kFront, kWidth, kHeight);
    const Rendering traced = STUDENT(ray_trace)(scene, kFront, kWidth, kHeight, true);
    item.show("your rasterizer", raster.color);
    item.show("your ray tracer, with shadows", traced.color);
    if (raster.color.size() == traced.color.size())
        item.show("your difference image", STUDENT(difference_image)(raster.color, traced.color, 0.5f));
}

LAB_ITEM(15, "the ray tracer sees the nearest triangle, and its distance") {
    const Scene scene = random_scene(item.random());
    for (const bool aside : {false, true}) {
        const Camera& camera = aside ? kTilted : kFront;
        const Rendering found = STUDENT(ray_trace)(scene, camera, kWidth, kHeight, false);
        check_triangles(item, aside ? "the ray tracer's image from aside" : "the ray tracer's image", found, scene,
                        camera, 1e-3);
        const View view(camera, kWidth, kHeight);
        for (const auto& [x, y] : {std::array{48, 40}, {20, 60}, {90, 55}, {5, 50}}) {
            const PixelHit pixel_hit = trace_pixel(scene, view, x + 0.5, y + 0.5);
            if (triangles_nearby(scene, view, x + 0.5, y + 0.5, 1e-3).size() > 1) continue;
            item.near(
                message("the distance at the pixel (", x, ", ", y, ")"), found.distance(x, y),
                static_cast<float>(pixel_hit.distance), 1e-4 * std::min(pixel_hit.distance, 1e3),
                {{static_cast<float>(pixel_hit.depth), "This is the depth along the direction of view: the distance is "
                                                       "that from the eye to the point."}});
        }
    }
    const View view(kFront, kWidth, kHeight);
    for (int i = 0; i < 60; ++i) {
        const double x = item.random().uniform(0, kWidth), y = item.random().uniform(0, kHeight);
        if (triangles_nearby(scene, view, x, y, 1e-3).size() > 1) continue;
        const PixelHit pixel_hit = trace_pixel(scene, view, x, y),
                       centered = trace_pixel(scene, view, std::floor(x) + 0.5, std::floor(y) + 0.5);
        item.equal(
            message("triangle_at(", x, ", ", y, ")"),
            STUDENT(triangle_at)(scene, kFront, kWidth, kHeight, static_cast<float>(x), static_cast<float>(y)),
            pixel_hit.triangle,
            {{centered.triangle, "This is what the pixel's center sees: (x, y) is any point of the image, and not "
                                 "the index of a pixel."}});
    }
}

LAB_ITEM(20, "the rasterizer sees the same") {
    const Scene scene = random_scene(item.random());
    for (const bool aside : {false, true}) {
        const Camera& camera = aside ? kTilted : kFront;
        const Rendering found = STUDENT(rasterize)(scene, camera, kWidth, kHeight);
        check_triangles(item, aside ? "the rasterizer's image from aside" : "the rasterizer's image", found, scene,
                        camera, 1.0 / 128);
        const View view(camera, kWidth, kHeight);
        for (int y = 3; y < kHeight; y += 5)
            for (int x = 2; x < kWidth; x += 7) {
                const PixelHit pixel_hit = trace_pixel(scene, view, x + 0.5, y + 0.5);
                if (found.triangle(x, y) != pixel_hit.triangle) continue;
                item.near(message("the distance at the pixel (", x, ", ", y, ")"), found.distance(x, y),
                          static_cast<float>(pixel_hit.distance), 1e-3 * std::min(pixel_hit.distance, 1e3),
                          {{static_cast<float>(pixel_hit.depth),
                            "This is the depth along the direction of view: the distance is "
                            "that from the eye to the point."}});
            }
    }
}

LAB_ITEM(10, "both shade alike") {
    const Scene scene = random_scene(item.random());
    const View view(kFront, kWidth, kHeight);
    for (const bool rays : {true, false}) {
        const Rendering found = rays ? STUDENT(ray_trace)(scene, kFront, kWidth, kHeight, false)
                                     : STUDENT(rasterize)(scene, kFront, kWidth, kHeight);
        require_sizes(item, found);
        const auto image_of = [&](const auto& color) {
            return each_pixel(kWidth, kHeight, [&](int x, int y) {
                const int i = found.triangle(x, y);
                if (i < 0 || i >= static_cast<int>(scene.triangles.size())) return Rgb(0);
                return color(scene.triangles[static_cast<std::size_t>(i)], view.direction(x + 0.5, y + 0.5));
            });
        };
        const Vec3d sun(scene.to_sun);
        const auto raw = [](const Triangle& t) { return cross(Vec3d(t.b) - Vec3d(t.a), Vec3d(t.c) - Vec3d(t.a)); };
        item.image(
            rays ? "the ray tracer's colors" : "the rasterizer's colors", found.color,
            image_of([&](const Triangle& t, Vec3d d) { return shaded(scene, t, dot(facing_normal(t, d), sun), true); }),
            2e-3,
            {{image_of([&](const Triangle& t, Vec3d) { return shaded(scene, t, dot(normalize(raw(t)), sun), true); }),
              "The normal is not turned to the side of the eye: turn it around where it points away."},
             {image_of([&](const Triangle& t, Vec3d d) {
                  return shaded(scene, t, std::abs(dot(facing_normal(t, d), sun)), true);
              }),
              "Sides that face away from the sun are lit: take max(0, n·to_sun), not the absolute value."},
             {image_of([&](const Triangle& t, Vec3d d) {
                  return shaded(scene, t, dot(facing_normal(t, d), sun) * length(raw(t)), true);
              }),
              "The normal doesn't have the length 1."},
             {image_of([&](const Triangle& t, Vec3d d) {
                  return t.albedo * scene.sun * static_cast<float>(std::max(0.0, dot(facing_normal(t, d), sun)));
              }),
              "The light of the sky is missing."},
             {image_of([&](const Triangle& t, Vec3d) { return t.albedo; }),
              "This is the albedo alone, without any light."}});
    }
}

LAB_ITEM(15, "the ray tracer's shadows") {
    const Scene scene = random_scene(item.random());
    const View view(kFront, kWidth, kHeight);
    const Rendering found = STUDENT(ray_trace)(scene, kFront, kWidth, kHeight, true);
    require_sizes(item, found);
    int acne = 0, in_sun = 0;
    ImageRgb expected(kWidth, kHeight), unshadowed(kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const Vec3d d = view.direction(x + 0.5, y + 0.5);
            const PixelHit pixel_hit = trace_pixel(scene, view, x + 0.5, y + 0.5);
            if (pixel_hit.triangle < 0 || found.triangle(x, y) != pixel_hit.triangle) {
                expected(x, y) = unshadowed(x, y) = found.color(x, y); // which triangle is seen has its own item
                continue;
            }
            const Triangle& t = scene.triangles[static_cast<std::size_t>(pixel_hit.triangle)];
            const Vec3d n = facing_normal(t, d), p = view.eye + d * pixel_hit.distance;
            const double cosine = dot(n, Vec3d(scene.to_sun));
            // Where the edge of a shadow is near, on the triangle, rounding decides, and both answers are right.
            const Vec3d s = normalize(cross(n, view.right)), u = cross(n, s);
            const auto lit_at = [&](double a, double b) { return is_sunlit(scene, p + s * a + u * b, n, 1e-5); };
            const bool lit = lit_at(0, 0), certain = lit_at(0.02, 0) == lit && lit_at(-0.02, 0) == lit &&
                                                     lit_at(0, 0.02) == lit && lit_at(0, -0.02) == lit;
            const Rgb bright = shaded(scene, t, cosine, true), dark = shaded(scene, t, cosine, false);
            const auto is_dark = [&] {
                return max_component(abs(Vec3(found.color(x, y).r - dark.r, found.color(x, y).g - dark.g,
                                              found.color(x, y).b - dark.b))) < 2e-3;
            };
            expected(x, y) = certain ? (lit ? bright : dark) : is_dark() ? dark : bright;
            unshadowed(x, y) = bright;
            if (certain && lit && cosine > 0.05) ++in_sun, acne += is_dark();
        }
    item.show("your shadows", found.color);
    item.require(acne <= in_sun / 12,
                 message("Of ", in_sun, " pixels in the sun ", acne,
                         " are dark: shadow acne. The shadow "
                         "ray meets the triangle that it leaves; start it a little above the surface, on "
                         "the side of the eye."));
    item.image("shadows", found.color, expected, 3e-3,
               {{unshadowed,
                 "There are no shadows: with `shadows`, the sun counts only where a ray toward it meets nothing."}});
}

LAB_ITEM(15, "the errors of an image are those of `compare`") {
    for (int i = 0; i < 4; ++i) {
        Rng& rng = item.random();
        const ImageRgb image = random_image(rng, 17, 11), reference = random_image(rng, 17, 11);
        const lab::Errors found = STUDENT(errors)(image, reference);
        const auto expected = compare::error_metrics(image, reference),
                   swapped = compare::error_metrics(reference, image);
        const auto mean = [](const Rgbd& c) { return (c.r + c.g + c.b) / 3; };
        item.near("mse", found.mse, expected.mse, 1e-6,
                  {{expected.mse * 3, "It is three times too large: the mean runs over all pixels and channels."},
                   {expected.mse * 17 * 11 * 3, "This is the sum: divide by the number of values."},
                   {expected.mae, "This is the mean of |a - b|: square the differences."}});
        item.near("rmse", found.rmse, expected.rmse, 1e-6,
                  {{expected.mse, "This is mse: take its root."},
                   {expected.mae, "This is the mean of |a - b|: the root is taken of the mean, not of each square."}});
        item.near("relmse", found.relmse, expected.relmse, 1e-5 * expected.relmse,
                  {{swapped.relmse, "Divide by the reference's values, not by the image's."},
                   {expected.mse, "This is mse: each square is divided by b² + 0.01."}});
        item.near("mean_signed_error", found.mean_signed_error, mean(expected.mean_signed_error), 1e-6,
                  {{-mean(expected.mean_signed_error),
                    "The sign is wrong: an image that is too bright has a positive error."},
                   {expected.mae, "The sign is lost: don't take the absolute value."}});
    }
}

LAB_ITEM(15, "hits are counted as same, edge, tie or unexplained") {
    const Scene scene = random_scene(item.random());
    const Rendering exact = truth(scene, kFront);
    const auto check = [&](const std::string& what, const Rendering& raster) {
        const HitCounts found = STUDENT(compare_hits)(scene, kFront, raster, exact);
        const HitCounts wide = count_hits(scene, kFront, raster, exact, 1),
                        narrow = count_hits(scene, kFront, raster, exact, 0);
        item.near(
            "the counts (same, edge, tie, unexplained) of " + what, as_list(found),
            as_list(count_hits(scene, kFront, raster, exact)), 3,
            {{as_list(wide), "The rays of `edge` are displaced by a whole pixel: the distance is 1/128 of a pixel."},
             {as_list(narrow),
              "No pixel counts as an edge: displace the ray by 1/128 of a pixel, in eight directions."}});
    };
    check("two equal renderings", exact);
    check("a rendering that is displaced by 1/200 of a pixel", truth(scene, kFront, 1.0 / 200));
    Rendering empty = exact;
    for (int x = 0; x < kWidth; ++x) empty.triangle(x, 50) = -1, empty.distance(x, 50) = kInfinity;
    const HitCounts truly = count_hits(scene, kFront, empty, exact);
    item.near("the counts (same, edge, tie, unexplained) of a rendering with a row that sees nothing",
              as_list(STUDENT(compare_hits)(scene, kFront, empty, exact)), as_list(truly), 3,
              {{std::vector<int>{truly.same, truly.edge, truly.tie + truly.unexplained, 0},
                "Where one of both sees nothing, its distance is infinite, and 1e-5 of infinity is infinite, too: that "
                "is no tie."}});
    check("a rendering that is displaced by a pixel", truth(scene, kFront, 1));
    Rendering wrong = exact;
    for (int y = 20; y < 30; ++y)
        for (int x = 40; x < 60; ++x) wrong.triangle(x, y) = 3, wrong.distance(x, y) = 0.5f;
    check("a rendering with a wrong triangle in a rectangle", wrong);
    Scene doubled = scene; // every triangle stands twice; a ray sees the first
    doubled.triangles.insert(doubled.triangles.end(), scene.triangles.begin(), scene.triangles.end());
    Rendering second = exact;
    int hits = 0;
    for (int& triangle : second.triangle.pixels())
        if (triangle >= 0) triangle += static_cast<int>(scene.triangles.size()), ++hits;
    item.near("the counts (same, edge, tie, unexplained) where the second of two equal triangles is seen",
              as_list(STUDENT(compare_hits)(doubled, kFront, second, exact)),
              std::vector<int>{kWidth * kHeight - hits, 0, hits, 0}, 0,
              {{std::vector<int>{kWidth * kHeight - hits, 0, 0, hits},
                "Equal distances are a tie: compare |a - b| with 1e-5 of the larger distance."}});
}

LAB_ITEM(5, "the difference image") {
    const ImageRgb image = random_image(item.random(), 23, 9), reference = random_image(item.random(), 23, 9);
    const auto drawn = [&](float sign, float range, bool clamped) {
        return each_pixel(23, 9, [&](int x, int y) {
            float d = sign * (luminance(image(x, y)) - luminance(reference(x, y))) / range;
            if (clamped) d = std::clamp(d, -1.0f, 1.0f);
            return d > 0 ? Rgb(d, 0, 0) : Rgb(0, 0, -d);
        });
    };
    item.image(
        "the difference image", STUDENT(difference_image)(image, reference, 0.4f), drawn(1, 0.4f, true), 1e-4,
        {{drawn(-1, 0.4f, true), "Red and blue are swapped: red is where the image is brighter than the reference."},
         {drawn(1, 0.4f, false), "Differences beyond the range are not limited to 1."},
         {drawn(1, 1, true), "The range plays no part: divide by it."}});
}

LAB_ITEM(5, "your two pipelines leave no pixel unexplained") {
    for (int i = 0; i < 2; ++i) {
        const Scene scene = random_scene(item.random(), 14);
        const Camera camera = i ? kTilted : kFront;
        const Rendering raster = STUDENT(rasterize)(scene, camera, kWidth, kHeight);
        const Rendering traced = STUDENT(ray_trace)(scene, camera, kWidth, kHeight, false);
        require_sizes(item, raster), require_sizes(item, traced);
        const HitCounts counts = count_hits(scene, camera, raster, traced);
        item.require(counts.same > kWidth * kHeight * 9 / 10, message("Only ", counts.same, " of ", kWidth * kHeight,
                                                                      " pixels see the same triangle both ways."));
        item.require(counts.unexplained == 0,
                     message(counts.unexplained, " pixels differ without a reason: neither an edge "
                                                 "nor a tie. One of your pipelines is wrong there."));
        item.require(std::ranges::any_of(raster.triangle, [](int t) { return t > 1; }), "No tetrahedron is drawn.");
    }
}
