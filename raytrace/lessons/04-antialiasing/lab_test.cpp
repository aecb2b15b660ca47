// The examiner of lab 04. Coverage is known from geometry: the area of a disk, and a straight edge. The bounds of
// random errors are six standard deviations or more.
#include "common/image/srgb.h"
#include "raytrace/lessons/04-antialiasing/lab.h"
#include "tests/grading/judge.h"

#include <algorithm>
#include <cmath>

using namespace duet;
using namespace duet::grading;
using lab::Disk;

LAB_TITLE("raytrace-04", "Many samples per pixel")

namespace {

/// A white half-plane: all with x < `edge`. It is a disk so large that its edge is straight.
std::vector<Disk> half_plane(float edge) { return {{{edge - 16384, 32}, 16384, Rgb(1)}}; }

/// The pixels of a column, in which a straight edge lies: one a row.
std::vector<double> edge_pixels(const ImageRgb& image, int column) {
    std::vector<double> values;
    for (int row = 0; row < image.height(); ++row) values.push_back(double{image(column, row).g});
    return values;
}

double mean(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
}
double deviation(const std::vector<double>& values, double center) {
    double sum = 0;
    for (const double value : values) sum += sqr(value - center);
    return std::sqrt(sum / static_cast<double>(values.size()));
}

Rgb decoded(double encoded) { return Rgb(static_cast<float>(srgb_decode(encoded))); }

} // namespace

LAB_ITEM(0, "the picture") {
    std::vector<Disk> disks{{{60, 400}, 345, {0.35f, 0.5f, 0.25f}}};
    for (int i = 0; i < 9; ++i) {
        const float angle = 0.35f * static_cast<float>(i), radius = 17 - 1.5f * static_cast<float>(i);
        const Rgb color = lerp(Rgb(0.9f, 0.3f, 0.05f), Rgb(0.1f, 0.2f, 0.8f), static_cast<float>(i) / 8);
        disks.push_back({{60 - 44 * std::cos(angle), 56 - 38 * std::sin(angle)}, radius, color});
    }
    item.limit(10);
    item.show("your disks", STUDENT(draw)(disks, 120, 72, 4, std::uint64_t{1}));
}

LAB_ITEM(15, "the mean of light") {
    const auto of = [](const std::vector<Rgb>& samples) { return STUDENT(mean_light)(samples); };
    item.near("the mean of black and white", of({Rgb(0), Rgb(1)}), Rgb(0.5f), 1e-6,
              {{decoded(0.5), "This is the mean of the encoded numbers. Average the light itself."},
               {Rgb(1), "This is the sum: divide it by the number of samples."},
               {Rgb(0), "Is this a division of whole numbers? They drop the remainder."},
               {Rgb(127 / 255.0f),
                "The samples were made whole numbers. Add them in float, and round when a file is written."}});
    item.near("the mean of (3, 1, 0) and (0, 1, 0.5)", of({{3, 1, 0}, {0, 1, 0.5f}}), Rgb(1.5f, 1, 0.25f), 1e-6,
              {{Rgb(0.5f, 1, 0.25f), "Light above 1 was limited before it was averaged. It counts in full."},
               {Rgb(1, 1, 0.25f), "The mean was limited to 1. A file does that when it is written, not before."},
               {Rgb(1.5f), "Each channel has a mean of its own."}});
    item.near("the mean of no samples", of({}), Rgb(0), 0,
              {{Rgb(NAN), "This is not a number: 0 / 0. Of no samples the mean is black."}});
    item.near("the mean of 1000 samples of 0.2", of(std::vector<Rgb>(1000, Rgb(0.2f))), Rgb(0.2f), 1e-4,
              {{Rgb(0), "The samples were divided as whole numbers before they were added. Add first, in float."}});
    for (int i = 0; i < 20; ++i) {
        std::vector<Rgb> samples;
        Rgbd sum;
        for (int k = item.random().integer(1, 30); k > 0; --k) {
            const auto channel = [&] { return static_cast<float>(item.random().uniform(0, 2)); };
            samples.push_back({channel(), channel(), channel()});
            sum += Rgbd(samples.back());
        }
        item.near("the mean of random colors", of(samples), Rgb(sum / static_cast<double>(samples.size())), 1e-4);
    }
}

