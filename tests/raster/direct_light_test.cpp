// These tests compare the direct light of deferred shading with BSDFs, and with a loop over all lights.
#include "common/material/metal.h"
#include "common/system/control.h"
#include "common/vec/frame.h"
#include "raster/gbuffer/gbuffer_pass.h"
#include "raster/geometry/geometry.h"
#include "raster/lighting/direct_light.h"
#include "raster/lighting/light_set.h"
#include "raster/lighting/lit_batch.h"
#include "raster/render.h"
#include "tests/support/random.h"

#include <doctest/doctest.h>

#include <atomic>
#include <cstring>

using namespace duet;
using namespace duet::raster;
using duet::test::Random;

namespace {

float lane(const Floats& x) { return Lanes<Floats>(x)[0]; }

/// Holds the G-buffer of a scene.
struct SceneGBuffer {
    Scene scene;
    RasterSettings settings;
    std::optional<RasterScene> prepared;
    std::optional<GBuffer> gbuffer;

    SceneGBuffer(Scene loaded, int width, int height) : scene(std::move(loaded)) {
        settings.shadows = false, settings.environment = false;
        settings.ambient_occlusion = settings.indirect_light = false;
        settings.threads = 1;
        prepared.emplace(prepare(scene, settings));
        const PassView pass = center_view({scene.camera, width, height});
        const TileGrid grid{{0, 0, width, height}};
        const auto geometry = prepared->data().geometries->take();
        process_geometry(prepared->data(), grid, pass, settings, *geometry);
        gbuffer.emplace(ScreenProjection(pass.pinhole, SampleOffset()), width, height, optional_planes(scene));
        Planes3 emission(width, height);
        const Control control;
        fill_gbuffer({prepared->data(), settings, *geometry, nullptr, pass, grid, SampleOffset(), control}, *gbuffer,
                     emission);
    }
    DirectLight light(int threads, const LightVisibility* shadows = nullptr, std::size_t most = ChosenLights::kAll) {
        DirectLight result;
        light_into(result, threads, shadows, most);
        return result;
    }
    void light_into(DirectLight& result, int threads, const LightVisibility* shadows = nullptr,
                    std::size_t most = ChosenLights::kAll) {
        settings.threads = threads;
        compute_direct_light(prepared->data(), settings, *gbuffer,
                             scene_lights(prepared->data(), settings, gbuffer->projection), shadows, result, {most});
    }
    /// Evaluates all lights at all pixels.
    Planes3 all_lights() const {
        const std::vector<FrameLight> lights = frame_lights(scene.lights, gbuffer->projection);
        LitBatch::Tables tables;
        Planes3 result(gbuffer->width(), gbuffer->height());
        for_each_batch(gbuffer->width(), gbuffer->height(), 1, [&](int x, int y) {
            const LitBatch batch(*gbuffer, x, y, gbuffer->visible(x, y), tables);
            RgbT<Floats> sum(Floats(0.0f));
            for (const FrameLight& light : lights) sum += batch.reflected(light);
            result.set(x, y, sum);
        });
        return result;
    }
};

Scene model(const char* name) { return load_scene(std::string(DUET_SOURCE_DIR "/models/") + name); }

bool bitwise_equal(const Planes3& a, const Planes3& b) {
    for (const auto plane : {&Planes3::x, &Planes3::y, &Planes3::z})
        for (int y = 0; y < a.x.height(); ++y)
            if (std::memcmp((a.*plane).row(y), (b.*plane).row(y),
                            sizeof(float) * static_cast<std::size_t>(a.x.width())))
                return false;
    return true;
}

/// Compares two images by the mean of their channels, where `exact` is not black.
struct Difference {
    double mean = 0, worst = 0;

    Difference(const Planes3& a, const Planes3& exact) {
        int count = 0;
        for (int y = 0; y < a.x.height(); ++y)
            for (int x = 0; x < a.x.width(); ++x) {
                const auto reference = static_cast<double>(average(exact.color_at(x, y)));
                if (!(reference > 1e-6)) continue;
                const double relative = std::abs(static_cast<double>(average(a.color_at(x, y))) / reference - 1);
                mean += relative, ++count;
                if (!(relative <= worst)) worst = relative;
            }
        mean /= count;
    }
};

/// Shadows every light by a half.
struct HalfShadows final : LightVisibility {
    std::size_t source(std::size_t light) const override { return light; }
    bool noisy(std::size_t) const override { return true; }
    Floats visibility(std::size_t, const Vec3T<Floats>&, const Vec3T<Floats>&, int, int,
                      const xsimd::batch_bool<float>&) const override {
        return Floats(0.5f);
    }
};

/// Takes all lights for one source, and counts how often its shadows are looked up.
struct OneSource final : LightVisibility {
    mutable std::atomic<int> looks = 0;

