#include "common/vec/box.h"
#include "common/vec/frame.h"
#include "common/vec/matrix.h"
#include "common/vec/robust.h"

#include <doctest/doctest.h>

#include <random>

using namespace duet;

TEST_SUITE("unit") {

    TEST_CASE("difference_of_products stays within 1.5 ulp where the products cancel") {
        std::mt19937 engine(1);
        std::uniform_real_distribution<float> u(0.5f, 2);
        for (int trial = 0; trial < 100000; ++trial) {
            const float a = u(engine), b = u(engine), c = a * (1 + 1e-6f * (u(engine) - 1)),
                        d = b * (1 + 1e-6f * (u(engine) - 1));
            const double exact =
                static_cast<double>(a) * static_cast<double>(b) - static_cast<double>(c) * static_cast<double>(d);
            const float result = difference_of_products(a, b, c, d);
            const float rounded = static_cast<float>(exact);
            const double ulp = static_cast<double>(next_up(std::abs(rounded))) - static_cast<double>(std::abs(rounded));
            CHECK(std::abs(static_cast<double>(result) - exact) <= 1.5 * ulp);
        }
        CHECK(difference_of_products(3.0f, 5.0f, 5.0f, 3.0f) == 0);
    }

    TEST_CASE("frames are orthonormal and right-handed, also near −z") {
        std::mt19937 engine(2);
        std::normal_distribution<float> g;
        for (int trial = 0; trial < 100000; ++trial) {
            Vec3 n = normalize(Vec3(g(engine), g(engine), g(engine)));
            if (trial % 2) n = normalize(Vec3(g(engine) * 1e-4f, g(engine) * 1e-8f, -1));
            if (trial == 1) n = {0, 0, -1};
            if (trial == 3) n = {0, -0.0f, 1};
            const Frame f = frame_from_normal(n);
            CHECK(std::abs(length(f.s) - 1) < 3e-7f);
            CHECK(std::abs(length(f.t) - 1) < 3e-7f);
            CHECK(std::abs(dot(f.s, f.t)) < 3e-7f);
            CHECK(std::abs(dot(f.s, f.n)) < 3e-7f);
            CHECK(length(cross(f.s, f.t) - f.n) < 6e-7f);
            const Vec3 w(g(engine), g(engine), g(engine));
            CHECK(length(f.to_world(f.to_local(w)) - w) < 2e-6f * length(w));
        }
    }

    TEST_CASE("affine inverse, normals, determinants") {
        std::mt19937 engine(4);
        std::uniform_real_distribution<double> u(-1, 1);
        for (int trial = 0; trial < 1000; ++trial) {
            const double scale = std::pow(10.0, 6 * u(engine));
            const Mat4d m = translation(Vec3d(u(engine), u(engine), u(engine)) * scale) *
                            rotation(normalize(Vec3d(u(engine), u(engine), u(engine))), 3 * u(engine)) *
                            scaling(Vec3d(0.1 + std::abs(u(engine)), -0.1 - std::abs(u(engine)), 2) * scale);
            CHECK(determinant3(m) < 0);
            const Mat4d identity = m * inverse_affine(m);
            for (std::size_t r = 0; r < 4; ++r)
                for (std::size_t c = 0; c < 3; ++c)
                    CHECK(identity[r][c] == doctest::Approx(r == c ? 1.0 : 0.0).epsilon(1e-9));
            const Vec3d there = transform_point(m, Vec3d(1, 2, 3));
            CHECK(length(transform_point(inverse_affine(m), there) - Vec3d(1, 2, 3)) < 1e-9);
            const Vec3d p(u(engine), u(engine), u(engine)), q(u(engine), u(engine), u(engine));
            const Vec3d n = cross(p, q); // remains perpendicular to both when it is transformed as a normal
            const Vec3d image = transform_normal(inverse_affine(m), n);
            CHECK(dot(image, transform_vector(m, p)) == doctest::Approx(0).epsilon(1e-9));
            CHECK(dot(image, transform_vector(m, q)) == doctest::Approx(0).epsilon(1e-9));
        }
        CHECK(transform_vector(rotation(Vec3d(0, 1, 0), kPiDouble / 2), Vec3d(0, 0, 1)).x == doctest::Approx(1));
    }

    TEST_CASE("interpolation is exact at both ends, boxes start empty") {
        CHECK(lerp(0.1f, 0.7f, 1.0f) == 0.7f);
        CHECK(lerp(0.1f, 0.7f, 0.0f) == 0.1f);
        Box3 box;
        CHECK(box.empty());
        CHECK(box.half_area() == 0);
        box.extend(Vec3(1, 2, 3));
        CHECK_FALSE(box.empty());
        box.extend(Vec3(2, 4, 6));
        CHECK(box.half_area() == doctest::Approx(1 * 2 + 2 * 3 + 3 * 1));
        CHECK(longest_axis(box.diagonal()) == 2);
    }

} // TEST_SUITE
