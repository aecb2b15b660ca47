#include "common/medium/medium.h"
#include "common/medium/phase_function.h"
#include "tests/support/random.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace duet;
using duet::test::Random;

namespace {

Ray random_ray(Random& random, float scale) {
    const Vec3 origin(4 * random() - 2, 4 * random() - 2, 4 * random() - 2);
    Vec3 direction = uniform_sphere(random.pair());
    if (random() < 0.3f) direction = {0, random() < 0.5f ? 1.0f : -1.0f, 0}; // parallel to two pairs of planes
    return Ray{origin * scale, direction};
}

bool inside(const Box3& box, Vec3d p, double margin) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (p[axis] < static_cast<double>(box.low[axis]) + margin ||
            p[axis] > static_cast<double>(box.high[axis]) - margin)
            return false;
    return true;
}

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("The overlap of a ray with a box holds the points inside, and no others") {
        for (const float scale : {1e-6f, 1.0f, 1e6f}) {
            CAPTURE(scale);
            Random random(1);
            for (int i = 0; i < 2000; ++i) {
                const Ray ray = random_ray(random, scale);
                Box3 box{Vec3(-1, -1, -1) * scale, Vec3(1, 0.5f, 0.25f) * scale};
                if (i % 7 == 0) box.high.x = kInfinity;
                if (i % 11 == 0) box.low.y = -kInfinity;
                const float end = 3 * scale;
                const Interval interval = overlap(box, ray, end);
                for (int k = 0; k < 20; ++k) {
                    const float t = random() * end;
                    const Vec3d p = Vec3d(ray.origin) + Vec3d(ray.direction) * static_cast<double>(t);
                    const double margin = 1e-5 * static_cast<double>(scale);
                    if (inside(box, p, margin)) CHECK((interval.begin <= t && t <= interval.end));
                    if (!inside(box, p, -margin)) CHECK(!(interval.begin < t && t < interval.end));
                }
            }
        }
        const Interval all = overlap(Medium::unbounded(), Ray{{1, 2, 3}, {0, 0, 1}}, kInfinity);
        CHECK(all.begin == 0);
        CHECK(all.end == kInfinity);
    }

    TEST_CASE("Transmittance is the product over all media on a ray") {
        std::vector<Medium> media(3);
        media[0].box = {{-1, -1, -1}, {1, 1, 1}};
        media[0].scattering = Rgb(0.3f, 0.2f, 0.0f);
        media[1].box = {{-0.5f, -2, -2}, {2, 0.3f, 0.4f}};
        media[1].absorption = Rgb(0.1f, 0.4f, 0.0f);
        media[2].box.high.y = 0.5f;
        media[2].scattering = Rgb(0.05f, 0.0f, 0.0f);
        Random random(2);
        for (int i = 0; i < 1000; ++i) {
            const Ray ray = random_ray(random, 1);
            const float end = 5 * random();
            // Between two planes that bound a medium, the same media are present everywhere.
            std::vector<double> planes{0, static_cast<double>(end)};
            for (const Medium& medium : media)
                for (std::size_t axis = 0; axis < 3; ++axis)
                    for (const float plane : {medium.box.low[axis], medium.box.high[axis]}) {
                        const double t = (static_cast<double>(plane) - static_cast<double>(ray.origin[axis])) /
                                         static_cast<double>(ray.direction[axis]);
                        if (t > 0 && t < static_cast<double>(end)) planes.push_back(t);
                    }
            std::sort(planes.begin(), planes.end());
            Rgbd depth;
            for (std::size_t k = 0; k + 1 < planes.size(); ++k) {
                const Vec3d middle = Vec3d(ray.origin) + Vec3d(ray.direction) * ((planes[k] + planes[k + 1]) / 2);
                for (const Medium& medium : media)
                    if (inside(medium.box, middle, 0))
                        depth += (Rgbd(medium.scattering) + Rgbd(medium.absorption)) * (planes[k + 1] - planes[k]);
            }
            const Rgb found = transmittance(media, ray, end);
            for (std::size_t c = 0; c < 3; ++c)
                CHECK(static_cast<double>(found[c]) == doctest::Approx(std::exp(-depth[c])).epsilon(1e-5));
            CHECK(found.b == 1);
        }
        CHECK(transmittance(media, Ray{{0, 0, 0}, {1, 0, 0}}, kInfinity).r == 0); // the third has no bounds
        CHECK(transmittance(media, Ray{{0, 0, 0}, {0, 1, 0}}, kInfinity).g > 0);
    }

    TEST_CASE("The phase function is a density, and its samples have the mean cosine g") {
        for (const float g : {-0.99f, -0.6f, -1e-4f, 0.0f, 1e-4f, 0.3f, 0.9f, 0.99f}) {
            CAPTURE(g);
            const Vec3 from = normalize(Vec3(0.3f, -0.5f, 0.8f));
            const Frame frame = frame_from_normal(from);
            // The substitution cos θ = 1 − 2s⁴ resolves the peak ahead, and its mirror image the one behind.
            double integral = 0;
            const int steps = 4000;
            for (int i = 0; i < steps; ++i) {
                const double s = (i + 0.5) / steps, gap = 2 * s * s * s * s, cosine = g < 0 ? gap - 1 : 1 - gap;
                const double sine = std::sqrt(gap * (2 - gap));
                const Vec3 to = frame.to_world({static_cast<float>(sine), 0, static_cast<float>(cosine)});
                integral += 2 * kPiDouble * static_cast<double>(phase(from, to, g)) * 8 * s * s * s / steps;
            }
            CHECK(integral == doctest::Approx(1).epsilon(2e-3));

            Random random(3);
            const int count = 200000;
            double sum = 0, squares = 0, inverse = 0;
            for (int i = 0; i < count; ++i) {
                const Vec3 to = sample_phase(from, g, random.pair());
                const double cosine = static_cast<double>(dot(from, to));
                sum += cosine, squares += cosine * cosine;
                inverse += std::abs(static_cast<double>(length(to)) - 1);
            }
            const double mean = sum / count, error = std::sqrt((squares / count - mean * mean) / count);
            // Five standard errors are exceeded by chance once in 1.7 million times.
            CHECK(std::abs(mean - static_cast<double>(g)) < 5 * error + 1e-6);
            CHECK(inverse / count < 1e-6);
        }
    }

    TEST_CASE("Samples of the phase function have its density") {
        const Vec3 from = normalize(Vec3(-0.2f, 0.9f, 0.1f));
        for (const float g : {-0.5f, 0.0f, 0.7f}) {
            CAPTURE(g);
            Random random(4);
            const int count = 200000, bins = 20;
            std::vector<double> found(bins);
            for (int i = 0; i < count; ++i) {
                const float cosine = dot(from, sample_phase(from, g, random.pair()));
                ++found[static_cast<std::size_t>(std::min(static_cast<int>((cosine + 1) * bins / 2), bins - 1))];
            }
            const Frame frame = frame_from_normal(from);
            for (int b = 0; b < bins; ++b) {
                double expected = 0;
                for (int k = 0; k < 100; ++k) {
                    const double cosine = -1 + 2 * (b + (k + 0.5) / 100) / bins, sine = std::sqrt(1 - cosine * cosine);
                    const Vec3 to = frame.to_world({static_cast<float>(sine), 0, static_cast<float>(cosine)});
                    expected += 2 * kPiDouble * static_cast<double>(phase(from, to, g)) * 2 / bins / 100 * count;
                }
                CAPTURE(b);
                // One of these 60 comparisons fails by chance once in 29,000 times.
                CHECK(std::abs(found[static_cast<std::size_t>(b)] - expected) < 5 * std::sqrt(expected));
            }
        }
    }
}
