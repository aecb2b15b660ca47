// The examiner of assignment 1. Images are compared with those of a renderer of its own (reference_renderer.h). The
// time budget is a multiple of the time that this plain renderer takes in the same run.
#include "compare/lessons/assignments/1-rasterizer/reference_renderer.h"
#include "tests/grading/judge.h"

#include <ctime>

using namespace duet;
using namespace duet::grading;
using lab::Triangle, lab::Vertex;

LAB_TITLE("assignment-1", "A rasterizer that draws the amphora")

namespace {

/// Pixels whose color differs by more than a tolerance. A few may: those whose center is within rounding of an outline.
std::size_t wrong_pixels(const ImageRgb& a, const ImageRgb& b, double tolerance) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        count += !(std::max({std::abs(a[i].r - b[i].r), std::abs(a[i].g - b[i].g), std::abs(a[i].b - b[i].b)}) <=
                   static_cast<float>(tolerance));
    return count;
}

constexpr double kTolerance = 0.03;

/// Draws by the student's code and compares. Up to 1 pixel in 200 may differ.
void check_picture(Item& item, const std::string& name, const Mesh& mesh, const Camera& camera, const ImageRgb& texture,
                   int width, int height) {
    const Rgb background(0.02f, 0.03f, 0.06f);
    item.limit(20);
    const ImageRgb found = STUDENT(draw)(mesh, camera, texture, width, height, background);
    const ImageRgb expected = render(mesh, camera, texture, width, height, background);
    if (found.width() == width && found.height() == height &&
        wrong_pixels(found, expected, kTolerance) <= expected.size() / 200) {
        item.show(name + ": found", found);
        return;
    }
    std::vector<Mistake<ImageRgb>> mistakes;
    const auto add = [&](const std::string& text, bool RendererMistakes::*flag) {
        RendererMistakes wrong;
        wrong.*flag = true;
        const ImageRgb image = render(mesh, camera, texture, width, height, background, wrong);
        if (wrong_pixels(image, expected, kTolerance) > expected.size() / 200) mistakes.push_back({image, text});
    };
    add("It looks as if depth were not compared: what is drawn last covers what is nearer. Keep the smallest depth of "
        "each "
        "pixel.",
        &RendererMistakes::depth_unused);
    add("The farthest surface wins: keep the smallest depth, and begin with infinity.",
        &RendererMistakes::farthest_wins);
    add("The texture is interpolated evenly over the image, so it bends at the diagonals: use perspective_weights for "
        "uv.",
        &RendererMistakes::affine);
    add("The texture stands on its head: v = 0 is its bottom row, and row 0 of an image is its top row.",
        &RendererMistakes::v_flipped);
    add("Triangles are not clipped: what is behind the eye is drawn in front of it.", &RendererMistakes::unclipped);
    add("Triangles that cross the near plane are missing: draw the part of them that is in front.",
        &RendererMistakes::dropped);
    add("Everything is half a pixel too far to the lower right: the center of pixel (0, 0) is at (0.5, 0.5).",
        &RendererMistakes::pixel_corners);
    add("The picture is upside down: y points up in clip space, and down in the image.",
        &RendererMistakes::upside_down);
    add("The picture is mirrored: x points right in clip space and in the image.", &RendererMistakes::mirrored);
    add("The aspect is not that of the image, width / height. Of two int this is a whole number: convert them first.",
        &RendererMistakes::aspect_ignored);
    add("Triangles are visible from one side only: both windings must be drawn.", &RendererMistakes::one_side_only);
    add("The texture has hard squares: mix the four nearest texels.", &RendererMistakes::nearest_texel);
    mistakes.push_back({ImageRgb(width, height, background), "Nothing is drawn."});
    item.image(name, found, expected, kTolerance, mistakes);
}

Image<int> counts_of(Item& item, const std::vector<lab::Fragment>& fragments, int width, int height) {
    Image<int> image(width, height, 0);
    for (const auto& f : fragments) {
        item.require(f.x >= 0 && f.x < width && f.y >= 0 && f.y < height,
                     message("There is a fragment at (", f.x, ", ", f.y, "), outside of the image of ", width, " × ",
                             height, " pixels."));
        ++image(f.x, f.y);
    }
    return image;
}

constexpr int kColumns = 48, kRows = 36; // of the images that rasterize covers
constexpr Vec2 kHalf{0.5f, 0.5f};
const char* const kAtCorners = "Pixels are tested at their upper left corners: their centers are at +0.5.";

