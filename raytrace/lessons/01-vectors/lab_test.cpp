// The examiner of lab 01. Values were computed by hand, or in double precision by sums over all components. Files are
// read by a reader of its own.
#include "raytrace/lessons/01-vectors/lab.h"
#include "tests/grading/judge.h"

#include <array>
#include <cctype>
#include <cmath>
#include <sstream>

using namespace duet;
using namespace duet::grading;
using lab::Vector;

LAB_TITLE("raytrace-01", "Vectors, colors and a file")

namespace {

using Numbers = std::vector<int>;

Vector random_vector(Rng& rng, double size = 1) {
    const auto component = [&] { return static_cast<float>(rng.uniform(-size, size)); };
    return {component(), component(), component()};
}

/// The cross product from its definition by the sign of permutations: another way than the formula of the page.
Vector sum_over_permutations(Vector a, Vector b) {
    const double from_a[] = {a.x, a.y, a.z}, from_b[] = {b.x, b.y, b.z};
    double result[] = {0, 0, 0};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 3; ++k) result[i] += (i - j) * (j - k) * (k - i) / 2.0 * from_a[j] * from_b[k];
    return {static_cast<float>(result[0]), static_cast<float>(result[1]), static_cast<float>(result[2])};
}

/// An image of width 3 and height 2 whose file has these numbers. 10, 13, 26 and 32 mean something in a text.
const Numbers kNumbers{255, 0, 10, 1, 2, 3, 200, 100, 50, 13, 26, 32, 0, 0, 0, 254, 128, 64};

ImageRgb image_of(const Numbers& numbers, int width, int height) {
    ImageRgb image(width, height);
    for (std::size_t i = 0; i < numbers.size(); ++i)
        image[i / 3][i % 3] = srgb_decode_8bit(static_cast<std::uint8_t>(numbers[i]));
    return image;
}

/// Returns the numbers that typical mistakes would produce for an image.
std::vector<Mistake<Numbers>> mistakes_in(const Numbers& numbers, int width, int height) {
    Numbers upside_down, by_columns, blue_first, linear;
    const auto copy = [&](int x, int y, Numbers& to) {
        for (int c = 0; c < 3; ++c) to.push_back(numbers[static_cast<std::size_t>(3 * (y * width + x) + c)]);
    };
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) copy(x, height - 1 - y, upside_down);
    for (int x = 0; x < width; ++x)
        for (int y = 0; y < height; ++y) copy(x, y, by_columns);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        blue_first.push_back(numbers[i + 2 - 2 * (i % 3)]);
        linear.push_back(static_cast<int>(std::lround(255 * srgb_decode_8bit(static_cast<std::uint8_t>(numbers[i])))));
    }
    return {{upside_down, "The rows are upside down: a file begins with the top row, which is row 0."},
            {by_columns, "The pixels come column by column: the loop over rows must be the outer one."},
            {blue_first, "Blue comes first: the order is red, green, blue."},
            {linear, "These are the amounts of light times 255: each number must follow the curve (use to_byte)."}};
}

/// A blank or line end.
bool is_blank(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }

/// Checks the first lines. Returns what follows the largest number, with the blank that ends the header.
std::string after_header(Item& item, const std::string& file, const std::string& kind, int width, int height) {
    const std::string other = kind == "P3" ? "P6" : "P3";
    item.require(file.substr(0, 2) != other, message("The file begins with ", other, ", which promises numbers as ",
                                                     other == "P3" ? "text. These are bytes: the kind is P6."
                                                                   : "bytes. This is text: the kind is P3."));
    item.require(file.substr(0, 2) == kind,
                 message("The file must begin with ", kind, "; it begins with ", describe(file.substr(0, 2)), "."));
    std::size_t at = 2;
    for (const auto& [what, expected] :
         {std::pair{"width", width}, std::pair{"height", height}, std::pair{"largest number", 255}}) {
        item.require(at < file.size() && is_blank(file[at]),
                     message("A blank or line end must stand before the ", what, " in the header."));
        while (at < file.size() && is_blank(file[at])) ++at;
        std::string digits;
        while (at < file.size() && std::isdigit(static_cast<unsigned char>(file[at])) && digits.size() < 8)
            digits += file[at++];
        item.require(!digits.empty(), message("The header has no ", what, ": a kind, the width, the height and 255."));
        item.require(!(std::string(what) == "width" && width != height && digits == std::to_string(height)),
                     "The first size is the height of the image: the width comes first.");
        item.equal(message("the ", what, " in the header"), std::stoi(digits), expected);
    }
    return file.substr(at);
}