    std::size_t source(std::size_t) const override { return 0; }
    bool noisy(std::size_t) const override { return true; }
    Floats visibility(std::size_t, const Vec3T<Floats>&, const Vec3T<Floats>&, int, int,
                      const xsimd::batch_bool<float>&) const override {
        ++looks;
        return Floats(0.25f);
    }
};

/// Holds a G-buffer of one batch: a surface point straight in front of a camera at the origin that looks along −z.
struct OneBatch {
    GBuffer gbuffer;
    LitBatch::Tables tables;

    explicit OneBatch(Vec3 normal, const MetalBsdf* metal)
        : gbuffer(ScreenProjection(pinhole(), SampleOffset()), kWidth, 1, {}) {
        const Rgb diffuse = metal ? Rgb() : Rgb(0.5f, 0.25f, 0.75f);
        for (int x = 0; x < kWidth; ++x) {
            gbuffer.reversed_depth(x, 0) = gbuffer.projection.near() / 2; // at 2 m
            gbuffer.normal.set_at(x, 0, normal);
            gbuffer.diffuse.set_at(x, 0, diffuse);
            if (metal) gbuffer.specular.set_at(x, 0, metal->reflectance);
            gbuffer.alpha(x, 0) = metal ? metal->alpha : 1;
        }
    }
    Rgb reflected(const Light& light) {
        const std::vector<FrameLight> lights = frame_lights(std::span(&light, 1), gbuffer.projection);
        const LitBatch batch(gbuffer, 0, 0, gbuffer.visible(0, 0), tables);
        const RgbT<Floats> c = batch.reflected(lights.front());
        return {lane(c.r), lane(c.g), lane(c.b)};
    }
    Vec3 p() const {
        const Vec3T<Floats> at = gbuffer.points(0, 0);
        return {lane(at.x), lane(at.y), lane(at.z)};
    }
    static Pinhole pinhole() {
        Camera camera;
        camera.eye = {0, 0, 0}, camera.look_at = {0, 0, -1}, camera.fov_degrees = 1, camera.near = 0.1;
        return CameraModel(View{camera, kWidth, 1}).pinhole();
    }
    static constexpr int kWidth = 16;
};

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("delta lights: the BSDF times the cosine; nothing from below the horizon") {
        Random random(5);
        double worst = 0;
        for (int i = 0; i < 2000; ++i) {
            Vec3 n = random.direction();
            if (n.z < 0.2f) continue; // the viewer is up to 8° from +z
            const MetalBsdf metal(Rgb(0.9f, 0.5f, 0.2f), random.log_range(0.002f, 1));
            const bool diffuse = i % 3 == 0;
            OneBatch one(n, diffuse ? nullptr : &metal);
            const Vec3 wi = random.direction(), wo = normalize(-one.p());
            const float distance = random.log_range(0.1f, 100);
            const Light point = PointLight{one.p() + wi * distance, Rgb(3, 2, 1)}, sun = SunLight{-wi, Rgb(1, 2, 3)};
            const float cosine = dot(n, wi);
            const Rgb at_point = one.reflected(point), at_sun = one.reflected(sun);
            if (cosine <= 0) {
                CHECK((is_black(at_point) || cosine > -1e-5f));
                CHECK(is_black(at_sun));
                continue;
            }
            const Frame frame = frame_from_normal(n);
            const Rgb f = diffuse ? Rgb(0.5f, 0.25f, 0.75f) * kInvPi
                                  : metal.eval(frame.to_local(wo), frame.to_local(wi), TransportMode::kRadiance);
            const auto check = [&](Rgb result, Rgb exact) {
                for (std::size_t c = 0; c < 3; ++c)
                    worst = std::max(worst, std::abs(static_cast<double>(result[c] - exact[c])) /
                                                (static_cast<double>(exact[c]) +
                                                 1e-4 * static_cast<double>(max_component(exact)) + 1e-9));
            };
            if (cosine > 0.01f) check(at_sun, f * Rgb(1, 2, 3) * cosine);
            if (cosine > 0.01f) check(at_point, f * Rgb(3, 2, 1) * (cosine / sqr(distance)));
        }
        CHECK(worst < 4e-5);
    }

