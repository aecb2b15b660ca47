// The examiner of raster lab 01. Expected pixels are computed one by one from a division of whole numbers, without any
// running error.
#include "raster/lessons/01-lines/lab.h"
#include "tests/grading/judge.h"

#include <algorithm>
#include <cmath>
#include <string>

using namespace duet;
using namespace duet::grading;
using lab::Line, lab::Pixel;

LAB_TITLE("raster-01", "Lines")

namespace {

using Pixels = std::vector<Pixel>;
enum class Ties { kLower, kUpper, kTowardEnd, kTowardStart, kCutOff };

std::int64_t floor_divided(std::int64_t a, std::int64_t b) { return a / b - (a % b != 0 && (a < 0) != (b < 0)); }

/// start + i·rise/count, rounded to the nearest whole number. Halfway between two, `ties` decides.
int rounded(int start, int rise, int i, int count, Ties ties) {
    const std::int64_t product = std::int64_t{i} * rise;
    const bool up =
        ties == Ties::kUpper || (ties == Ties::kTowardEnd && rise > 0) || (ties == Ties::kTowardStart && rise < 0);
    if (ties == Ties::kCutOff) return start + static_cast<int>(product / count);
    const std::int64_t whole =
        up ? floor_divided(2 * product + count, 2 * count) : -floor_divided(count - 2 * product, 2 * count);
    return start + static_cast<int>(whole);
}

Pixels line(Pixel a, Pixel b, Ties ties = Ties::kLower) {
    const int dx = b.x - a.x, dy = b.y - a.y, count = std::max(std::abs(dx), std::abs(dy));
    Pixels pixels{a};
    for (int i = 1; i <= count; ++i)
        pixels.push_back(std::abs(dx) >= std::abs(dy)
                             ? Pixel{dx > 0 ? a.x + i : a.x - i, rounded(a.y, dy, i, count, ties)}
                             : Pixel{rounded(a.x, dx, i, count, ties), dy > 0 ? a.y + i : a.y - i});
    return pixels;
}

/// One pixel for each column, also of steep lines.
Pixels columns_only(Pixel a, Pixel b) {
    Pixels pixels;
    const int dx = b.x - a.x, step = dx < 0 ? -1 : 1;
    for (int i = 0; i <= std::abs(dx); ++i)
        pixels.push_back({a.x + step * i, dx == 0 ? a.y : rounded(a.y, b.y - a.y, i, std::abs(dx), Ties::kLower)});
    return pixels;
}

std::vector<Mistake<Pixels>> mistakes(Pixel a, Pixel b) {
    const Pixels right = line(a, b);
    Pixels backward(right.rbegin(), right.rend()), without_last(right.begin(), right.end() - 1),
        without_first(right.begin() + 1, right.end()), mirrored, stairs{a};
    for (const Pixel p : right) mirrored.push_back({p.x, 2 * a.y - p.y});
    for (const Pixel p : right) { // never a diagonal step
        if (p.x != stairs.back().x && p.y != stairs.back().y) stairs.push_back({p.x, stairs.back().y});
        if (p.x != stairs.back().x || p.y != stairs.back().y) stairs.push_back(p);
    }
    const std::string equally_near =
        " The ends of the line must not matter: of two pixels equally near, take the one with the smaller y (or, in a "
        "steep line, the smaller x).";
    return {
        {Pixels{}, "There are no pixels: which way do x and y go in this line?"},
        {without_last, "The last pixel is missing: the end b belongs to the line."},
        {without_first, "The first pixel is missing: the line begins with a itself."},
        {columns_only(a, b), "A steep line has gaps: there is one pixel for each column, but this line has more rows "
                             "than columns. Take one pixel for each row."},
        {columns_only(b, a), "A steep line has gaps: there is one pixel for each column, but this line has more rows "
                             "than columns. Take one pixel for each row."},
        {Pixels{a}, "It ends after the first pixel: which way do x and y go in this line?"},
        {backward, "The pixels are in reverse order: from b to a. Are the ends swapped where x goes left?"},
        {line(a, b, Ties::kCutOff), "The coordinates are cut off, not rounded to the nearest pixel."},
        {line(a, b, Ties::kUpper), "Where two pixels are equally near, this takes the one with the larger "
                                   "coordinate." +
                                       equally_near},
        {line(a, b, Ties::kTowardEnd), "Where two pixels are equally near, this depends on the end where you begin: "
                                       "it takes the one on the far side." +
                                           equally_near},
        {line(a, b, Ties::kTowardStart), "Where two pixels are equally near, this depends on the end where you "
                                         "begin: it takes the one on the near side." +
                                             equally_near},
        {mirrored, "The line goes the wrong way in y: y must fall where b.y < a.y."},
        {stairs, "x and y never change in the same step: a diagonal step is one pixel, not two."}};
}

void check_line(Item& item, Pixel a, Pixel b) {
    item.near(message("the list of pixels from ", describe(a), " to ", describe(b)), STUDENT(line_pixels)(a, b),
              line(a, b), 0, mistakes(a, b));
}

using Put = std::function<void(ImageRgb&, Pixel, Rgb)>;
void put_inside(ImageRgb& image, Pixel p, Rgb color) {
    if (p.x >= 0 && p.x < image.width() && p.y >= 0 && p.y < image.height()) image(p.x, p.y) = color;
}
ImageRgb drawn(const std::vector<Line>& lines, int width, int height, const Put& put = put_inside) {
    ImageRgb image(width, height, Rgb(0.02f));
    for (const Line& l : lines)
        for (const Pixel p : line(l.a, l.b)) put(image, p, l.color);
    return image;
}

void check_image(Item& item, const std::string& name, const std::vector<Line>& lines, int width, int height) {
    const std::vector<Line> reversed(lines.rbegin(), lines.rend());
    std::vector<Line> clamped = lines;
    for (Line& l : clamped)
        for (Pixel* p : {&l.a, &l.b}) *p = {std::clamp(p->x, 0, width - 1), std::clamp(p->y, 0, height - 1)};
    const auto wrapped = [](ImageRgb& image, Pixel p, Rgb color) {
        const std::int64_t index = std::int64_t{p.y} * image.width() + p.x;
        if (index >= 0 && index < static_cast<std::int64_t>(image.size()))
            image[static_cast<std::size_t>(index)] = color;
    };
    const auto on_border = [](ImageRgb& image, Pixel p, Rgb color) {
        image(std::clamp(p.x, 0, image.width() - 1), std::clamp(p.y, 0, image.height() - 1)) = color;
    };
    const auto short_of_border = [](ImageRgb& image, Pixel p, Rgb color) {
        if (p.x < image.width() - 1 && p.y < image.height() - 1) put_inside(image, p, color);
    };
    const auto without_first = [](ImageRgb& image, Pixel p, Rgb color) {
        if (p.x > 0 && p.y > 0) put_inside(image, p, color);
    };
    item.image(
        name, STUDENT(draw_lines)(lines, width, height, Rgb(0.02f)), drawn(lines, width, height), 1e-4,
        {{drawn(clamped, width, height), "The ends outside of the image were moved to its border. That turns the "
                                         "line: test each pixel instead."},
         {drawn(lines, width, height, on_border), "Pixels outside of the image were drawn on its border: leave "
                                                  "them out."},
         {drawn(lines, width, height, wrapped), "A pixel beside the image was drawn in another row: test x, too, "
                                                "not only the index y·width + x."},
         {drawn(lines, width, height, short_of_border), "The last column and the last row are missing: x may be "
                                                        "width - 1, and y may be height - 1."},
         {drawn(lines, width, height, without_first), "Column 0 and row 0 are missing: x and y may be 0."},
         {drawn(reversed, width, height), "An earlier line is over a later one: draw them in their order."},
         {ImageRgb(width, height, Rgb(0.02f)), "Nothing is drawn."}});
}

std::vector<Line> rose(Pixel middle, int count, double near, double far) {
    std::vector<Line> lines;
    for (int i = 0; i < count; ++i) {
        const double angle = 2 * kPiDouble * i / count;
        const auto at = [&](double r) {
            return Pixel{middle.x + static_cast<int>(std::lround(r * std::cos(angle))),
                         middle.y + static_cast<int>(std::lround(r * std::sin(angle)))};
        };
        const auto channel = [angle](double phase) { return static_cast<float>(0.5 + 0.5 * std::cos(angle - phase)); };
        lines.push_back({at(near), at(far), Rgb(channel(0), channel(2.1), channel(4.2))});
    }
    return lines;
}

} // namespace

