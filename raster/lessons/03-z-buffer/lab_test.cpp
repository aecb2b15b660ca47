// The examiner of raster lab 03. Lesson 02 tells which pixels a triangle covers. The expected triangle of a pixel is
// the nearest of all that cover it, found in double precision without a depth buffer.
#include "raster/lessons/02-triangles/triangle.h"
#include "raster/lessons/03-z-buffer/lab.h"
#include "tests/grading/judge.h"

#include <algorithm>
#include <cmath>
#include <string>

using namespace duet;
using namespace duet::grading;
using lab::Triangle;

LAB_TITLE("raster-03", "The z-buffer")

namespace {

using Triangles = std::vector<Triangle>;
constexpr int kWidth = 40, kHeight = 30;
const Rgb kBackground(0.05f, 0.05f, 0.1f);

/// What a pixel's fragment of one triangle is: its depth in double, and its color.
struct Fragment {
    double z;
    Rgb color;
};
using Fragments = std::vector<Fragment>; // of one pixel, in the order of the list

enum class DepthRule { kInterpolated, kMean, kFirstCorner, kTurned };
std::vector<Fragments> fragments(const Triangles& triangles, DepthRule rule = DepthRule::kInterpolated) {
    std::vector<Fragments> pixels(static_cast<std::size_t>(kWidth * kHeight));
    for (const Triangle& t : triangles) {
        const auto& p = t.corners;
        lesson::for_each_pixel({p[0].x, p[0].y}, {p[1].x, p[1].y}, {p[2].x, p[2].y}, kWidth, kHeight,
                               [&](int x, int y, Vec3 w) {
                                   const Vec3d z(Vec3(p[0].z, p[1].z, p[2].z)), weights(w);
                                   double depth = dot(z, weights);
                                   if (rule == DepthRule::kMean) depth = (z.x + z.y + z.z) / 3;
                                   if (rule == DepthRule::kFirstCorner) depth = z.x;
                                   if (rule == DepthRule::kTurned)
                                       depth = dot(z, Vec3d{weights.z, weights.x, weights.y});
                                   pixels[static_cast<std::size_t>(y * kWidth + x)].push_back(
                                       {depth, t.colors[0] * w.x + t.colors[1] * w.y + t.colors[2] * w.z});
                               });
    }
    return pixels;
}

/// An image, of each pixel the fragment that `pick` chooses: it gets one or more fragments.
template <typename Pick> ImageRgb image_of(const std::vector<Fragments>& pixels, const Pick& pick) {
    ImageRgb image(kWidth, kHeight, kBackground);
    for (std::size_t i = 0; i < pixels.size(); ++i)
        if (!pixels[i].empty()) image[i] = pick(pixels[i]);
    return image;
}
bool nearer(const Fragment& a, const Fragment& b) { return a.z < b.z; }
Rgb first_nearest(const Fragments& f) { return std::min_element(f.begin(), f.end(), nearer)->color; }
Rgb last_nearest(const Fragments& f) { return std::min_element(f.rbegin(), f.rend(), nearer)->color; }
Rgb farthest(const Fragments& f) { return std::max_element(f.begin(), f.end(), nearer)->color; }
Rgb last(const Fragments& f) { return f.back().color; }
Rgb first(const Fragments& f) { return f.front().color; }

/// The depths rounded to so many levels; `shift` is 0.5 if they are rounded to the nearest.
std::vector<Fragments> rounded(std::vector<Fragments> pixels, double levels, double shift = 0.5) {
    for (Fragments& pixel : pixels)
        for (Fragment& f : pixel) f.z = std::floor(f.z * levels + shift);
    return pixels;
}

/// Whether rounding of a float could change what is seen somewhere, with exact depths or with so many levels.
bool is_ambiguous(const std::vector<Fragments>& pixels, double levels) {
    for (const Fragments& pixel : pixels) {
        for (const Fragment& f : pixel)
            if (levels > 0 && std::abs(f.z * levels + 0.5 - std::round(f.z * levels + 0.5)) < 1e-6 * levels)
                return true;
        for (std::size_t i = 0; levels == 0 && i < pixel.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                if (pixel[i].z != pixel[j].z && std::abs(pixel[i].z - pixel[j].z) < 1e-5) return true;
    }
    return false;
}

/// Random triangles, many of which pass through each other. The depth at each corner is anything.
Triangles pile(Rng& rng, int count, double levels = 0) {
    for (;;) {
        Triangles triangles;
        for (int i = 0; i < count; ++i) {
            Triangle t;
            for (std::size_t k = 0; k < 3; ++k) {
                t.corners[k] = Vec3(Vec3d(rng.uniform(-8, kWidth + 8), rng.uniform(-8, kHeight + 8), rng.uniform()));
                t.colors[k] = Rgb(Rgbd(rng.uniform(), rng.uniform(), rng.uniform()));
            }
            triangles.push_back(t);
        }
        if (!is_ambiguous(fragments(triangles), levels)) return triangles;
    }
}

/// A triangle of one color.
Triangle flat(Vec3 a, Vec3 b, Vec3 c, Rgb color) { return {{a, b, c}, {color, color, color}}; }
const Rgb kRed(0.9f, 0.1f, 0.1f), kGreen(0.1f, 0.8f, 0.2f), kBlue(0.1f, 0.3f, 0.9f), kWhite(0.9f, 0.9f, 0.9f);

void check(Item& item, const std::string& name, const Triangles& triangles) {
    const std::vector<Fragments> right = fragments(triangles);
    const auto by = [&](DepthRule rule) { return image_of(fragments(triangles, rule), first_nearest); };
    item.image(name, STUDENT(draw)(triangles, kWidth, kHeight, kBackground), image_of(right, first_nearest), 1e-4,
               {{by(DepthRule::kMean), "Each triangle has one depth, its mean: each pixel needs a depth of its own."},
                {by(DepthRule::kFirstCorner), "Each triangle has one depth, that of its first corner: each pixel needs "
                                              "a depth of its own."},
                {by(DepthRule::kTurned), "The weights are at the wrong corners when the depth is computed."},
                {ImageRgb(kWidth, kHeight, kBackground), "Nothing is drawn. Does the depth buffer begin with infinity, "
                                                         "so that the first triangle is nearer?"},
                {image_of(right, last_nearest), "Of triangles at the same depth the last one is seen: test with <, not "
                                                "with <=."},
                {image_of(right, farthest), "The farthest triangle is seen: less depth is nearer."},
                {image_of(right, last), "Each triangle is over those before, whatever its depth. Is the depth of a "
                                        "pixel stored when it is drawn?"},
                {image_of(right, first), "Each triangle is under those before, whatever its depth."}});
}

} // namespace

LAB_ITEM(0, "the picture") {
    Triangles cycle;
    for (int i = 0; i < 3; ++i) {
        const auto at = [i](float x, float y, float z) {
            const float angle = 2 * kPi * static_cast<float>(i) / 3, c = std::cos(angle), s = std::sin(angle);
            return Vec3{80 + x * c - y * s, 64 + x * s + y * c, z};
        };
        const Rgb color = std::array{kRed, kGreen, kBlue}[static_cast<std::size_t>(i)];
        cycle.push_back({{at(-60, 34, 0), at(64, 8, 1), at(62, 48, 1)}, {color, color * 0.4f, color * 0.4f}});
    }
    item.show("three triangles, each over the next one", STUDENT(draw)(cycle, 160, 120, Rgb(0.02f, 0.03f, 0.08f)));
}

LAB_ITEM(10, "the depth at a point of a triangle") {
    const auto check_depth = [&item](Vec3 z, Vec3 w, double right) {
        const Triangle t = flat({0, 0, z.x}, {9, 0, z.y}, {0, 9, z.z}, kRed);
        item.near(
            message("the depth for corners of depth ", describe(z), " and the weights ", describe(w)),
            STUDENT(depth_at)(t, w), static_cast<float>(right), 1e-5,
            {{(z.x + z.y + z.z) / 3, "This is the mean of the three corners: use the weights."},
             {z.x, "This is the depth of the first corner: mix all three by the weights."},
             {dot(z, Vec3{w.z, w.x, w.y}), "The weights are at the wrong corners: weights.x belongs to corners[0]."},
             {dot(z, Vec3{w.y, w.z, w.x}), "The weights are at the wrong corners: weights.x belongs to corners[0]."},
             {dot(z, w) / 3, "The weights sum to 1 already: don't divide by 3."},
             {1 - dot(z, w), "It is turned around: a depth of 1 is far."}});
    };
    check_depth({0.25f, 0.5f, 1}, {0.5f, 0.25f, 0.25f}, 0.5); // by hand: 0.125 + 0.125 + 0.25
    check_depth({0.1f, 0.6f, 0.9f}, {0, 0, 1}, 0.9);
    for (int i = 0; i < 50; ++i) {
        const double a = item.random().uniform(), b = item.random().uniform(0, 1 - a);
        const Vec3d z(item.random().uniform(), item.random().uniform(), item.random().uniform());
        const Vec3d w{a, b, 1 - a - b};
        check_depth(Vec3(z), Vec3(w), dot(z, w));
    }
}

LAB_ITEM(10, "the depth test") {
    const auto check_pass = [&item](float z, float stored, bool right, const std::string& text) {
        item.equal(message("the test of depth ", describe(z), " where ", describe(stored), " is stored"),
                   STUDENT(passes)(z, stored), right, {{!right, text}});
    };
    check_pass(0.5f, kInfinity, true, "Infinity stands for nothing drawn yet, so everything is nearer.");
    check_pass(0.25f, 0.5f, true, "Less depth is nearer: is the comparison turned around?");
    check_pass(0.75f, 0.5f, false, "More depth is farther: is the comparison turned around?");
    check_pass(0.5f, 0.5f, false,
               "Both are equal: test with <, not with <=. Else the order of drawing decides what is "
               "seen.");
    check_pass(std::nextafter(0.5f, 0.0f), 0.5f, true,
               "It is nearer by the least that a float can tell: no tolerance is "
               "needed.");
    check_pass(std::nanf(""), kInfinity, false,
               "NaN isn't nearer than anything. !(z >= stored) is true for it, and "
               "z < stored is false.");
}

LAB_ITEM(15, "depths rounded to levels") {
    const auto check_level = [&item](double z, int bits, int right) {
        const double levels = std::pow(2.0, bits) - 1, clamped = std::clamp(z, 0.0, 1.0);
        item.equal(
            message("the level of depth ", describe(z), " with ", bits, " bits"),
            STUDENT(quantize)(static_cast<float>(z), bits), right,
            {{static_cast<int>(z * levels), "It is cut off, not rounded to the nearest level."},
             {static_cast<int>(std::lround(clamped * (levels + 1))),
              "2^bits levels have the numbers 0 to 2^bits - 1, so depth 1 is 2^bits - 1: multiply by that."},
             {static_cast<int>(clamped * (levels + 1)), "2^bits levels have the numbers 0 to 2^bits - 1: multiply "
                                                        "by 2^bits - 1, then round."},
             {static_cast<int>(std::lround(z * levels)), "Depths below 0 count as 0, depths above 1 as 1."},
             {static_cast<int>(std::lround(clamped * bits)), "bits is the number of bits, not of levels: there are "
                                                             "2^bits levels."}});
    };
    check_level(0, 8, 0);
    check_level(1, 8, 255);
    check_level(0.4, 2, 1); // by hand: 0.4·3 = 1.2
    check_level(0.6, 2, 2); // 0.6·3 = 1.8
    check_level(1.5, 4, 15);
    check_level(-0.5, 4, 0);
    for (int i = 0; i < 100; ++i) {
        const int bits = item.random().integer(1, 16);
        const double levels = std::pow(2.0, bits) - 1;
        const int right = item.random().integer(0, static_cast<int>(levels));
        check_level(std::clamp((right + item.random().uniform(-0.4, 0.4)) / levels, 0.0, 1.0), bits, right);
    }
}

LAB_ITEM(20, "the nearest triangle is seen") {
    const Triangle front = flat({5, 4, 0.3f}, {32, 8, 0.3f}, {10, 27, 0.3f}, kRed);
    const Triangle back = flat({8, 2, 0.7f}, {38, 14, 0.7f}, {18, 28, 0.7f}, kBlue);
    check(item, "one triangle", {front});
    check(item, "a near triangle, then a far one", {front, back});
    check(item, "a far triangle, then a near one", {back, front});
    Triangle copy = front;
    copy.colors = {kGreen, kGreen, kGreen};
    check(item, "two triangles at the same place, the red one first", {front, copy});
    check(item, "two triangles at the same place, the green one first", {copy, front});
}

LAB_ITEM(20, "triangles that can't be sorted") {
    for (int i = 0; i < 12; ++i)
        check(item, message("the pile number ", i + 1, " of 12 random ones"), pile(item.random(), 5));
    check(item, "two triangles that pass through each other",
          {flat({4, 3, 0.1f}, {36, 3, 0.9f}, {20, 28, 0.5f}, kRed),
           flat({4, 3, 0.9f}, {36, 3, 0.1f}, {20, 28, 0.48f}, kBlue)});
}

LAB_ITEM(15, "depth fighting, made on purpose") {
    for (const int bits : {2, 4, 6}) {
        const double levels = std::pow(2.0, bits) - 1;
        for (int i = 0; i < 6; ++i) {
            const Triangles triangles = pile(item.random(), 5, levels);
            const std::vector<Fragments> exact = fragments(triangles), right = rounded(exact, levels);
            item.image(
                message("a pile of triangles, with ", bits, " bits of depth"),
                STUDENT(draw_quantized)(triangles, kWidth, kHeight, kBackground, bits), image_of(right, first_nearest),
                1e-4,
                {{ImageRgb(kWidth, kHeight, kBackground), "Nothing is drawn: does the depth buffer begin with "
                                                          "more than the last level?"},
                 {image_of(right, last_nearest), "Of triangles on the same level the last one is seen: the first "
                                                 "one must stay."},
                 {image_of(exact, first_nearest), "The depths are compared as they are: round them first."},
                 {image_of(rounded(exact, levels, 0), first_nearest), "The depths are cut off, not rounded to the "
                                                                      "nearest level."},
                 {image_of(rounded(exact, levels + 1), first_nearest), "There is a level too much: depth 1 is "
                                                                       "2^bits - 1."},
                 {image_of(right, farthest), "The farthest triangle is seen: less depth is nearer."}});
        }
    }
}

LAB_ITEM(10, "each image begins with empty depths") {
    const auto square = [](float x, float z, Rgb color) {
        return Triangles{flat({x, 6, z}, {x + 16, 6, z}, {x + 16, 24, z}, color),
                         flat({x, 6, z}, {x + 16, 24, z}, {x, 24, z}, color)};
    };
    const std::vector<Triangles> frames{square(4, 0.2f, kRed), square(12, 0.5f, kGreen), square(20, 0.8f, kWhite)};
    const std::vector<ImageRgb> found = STUDENT(draw_frames)(frames, kWidth, kHeight, kBackground);
    item.require(found.size() == frames.size(), message("There are ", found.size(), " images; expected ", frames.size(),
                                                        ", one for each list of triangles."));
    std::vector<Fragments> before(static_cast<std::size_t>(kWidth * kHeight));
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const std::vector<Fragments> now = fragments(frames[i]);
        // The mistakes: the depths stay, and so this image is hidden by the one before; or the colors stay, too.
        ImageRgb hidden(kWidth, kHeight, kBackground), over(kWidth, kHeight, kBackground), both = over;
        for (std::size_t k = 0; k < now.size(); ++k) {
            if (!now[k].empty() && before[k].empty()) hidden[k] = now[k].front().color;
            if (!before[k].empty()) both[k] = before[k].front().color, over[k] = before[k].back().color;
            if (!now[k].empty()) over[k] = now[k].front().color;
            if (!now[k].empty() && before[k].empty()) both[k] = now[k].front().color;
            before[k].insert(before[k].end(), now[k].begin(), now[k].end());
        }
        item.image(
            message("image ", i + 1, " of 3"), found[i], image_of(now, first_nearest), 1e-4,
            {{hidden, "The depths of the image before are still there and hide this one: set all of the depth "
                      "buffer to infinity before each image."},
             {both, "The image before is still there, with its depths: clear colors and depths before each image."},
             {over, "The colors of the image before are still there: begin each image with the background."},
             {ImageRgb(kWidth, kHeight, kBackground), "Nothing is drawn."}});
    }
}