/// Checks a fan whose corners lie on centers of pixels, so that its edges pass through others.
void require_fan(Item& item) {
    const auto center = [&](int x, int y) { return Vec2{static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f}; };
    const Vec2 hub = center(24, 18);
    const std::vector<Vec2> rim{center(4, 2),   center(24, 1),  center(44, 2), center(46, 18),
                                center(44, 34), center(24, 35), center(4, 34), center(1, 18)};
    Image<int> found(kColumns, kRows, 0), expected(kColumns, kRows, 0), clockwise(kColumns, kRows, 0),
        moved(kColumns, kRows, 0);
    for (std::size_t i = 0; i < rim.size(); ++i) {
        const Vec2 b = rim[i], c = rim[(i + 1) % rim.size()];
        const bool turned = i % 3 == 0;
        const auto fragments = STUDENT(rasterize)(hub, turned ? c : b, turned ? b : c, kColumns, kRows);
        const Image<int> one = counts_of(item, fragments, kColumns, kRows);
        for (std::size_t k = 0; k < one.size(); ++k) found[k] += one[k];
        lesson::for_each_pixel(hub, b, c, kColumns, kRows, [&](int x, int y, Vec3) {
            ++expected(x, y);
            clockwise(x, y) += !turned;
        });
        lesson::for_each_pixel(hub + kHalf, b + kHalf, c + kHalf, kColumns, kRows,
                               [&](int x, int y, Vec3) { ++moved(x, y); });
    }
    item.coverage(
        "a fan of eight triangles, three of them counter-clockwise", found, expected,
        {{clockwise, "Triangles with counter-clockwise corners are missing: where the area is negative, swap two "
                     "corners."},
         {moved, kAtCorners},
         {count_fan_coverage(hub, rim, kColumns, kRows, [](auto w, auto, auto) { return w >= 0; }),
          "Both triangles at an edge take the centers on it: w == 0 counts for a left or top edge only."},
         {count_fan_coverage(hub, rim, kColumns, kRows, [](auto w, auto, auto) { return w > 0; }),
          "No triangle takes the centers on an edge: w == 0 counts for a left or top edge."},
         {count_fan_coverage(hub, rim, kColumns, kRows,
                             [](auto w, auto a, auto b) { return w > 0 || (w == 0 && !lesson::is_top_left(a, b)); }),
          "The rule is turned around: the bottom and right edges take the centers on them."},
         {Image<int>(kColumns, kRows, 0), "Nothing is covered at all."}});
}

} // namespace

LAB_ITEM(0, "the picture: your amphora") {
    item.limit(20);
    const Camera camera{{0.75f, 0.95f, 1.5f}, {0, 0.43f, 0}, {0, 1, 0}, 0.62f, 0.1f};
    item.show("the amphora", STUDENT(draw)(amphora(), camera, amphora_texture(), 300, 360, Rgb(0.02f, 0.03f, 0.06f)));
}

