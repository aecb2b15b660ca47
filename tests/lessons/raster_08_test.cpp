// Lesson raster-08: normals of a normal map are the library's.
#include "common/material/surface_maps.h"
#include "raster/lessons/08-normal-maps/normal_map.h"

#include <doctest/doctest.h>

#include <random>

using namespace duet;

TEST_SUITE("lesson") {

    TEST_CASE("raster-08: a normal map turns normals as the library does") {
        std::mt19937 random(8);
        const auto uniform = [&](float low, float high) {
            return std::uniform_real_distribution<float>(low, high)(random);
        };
        const auto point = [&] {
            const float x = uniform(-1, 1), y = uniform(-1, 1);
            return Vec3{x, y, uniform(-1, 1)};
        };
        int cases = 0, mirrored = 0;
        while (cases < 3000) {
            lesson::Triangle triangle;
            for (lesson::Vertex& v : triangle) {
                v.p = point();
                const float u = uniform(0, 1);
                v.uv = {u, uniform(0, 1)};
            }
            const auto& [a, b, c] = triangle;
            const Vec3 face = cross(b.p - a.p, c.p - a.p);
            const Vec2 st = b.uv - a.uv, xy = c.uv - a.uv;
            const float det = st.x * xy.y - st.y * xy.x;
            if (length(face) < 0.2f || std::abs(det) < 0.05f) continue;
            const Vec3 smooth = normalize(normalize(face) + point() * 0.2f);
            // Far from the horizon, where the library would bend the normal back.
            const float x = uniform(-0.4f, 0.4f);
            const Rgb texel = direction_color(normalize(Vec3{x, uniform(-0.4f, 0.4f), 1}));

            const Mesh mesh{.positions = {a.p, b.p, c.p},
                            .normals = {smooth, smooth, smooth},
                            .uvs = {a.uv, b.uv, c.uv},
                            .triangles = {{0, 1, 2}},
                            .material_slots = {}};
            Hit hit;
            hit.object = hit.primitive = 0, hit.u = hit.v = 0.3f, hit.t = 1;
            const Ray ray{{0, 0, 0}, -smooth};
            SurfacePoint at = surface_point(mesh, hit, ray, Mat4(), Mat4(), true);
            TextureSet set;
            set.images.push_back(ImageRgb(1, 1, texel));
            set.textures.push_back(ImageTexture{.image = 0, .scale = {1, 1}, .filter = TextureFilter::kBilinear});
            SurfaceMaps maps;
            maps.normal = 0;
            apply_normal_maps(set, maps, ray.direction, at);

            const Vec3 naive =
                lesson::perturb(smooth, lesson::tangent_frame(triangle, smooth), lesson::decode_normal(texel));
            CAPTURE(cases);
            REQUIRE(length(at.ns - naive) < 2e-4f);
            ++cases, mirrored += det < 0;
        }
        CHECK(mirrored > 1000);
        CHECK(mirrored < 2000);
    }

    TEST_CASE("raster-08: the map of a slope has the normal of the slope") {
        // A roof: 32 texels wide, up 0.75 a texel on the left side and down on the right.
        ImageFloat heights(32, 4);
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 32; ++x) heights(x, y) = 0.75f * static_cast<float>(x < 16 ? x : 32 - x);
        const ImageRgb map = lesson::normal_map(heights);
        for (int y = 0; y < 4; ++y)
            for (int x = 1; x < 32; ++x) {
                if (x == 16) continue;                               // the ridge
                const Vec3 expected{x < 16 ? -0.6f : 0.6f, 0, 0.8f}; // (∓0.75, 0, 1) has the length 1.25
                REQUIRE(length(lesson::decode_normal(map(x, y)) - expected) < 1e-5f);
            }
    }
}