    TEST_CASE("an emitter is dark behind, and does not light points in its own plane") {
        OneBatch one({0, 0, 1}, nullptr);
        const Vec3 p = one.p();
        const auto square = [&](Vec3 middle, Vec3 u, Vec3 v, bool two_sided) {
            SurfaceLight light{
                .shape = Quad{middle - (u + v) * 0.5f, u, v}, .two_sided = two_sided, .radiance = Rgb(1.0f)};
            return one.reflected(light).r;
        };
        const Vec3 above = p + Vec3(0, 0, 1);
        CHECK(square(above, {1, 0, 0}, {0, -1, 0}, false) == doctest::Approx(0.5f * 0.239).epsilon(0.01)); // faces p
        CHECK(square(above, {1, 0, 0}, {0, 1, 0}, false) == 0);                                            // faces away
        CHECK(square(above, {1, 0, 0}, {0, 1, 0}, true) == square(above, {1, 0, 0}, {0, -1, 0}, true));
        for (const float height : {-1e-6f, 0.0f, 1e-6f})
            for (const bool two_sided : {false, true}) {
                CHECK(square(p + Vec3(0, 0, height), {1, 0, 0}, {0, 1, 0}, two_sided) == 0);
                CHECK(square(p + Vec3(0, 0, height), {1, 0, 0}, {0, -1, 0}, two_sided) == 0);
            }
        // The point of a sphere that faces the viewer, with the sphere's normal.
        for (const bool two_sided : {false, true})
            for (const float radius : {0.999999f, 1.0f, 1.000001f}) {
                const SurfaceLight ball{
                    .shape = Sphere{p - Vec3(0, 0, 1), radius}, .two_sided = two_sided, .radiance = Rgb(1.0f)};
                CHECK(is_black(one.reflected(ball)));
            }
        const SurfaceLight around{.shape = Sphere{p + Vec3(0, 0, 0.1f), 5}, .two_sided = true, .radiance = Rgb(1.0f)};
        CHECK(one.reflected(around).r == doctest::Approx(0.5f)); // it fills the hemisphere
    }

    TEST_CASE("six lights of all kinds: rows as a loop over the lights; the same bits for any threads; half shadows") {
        SceneGBuffer view(model("everything.json"), 200, 120);
        const DirectLight one = view.light(1), three = view.light(3);
        CHECK(bitwise_equal(one.exact, three.exact));
        CHECK(bitwise_equal(one.exact, view.all_lights()));
        CHECK(one.lit.empty());
        const HalfShadows shadows;
        const DirectLight half = view.light(2, &shadows);
        CHECK(bitwise_equal(half.unshadowed, one.exact));
        for (int y = 0; y < one.exact.x.height(); ++y)
            for (int x = 0; x < one.exact.x.width(); ++x) {
                const bool any = !is_black(one.exact.color_at(x, y));
                CHECK(half.lit.x(x, y) == doctest::Approx(any ? 0.5f : DirectLight::kNoLight));
            }
    }

    TEST_CASE("the lights of one source share one look at its shadows, and are shadowed alike") {
        SceneGBuffer view(model("everything.json"), 200, 120);
        const OneSource shadows;
        const DirectLight found = view.light(2, &shadows), open = view.light(1);
        CHECK(bitwise_equal(found.unshadowed, open.exact));
        constexpr int kBatch = static_cast<int>(Floats::size), batches = (200 + kBatch - 1) / kBatch * 120;
        CHECK(shadows.looks > batches / 2);
        CHECK(shadows.looks <= batches);
        for (int y = 0; y < 120; ++y)
            for (int x = 0; x < 200; ++x)
                CHECK(found.lit.z(x, y) ==
                      doctest::Approx(is_black(open.exact.color_at(x, y)) ? DirectLight::kNoLight : 0.25f));
    }