LAB_ITEM(10, "parse_obj") {
    const Mesh small = STUDENT(parse_obj)("# a quad and a triangle\nv 0 0 0\nv 1 0 0\nv 1 1.5 -2e-1\nv  0 1 0\n"
                                          "vt 0 0\nvt 1 0\nvt 1 0.5\nvn 0 0 1\no thing\nf 1/1/1 2/2/1 3/3/1 4/1/1\n"
                                          "s off\nf 1/3 3/2 2/1\n");
    item.equal("the number of points", small.points.size(), 4,
               {{5, "A line \"vn\" is a normal, not a point: compare the whole word."},
                {8, "Lines \"vt\" and \"vn\" are no points: compare the whole word."},
                {7, "Lines \"vt\" are no points: compare the whole word."}});
    item.equal("the number of uvs", small.uvs.size(), 3, {{0, "Lines \"vt\" have the texture coordinates."}});
    item.near("the third point", small.points[2], Vec3{1, 1.5f, -0.2f}, 1e-6);
    item.near("the third uv", small.uvs[2], Vec2{1, 0.5f}, 1e-6);
    item.equal("the number of corners", small.corners.size(), 9,
               {{6, "A face of four corners becomes two triangles: 0 1 2 and 0 2 3."},
                {7, "A face of four corners becomes two triangles, six corners: 0 1 2 and 0 2 3."},
                {12, "A face of n corners becomes n - 2 triangles."}});
    const auto points_of = [](const Mesh& mesh) {
        std::vector<int> list;
        for (const Corner& c : mesh.corners) list.push_back(c.point);
        return list;
    };
    item.near("the points of the corners", points_of(small), std::vector<int>{0, 1, 2, 0, 2, 3, 0, 2, 1}, 0,
              {{{1, 2, 3, 1, 3, 4, 1, 3, 2}, "An OBJ file counts from 1, a std::vector from 0: subtract 1."},
               {{0, 1, 2, 1, 2, 3, 0, 2, 1}, "The second triangle of a quad has the corners 0 2 3, not 1 2 3."}});
    std::vector<int> uvs;
    for (const Corner& c : small.corners) uvs.push_back(c.uv);
    item.near(
        "the uvs of the corners", uvs, std::vector<int>{0, 1, 2, 0, 2, 0, 2, 1, 0}, 0,
        {{{0, 1, 2, 0, 2, 3, 0, 2, 1}, "These are the numbers of the points: the second number is that of the uv."},
         {{1, 2, 3, 1, 3, 1, 3, 2, 1}, "The uvs are counted from 1, too: subtract 1."}});
    item.limit(20);
    const Mesh found = STUDENT(parse_obj)(amphora_text());
    item.equal("the number of points of the amphora", found.points.size(), amphora().points.size());
    item.equal("the number of corners of the amphora", found.corners.size(), amphora().corners.size());
    for (std::size_t i = 0; i < found.corners.size(); i += 97) {
        const auto [point, uv] = found.corners[i];
        item.require(point >= 0 && point < static_cast<int>(found.points.size()) && uv >= 0 &&
                         uv < static_cast<int>(found.uvs.size()),
                     message("Corner ", i, " names point ", point, " and uv ", uv, ", which don't exist."));
        const Corner right = amphora().corners[i];
        item.near(message("the point of corner ", i, " of the amphora"), found.points[static_cast<std::size_t>(point)],
                  amphora().points[static_cast<std::size_t>(right.point)], 1e-6);
        item.near(message("the uv of corner ", i, " of the amphora"), found.uvs[static_cast<std::size_t>(uv)],
                  amphora().uvs[static_cast<std::size_t>(right.uv)], 1e-6);
    }
}

LAB_ITEM(10, "to_clip") {
    const Camera front{{0, 0, 0}, {0, 0, -1}, {0, 1, 0}, kPi / 2, 1};
    item.near("the point (1, 2, -4) of the page of lesson 04, in clip space,",
              STUDENT(to_clip)({1, 2, -4}, front, 1.5f), Vec4(2 / 3.0f, 2, 3, 4), 1e-5,
              {{Vec4(1 / 6.0f, 0.5f, 0.75f, 1), "This is after the division by w. Leave the division to draw."},
               {Vec4(1.5f, 2, 3, 4), "x must be divided by the aspect, not multiplied."},
               {Vec4(1, 2, 3, 4), "The aspect plays no part: x is divided by it."},
               {Vec4(-2 / 3.0f, 2, 3, 4), "The camera's x axis points left: it is up × back, in this order."},
               {Vec4(2 / 3.0f, -2, 3, 4), "y points up in clip space."},
               {Vec4(2 / 3.0f, 2, 4, 4), "z is w - near."},
               {Vec4(2 / 3.0f, 2, -5, -4), "w is the distance in front of the eye, which looks along -z: w = -z."}});
    for (int i = 0; i < 100; ++i) {
        Rng& rng = item.random();
        const Vec3d back = rng.unit_vector();
        Vec3d up = rng.unit_vector();
        while (length(cross(up, back)) < 0.4) up = rng.unit_vector();
        const Vec3 target(rng.unit_vector() * rng.uniform(0, 3)), p(rng.unit_vector() * rng.uniform(0, 5));
        const Camera camera{target + Vec3(back * rng.uniform(0.5, 5)), target, Vec3(up * rng.uniform(0.5, 2)),
                            static_cast<float>(rng.uniform(0.4, 2)), static_cast<float>(rng.uniform(0.05, 1))};
        const auto aspect = static_cast<float>(rng.uniform(0.5, 2));
        const auto as_float = [](Vec4d v) {
            const Vec3 xyz(Vec3d(v.x, v.y, v.z));
            return Vec4(xyz, static_cast<float>(v.w));
        };
        const Vec4d right = clip_point(p, camera, d(aspect));
        item.near(message("the point ", describe(p), " seen from ", describe(camera.eye), " toward ",
                          describe(camera.target), ", up ", describe(camera.up), ","),
                  STUDENT(to_clip)(p, camera, aspect), as_float(right), 1e-3,
                  {{as_float({-right.x, right.y, right.z, right.w}),
                    "The camera's x axis points left: it is up × back, in this order."},
                   {as_float({right.x, -right.y, right.z, right.w}), "y points up in clip space."}});
    }
}

