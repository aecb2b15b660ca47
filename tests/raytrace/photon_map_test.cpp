// These tests compare the photon map with a search of all photons.
#include "raytrace/bidirectional/photon_map.h"
#include "raytrace/sampling/sampler.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

using namespace duet;
using namespace duet::raytrace;

TEST_SUITE("unit") {
    // Photons lie in clusters, on cell boundaries, at the same place, and far from the origin.
    TEST_CASE("the photon map finds each photon within the radius once, whatever the number of threads") {
        for (const float scale : {1e-6f, 1.0f, 1e6f})
            for (const int count : {0, 1, 5000}) {
                std::vector<Photon> photons;
                Sampler sampler(SamplerKind::kIndependent, 5, 1);
                for (int i = 0; i < count; ++i) {
                    sampler.start(0, 0, static_cast<std::uint32_t>(i));
                    const auto u = sampler.get_block();
                    Vec3 p = Vec3(u[0], u[1], u[2]) * scale;
                    if (i % 3 == 0) p = Vec3(std::floor(4 * u[0]), std::floor(4 * u[1]), 0) * (0.25f * scale);
                    if (i % 7 == 0) p = p - Vec3(scale, 0, scale);
                    photons.push_back({p, {}, Rgb(), {}, i});
                }
                const float radius = 0.05f * scale;
                const PhotonMap one(photons, radius, 1), three(photons, radius, 3);
                for (int i = 0; i < 200; ++i) {
                    sampler.start(1, 0, static_cast<std::uint32_t>(i));
                    const auto u = sampler.get_block();
                    const Vec3 p = i % 2 == 0 && count > 0 ? photons[static_cast<std::size_t>(i % count)].p
                                                           : (Vec3(u[0], u[1], u[2]) * 2.0f - Vec3(1, 1, 1)) * scale;
                    std::vector<int> found, found_by_three, expected;
                    one.for_each_near(p, [&](const Photon& photon) { found.push_back(photon.depth); });
                    three.for_each_near(p, [&](const Photon& photon) { found_by_three.push_back(photon.depth); });
                    for (const Photon& photon : photons)
                        if (length_squared(photon.p - p) <= sqr(radius)) expected.push_back(photon.depth);
                    CHECK(found == found_by_three);
                    std::sort(found.begin(), found.end());
                    CHECK(found == expected);
                }
            }
    }
}
