// These tests check that batched path tracing with SIMD lanes and ray packets gives the same bits as tracing each
// path separately.
#include "raytrace/integrator/integrator.h"
#include "raytrace/render.h"
#include "raytrace/render_pass.h"

#include "common/image/bitwise_equal.h"
#include "common/sampling/warp.h"
#include "tests/raytrace/rooms.h"

#include <doctest/doctest.h>

#include <array>
#include <numeric>
#include <vector>

using namespace duet;
using namespace duet::raytrace;

namespace {

std::vector<std::uint32_t> all_of(const std::vector<Ray>& rays) {
    std::vector<std::uint32_t> which(rays.size());
    std::iota(which.begin(), which.end(), 0u);
    return which;
}

// Counts the paths of a small image whose result differs in any bit, the paths that bring light, and the paths that
// give NaN, whose bits may differ.
struct Differences {
    // plain and smooth count the paths whose first hit is a batched surface, and of these the ones of form kSmooth.
    int differ = 0, lit = 0, not_numbers = 0, plain = 0, smooth = 0;
    std::array<int, BatchedSurfaces::Kind::kCount> kinds{}; // by kind
    bool same_rays = false;
};
Differences wavefront_and_single(const Scene& scene, const PathTracerSettings& settings, int side = 16) {
    constexpr int kSamples = 2;
    const View view{scene.camera, side, side};
    const PathTracerScene prepared = prepare(scene, settings);
    const RenderPlan plan(prepared.data(), view, settings);
    const CameraModel camera(view);
    std::vector<Sampler> samplers;
    std::vector<Ray> rays;
    std::vector<Hit> hits;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            for (std::uint32_t i = 0; i < kSamples; ++i) {
                samplers.push_back(settings.make_sampler());
                samplers.back().start(x, y, i);
                rays.push_back(camera_ray(plan, camera, x, y, samplers.back()));
                hits.push_back(plan.prepared.accelerator.closest(rays.back()));
            }
    RayCounts alone_counts, counts;
    std::vector<Rgb> alone, together(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
        Sampler sampler = samplers[i];
        alone.push_back(path_radiance(plan, rays[i], hits[i], sampler, alone_counts));
    }
    const std::vector<Hit> first_hits = hits;
    path_radiances(plan, rays, hits, samplers, together, counts);
    Differences found;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const auto is_number = [](Rgb c) { return c == c; };
        found.differ += is_number(alone[i]) ? !bitwise_equal(together[i], alone[i]) : is_number(together[i]);
        found.not_numbers += !is_number(alone[i]);
        found.lit += !is_black(alone[i]);
        const auto kind = first_hits[i].valid() ? plan.batched.kind(first_hits[i]) : std::nullopt;
        found.plain += kind.has_value();
        found.smooth += kind && kind->geometry == BatchedSurfaces::Geometry::kSmooth;
        if (kind) ++found.kinds[kind->index()];
    }
    found.same_rays = counts.indirect == alone_counts.indirect && counts.shadow == alone_counts.shadow &&
                      counts.ended == alone_counts.ended;
    return found;
}