LAB_ITEM(10, "clip_near") {
    // The uv of the whole triangle are (0, 0), (1, 0), (0, 1), so areas can be measured by them.
    const auto area = [](const Triangle& t) {
        const Vec2d ab = Vec2d(t[1].uv) - Vec2d(t[0].uv), ac = Vec2d(t[2].uv) - Vec2d(t[0].uv);
        return ab.x * ac.y - ab.y * ac.x;
    };
    for (int i = 0; i < 240; ++i) {
        Rng& rng = item.random();
        const auto corner = [&](int k) {
            const double z = rng.uniform(0.1, 3) * ((i >> k) % 2 ? 1 : -1), x = rng.uniform(-2, 2);
            return Vec4(Vec3(Vec3d(x, rng.uniform(-2, 2), z)), static_cast<float>(z + 0.2));
        };
        const Vec4 a = corner(0), b = corner(1), c = corner(2);
        const Triangle t{Vertex{a, {0, 0}}, Vertex{b, {1, 0}}, Vertex{c, {0, 1}}};
        const auto parts = STUDENT(clip_near)(t);
        double whole = 0, sum = 0, absolute = 0; // what the examiner's own clipping leaves, and the student's
        for (const auto& part : clipped({Point{Vec4d(d(a.x), d(a.y), d(a.z), d(a.w)), {0, 0}},
                                         Point{Vec4d(d(b.x), d(b.y), d(b.z), d(b.w)), {1, 0}},
                                         Point{Vec4d(d(c.x), d(c.y), d(c.z), d(c.w)), {0, 1}}},
                                        {})) {
            const Vec2d ab = part[1].uv - part[0].uv, ac = part[2].uv - part[0].uv;
            whole += ab.x * ac.y - ab.y * ac.x;
        }
        const std::string name = message("For the triangle with z = ", a.z, ", ", b.z, ", ", c.z, " ");
        item.require(parts.size() <= 2, message(name, "there are ", parts.size(), " parts, at most 2 are possible."));
        for (const Triangle& part : parts) {
            sum += area(part), absolute += std::abs(area(part));
            for (const Vertex& v : part) {
                item.require(v.clip.z > -1e-4f,
                             message(name, "a part has a corner with z = ", v.clip.z, ", behind the near plane."));
                const float u = v.uv.x, w = v.uv.y;
                item.near(message("the place of the new corner with uv ", describe(v.uv)), v.clip,
                          a * (1 - u - w) + b * u + c * w, 1e-3);
            }
        }
        item.require(parts.size() > 0 || whole < 1e-4,
                     message(name, "nothing is left, but a part of it is in front: draw that part."));
        item.require(std::abs(absolute - whole) < 1e-3,
                     message(name, "the part in front has ", describe_number(100 * whole),
                             " % of the area, and yours has ", describe_number(100 * absolute),
                             " %. An outline of four corners 0, 1, 2, 3 becomes the triangles 0 1 2 and 0 2 3."));
        item.require(sum > whole - 1e-3, message(name, "a part has the opposite winding of the original."));
    }
}