    TEST_CASE("all pixels of an earlier frame's images are overwritten, by few lights and by many") {
        for (const char* file : {"everything.json", "lanterns.json"}) {
            SceneGBuffer view(model(file), 200, 112);
            view.gbuffer->reversed_depth.fill(0); // the background, but for a band of rows
            for (int y = 40; y < 60; ++y)
                for (int x = 0; x < 200; ++x) view.gbuffer->reversed_depth(x, y) = 0.1f;
            const HalfShadows shadows;
            const DirectLight fresh = view.light(1, &shadows), unshadowed = view.light(1);
            REQUIRE_FALSE(fresh.lit.empty());
            DirectLight reused = view.light(1, &shadows);
            for (Planes3* image : {&reused.exact, &reused.unshadowed, &reused.lit})
                for (PlaneFloat* plane : {&image->x, &image->y, &image->z}) plane->fill(7);
            view.light_into(reused, 1, &shadows);
            CHECK(bitwise_equal(reused.exact, fresh.exact));
            CHECK(bitwise_equal(reused.unshadowed, fresh.unshadowed));
            CHECK(bitwise_equal(reused.lit, fresh.lit));
            view.light_into(reused, 1);
            CHECK(bitwise_equal(reused.exact, unshadowed.exact));
            CHECK(reused.lit.empty());
        }
    }

    TEST_CASE("a thousand lights: clusters lose no light and err little; none if all lights have shadows") {
        SceneGBuffer view(model("lanterns.json"), 200, 112);
        const DirectLight one = view.light(1), three = view.light(3);
        CHECK(bitwise_equal(one.exact, three.exact));
        const Planes3 all = view.all_lights();
        const Difference difference(one.exact, all);
        CHECK(difference.mean < 2e-4);
        CHECK(difference.worst < 0.0035);
        const HalfShadows shadows;
        const Difference exact(view.light(2, &shadows).unshadowed, all);
        CHECK(exact.worst < 1e-5);
    }

    TEST_CASE("a few lights stand for a thousand: the mean over an image stays") {
        SceneGBuffer view(model("lanterns.json"), 200, 112);
        const auto mean = [](const Planes3& image) {
            double sum = 0;
            for (int y = 0; y < image.x.height(); ++y)
                for (int x = 0; x < image.x.width(); ++x) sum += static_cast<double>(average(image.color_at(x, y)));
            return sum / (image.x.width() * image.x.height());
        };
        const double all = mean(view.light(1).exact);
        const Planes3 few = view.light(1, nullptr, 8).exact;
        CHECK(mean(few) == doctest::Approx(all).epsilon(0.02));
        CHECK(bitwise_equal(few, view.light(3, nullptr, 8).exact));
        CHECK(!bitwise_equal(few, view.light(1).exact));
    }

    TEST_CASE("chosen lights have the expected light of all") {
        std::vector<FrameLight> lights;
        Random random(5);
        for (int i = 0; i < 200; ++i) {
            FrameLight& light = lights.emplace_back(FrameLight::Kind::kPoint, Rgb(random.log_range(0.01f, 10)));
            light.index = static_cast<std::size_t>(i);
            light.position = {random.range(-3, 3), random.range(0.1f, 2), random.range(-3, 3)}; // many in the box
        }
        const LightSet set(lights, nullptr);
        LightsOfCluster cluster;
        set.reach({{-1, 0, -1}, {1, 1, 1}, {-1, -1, -1}, {1, 1, 1}}, 0, cluster);
        double all = 0, expected = 0;
        for (const std::uint32_t i : cluster.near) all += static_cast<double>(lights[set.lights()[i]].emitted.g);
        REQUIRE(cluster.near.size() > 100);
        constexpr int kTries = 4096;
        std::vector<WeightedLight> chosen;
        for (int k = 0; k < kTries; ++k) {
            set.choose(cluster, 12, (static_cast<float>(k) + 0.5f) / kTries, chosen);
            CHECK(chosen.size() <= 12);
            for (const WeightedLight& light : chosen) {
                CHECK(light.weight < 1e4f); // no light stands for far brighter ones
                expected += static_cast<double>(light.weight * lights[light.index].emitted.g) / kTries;
            }
        }
        CHECK(expected == doctest::Approx(all).epsilon(0.002));
        set.choose(cluster, cluster.near.size(), 0.5f, chosen);
        for (const WeightedLight& light : chosen) CHECK(light.weight == 1);
    }
}
