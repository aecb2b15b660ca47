#include "tests/grading/judge.h"

#include "common/image/image_file.h"

#include <algorithm>
#include <cmath>

namespace duet::grading {

namespace {

/// The largest side of an image that goes to the page.
constexpr int kMaxShownSide = 2048;
/// The largest map that is printed; a larger image is reduced, and a character stands for the worst of its pixels.
constexpr int kMapWidth = 64, kMapHeight = 32;

/// A character for each pixel or block of pixels. `rank` orders them: of a block the highest is shown.
template <typename Symbol, typename Rank>
std::string draw_map(int width, int height, const Symbol& symbol, const Rank& rank) {
    const int step_x = (width + kMapWidth - 1) / kMapWidth, step_y = (height + kMapHeight - 1) / kMapHeight;
    std::string map;
    for (int y = 0; y < height; y += step_y) {
        for (int x = 0; x < width; x += step_x) {
            char shown = '.';
            for (int j = y; j < std::min(y + step_y, height); ++j)
                for (int i = x; i < std::min(x + step_x, width); ++i)
                    if (const char c = symbol(i, j); rank(c) > rank(shown)) shown = c;
            map += shown;
        }
        map += '\n';
    }
    if (step_x > 1 || step_y > 1) map += message("(a character stands for ", step_x, " x ", step_y, " pixels)\n");
    return map;
}

double distance(Rgb a, Rgb b) {
    const double d = std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
    return std::isnan(d) || !is_finite(a) ? kInfinity : d;
}
double mean_distance(const ImageRgb& a, const ImageRgb& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += std::min(distance(a[i], b[i]), 1e3);
    return sum / static_cast<double>(a.size());
}
ImageRgb as_gray(const ImageFloat& values) {
    ImageRgb image(values.width(), values.height());
    for (std::size_t i = 0; i < image.size(); ++i) image[i] = Rgb(values[i]);
    return image;
}
template <typename Pixel>
void require_size(const std::string& name, const Image<Pixel>& found, const Image<Pixel>& expected) {
    if (found.width() == expected.width() && found.height() == expected.height()) return;
    throw ItemFailed{name + " has the wrong size.", message(expected.width(), " x ", expected.height()),
                     message(found.width(), " x ", found.height()), ""};
}
template <typename Pixel>
std::string hint_of(const Image<Pixel>& found, const std::vector<Mistake<Image<Pixel>>>& mistakes,
                    const auto& is_like) {
    for (const auto& mistake : mistakes)
        if (mistake.value.size() == found.size() && is_like(mistake.value)) return " " + mistake.text;
    return "";
}

} // namespace

std::uint64_t Rng::bits() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}
int Rng::integer(int low, int high) {
    return low + static_cast<int>(uniform() * (static_cast<double>(high) - low + 1));
}
Vec3d Rng::unit_vector() {
    const double z = uniform(-1, 1), phi = uniform(0, 2 * kPiDouble), r = std::sqrt(1 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
}

std::string explain_components(const std::vector<double>& found, const std::vector<double>& expected,
                               double tolerance) {
    const auto count = [](const std::vector<double>& values, auto is) { return std::ranges::count_if(values, is); };
    const auto is_nan = [](double x) { return std::isnan(x); };
    const auto is_infinite = [](double x) { return std::isinf(x); };
    if (count(found, is_nan) > count(expected, is_nan))
        return "It is not a number (NaN): is 0 divided by 0, or the root of a negative number taken?";
    if (count(found, is_infinite) > count(expected, is_infinite)) return "It is infinite: is something divided by 0?";
    if (found.size() != expected.size() || found.empty()) return "";
    std::size_t i = 0;
    while (i + 1 < found.size() && is_near(found[i], expected[i], tolerance)) ++i;
    if (found.size() > 4)
        return message("The first wrong value is number ", i + 1, " of ", found.size(), ": expected ",
                       describe(expected[i]), ", found ", describe(found[i]), ".");
    if (describe(found[i]) != describe(expected[i])) return "";
    return message("The values differ by ", describe(std::abs(found[i] - expected[i])), ", and at most ",
                   describe(tolerance), " is allowed.");
}

void Item::show(const std::string& name, const ImageRgb& image) {
    if (image.empty() || std::max(image.width(), image.height()) > kMaxShownSide) return;
    const std::string file = message("item", index_, "-", images_.size(), ".png");
    ImageRgb finite = image;
    for (Rgb& pixel : finite.pixels())
        if (!is_finite(pixel)) pixel = Rgb(1, 0, 1); // what isn't a number is shown in magenta
    write_image(out_ + "/" + file, finite);
    images_.push_back({name, file});
}

void Item::show(const std::string& name, const ImageFloat& image) { show(name, as_gray(image)); }

void Item::image(const std::string& name, const ImageRgb& found, const ImageRgb& expected, double tolerance,
                 const std::vector<Mistake<ImageRgb>>& mistakes) {
    show(name + ": found", found);
    show(name + ": expected", expected);
    require_size(name, found, expected);
    const auto wrong = [&](int x, int y) { return distance(found(x, y), expected(x, y)) > tolerance; };
    ImageRgb difference(found.width(), found.height());
    double largest = 0;
    std::size_t count = 0;
    std::string first;
    for (int y = 0; y < found.height(); ++y)
        for (int x = 0; x < found.width(); ++x) {
            const double d = std::min(distance(found(x, y), expected(x, y)), 1.0);
            difference(x, y) = Rgb(static_cast<float>(d));
            largest = std::max(largest, d);
            if (wrong(x, y) && count++ == 0)
                first = message(", first at (", x, ", ", y, "): expected ", describe(expected(x, y)), ", found ",
                                describe(found(x, y)));
        }
    if (count == 0) return;
    for (Rgb& pixel : difference.pixels()) pixel = pixel / static_cast<float>(largest);
    show(message(name, ": difference (white is ", describe_number(largest), ")"), difference);
    const std::string hint = hint_of(found, mistakes, [&](const ImageRgb& mistake) {
        return mean_distance(found, mistake) < 0.3 * mean_distance(found, expected);
    });
    throw ItemFailed{message(name, " has ", count, " wrong pixels of ", found.size(), first, ".", hint), "", "",
                     draw_map(
                         found.width(), found.height(), [&](int x, int y) { return wrong(x, y) ? '#' : '.'; },
                         [](char c) { return c == '#'; })};
}

void Item::image(const std::string& name, const ImageFloat& found, const ImageFloat& expected, double tolerance,
                 const std::vector<Mistake<ImageFloat>>& mistakes) {
    std::vector<Mistake<ImageRgb>> gray;
    for (const auto& [value, text] : mistakes) gray.push_back({as_gray(value), text});
    image(name, as_gray(found), as_gray(expected), tolerance, gray);
}

void Item::coverage(const std::string& name, const Image<int>& found, const Image<int>& expected,
                    const std::vector<Mistake<Image<int>>>& mistakes) {
    require_size(name, found, expected);
    const auto symbol = [&](int x, int y) {
        const int f = found(x, y), e = expected(x, y);
        return f == e ? (e ? 'o' : '.') : f < e ? '-' : e == 0 ? '+' : '2';
    };
    std::size_t missing = 0, doubled = 0, extra = 0;
    ImageRgb shown_image(found.width(), found.height(), Rgb(0.02f));
    for (int y = 0; y < found.height(); ++y)
        for (int x = 0; x < found.width(); ++x) {
            const char c = symbol(x, y);
            missing += c == '-', doubled += c == '2', extra += c == '+';
            if (c == 'o') shown_image(x, y) = Rgb(0.4f);
            if (c == '-') shown_image(x, y) = Rgb(1, 0, 0);
            if (c == '2') shown_image(x, y) = Rgb(1, 0.8f, 0);
            if (c == '+') shown_image(x, y) = Rgb(0, 0.3f, 1);
        }
    if (missing + doubled + extra == 0) return;
    show(name + ": red is missing, yellow doubled, blue too much", shown_image);
    const std::string hint =
        hint_of(found, mistakes, [&](const Image<int>& mistake) { return mistake.pixels() == found.pixels(); });
    throw ItemFailed{message(name, ": ", missing, " pixels missing (-), ", doubled,
                             " covered more often than they should be (2), ", extra, " where nothing is (+).", hint),
                     "", "", draw_map(found.width(), found.height(), symbol, [](char c) {
                         return c == '-' || c == '2' || c == '+' ? 2 : c == 'o' ? 1 : 0;
                     })};
}

std::vector<ItemDefinition>& items() {
    static std::vector<ItemDefinition> all;
    return all;
}
LabTitle& lab_title() {
    static LabTitle title;
    return title;
}

} // namespace duet::grading