LAB_ITEM(15, "rasterize: every pixel once, with its weights") {
    require_fan(item);
    Rng& rng = item.random();
    for (int i = 0; i < 60; ++i) {
        const double reach = i % 3 == 0 ? 20000 : i % 3 == 1 ? 30 : 2;
        const double x = rng.uniform(0, kColumns), y = rng.uniform(0, kRows);
        const auto corner = [&] { // on the grid
            const double px = std::round((x + rng.uniform(-reach, reach)) * 256) / 256;
            return Vec2(Vec2d(px, std::round((y + rng.uniform(-reach, reach)) * 256) / 256));
        };
        const Vec2 a = corner(), b = corner(), c = corner();
        const std::string name = message("the triangle ", describe(a), ", ", describe(b), ", ", describe(c));
        Image<int> right(kColumns, kRows, 0), shifted(kColumns, kRows, 0);
        Image<Vec3> weights(kColumns, kRows);
        lesson::for_each_pixel(a, b, c, kColumns, kRows,
                               [&](int px, int py, Vec3 w) { ++right(px, py), weights(px, py) = w; });
        lesson::for_each_pixel(a + kHalf, b + kHalf, c + kHalf, kColumns, kRows,
                               [&](int px, int py, Vec3) { ++shifted(px, py); });
        const auto fragments = STUDENT(rasterize)(a, b, c, kColumns, kRows);
        const std::string overflow =
            "This is what edge functions of 32 bits give: compute them, and the area, in 64 bits.";
        item.coverage(name, counts_of(item, fragments, kColumns, kRows), right,
                      {{shifted, kAtCorners},
                       {coverage_with_overflow(a, b, c, kColumns, kRows), overflow},
                       {Image<int>(kColumns, kRows, 0), "Nothing is covered."}});
        for (const auto& f : fragments) {
            const Vec3 w = weights(f.x, f.y);
            item.near(
                message("the weights at (", f.x, ", ", f.y, ") of ", name), f.weights, w, 2e-3,
                {{Vec3{w.x, w.z, w.y}, "Where two corners were swapped, their weights must be swapped back."},
                 {Vec3{w.z, w.x, w.y}, "Each weight is at the wrong corner: that of a comes from the edge b c."},
                 {Vec3{w.y, w.z, w.x}, "Each weight is at the wrong corner: that of a comes from the edge b c."}});
        }
    }
    item.require(STUDENT(rasterize)({1, 1}, {20, 20}, {10, 10}, kColumns, kRows).empty(),
                 "A triangle whose corners lie on one line covers nothing.");
}

LAB_ITEM(10, "perspective_weights") {
    item.near("the middle of an edge from w = 1 to w = 3", STUDENT(perspective_weights)({0.5f, 0.5f, 0}, {1, 3, 7}),
              Vec3{0.75f, 0.25f, 0}, 1e-6,
              {{Vec3{0.5f, 0.5f, 0}, "These are the weights in the image. In space the nearer end has more weight."},
               {Vec3{0.25f, 0.75f, 0}, "The nearer end must get more weight: divide by w, don't multiply."},
               {Vec3{0.5f, 1 / 6.0f, 0}, "They must sum to 1: divide by their sum."}});
    for (int i = 0; i < 100; ++i) {
        // A point on a triangle in space by its weights there; the weights in the image follow from them.
        Rng& rng = item.random();
        Vec3d b(rng.uniform(0, 1), rng.uniform(0, 1), rng.uniform(0, 1));
        b = b / (b.x + b.y + b.z);
        const Vec3d w(rng.uniform(0.2, 5), rng.uniform(0.2, 5), rng.uniform(0.2, 5));
        const double at = dot(b, w);
        item.near(message("the weights for w = ", describe(Vec3(w))),
                  STUDENT(perspective_weights)(Vec3(b * w / at), Vec3(w)), Vec3(b), 1e-4);
    }
}

LAB_ITEM(10, "sample") {
    ImageRgb texture(4, 2);
    for (int x = 0; x < 4; ++x)
        texture(x, 0) = Rgb(static_cast<float>(x), 1, 0), texture(x, 1) = Rgb(static_cast<float>(x), 0, 0);
    const auto at = [&](float u, float v) { return STUDENT(sample)(texture, {u, v}); };
    const std::string flipped =
        "The texture stands on its head: v = 0 is the bottom, which is the last row of the image.";
    item.near("the center of the lower left texel", at(0.125f, 0.25f), Rgb(0, 0, 0), 1e-5,
              {{Rgb(0, 1, 0), flipped},
               {Rgb(0.5f, 0.5f, 0), "A texel's center is half a texel from its corner: subtract 0.5."}});
    item.near("the center of the third texel above", at(0.625f, 0.75f), Rgb(2, 1, 0), 1e-5, {{Rgb(2, 0, 0), flipped}});
    item.near("a point between two texels", at(0.25f, 0.25f), Rgb(0.5f, 0, 0), 1e-5,
              {{Rgb(1, 0, 0), "This is the nearest texel: mix the four around the point."},
               {Rgb(0, 0, 0), "This is the nearest texel: mix the four around the point."}});
    item.near("the middle of the texture", at(0.5f, 0.5f), Rgb(1.5f, 0.5f, 0), 1e-5);
    item.near("the left edge, halfway between the first texel and the last", at(0, 0.25f), Rgb(1.5f, 0, 0), 1e-5,
              {{Rgb(0, 0, 0), "The texture repeats: left of the first texel is the last one."}});
    item.near("u = -0.875, which is u = 0.125,", at(-0.875f, 0.25f), Rgb(0, 0, 0), 1e-5);
    item.near("v = 1.75, which is v = 0.75,", at(0.625f, 1.75f), Rgb(2, 1, 0), 1e-5);
    const ImageRgb random = checkerboard(5, 3);
    for (int i = 0; i < 200; ++i) {
        const Vec2d uv(item.random().uniform(-2, 3), item.random().uniform(-2, 3));
        item.near(message("the texture at ", describe(Vec2(uv))), STUDENT(sample)(random, Vec2(uv)),
                  sample_texture(random, Vec2d(Vec2(uv))), 1e-3);
    }
}