void check_text(Item& item, const Numbers& numbers, int width, int height) {
    const std::string file = STUDENT(ppm_text)(image_of(numbers, width, height));
    std::istringstream words(after_header(item, file, "P3", width, height));
    Numbers found;
    for (std::string word; words >> word;) {
        item.require(word.find_first_not_of("0123456789") == std::string::npos,
                     message("Numbers stand apart by blanks or line ends alone; this is no number: ",
                             describe(word.substr(0, 20)), "."));
        item.require(word.size() <= 3,
                     message("The numbers run together: ", word.substr(0, 20), ". Write a blank after each."));
        found.push_back(std::stoi(word));
    }
    item.equal("how many numbers follow the header", found.size(), numbers.size(),
               {{numbers.size() / 3, "There is one number for each pixel, and it needs three: red, green, blue."}});
    item.equal("the list of numbers", found, numbers, mistakes_in(numbers, width, height));
}

void check_binary(Item& item, const Numbers& numbers, int width, int height) {
    const std::string file = STUDENT(ppm_binary)(image_of(numbers, width, height));
    std::string rest = after_header(item, file, "P6", width, height), expected;
    for (const int number : numbers) expected += static_cast<char>(number);
    item.require(!rest.empty() && is_blank(rest[0]), "A line end must follow the 255 of the header.");
    item.require(rest[0] != '\r', "The header's line ends are two bytes, 13 and 10: only one byte may follow 255.");
    rest.erase(0, 1);
    item.require(rest.size() <= expected.size() || rest.find_first_not_of("0123456789 \n") != std::string::npos,
                 "These are numbers as text. In a P6 file each number is one byte: static_cast<char>(number).");
    item.require(rest.size() != expected.size() + 1 || rest.substr(1) != expected,
                 "One byte too many follows the header: after 255 comes one line end and then the first pixel.");
    item.require(rest.size() <= expected.size() || rest.substr(0, expected.size()) != expected,
                 "Something follows the last pixel: the file ends with its blue byte.");
    std::string as_text;
    for (const char byte : expected) as_text += byte == '\n' ? std::string("\r\n") : std::string(1, byte);
    item.require(rest == expected || rest != as_text, "A byte 13 stands before each byte 10, as in a text of Windows.");
    item.require(
        rest.size() >= expected.size() || expected[rest.size()] != '\0',
        "The file ends before the first byte 0. A C string ends there; add single bytes to the string instead.");
    Numbers found;
    for (const char byte : rest) found.push_back(static_cast<unsigned char>(byte));
    item.equal("how many bytes follow the header", found.size(), numbers.size(),
               {{numbers.size() / 3, "There is one byte for each pixel, and it needs three: red, green, blue."}});
    item.equal("the list of bytes", found, numbers, mistakes_in(numbers, width, height));
}

Numbers random_numbers(Rng& rng, int pixels) {
    Numbers numbers;
    for (int i = 0; i < 3 * pixels; ++i) numbers.push_back(rng.integer(0, 255));
    return numbers;
}

} // namespace

LAB_ITEM(0, "the picture") {
    ImageRgb image(120, 60);
    for (int y = 0; y < 60; ++y) {
        const float up = 1 - static_cast<float>(y) / 59;
        for (int x = 0; x < 120; ++x) {
            const Vector left{0.9f, 0.25f, 0.02f}, right{0.02f, 0.2f * up, 0.6f * up};
            const Vector color = STUDENT(lerp)(left, right, static_cast<float>(x) / 119);
            image(x, y) = Rgb(color.x, color.y, color.z);
        }
    }
    item.show("your gradient", image);
}