LAB_ITEM(0, "the picture") {
    item.show("your rose", STUDENT(draw_lines)(rose({80, 60}, 60, 15, 56), 160, 120, Rgb(0.02f, 0.03f, 0.08f)));
}

LAB_ITEM(10, "how many pixels a line has") {
    const auto check = [&item](Pixel a, Pixel b) {
        const int dx = std::abs(b.x - a.x), dy = std::abs(b.y - a.y), found = STUDENT(pixel_count)(a, b);
        item.equal(message("the number of pixels from ", describe(a), " to ", describe(b)), found, std::max(dx, dy) + 1,
                   {{std::max(dx, dy), "This is the number of steps. Both ends are pixels of the line, so it has one "
                                       "pixel more."},
                    {dx + 1, "Only the columns are counted: a steep line has a pixel for each row."},
                    {b.x - a.x + 1, "Only the columns are counted, and from left to right: a line may run to the left, "
                                    "and a steep one has more rows than columns."},
                    {dy + 1, "Only the rows are counted: a gentle line has a pixel for each column."},
                    {dx + dy + 1, "A diagonal step is one step, not two: take the larger of the two numbers."}});
    };
    check({2, 3}, {5, 4});
    check({2, 3}, {3, 9});
    check({5, 4}, {-2, 3});
    check({3, -9}, {2, -19});
    check({7, 7}, {7, 7});
    for (int i = 0; i < 50; ++i) {
        const auto any = [&] { return item.random().integer(-32768, 32768); };
        const Pixel a{any(), any()};
        check(a, {any(), any()});
    }
}