LAB_ITEM(10, "draw: a floor that passes below the eye, and walls that cross") {
    Mesh mesh;
    add_quad(mesh, {Vec3{-3, 0, 3}, Vec3{3, 0, 3}, Vec3{3, 0, -5}, Vec3{-3, 0, -5}});
    const Camera camera{{0.4f, 0.9f, 1}, {-0.2f, 0.3f, -1.5f}, {0, 1, 0}, 1.1f, 0.05f};
    check_picture(item, "a floor", mesh, camera, checkerboard(8, 4), 160, 120);
    add_quad(mesh, {Vec3{-1.5f, 0, -2.5f}, Vec3{1.2f, 0, -0.7f}, Vec3{1.2f, 1.2f, -0.7f}, Vec3{-1.5f, 1.2f, -2.5f}});
    add_quad(mesh,
             {Vec3{1.4f, -0.2f, -2.6f}, Vec3{-1.3f, -0.2f, -0.9f}, Vec3{-1.3f, 0.9f, -0.9f}, Vec3{1.4f, 0.9f, -2.6f}});
    check_picture(item, "a floor and two walls that cross", mesh, camera, checkerboard(8, 4), 160, 120);
}

LAB_ITEM(15, "draw: the amphora from three places") {
    check_picture(item, "the amphora", amphora(), {{0.75f, 0.95f, 1.5f}, {0, 0.43f, 0}, {0, 1, 0}, 0.62f, 0.1f},
                  amphora_texture(), 150, 180);
    check_picture(item, "the amphora from above", amphora(), {{0.3f, 1.7f, 0.5f}, {0, 0.6f, 0}, {0, 1, 0}, 0.6f, 0.1f},
                  amphora_texture(), 180, 150);
    check_picture(item, "the amphora from inside, with a checkerboard for its texture", amphora(),
                  {{0.05f, 0.3f, 0.04f}, {0, 0.75f, 0}, {0, 0, 1}, 1.7f, 0.02f}, checkerboard(16, 8), 150, 150);
}

LAB_ITEM(10, "the time budget: a large picture of the amphora") {
    constexpr int kWidth = 240, kHeight = 300;
    const Camera camera{{0.5f, 0.8f, 1.5f}, {0, 0.45f, 0}, {0, 1, 0}, 0.65f, 0.1f};
    const Rgb background(0.02f, 0.03f, 0.06f);
    item.limit(60);
    const ImageRgb found = STUDENT(draw)(amphora(), camera, amphora_texture(), kWidth, kHeight, background);
    const double seconds = item.seconds();
    double plain = 0; // processor time of the slower of two runs: a budget that is too large harms nobody
    ImageRgb expected;
    for (int run = 0; run < 2; ++run) {
        const std::clock_t start = std::clock();
        expected = render(amphora(), camera, amphora_texture(), kWidth, kHeight, background);
        plain = std::max(plain, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    }
    item.require(found.size() == expected.size() && wrong_pixels(found, expected, kTolerance) <= expected.size() / 100,
                 "The large picture is not right: mend the items above first.");
    item.require(seconds <= 20 * plain,
                 message("Your picture took ", describe_number(seconds), " s of processor time, and the budget is ",
                         describe_number(20 * plain),
                         " s, 20 times what the examiner's plain renderer takes here. Does "
                         "rasterize look at every pixel of the image, rather than at those around the triangle?"));
}