LAB_ITEM(15, "the dot product") {
    // 1·4 + 2·(-5) + 3·6 = 4 - 10 + 18
    item.near("(1, 2, 3)·(4, -5, 6)", STUDENT(dot)(Vector{1, 2, 3}, Vector{4, -5, 6}), 12, 1e-5,
              {{-6, "The product of the z components is left out."},
               {32, "A sign is lost: add the products as they are, without absolute values."},
               {30, "This is the product of the sums. Multiply component by component first, and then add."},
               {0.365487f, "This is the cosine of the angle: don't divide by the lengths."},
               {std::sqrt(12.0f), "The root belongs to the length, not to the dot product."}});
    item.near("(1, 0, 0)·(0, 1, 0)", STUDENT(dot)(Vector{1, 0, 0}, Vector{0, 1, 0}), 0, 0);
    item.near("the dot product of (1, 2, 3) with itself", STUDENT(dot)(Vector{1, 2, 3}, Vector{1, 2, 3}), 14, 1e-5,
              {{std::sqrt(14.0f), "This is the length; the dot product with itself is the length squared."}});
    for (int i = 0; i < 100; ++i) {
        const Vector a = random_vector(item.random(), 5), b = random_vector(item.random(), 5);
        const double expected = double{a.x} * b.x + double{a.y} * b.y + double{a.z} * b.z;
        item.near(message(describe(a), "·", describe(b)), STUDENT(dot)(a, b), static_cast<float>(expected), 1e-4);
    }
}

LAB_ITEM(20, "the cross product") {
    item.near(
        "(1, 0, 0) × (0, 1, 0)", STUDENT(cross)(Vector{1, 0, 0}, Vector{0, 1, 0}), Vector{0, 0, 1}, 1e-6,
        {{Vector{0, 0, -1}, "It points the wrong way, as with left-handed axes: each difference is turned around."}});
    // (2·6 - 3·(-5), 3·4 - 1·6, 1·(-5) - 2·4)
    item.near(
        "(1, 2, 3) × (4, -5, 6)", STUDENT(cross)(Vector{1, 2, 3}, Vector{4, -5, 6}), Vector{27, 6, -13}, 1e-4,
        {{Vector{27, -6, -13}, "The sign of y is wrong: it is a.z·b.x - a.x·b.z, in this order."},
         {Vector{-27, -6, 13}, "It points the wrong way: each difference is turned around."},
         {Vector{4, -10, 18}, "This is the product component by component. The cross product takes differences of "
                              "products of different components."},
         {Vector{-3, 18, 3}, "The products are added; the cross product takes their differences."}});
    for (int i = 0; i < 100; ++i) {
        const Vector a = random_vector(item.random(), 3), b = random_vector(item.random(), 3);
        item.near(message(describe(a), " × ", describe(b)), STUDENT(cross)(a, b), sum_over_permutations(a, b), 1e-4);
    }
}

LAB_ITEM(15, "a vector 1 long") {
    item.near(
        "(3, 4, 0), normalized", STUDENT(normalize)(Vector{3, 4, 0}), Vector{0.6f, 0.8f, 0}, 1e-6,
        {{Vector{3, 4, 0}, "It is still 5 long: divide by the length."},
         {Vector{0.12f, 0.16f, 0}, "It was divided by the length squared: the root is missing."},
         {Vector{3 / 7.0f, 4 / 7.0f, 0}, "It was divided by the sum of the components. The length is the root of the "
                                         "sum of their squares."},
         {Vector{0.75f, 1, 0}, "It was divided by its largest component. That isn't the length."},
         {Vector{15, 20, 0}, "It was multiplied by its length: divide."}});
    item.near("(2, 3, 6), normalized", STUDENT(normalize)(Vector{2, 3, 6}), Vector{2 / 7.0f, 3 / 7.0f, 6 / 7.0f}, 1e-6,
              {{Vector{2 / std::sqrt(13.0f), 3 / std::sqrt(13.0f), 6 / std::sqrt(13.0f)},
                "The length leaves out z: it is the root of x² + y² + z²."}});
    item.near("(0, -2, 0), normalized", STUDENT(normalize)(Vector{0, -2, 0}), Vector{0, -1, 0}, 1e-6,
              {{Vector{0, 1, 0}, "The sign is lost."}});
    for (int i = 0; i < 100; ++i) {
        const Vec3d n = item.random().unit_vector();
        const double length = std::pow(10.0, item.random().uniform(-5, 5));
        const Vec3 a(n * length), unit(n);
        item.near(message("(", a.x, ", ", a.y, ", ", a.z, "), normalized"), STUDENT(normalize)(Vector{a.x, a.y, a.z}),
                  Vector{unit.x, unit.y, unit.z}, 1e-5);
    }
}