LAB_ITEM(20, "a sample in its cell") {
    const auto of = [](int i, int n, Vec2 u) { return STUDENT(sample_in_cell)(i, n, u); };
    item.near("sample 1 of 4 with u = (0.5, 0.5)", of(1, 2, {0.5f, 0.5f}), Vec2(0.75f, 0.25f), 1e-6,
              {{Vec2(0.25f, 0.75f), "Column and row are exchanged: the column is i % n, and the row is i / n."},
               {Vec2(1.5f, 0.5f), "This is in units of cells: divide by n."},
               {Vec2(0.5f, 0), "This is the corner of the cell: add u to the cell's column and row."},
               {Vec2(0.5f, 0.5f), "This is the middle of the pixel: in which cell lies sample 1?"},
               {Vec2(1, 0.5f), "u was not made smaller: it spans one cell, which is 1/n of the pixel."}});
    item.near("sample 7 of 9 with u = (0.25, 0.75)", of(7, 3, {0.25f, 0.75f}), Vec2(1.25f / 3, 2.75f / 3), 1e-6,
              {{Vec2(2.25f / 3, 1.75f / 3), "Column and row are exchanged: the column is i % n, and the row is i / n."},
               {Vec2(1.75f / 3, 2.25f / 3), "u.x belongs to the column and u.y to the row."},
               {Vec2(1.5f / 3, 2.5f / 3),
                "This is the middle of the cell, whatever u is: add u to the cell's column and row."}});
    item.near("the only sample of n = 1", of(0, 1, {0.3f, 0.9f}), Vec2(0.3f, 0.9f), 1e-6);
    for (int i = 0; i < 60; ++i) {
        const int n = item.random().integer(1, 9), cell = item.random().integer(0, n * n - 1);
        const double x = item.random().uniform(), y = item.random().uniform();
        int column = cell, row = 0; // counted, another way than by division
        for (; column >= n; column -= n) ++row;
        item.near(message("sample ", cell, " of ", n * n), of(cell, n, Vec2(Vec2d(x, y))),
                  Vec2(Vec2d((column + x) / n, (row + y) / n)), 1e-5);
    }
}

LAB_ITEM(15, "a picture whose pixels are means: colors and coverage") {
    item.limit(10);
    const std::vector<Disk> full{{{8, 8}, 100, {0.5f, 0.25f, 2}}};
    item.near("a pixel that one color covers", STUDENT(draw)(full, 16, 16, 4, std::uint64_t{1})(5, 5),
              Rgb(0.5f, 0.25f, 2), 1e-5,
              {{Rgb(0.5f, 0.25f, 1), "Light above 1 was limited. It counts in full."},
               {Rgb(0.5f, 0.25f, 2) * 16.0f, "This is the sum of the 16 samples: divide it by n·n."},
               {Rgb(0.5f, 0.25f, 2) * 4.0f, "The sum was divided by n: there are n·n samples."}});
    // The edge lies at 0.3 of column 3. With 16 samples in cells the value of a pixel deviates by 0.05, and the mean of
    // 64 pixels by 0.006.
    const ImageRgb image = STUDENT(draw)(half_plane(3.3f), 8, 64, 4, item.random().bits());
    item.require(!std::all_of(image.begin(), image.end(), [](const Rgb& c) { return c.g == 0 || c.g == 1; }),
                 "All pixels at an edge are black or white: each pixel must be the mean of its samples.");
    item.require(!(image(6, 0).g > 0.5f && image(0, 40).g < 0.5f),
                 "x and y are exchanged: x comes from the column and y from the row.");
    const auto values = edge_pixels(image, 3);
    const double found = mean(values);
    item.require(std::abs(found - 0.8) > 0.04,
                 "A pixel that is covered to 0.3 has the mean 0.8: the samples lie around the "
                 "corner of the pixel. They must lie between column and column + 1.");
    item.near("the mean of pixels that are covered to 0.3", static_cast<float>(found), 0.3f, 0.04,
              {{static_cast<float>(srgb_decode(0.3)),
                "It looks as if the encoded numbers were averaged. Average the light itself."},
               {0, "The edge lies in another column: a sample lies between column and column + 1."},
               {0.7f, "This is what is not covered: is x mirrored?"}});
}

LAB_ITEM(15, "samples lie in the pixel, all around") {
    item.limit(10);
    const Vec2 center{8.2f, 7.7f};
    const ImageRgb image = STUDENT(draw)(std::vector<Disk>{{center, 5.3f, Rgb(1)}}, 16, 16, 8, item.random().bits());
    double area = 0, x = 0, y = 0;
    for (int row = 0; row < 16; ++row)
        for (int column = 0; column < 16; ++column) {
            const double light = double{image(column, row).g};
            area += light, x += light * (column + 0.5), y += light * (row + 0.5);
        }
    item.require(area > 1, "A disk in the middle of the picture is not there.");
    const Vec2d found(x / area, y / area);
    item.near(
        "the middle of the disk's light", Vec2(found), center, 0.1,
        {{center + Vec2(0.5f, 0.5f), "All is half a pixel too far to the right and too low: samples must lie between "
                                     "column and column + 1, and between row and row + 1."},
         {center - Vec2(0.5f, 0.5f), "All is half a pixel too far to the left and too high: don't add 0.5 to a sample "
                                     "that is spread over the pixel already."},
         {Vec2(center.y, center.x), "x and y are exchanged."},
         {center + Vec2(0, 0.4f),
          "It is too low, as if only the first row of cells had samples. There are n·n samples, not n."}});
    item.near("the area of a disk with radius 5.3, in pixels", static_cast<float>(area),
              static_cast<float>(kPi * 5.3 * 5.3), 1.5);
}

