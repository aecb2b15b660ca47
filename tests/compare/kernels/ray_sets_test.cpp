#include "compare/kernels/ray_sets.h"

#include "compare/kernels/tracer.h"
#include "compare/stress/accelerated_scene.h"
#include "compare/stress/chi_squared.h"

#include <doctest/doctest.h>

#include <map>
#include <set>

using namespace duet;
using namespace duet::compare;

namespace {

/// Returns a square floor of half side length 100 in the plane y = 0.
Mesh floor_mesh() {
    Mesh mesh;
    mesh.positions = {{-100, 0, 100}, {100, 0, 100}, {100, 0, -100}, {-100, 0, -100}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

Camera camera_at(Vec3d eye, Vec3d look_at) {
    Camera camera;
    camera.eye = eye;
    camera.look_at = look_at;
    return camera;
}

KernelScene lumpy_room() {
    return make_kernel_scene("lump", Arrangement::kRoom, enclosed(icosphere(3, 0.2f), Vec3(), 3),
                             camera_at({1, 1.5, 2.5}, {0, 0, 0}));
}

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("camera rays: each pixel's once, in tiles; on the Z-curve 16 on end are 4 x 4 pixels") {
        const Camera camera = camera_at({0, 0, 5}, {0, 0, 0});
        for (const auto& [width, height] : {std::pair{64, 48}, {37, 21}, {20, 24}, {64, 40}}) {
            const CameraModel model({camera, width, height});
            std::map<std::pair<float, float>, std::pair<int, int>> pixel_of;
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x) {
                    const Vec3 d = model.ray({x + 0.5, y + 0.5}).direction;
                    pixel_of[{d.x, d.y}] = {x, y};
                }
            REQUIRE(pixel_of.size() == static_cast<std::size_t>(width * height));
            for (const PixelOrder order : {PixelOrder::kRows, PixelOrder::kZCurve}) {
                const std::vector<Ray> rays = camera_rays(camera, width, height, order, 2);
                std::vector<std::pair<int, int>> pixels;
                for (const Ray& ray : rays) pixels.push_back(pixel_of.at({ray.direction.x, ray.direction.y}));
                CHECK(std::set(pixels.begin(), pixels.end()).size() == rays.size());
                CHECK(rays.size() == pixel_of.size());
                CHECK(pixels[0] == std::pair{0, 0});
                CHECK(pixels[1] == std::pair{1, 0});
                CHECK(pixels[16] == (order == PixelOrder::kRows ? std::pair{0, 1} : std::pair{4, 0}));
                if (order == PixelOrder::kRows || width % 4 != 0 || height % 4 != 0) continue;
                for (std::size_t i = 0; i < rays.size(); ++i) {
                    REQUIRE(pixels[i].first / 4 == pixels[i / 16 * 16].first / 4);
                    REQUIRE(pixels[i].second / 4 == pixels[i / 16 * 16].second / 4);
                }
            }
        }
    }

    TEST_CASE("bounce and shadow rays are the same for any number of threads, others for another seed") {
        const KernelScene scene = lumpy_room();
        const raytrace::Accelerator accelerator(*scene.scene, 1);
        const std::vector<Ray> camera = camera_rays(scene.camera, 96, 64, PixelOrder::kRows, 1);
        const auto same = [](const std::vector<Ray>& a, const std::vector<Ray>& b) {
            return std::ranges::equal(a, b, [](const Ray& p, const Ray& q) {
                return p.origin == q.origin && p.direction == q.direction && p.t_max == q.t_max;
            });
        };
        const auto bounce = bounce_rays(scene, accelerator, camera, 1, 1);
        CHECK(bounce.size() == camera.size()); // a closed room: every camera ray hits
        CHECK(same(bounce, bounce_rays(scene, accelerator, camera, 1, 3)));
        CHECK_FALSE(same(bounce, bounce_rays(scene, accelerator, camera, 2, 1)));
        const ShadowRays one = shadow_rays(scene, accelerator, camera, 1, 1),
                         three = shadow_rays(scene, accelerator, camera, 1, 3);
        CHECK(same(one.rays, three.rays));
        CHECK(one.ends == three.ends);
    }

    TEST_CASE("in a closed room no ray is lost: from the camera, nor after a bounce, nor after ten") {
        const KernelScene scene = lumpy_room();
        const raytrace::Accelerator accelerator(*scene.scene, 1);
        std::vector<Ray> rays = camera_rays(scene.camera, 160, 120, PixelOrder::kZCurve, 1);
        const std::size_t count = rays.size();
        for (std::uint64_t depth = 0; depth < 10; ++depth) {
            for (const RayResult& ray_result : trace_all(duet_closest(accelerator, rays), rays.size(), 1))
                REQUIRE(ray_result.hit());
            rays = bounce_rays(scene, accelerator, rays, depth, 1);
            REQUIRE(rays.size() == count);
        }
    }

    TEST_CASE("in an empty room no shadow ray is blocked; below a lid, each") {
        Mesh room = enclosed({}, Vec3(), 3);
        const Camera camera = camera_at({0, -1, 2.9}, {0, -1.4, 0});
        for (const bool lid : {false, true}) {
            Mesh mesh = room;
            if (lid) {
                const auto first = static_cast<std::uint32_t>(mesh.positions.size());
                for (const Vec3& p : {Vec3(-3, 0, 3), Vec3(3, 0, 3), Vec3(3, 0, -3), Vec3(-3, 0, -3)})
                    mesh.positions.push_back(p);
                mesh.triangles.push_back({first, first + 1, first + 2});
                mesh.triangles.push_back({first, first + 2, first + 3});
            }
            const KernelScene scene = make_kernel_scene("room", Arrangement::kRoom, mesh, camera);
            const raytrace::Accelerator accelerator(*scene.scene, 1);
            const auto rays = camera_rays(scene.camera, 64, 64, PixelOrder::kRows, 1);
            const auto shadow = shadow_rays(scene, accelerator, rays, 0, 1);
            REQUIRE(shadow.rays.size() > rays.size() / 2);
            const auto ray_results =
                trace_all(duet_occluded(accelerator, shadow.rays, shadow.ends), shadow.rays.size(), 1);
            std::size_t blocked = 0;
            for (const RayResult& a : ray_results) blocked += a.hit();
            CHECK(blocked == (lid ? ray_results.size() : 0));
            // Each shadow ray ends on one of the light's two triangles, which are the last.
            for (std::size_t i = 0; i < shadow.rays.size(); ++i) {
                const Ray& ray = shadow.rays[i];
                const Hit& end = shadow.ends[i];
                REQUIRE(ray.at(ray.t_max).y == doctest::Approx(3 - 0.02 * 6).epsilon(1e-3));
                REQUIRE(end.object == 0);
                REQUIRE(end.primitive >= scene.triangle_count() - 2);
                REQUIRE(end.t > ray.t_max);
                REQUIRE(end.t == doctest::Approx(ray.t_max).epsilon(2e-4));
                if (!lid) REQUIRE(accelerator.closest(Ray{ray.origin, ray.direction}).primitive == end.primitive);
            }
        }
    }
}

TEST_SUITE("statistical") {
    // A false alarm has odds of 1e-6 in each of the two tests; the seeds are fixed.
    TEST_CASE("bounce rays have density cos θ / π, on the side that the ray came from") {
        for (const double side : {1.0, -1.0}) {
            const KernelScene scene = make_kernel_scene("floor", Arrangement::kAlone, floor_mesh(),
                                                        camera_at({0.3, side * 5, 0.2}, {0, 0, 0}));
            const raytrace::Accelerator accelerator(*scene.scene, 1);
            const auto camera = camera_rays(scene.camera, 512, 512, PixelOrder::kRows, 1);
            const auto rays = bounce_rays(scene, accelerator, camera, 3, 1);
            REQUIRE(rays.size() == camera.size());
            constexpr int kRings = 16, kSectors = 16;
            std::vector<double> observed(kRings * kSectors, 0.0);
            const std::vector<double> expected(kRings * kSectors,
                                               static_cast<double>(rays.size()) / (kRings * kSectors));
            for (const Ray& ray : rays) {
                const Vec3d d(ray.direction);
                REQUIRE(d.y * side > 0);
                // If the density is cos θ / π, sin² θ and φ are uniformly distributed.
                const double ring = (d.x * d.x + d.z * d.z) * kRings;
                const double sector = (0.5 + std::atan2(d.z, d.x) / (2 * kPiDouble)) * kSectors;
                const int i = std::clamp(static_cast<int>(ring), 0, kRings - 1);
                const int j = std::clamp(static_cast<int>(sector), 0, kSectors - 1);
                ++observed[static_cast<std::size_t>(i * kSectors + j)];
            }
            const ChiSquared found = chi_squared(observed, expected);
            CHECK_MESSAGE(found.p_value > 1e-6, found.details);
        }
    }
}