Differences check_same(const Scene& scene, const PathTracerSettings& settings) {
    const Differences found = wavefront_and_single(scene, settings);
    CHECK(found.differ == 0);
    CHECK(found.lit > 20);
    CHECK(found.same_rays);
    // Tests may request these; then no path is batched.
    const bool asked = settings.skips.shadow_rays && settings.skips.textures;
    CHECK((found.plain > 100) == asked);
    return found;
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("paths side by side give the bits of each alone, under every light, in lists and trees") {
        for (const RoomLight light : kRoomLights)
            for (const ObjectCount count : {ObjectCount::kFew, ObjectCount::kSome, ObjectCount::kMany}) {
                CAPTURE(static_cast<int>(light));
                CAPTURE(static_cast<int>(count));
                PathTracerSettings settings;
                settings.seed = 7;
                const Differences found = check_same(room(light, count, {}), settings);
                CHECK((found.smooth > 10) == (count != ObjectCount::kFew));
            }
    }

    TEST_CASE("and at metal, mirrors and glass of every form") {
        std::array<int, BatchedSurfaces::Kind::kCount> kinds{};
        for (const RoomLight light : kRoomLights)
            for (const ObjectCount count : {ObjectCount::kFew, ObjectCount::kMany})
                for (const int depth : {1, 64}) {
                    CAPTURE(static_cast<int>(light));
                    CAPTURE(static_cast<int>(count));
                    PathTracerSettings settings;
                    settings.seed = 9;
                    settings.max_depth = depth;
                    const Differences found = check_same(room(light, count, {}, Finish::kShiny), settings);
                    for (std::size_t k = 0; k < kinds.size(); ++k) kinds[k] += found.kinds[k];
                }
        for (const int count : kinds) CHECK(count > 10); // every kind occurs
        for (const bool roulette : {false, true}) {
            PathTracerSettings settings;
            settings.russian_roulette = roulette;
            settings.sampler = SamplerKind::kIndependent;
            check_same(room(RoomLight::kMany, ObjectCount::kSome, {1e-3f, {1, 2, 3}}, Finish::kShiny), settings);
        }
        PathTracerSettings settings;
        settings.skips.mirror_light = false;
        CHECK(wavefront_and_single(room(RoomLight::kSphere, ObjectCount::kFew, {}, Finish::kShiny), settings).differ ==
              0);
    }

    TEST_CASE("and in rooms where anything may stand, more paths than ever go at once") {
        const Placement places[] = {{}, {1, {1e4f, 3e3f, -1e4f}}, {1e-3f, {1e-3f, 0, 0}}, {1e3f, {}}};
        for (int seed = 0; seed < 12; ++seed) {
            CAPTURE(seed);
            PathTracerSettings settings;
            settings.seed = static_cast<std::uint64_t>(seed);
            settings.russian_roulette = seed % 4 != 3;
            settings.max_depth = seed % 4 == 3 ? 12 : 64;
            // The image of 24 × 24 pixels has 1,152 paths.
            const Differences found = wavefront_and_single(wild_room(seed, places[seed % 4]), settings, 24);
            CHECK(found.differ == 0);
            CHECK(found.not_numbers == 0);
            CHECK(found.lit > 20);
            CHECK(found.same_rays);
            CHECK(found.plain > 100);
        }
    }

    TEST_CASE("and in solids with subsurface scattering") {
        for (const int depth : {1, 2, 64}) {
            CAPTURE(depth);
            SceneBuilder builder;
            const Coated wax{{Rgb(0.8f)}, 0.3f, 1.5f, Rgb(0.3f, 0.1f, 0)};
            builder.add(icosphere(2, 1, {}, true), builder.material(wax));
            builder.add(Sphere{{0, 0, 0.3f}, 0.2f}, builder.material(Emissive{Rgb(2.0f, 1, 3)}));
            builder.add(Sphere{{0, 1.4f, 0}, 0.2f}, builder.material(Emissive{Rgb(20.0f)}));
            builder.scene.environment = SkyEnvironment{Rgb(0.3f), Rgb(0.4f, 0.6f, 1.0f)};
            builder.scene.camera.eye = {0, 0.5, 4};
            PathTracerSettings settings;
            settings.max_depth = depth;
            const Differences found = wavefront_and_single(builder.finish(), settings);
            CHECK(found.differ == 0);
            CHECK(found.not_numbers == 0);
            CHECK(found.same_rays);
            CHECK(found.plain == 0);
        }
    }

    TEST_CASE("many spheres: rays stream through their tree") {
        for (const bool light : {false, true}) {
            SceneBuilder builder;
            const std::uint32_t white = builder.material(Diffuse{{Rgb(0.7f)}});
            const std::uint32_t brushed = builder.material(Metal{{Rgb(0.9f)}, 0.3f}),
                                glass = builder.material(Dielectric{});
            Sampler random(SamplerKind::kIndependent, 5, 1);
            for (int i = 0; i < 300; ++i) {
                random.start(i, 0, 0);
                const Vec2 at = random.get_2d();
                builder.add(Sphere{Vec3(6 * at.x - 3, 0.15f, 6 * at.y - 3), 0.15f}, i % 3 == 0   ? white
                                                                                    : i % 3 == 1 ? brushed
                                                                                                 : glass);
            }
            builder.add(Sphere{Vec3(0, -1000, 0), 1000}, white);
            builder.add(quad(Vec3(-3, 0.5f, -1), {6, 0, 0}, {0, 1, 0.1f}), brushed);
            builder.add(icosphere(0, 0.5f, Vec3(0, 0.6f, 0), true), white);
            builder.scene.environment = SkyEnvironment{Rgb(0.3f), Rgb(0.4f, 0.6f, 1.0f)};
            const std::uint32_t bright = builder.material(Emissive{Rgb(9.0f, 8, 6), true, {Rgb(0.0f)}});
            if (light) builder.add(quad(Vec3(-1, 3, -1), {2, 0, 0}, {0, 0, 2}), bright);
            builder.scene.camera.eye = Vec3d(0, 1.5, 6);
            builder.scene.camera.look_at = Vec3d(0, 0, 0);
            builder.scene.camera.fov_degrees = 50;
            const Scene scene = builder.finish();
            PathTracerSettings settings;
            const PathTracerScene prepared = prepare(scene, settings);
            const Accelerator& accelerator = prepared.data().accelerator;
            REQUIRE(!accelerator.few_primitives());
            check_same(scene, settings);
        }
    }

    TEST_CASE("rays that run anywhere, in any number, hit what each alone does") {
        const Scene scene = room(RoomLight::kRectangle, ObjectCount::kFew, {});
        PathTracerSettings settings;
        const PathTracerScene prepared = prepare(scene, settings);
        const Accelerator& accelerator = prepared.data().accelerator;
        REQUIRE(accelerator.few_primitives());
        REQUIRE(!prepare(room(RoomLight::kRectangle, ObjectCount::kMany, {}), settings)
                     .data()
                     .accelerator.few_primitives());
        Sampler sampler(SamplerKind::kIndependent, 3, 1);
        int found = 0;
        for (std::uint32_t count = 0; count < 1200; count = count < 40 ? count + 1 : 3 * count) {
            std::vector<Ray> rays;
            for (std::uint32_t i = 0; i < count; ++i) {
                sampler.start(static_cast<int>(count), 0, i);
                const Vec2 at = sampler.get_2d();
                // A third of the rays start on the floor.
                Ray ray{Vec3(2 * at.x - 1, i % 3 == 0 ? 0.0f : 1.9f * sampler.get_2d().x, 2 * at.y - 1),
                        uniform_sphere(sampler.get_2d())};
                if (i % 5 == 0) ray.direction = Vec3(i % 2 == 0 ? 1.0f : -1.0f, 0, 0);
                if (i % 7 == 0) ray.t_max = sampler.get_2d().x;
                if (i % 31 == 30) ray.direction = {};
                if (i % 37 == 36) ray.t_max = std::numeric_limits<float>::quiet_NaN();
                rays.push_back(ray);
                if (i % 11 == 0) rays.push_back(ray);
            }
            std::vector<Hit> hits(rays.size());
            accelerator.closest_of_incoherent(rays, all_of(rays), hits);
            for (std::size_t i = 0; i < rays.size(); ++i) {
                REQUIRE(hits[i] == accelerator.closest(rays[i]));
                found += hits[i].valid();
            }
        }
        CHECK(found > 1000);
    }

    TEST_CASE("one instance is no list of few primitives") {
        SceneBuilder builder;
        const std::uint32_t white = builder.material(Diffuse{{Rgb(0.7f)}}), ball = builder.shape(icosphere(3));
        builder.place_moving(ball, white, translation(Vec3(0, 0, 0)), translation(Vec3(1, 0, 0)));
        const Scene scene = builder.finish();
        CHECK(!prepare(scene, PathTracerSettings()).data().accelerator.few_primitives());
    }

    TEST_CASE("and at every scale, far from the origin") {
        for (const Placement& place : {Placement{1e-6f, {}}, Placement{1e6f, {}}, Placement{1, {5000, -3000, 8000}},
                                       Placement{1e-3f, {1, 2, 3}}})
            for (const RoomLight light :
                 {RoomLight::kRectangle, RoomLight::kTriangle, RoomLight::kPoint, RoomLight::kSky}) {
                CAPTURE(place.scale);
                CAPTURE(static_cast<int>(light));
                PathTracerSettings settings;
                settings.seed = 8;
                check_same(room(light, ObjectCount::kFew, place), settings);
            }
    }

    TEST_CASE("and whatever paths are requested") {
        const Scene scene = room(RoomLight::kRectangle, ObjectCount::kFew, {});
        const auto check_with = [&](const auto& change) {
            PathTracerSettings settings;
            change(settings);
            check_same(scene, settings);
        };
        for (const int depth : {1, 2, 5}) check_with([&](PathTracerSettings& s) { s.max_depth = depth; });
        check_with([](PathTracerSettings& s) { s.russian_roulette = false, s.max_depth = 20; });
        check_with([](PathTracerSettings& s) { s.integrator = Integrator::kDirect; });
        check_with([](PathTracerSettings& s) { s.sampler = SamplerKind::kIndependent; });
        check_with([](PathTracerSettings& s) { s.adaptive = true; }); // two replicates
        check_with([](PathTracerSettings& s) { s.environment = false; });
        check_with([](PathTracerSettings& s) { s.skips.shadow_rays = false; });
        check_with([](PathTracerSettings& s) { s.skips.textures = false; });
    }
}
