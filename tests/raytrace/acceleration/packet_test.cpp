// These tests check that a ray packet gives the same hits as its rays traced separately, bit for bit.
#include "raytrace/acceleration/accelerator.h"
#include "raytrace/acceleration/bvh_packet.h"
#include "tests/raytrace/acceleration/soup.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace duet;
using namespace duet::raytrace;

namespace {

// Returns camera rays through a square of pixels of width `spread`, from one point or from a lens.
std::vector<Ray> bundle(Random& random, const Soup& soup, Vec3 axis, float spread, float lens, std::size_t count) {
    std::vector<Ray> rays(count);
    const Vec3 eye = soup.offset - axis * (soup.scale * random.uniform(0, 3));
    for (Ray& ray : rays) {
        ray.direction = normalize(axis + random.vector() * spread);
        ray.origin = eye + random.vector() * (lens * soup.scale);
        ray.time = random.uniform(0, 1);
    }
    return rays;
}

void check_same(const Accelerator& accelerator, const std::vector<Ray>& rays) {
    std::vector<Hit> hits(rays.size());
    accelerator.closest(rays, hits);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Hit alone = accelerator.closest(rays[i]);
        INFO("ray ", i, " of ", rays.size(), ": alone ", described(alone), ", together ", described(hits[i]));
        CHECK(alone == hits[i]);
    }
}

bool coherent(const std::vector<Ray>& rays, const Accelerator& accelerator) {
    return RayPacket(std::span(rays).first<RayPacket::kSize>(), accelerator.world().bounds).coherent();
}

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("packets hit what their rays hit alone, near and far, large and small") {
        int packets = 0, hits = 0;
        for (const float scale : {1e-6f, 1.0f, 1e6f})
            for (const float away : {0.0f, 1e3f}) {
                Soup soup{Random(17), scale, Vec3(away, -away, away) * scale};
                const Scene scene = soup.scene(true);
                const Accelerator accelerator(scene, 1);
                for (int trial = 0; trial < 60; ++trial) {
                    const float spread = std::pow(10.0f, soup.random.uniform(-5, 0.3f));
                    const Vec3 axis = trial % 3 ? soup.random.direction() : Vec3(0, 0, trial % 2 ? 1.0f : -1.0f);
                    const auto rays = bundle(soup.random, soup, axis, spread, trial % 4 ? 0 : 0.01f, 67);
                    packets += coherent(rays, accelerator);
                    check_same(accelerator, rays);
                    for (const Ray& ray : rays) hits += accelerator.closest(ray).valid();
                }
            }
        CHECK(packets > 60); // the test covers real packets
        CHECK(hits > 5000);
    }

    TEST_CASE("rays of a packet end where they end, one by one") {
        Soup soup{Random(5), 1, {}};
        const Scene scene = soup.scene(false);
        const Accelerator accelerator(scene, 1);
        for (int trial = 0; trial < 40; ++trial) {
            auto rays = bundle(soup.random, soup, soup.random.direction(), 0.01f, 0, RayPacket::kSize);
            for (Ray& ray : rays) {
                const Hit hit = accelerator.closest(ray);
                if (!hit.valid()) continue;
                switch (soup.random.below(5)) {
                case 0:
                    ray.t_max = hit.t; // still a hit
                    break;
                case 1:
                    ray.t_max = std::nextafter(hit.t, 0.0f);
                    break;
                case 2:
                    ray.t_min = hit.t;
                    break;
                case 3:
                    ray.t_min = ray.t_max = hit.t; // the interval is empty
                    break;
                default:
                    break;
                }
            }
            check_same(accelerator, rays);
        }
    }

    TEST_CASE("rays at edges and vertices, along axes, with zeros of both signs") {
        Soup soup{Random(23), 1, {}};
        const Scene scene = soup.scene(false);
        const Accelerator accelerator(scene, 1);
        const auto& positions = std::get<Mesh>(scene.shapes[0]).positions;
        int packets = 0;
        for (int trial = 0; trial < 200; ++trial) {
            const Vec3 eye = soup.random.direction() * 4.0f;
            const auto axis = static_cast<std::size_t>(trial % 3);
            std::vector<Ray> rays(RayPacket::kSize);
            for (Ray& ray : rays) {
                const Vec3 vertex =
                    positions[static_cast<std::size_t>(soup.random.below(static_cast<int>(positions.size())))];
                if (trial % 2) {
                    ray.origin = eye;
                    ray.direction = normalize(vertex - eye);
                } else {
                    const float zero = soup.random.below(2) ? 0.0f : -0.0f;
                    ray.direction = {zero, -zero, zero};
                    ray.direction[axis] = 1;
                    ray.origin = vertex - ray.direction;
                }
            }
            packets += coherent(rays, accelerator);
            check_same(accelerator, rays);
        }
        CHECK(packets >= 100); // zeros of both signs occur in one packet
    }

    TEST_CASE("packets of rays that cannot be traced, or that part, are traced one by one") {
        Soup soup{Random(3), 1, {}};
        const Scene scene = soup.scene(true);
        const Accelerator accelerator(scene, 1);
        const float infinity = kInfinity, nan = std::numeric_limits<float>::quiet_NaN();
        for (float Ray::*const end : {&Ray::t_min, &Ray::t_max}) {
            auto rays = bundle(soup.random, soup, {0, 0, 1}, 0.01f, 0, RayPacket::kSize);
            rays[3].*end = nan;
            check_same(accelerator, rays);
        }
        for (const Vec3 bad : {Vec3(nan, 0, 1), Vec3(0, infinity, 1), Vec3(0, 0, 0)}) {
            auto rays = bundle(soup.random, soup, {0, 0, 1}, 0.01f, 0, 2 * RayPacket::kSize);
            rays[3].direction = bad;
            CHECK_FALSE(coherent(rays, accelerator));
            check_same(accelerator, rays);
            std::vector<Hit> hits(rays.size());
            accelerator.closest(rays, hits);
            CHECK_FALSE(hits[3].valid());
        }
        auto rays = bundle(soup.random, soup, {0, 0, 1}, 0.01f, 0, RayPacket::kSize);
        rays[5].direction = -rays[5].direction;
        CHECK_FALSE(coherent(rays, accelerator));
        check_same(accelerator, rays);
        rays[5].origin.x = infinity;
        check_same(accelerator, rays);
    }

    TEST_CASE("no rays, few rays, and a scene without objects") {
        SceneBuilder nothing;
        const Scene empty = nothing.finish();
        const Accelerator none(empty, 1);
        Soup soup{Random(3), 1, {}};
        const Scene scene = soup.scene(false);
        const Accelerator accelerator(scene, 1);
        for (const std::size_t count : {std::size_t{0}, std::size_t{1}, RayPacket::kSize - 1, RayPacket::kSize}) {
            const auto rays = bundle(soup.random, soup, {0, 0, 1}, 0.1f, 0, count);
            check_same(none, rays);
            check_same(accelerator, rays);
        }
    }
}