LAB_ITEM(10, "linear interpolation") {
    const Vector a{1, 2, 3}, b{5, -2, 3};
    const auto at = [&](float t) { return STUDENT(lerp)(a, b, t); };
    item.near("lerp at t = 0", at(0), a, 1e-6, {{b, "Both ends are exchanged: t = 0 gives a."}});
    item.near("lerp at t = 1", at(1), b, 1e-6,
              {{Vector{6, 0, 6}, "All of a is still there: its weight is 1 - t."},
               {a, "This is a: the weight of b is t, and that of a is 1 - t."}});
    item.near("lerp at t = 0.25", at(0.25f), Vector{2, 1, 3}, 1e-5,
              {{Vector{4, -1, 3}, "Both ends are exchanged: at t = 0.25 it is nearer to a."}});
    for (int i = 0; i < 50; ++i) {
        const Vector p = random_vector(item.random()), q = random_vector(item.random());
        const double t = item.random().uniform();
        const auto mix = [t](float x, float y) { return static_cast<float>(x + (double{y} - x) * t); };
        item.near(message("lerp from ", describe(p), " to ", describe(q), " at t = ", t),
                  STUDENT(lerp)(p, q, static_cast<float>(t)), Vector{mix(p.x, q.x), mix(p.y, q.y), mix(p.z, q.z)},
                  1e-5);
    }
}

LAB_ITEM(15, "light as a number of a file") {
    item.equal("the number of 0", STUDENT(to_byte)(0), 0);
    item.equal("the number of 1", STUDENT(to_byte)(1), 255,
               {{256, "The largest number is 255, so the factor is 255."},
                {254, "It was cut off, not rounded: the curve gives a little less than 1."},
                {1, "The encoded value must be multiplied by 255."},
                {0, "256 does not fit into a byte, which begins at 0 again: the factor is 255."}});
    item.equal("the number of 0.5", STUDENT(to_byte)(0.5f), 188,
               {{127, "This is half of 255: the curve of sRGB is missing (srgb_encode)."},
                {128, "This is half of 255: the curve of sRGB is missing (srgb_encode)."},
                {187, "It was cut off, not rounded: 187.5 and more is 188."},
                {55, "This curve goes the other way: use srgb_encode, not srgb_decode."},
                {54, "This curve goes the other way: use srgb_encode, not srgb_decode."},
                {1, "The encoded value must be multiplied by 255 before it is rounded."}});
    item.equal("the number of 1.6", STUDENT(to_byte)(1.6f), 255,
               {{313, "A byte holds 0 to 255: limit the light to 1 first."},
                {312, "A byte holds 0 to 255: limit the light to 1 first."},
                {57, "The number began again at 0, as a byte does after 255: limit the light to 1 first."},
                {56, "The number began again at 0, as a byte does after 255: limit the light to 1 first."},
                {0, "Too bright is white, not black: limit the light to 1."}});
    item.equal("the number of -0.25", STUDENT(to_byte)(-0.25f), 0,
               {{-824, "Light below 0 gives 0: limit it first."},
                {-823, "Light below 0 gives 0: limit it first."},
                {201, "The number began again at 255: limit the light to 0 first."},
                {200, "The number began again at 255: limit the light to 0 first."},
                {255, "Light below 0 gives 0."}});
    for (int number = 0; number < 255; ++number)
        for (const double beside : {-0.4, 0.0, 0.4}) {
            const double light = srgb_decode((number + beside) / 255);
            if (light < 0) continue;
            item.equal(
                message("the number of ", light, ", which is ", number + beside, " before it is rounded,"),
                STUDENT(to_byte)(static_cast<float>(light)), number,
                {{number - 1, "It was cut off, not rounded: multiply by 255, and round to the nearest whole number."},
                 {number + 1, "It is one too large: multiply by 255, and round to the nearest whole number."}});
        }
}

LAB_ITEM(10, "a P3 file") {
    check_text(item, kNumbers, 3, 2);
    check_text(item, random_numbers(item.random(), 20), 4, 5);
    check_text(item, random_numbers(item.random(), 1), 1, 1);
}

LAB_ITEM(15, "a P6 file") {
    check_binary(item, kNumbers, 3, 2);
    check_binary(item, random_numbers(item.random(), 20), 4, 5);
    check_binary(item, random_numbers(item.random(), 1), 1, 1);
}