LAB_ITEM(15, "how far a pixel is off the line, as a whole number") {
    const auto check = [&item](Pixel a, Pixel b, Pixel p, std::int64_t right) {
        item.equal(
            message("the error of p = ", describe(p), " for the line from a = ", describe(a), " to b = ", describe(b)),
            STUDENT(line_error)(a, b, p), right,
            {{-right, "Its sign is turned around: the product with p.y - a.y comes first."},
             {static_cast<std::int32_t>(static_cast<std::uint32_t>(right)),
              "This is what 32 bits hold of it: int times int is int. Convert the differences to std::int64_t "
              "before you multiply."},
             {static_cast<std::int64_t>(static_cast<float>(right)),
              "A float has 24 bits only: compute with whole numbers."},
             {std::int64_t{b.x} * p.y - std::int64_t{b.y} * p.x, "The line need not begin at (0, 0): subtract a "
                                                                 "from both b and p."},
             {std::int64_t{b.x - a.x} * (p.x - a.x) - std::int64_t{b.y - a.y} * (p.y - a.y),
              "x is multiplied by x and y by y: the x of the line belongs to the y of the point."},
             {std::abs(right), "Pixels on both sides have the same sign: no absolute value is needed here."}});
    };
    check({0, 0}, {5, 2}, {2, 1}, 1); // by hand: 5·1 - 2·2
    check({0, 0}, {5, 2}, {1, 0}, -2);
    check({3, 4}, {8, 6}, {5, 5}, 1);
    check({3, 4}, {-2, 6}, {3, 4}, 0);
    check({-30000, -30000}, {30000, 29000}, {-30000, 30000}, 3'600'000'000); // 60000·60000
    for (int i = 0; i < 100; ++i) {
        const auto any = [&] { return item.random().integer(-32768, 32768); };
        const Pixel a{any(), any()}, b{any(), any()}, p{any(), any()};
        // By the determinant of the three points, instead of two differences.
        const auto product = [](Pixel u, Pixel v) { return std::int64_t{u.x} * v.y - std::int64_t{u.y} * v.x; };
        check(a, b, p, product(a, b) + product(b, p) + product(p, a));
    }
}

LAB_ITEM(20, "lines that run to the right and gently down") {
    // By hand: y = 0, 0.4, 0.8, 1.2, 1.6, 2 in the columns 0 to 5.
    item.near("the list of pixels from (0, 0) to (5, 2)", STUDENT(line_pixels)(Pixel{0, 0}, Pixel{5, 2}),
              {{0, 0}, {1, 0}, {2, 1}, {3, 1}, {4, 2}, {5, 2}}, 0, mistakes({0, 0}, {5, 2}));
    check_line(item, {4, 4}, {4, 4});
    check_line(item, {2, 3}, {9, 3});
    check_line(item, {2, 3}, {6, 7});
    for (int i = 0; i < 60; ++i) {
        const int dx = 2 * item.random().integer(0, 30) + 1; // odd: no two pixels are equally near
        const Pixel a{item.random().integer(-50, 50), item.random().integer(-50, 50)};
        check_line(item, a, {a.x + dx, a.y + item.random().integer(0, dx)});
    }
}

LAB_ITEM(25, "lines in all directions") {
    check_line(item, {0, 0}, {0, 4});
    check_line(item, {0, 0}, {-4, 0});
    check_line(item, {0, 0}, {0, -4});
    for (const Pixel end : {Pixel{5, 2}, {2, 5}, {-2, 5}, {-5, 2}, {-5, -2}, {-2, -5}, {2, -5}, {5, -2}})
        check_line(item, {0, 0}, end);
    for (const Pixel end : {Pixel{4, 4}, {-4, 4}, {-4, -4}, {4, -4}}) check_line(item, {1, 2}, {1 + end.x, 2 + end.y});
    for (int i = 0; i < 150; ++i) {
        const Pixel a{item.random().integer(-50, 50), item.random().integer(-50, 50)};
        const int major = 2 * item.random().integer(0, 30) + 1, minor = item.random().integer(-major, major);
        const int sign = item.random().uniform() < 0.5 ? 1 : -1;
        check_line(item, a, i % 2 ? Pixel{a.x + sign * major, a.y + minor} : Pixel{a.x + minor, a.y + sign * major});
    }
}

LAB_ITEM(10, "the same pixels from both ends") {
    const auto check = [&item](Pixel a, Pixel b) {
        const Pixels there = STUDENT(line_pixels)(a, b);
        Pixels back = STUDENT(line_pixels)(b, a);
        std::reverse(back.begin(), back.end());
        item.near(message("the list of pixels from ", describe(b), " to ", describe(a), ", read from its end,"), back,
                  there, 0,
                  {{back, message("It differs from that from ", describe(a), " to ", describe(b),
                                  ". Where two pixels are "
                                  "equally near, this depends on the end where you begin: the one with the smaller y "
                                  "(or, in a steep line, the smaller x) must win, whichever way you go.")}});
        check_line(item, a, b);
    };
    for (const Pixel end : {Pixel{2, 1}, {4, 1}, {4, 3}, {1, 2}, {3, 4}}) // halfway between two pixels somewhere
        for (const int x : {1, -1})
            for (const int y : {1, -1}) check({0, 0}, {x * end.x, y * end.y});
    for (int i = 0; i < 100; ++i) {
        const auto any = [&] { return item.random().integer(-30, 30); };
        const Pixel a{any(), any()};
        check(a, {any(), any()});
    }
}

LAB_ITEM(20, "lines that leave the image, and long ones") {
    check_image(item, "a rose inside of the image", rose({20, 15}, 24, 3, 14), 41, 31);
    check_image(item, "a rose larger than the image", rose({20, 15}, 32, 6, 60), 41, 31);
    check_image(item, "a frame of lines on the border",
                {{{0, 0}, {19, 0}, Rgb(1, 0, 0)},
                 {{19, 0}, {19, 9}, Rgb(0, 1, 0)},
                 {{19, 9}, {0, 9}, Rgb(0, 0, 1)},
                 {{0, 9}, {0, 0}, Rgb(1, 1, 0)}},
                20, 10);
    check_image(item, "a line beside the image", {{{-5, 2}, {-2, 7}, Rgb(1)}, {{22, 2}, {25, 7}, Rgb(1)}}, 20, 10);
    std::vector<Line> longest;
    for (int i = 0; i < 12; ++i) {
        const auto far = [&] { return item.random().integer(-32768, 32768); };
        const Pixel a{far(), far()};
        // Opposite ends, so that the line passes through the image.
        longest.push_back(
            {a, {20 - a.x + item.random().integer(-20, 20), 15 - a.y + item.random().integer(-15, 15)}, Rgb(1)});
        for (Pixel* p : {&longest.back().a, &longest.back().b})
            *p = {std::clamp(p->x, -32768, 32768), std::clamp(p->y, -32768, 32768)};
    }
    check_image(item, "lines of 60,000 pixels", longest, 41, 31);
}
