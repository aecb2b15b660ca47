// Lesson raytrace-10: its Cornell box has the means that two independent renderers publish, and its quads are met where
// the library's are.
#include "common/geometry/quad.h"
#include "raytrace/lessons/07-camera/camera.h"
#include "raytrace/lessons/10-cornell-box/quads.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

using namespace duet;

namespace {

struct Block {
    int row = 0, column = 0;
    Rgbd mean;
};

std::vector<Block> published_means() {
    std::ifstream in(DUET_SOURCE_DIR "/tests/golden/cornell-box-means.csv");
    std::vector<Block> blocks;
    for (std::string line; std::getline(in, line);) {
        if (line.empty() || line[0] == '#' || line[0] == 'b') continue;
        std::replace(line.begin(), line.end(), ',', ' ');
        std::istringstream fields(line);
        Block b;
        fields >> b.row >> b.column >> b.mean.r >> b.mean.g >> b.mean.b;
        REQUIRE(fields);
        blocks.push_back(b);
    }
    return blocks;
}

/// The mean of many paths through random points of a block of 32 x 32 pixels, and its squared standard error.
struct Estimate {
    Rgbd mean, error2;
};
Estimate estimate(const std::vector<lesson::Quad>& quads, const Block& block, int paths) {
    const lesson::Camera camera({.eye = {0, 1, 6.8f}, .look_at = {0, 1, 0}, .fov_degrees = 35}, 512, 512);
    lesson::Random random(static_cast<std::uint64_t>(1000 * block.row + block.column));
    Rgbd sum, squares;
    for (int i = 0; i < paths; ++i) {
        const float x = 32 * (static_cast<float>(block.column) + random.next());
        const float y = 32 * (static_cast<float>(block.row) + random.next());
        const Rgbd light(lesson::path_color(quads, camera.ray(x, y, random), 64, random));
        sum += light, squares += light * light;
    }
    const Rgbd mean = sum / double(paths);
    return {mean, (squares / double(paths) - mean * mean) / double(paths - 1)};
}

/// How many standard errors the sums over all blocks are apart, channel by channel, and the largest such number of one
/// block. The published means agree with each other to 0.5 % by block, which is allowed on top.
struct Comparison {
    double whole = 0, block = 0, relative_error = 0;
};
Comparison compare(const std::vector<lesson::Quad>& quads, int paths) {
    Comparison result;
    Rgbd difference, error2, published;
    for (const Block& block : published_means()) {
        const Estimate found = estimate(quads, block, paths);
        difference += found.mean - block.mean, error2 += found.error2, published += block.mean;
        for (std::size_t c = 0; c < 3; ++c) {
            const double off = std::abs(found.mean[c] - block.mean[c]) - 0.005 * block.mean[c];
            result.block = std::max(result.block, off / std::sqrt(found.error2[c]));
        }
    }
    for (std::size_t c = 0; c < 3; ++c) {
        result.whole = std::max(result.whole, std::abs(difference[c]) / std::sqrt(error2[c]));
        result.relative_error = std::max(result.relative_error, std::sqrt(error2[c]) / published[c]);
    }
    return result;
}

} // namespace

TEST_SUITE("lesson") {

    // 100 blocks in three channels, which are not independent. For errors of a normal distribution one of 300 is
    // beyond 5 standard errors in less than one of 5000 seeds; the whole is, in one of 600 000.
    TEST_CASE("raytrace-10: the Cornell box against an independent renderer") {
        const Comparison right = compare(lesson::cornell_box(), 16'000);
        MESSAGE("whole ", right.whole, ", worst block ", right.block, ", standard error ", right.relative_error);
        CHECK(right.whole < 5);
        CHECK(right.block < 5);
        CHECK(right.relative_error < 0.01); // so that an error of 5 % of the whole would be found

        // The comparison can fail: albedos that are 10 % off, and a light that shines on both sides.
        std::vector<lesson::Quad> dark = lesson::cornell_box(), both = lesson::cornell_box();
        for (lesson::Quad& quad : dark) quad.material.albedo *= 0.9f;
        const lesson::Quad light = both[0];
        both.push_back({light.corner + Vec3{0, 1e-3f, 0}, light.v, light.u, light.material, light.emission});
        CHECK(compare(dark, 4'000).whole > 5);
        CHECK(compare(both, 1'000).block > 5);
    }

    TEST_CASE("raytrace-10: rays meet a quad where they meet the library's") {
        lesson::Random random(10);
        const auto vector = [&] { return lesson::random_unit_vector(random) * (0.1f + 2 * random.next()); };
        int hits = 0, misses = 0;
        while (hits + misses < 100'000) {
            const lesson::Quad quad{vector(), vector(), vector(), lesson::matte(Rgb(1))};
            if (length(cross(quad.u, quad.v)) < 0.05f) continue;
            const float a = 2 * random.next() - 0.5f, b = 2 * random.next() - 0.5f;
            const auto near_edge = [](float x) { return std::abs(x) < 1e-3f || std::abs(x - 1) < 1e-3f; };
            const Vec3 origin = vector() * 2.0f, target = quad.corner + quad.u * a + quad.v * b;
            const Ray ray{origin, target - origin}; // meets the plane at t = 1
            if (near_edge(a) || near_edge(b) || std::abs(dot(quad.n, ray.direction)) < 0.05f) continue;
            const bool inside = a > 0 && a < 1 && b > 0 && b < 1;
            const auto naive = lesson::hit_quad(quad, ray);
            const auto library = intersect_quad(ShearedRay(ray), duet::Quad{quad.corner, quad.u, quad.v});
            REQUIRE(naive.has_value() == inside);
            REQUIRE(library.has_value() == inside);
            if (inside) REQUIRE(*naive == doctest::Approx(library->t).epsilon(1e-4));
            ++(inside ? hits : misses);
        }
        CHECK(hits > 10'000);
        CHECK(misses > 10'000);
    }
}