LAB_ITEM(15, "random numbers: others in each pixel, and less noise by cells") {
    item.limit(10);
    const std::uint64_t seed = item.random().bits();
    const ImageRgb image = STUDENT(draw)(half_plane(3.3f), 8, 64, 4, seed);
    const auto values = edge_pixels(image, 3);
    // The edge is a little curved, so a few values change even with the same numbers. With others about 45 of 63 do.
    int changes = 0;
    for (std::size_t row = 1; row < values.size(); ++row) changes += values[row] != values[row - 1] ? 1 : 0;
    item.require(
        changes > 12,
        "The 64 pixels along a straight edge have the same value: all pixels use the same random numbers, or none. "
        "Let the state run on from pixel to pixel, or give each pixel a seed of its own.");
    // The same for an edge that runs across, in which the pixels of one row differ.
    const ImageRgb across = STUDENT(draw)(std::vector<Disk>{{{32, 3.3f - 16384}, 16384, Rgb(1)}}, 64, 8, 4, seed);
    int changes_across = 0;
    for (int column = 1; column < 64; ++column)
        changes_across += across(column, 3).g != across(column - 1, 3).g ? 1 : 0;
    item.require(changes_across > 12,
                 "All pixels of a row use the same random numbers, and other rows have others. Let the "
                 "state run on from pixel to pixel.");
    // In cells only the second column of cells matters: four samples of 16, each inside with the chance 0.2. So the
    // deviation is √(4·0.2·0.8)/16 = 0.05. Anywhere in the pixel it would be √(0.3·0.7/16) = 0.115.
    const double found = deviation(values, 0.3);
    item.require(found < 0.08, message("The pixels along an edge deviate by ", found,
                                       " from the exact value, as samples anywhere in the pixel do. One in each cell "
                                       "deviate by 0.05: put sample i into cell i."));
    item.require(image.pixels() == STUDENT(draw)(half_plane(3.3f), 8, 64, 4, seed).pixels(),
                 "The same seed gave two pictures: all random numbers must come from the seed.");
    item.require(image.pixels() != STUDENT(draw)(half_plane(3.3f), 8, 64, 4, seed + 1).pixels(),
                 "Two seeds gave the same picture: the random numbers must come from the seed.");
}

LAB_ITEM(10, "the error between two images") {
    ImageRgb a(2, 1), b(2, 1);
    b(0, 0) = Rgb(0.3f, 0, -0.4f); // (0.09 + 0.16) / 6 = 0.0416667
    item.near("the error of two images that differ by 0.3 and 0.4 in one pixel of two", STUDENT(rms_error)(a, b),
              std::sqrt(0.25 / 6), 1e-6,
              {{0.25 / 6, "This is the mean squared error: take its root."},
               {0.5, "This is the root of the sum: divide the sum by the number of components first."},
               {std::sqrt(0.25 / 2), "The sum was divided by the number of pixels: each has three components."},
               {0.7 / 6, "These are absolute differences: square them."},
               {0.1 / 6, "Signs cancel: square the differences before you add them."}});
    item.near("the error of an image with itself", STUDENT(rms_error)(b, b), 0, 0);
    for (int i = 0; i < 10; ++i) {
        ImageRgb p(5, 3), q(5, 3);
        double sum = 0;
        for (std::size_t k = 0; k < p.size(); ++k)
            for (std::size_t c = 0; c < 3; ++c) {
                p[k][c] = static_cast<float>(item.random().uniform(0, 2));
                q[k][c] = static_cast<float>(item.random().uniform(0, 2));
                sum += sqr(double{p[k][c]} - double{q[k][c]});
            }
        item.near("the error of two random images", STUDENT(rms_error)(p, q), std::sqrt(sum / 45), 1e-5);
    }
}

LAB_ITEM(10, "how many samples an error takes") {
    item.equal("the number for half of the error of 16 samples", STUDENT(samples_needed)(16, 0.5, 0.25), 64,
               {{32, "Half of the error takes four times as many samples: the error falls as 1/√N."},
                {23, "The error falls as 1/√N, so N grows as the square of the ratio, not as its root."},
                {4, "The ratio is the wrong way around: a smaller error takes more samples."}});
    item.equal("the number for the error 0.3 if 10 samples have 1", STUDENT(samples_needed)(10, 1.0, 0.3), 112,
               {{111, "111 samples are not quite enough (111.1 are needed): round up."}});
    item.equal("the number for an eighth of the error of one sample", STUDENT(samples_needed)(1, 0.5, 0.0625), 64,
               {{65, "Exactly 64 are enough; rounding took one more."}, {8, "The ratio must be squared."}});
    item.equal("the number for a larger error than one sample has", STUDENT(samples_needed)(1, 0.1, 0.5), 1,
               {{0, "At least one sample is needed: round up."}});
    for (int i = 0; i < 40; ++i) {
        const int samples = item.random().integer(1, 50), ratio = item.random().integer(1, 30);
        const double error = item.random().uniform(0.1, 1);
        const double factor = ratio * 1.00001; // a whole one would hang on the last digit
        item.equal(message("the number for 1/", factor, " of the error of ", samples, " samples"),
                   STUDENT(samples_needed)(samples, error, error / factor),
                   static_cast<int>(std::ceil(samples * sqr(factor))));
    }
}
