// These tests check random walks inside of solids against closed forms, and pictures of solids against those of
// diffuse surfaces. Where a comparison is statistical, its odds of a false alarm are stated.
#include "common/material/subsurface.h"

#include "common/sampling/hash.h"
#include "raster/screen_space/diffusion_profile.h"
#include "raytrace/integrator/random_walk.h"
#include "tests/raytrace/estimates.h"
#include "tests/raytrace/h_function.h"
#include "tests/raytrace/scene_builder.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::raytrace;

namespace {

/// Returns the fraction of diffuse light that a half space reflects toward cosines in [from, to]. Under the radiance 1
/// from everywhere it reflects the radiance 1 − √(1 − ϖ) H(μ) (Chandrasekhar, §38 and the principle of reciprocity).
double reflected_between(const HFunction& h, double albedo, double from, double to) {
    constexpr int kSteps = 200;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double mu = from + (to - from) * (i + 0.5) / kSteps;
        sum += 2 * mu * (1 - std::sqrt(1 - albedo) * h(mu));
    }
    return sum * (to - from) / kSteps;
}

/// Returns the fraction of the light of a thin beam that leaves a half space farther than `radius` mean free paths from
/// where it has entered (Jensen et al. 2001, "A Practical Model for Subsurface Light Transport", §2.1).
double dipole_beyond(double radius, double albedo, double internal_reflectance) {
    const double transport = std::sqrt(3 * (1 - albedo)); // σtr in units of 1 / mean free path
    const double a = (1 + internal_reflectance) / (1 - internal_reflectance);
    const double depths[] = {1, 1 + 4 * a / 3}; // of the real source, and height of the virtual one
    double sum = 0;
    // ∫ z (σ d + 1) exp(−σ d) / d³ · r dr = z exp(−σ d) / d, because d dd = r dr
    for (const double z : depths) {
        const double d = std::sqrt(radius * radius + z * z);
        sum += z * std::exp(-transport * d) / d;
    }
    return albedo / 2 * sum;
}

/// Says where walks have left a half space, by their distance from where they have entered.
struct Distances {
    double share = 0; ///< of the light that leaves at all
    double mean = 0, median = 0, last_tenth = 0;

    Distances(std::vector<std::pair<double, double>> distances_and_weights, int walks) {
        std::ranges::sort(distances_and_weights);
        double sum = 0, passed = 0;
        for (const auto& [distance, weight] : distances_and_weights) sum += weight, mean += weight * distance;
        share = sum / walks;
        mean /= sum;
        for (const auto& [distance, weight] : distances_and_weights) {
            if (passed < sum / 2) median = distance;
            if (passed < sum * 0.9) last_tenth = distance;
            passed += weight;
        }
    }
};

/// Walks in a half space of mean free path 1, whose surface reflects this fraction of the light back, diffusely.
Distances reflected_walks(float albedo, float internal_reflectance, int count) {
    const double s = static_cast<double>(similarity_parameter(albedo)), survival = 1 - s * s;
    std::uint64_t drawn = 0;
    const auto random = [&] { return static_cast<double>(unit_float(high_bits(stream_number(1, drawn++)))); };
    const auto direction = [&](double z) {
        const double phi = 2 * kPiDouble * random(), r = std::sqrt(1 - z * z);
        return Vec3d(r * std::cos(phi), r * std::sin(phi), z);
    };
    std::vector<std::pair<double, double>> found;
    for (int i = 0; i < count; ++i) {
        Vec3d p(0, 0, 0), w = direction(-std::sqrt(random()));
        for (;;) {
            const double t = -std::log1p(-random());
            if (p.z + w.z * t > 0) {
                p = p - w * (p.z / w.z);
                if (random() >= static_cast<double>(internal_reflectance)) {
                    found.emplace_back(std::hypot(p.x, p.y), 1);
                    break;
                }
                p.z = 0, w = direction(-std::sqrt(random()));
                continue;
            }
            if (random() >= survival) break;
            p = p + w * t, w = direction(2 * random() - 1);
        }
    }
    return {std::move(found), count};
}

/// Holds a slab so large and thick that it is a half space for light, below z = 0, seen from above.
struct HalfSpace {
    static Scene make_scene(float mean_free_path, const Material& material) {
        SceneBuilder builder;
        const float half = 3000 * mean_free_path;
        builder.add(box_quads({-half, -half, -half}, {half, half, 0}), builder.material(material));
        builder.scene.camera.eye = {0, 0, 1.0 * static_cast<double>(mean_free_path)};
        return builder.finish();
    }
    HalfSpace(float mean_free_path, const Material& material)
        : scene(make_scene(mean_free_path, material)), prepared(prepare(scene, settings())),
          plan(prepared.data(), View{scene.camera, 1, 1}, settings()) {}
    HalfSpace(const HalfSpace&) = delete; // the plan refers to the scene
    HalfSpace& operator=(const HalfSpace&) = delete;
    static PathTracerSettings settings() { return {}; }

    /// Returns where a walk leaves that has entered at (0, 0, 0), and its weight.
    std::optional<SolidExit> walk(const SolidInterior& interior, int index, Rgb& weight) const {
        Sampler sampler(SamplerKind::kIndependent, 7, 1);
        sampler.start(0, 0, static_cast<std::uint32_t>(index));
        const VertexRandomSamples u = vertex_random_samples(sampler, 0);
        const Vec3 up = cosine_hemisphere(u.bsdf);
        Ray ray{Vec3(0, 0, 0), Vec3(up.x, up.y, -up.z)};
        Hit hit = plan.prepared.accelerator.closest(ray);
        PathThroughputT<float> path;
        Rgb emitted;
        RayCounts counts;
        const auto exit = random_walk(plan, {interior, hit.object}, ray, hit, u.distance, path, emitted, counts);
        weight = exit ? path.throughput : Rgb();
        CHECK(is_black(emitted));
        return exit;
    }

    Distances distances(const SolidInterior& interior, int count) const {
        std::vector<std::pair<double, double>> found;
        for (int i = 0; i < count; ++i) {
            Rgb weight;
            const auto exit = walk(interior, i, weight);
            if (!exit) continue;
            const Vec3 p = exit->ray.at(exit->hit.t);
            found.emplace_back(std::hypot(p.x, p.y), weight.g);
        }
        return {std::move(found), count};
    }

    const Scene scene;
    const PathTracerScene prepared;
    const RenderPlan plan;
};

/// A principled solid has no reflection at the inner side of its surface.
Principled index_matched(Rgb albedo, Rgb mean_free_path) {
    Principled material;
    material.base_color = {albedo};
    material.metallic = 0;
    material.subsurface = 1;
    material.mean_free_path = mean_free_path;
    return material;
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("the albedo of a thick layer is that of Chandrasekhar's H-function to 0.003, and has an exact inverse") {
        for (const double albedo : {0.05, 0.3, 0.6, 0.9, 0.99, 0.999}) {
            CAPTURE(albedo);
            const double truth = reflected_between(HFunction(albedo), albedo, 0, 1);
            const float found = thick_layer_albedo(static_cast<float>(albedo));
            CHECK(std::abs(static_cast<double>(found) - truth) < 0.003);
            const SolidInterior interior = solid_interior(Rgb(found), Rgb(0.01f));
            CHECK(interior.scattering.g == doctest::Approx(albedo * 100).epsilon(1e-5));
            CHECK(interior.absorption.g == doctest::Approx((1 - albedo) * 100).epsilon(1e-4));
        }
        CHECK(is_black(solid_interior(Rgb(1.0f), Rgb(1.0f)).absorption));
        CHECK(solid_interior(Rgb(0.0f), Rgb(1.0f)).scattering.g < 1e-6f);
    }

    TEST_CASE("measured solids reflect what their authors have computed, within 0.05") {
        struct Row {
            const char* name;
            Rgb reflectance; // Jensen et al. 2001, figure 5
        };
        for (const Row& row : {Row{"marble", {0.83f, 0.79f, 0.75f}}, Row{"skin", {0.44f, 0.22f, 0.13f}},
                               Row{"skin-pale", {0.63f, 0.44f, 0.34f}}, Row{"whole-milk", {0.91f, 0.88f, 0.76f}},
                               Row{"ketchup", {0.16f, 0.01f, 0.00f}}, Row{"apple", {0.85f, 0.84f, 0.53f}},
                               Row{"cream", {0.98f, 0.90f, 0.73f}}, Row{"potato", {0.77f, 0.62f, 0.21f}},
                               Row{"skimmed-milk", {0.81f, 0.81f, 0.69f}}, Row{"chicken", {0.31f, 0.15f, 0.10f}}}) {
            CAPTURE(row.name);
            const MeasuredSolid* solid = find_measured_solid(row.name);
            REQUIRE(solid != nullptr);
            const float back = Coated{{}, 0, solid->ior}.internal_reflectance();
            for (std::size_t c = 0; c < 3; ++c) {
                CAPTURE(c);
                const float a = solid->albedo()[c];
                CHECK(std::abs(a * (1 - back) / (1 - a * back) - row.reflectance[c]) < 0.05f);
            }
        }
        CHECK(measured_solids().size() == 10);
        CHECK(find_measured_solid("granite") == nullptr);
    }

    TEST_CASE("a solid whose light comes nowhere becomes a diffuse surface") {
        const auto path_at = [](float mean_free_path) {
            SceneBuilder builder;
            builder.add(Sphere{{0, 0, 0}, 100}, builder.material(index_matched(Rgb(0.5f), Rgb(mean_free_path))));
            const Scene scene = builder.finish();
            CHECK(scene.needs.subsurface == has_subsurface(scene.materials[0]));
            return *duet::mean_free_path(scene.materials[0]);
        };
        CHECK(path_at(1e-6f).g == 0);
        CHECK(path_at(0.1f).g == 0.1f);
    }
}

TEST_SUITE("statistical") {

    // Diffusion theory holds far from the point of entry in a medium that absorbs little. It takes all light to enter
    // straight and to start from the depth of one mean free path, so that agreement is not exact.
    TEST_CASE("walks come as far as in the diffusion dipole, within a tenth") {
        constexpr int kWalks = 200000;
        const Coated material{{Rgb(thick_layer_albedo(0.99f))}, 0, 1.5f, Rgb(1.0f)};
        const HalfSpace space(1, material);
        const SolidInterior interior = material.subsurface_at({}, SurfacePoint{}).interior;
        for (const double radius : {4.0, 8.0, 12.0}) {
            CAPTURE(radius);
            double beyond = 0;
            for (int i = 0; i < kWalks; ++i) {
                Rgb weight;
                const auto exit = space.walk(interior, i, weight);
                if (!exit) continue;
                const Vec3 p = exit->ray.at(exit->hit.t);
                if (sqr(p.x) + sqr(p.y) > sqr(static_cast<float>(radius))) beyond += static_cast<double>(weight.g);
            }
            const double truth = dipole_beyond(radius, 0.99, static_cast<double>(material.internal_reflectance()));
            CHECK(beyond / kWalks == doctest::Approx(truth).epsilon(0.1));
        }
    }

    // The standard errors are below 1 %.
    TEST_CASE("walks come as far on average as in the profile of the rasterizer, within 5 %") {
        for (const float albedo : {0.1f, 0.3f, 0.6f, 0.8f, 0.95f}) {
            CAPTURE(albedo);
            const HalfSpace space(1, index_matched(Rgb(albedo), Rgb(1.0f)));
            const Distances walks = space.distances(solid_interior(Rgb(albedo), Rgb(1.0f)), 40000);
            CHECK(walks.mean == doctest::Approx(2.5f / raster::diffusion_profile::scale(albedo)).epsilon(0.05));
        }
    }

    // The test's own walks are reflected at the inner side of the surface. The standard errors are below 1 %.
    TEST_CASE("without reflection at the inner side, walks with longer free paths leave as far, within 5 %") {
        for (const float ior : {1.3f, 1.5f})
            for (const float albedo : {0.5f, 0.8f, 0.93f}) {
                CAPTURE(ior);
                CAPTURE(albedo);
                const Coated material{{Rgb(albedo)}, 0.3f, ior, Rgb(1.0f)};
                const SubsurfaceBsdf surface = material.subsurface_at({}, SurfacePoint{});
                const Distances truth = reflected_walks(albedo, material.internal_reflectance(), 40000);
                const Distances walks = HalfSpace(1, material).distances(surface.interior, 40000);
                CHECK(walks.share == doctest::Approx(truth.share).epsilon(0.02));
                CHECK(walks.mean == doctest::Approx(truth.mean).epsilon(0.05));
                CHECK(walks.median == doctest::Approx(truth.median).epsilon(0.06));
                CHECK(walks.last_tenth == doctest::Approx(truth.last_tenth).epsilon(0.05));
            }
    }

    // The standard errors are below 0.001. If a path left a solid inside of another, or at the surface of one that
    // overlaps another, its light would be lost.
    TEST_CASE("white solids inside of each other, and overlapping, return all light") {
        for (const Vec3 shift : {Vec3(0, 0, 0), Vec3(0.7f, 0.2f, 0)}) {
            CAPTURE(shift.x);
            SceneBuilder builder;
            const std::uint32_t white = builder.material(Coated{{Rgb(1.0f)}, 0.3f, 1.5f, Rgb(0.3f)});
            builder.add(Sphere{{0, 0, 0}, 1}, white);
            builder.add(icosphere(2, 0.5f, shift), white);
            builder.scene.environment = ConstantEnvironment{Rgb(1.0f)};
            builder.scene.camera.eye = {0, 0, 4};
            PathTracerSettings settings;
            settings.samples_per_pixel = 64;
            settings.max_depth = 100000;
            CHECK(estimate(builder.finish(), 24, settings).mean == doctest::Approx(1).epsilon(0.004));
        }
    }

    // In a white medium that fills all space, nearly all walks would go on to the limit of 30,000 rays.
    TEST_CASE("a walk that has left an open mesh through its hole ends") {
        SceneBuilder builder;
        builder.add(QuadList{{Quad{{-1, -1, 0}, {2, 0, 0}, {0, 2, 0}}}},
                    builder.material(index_matched(Rgb(1.0f), Rgb(1.0f))));
        builder.scene.environment = ConstantEnvironment{Rgb(1.0f)};
        builder.scene.camera.eye = {0, 0, 1};
        PathTracerSettings settings;
        settings.samples_per_pixel = 16;
        const Rendering image = render_scene(builder.finish(), 16, settings);
        CHECK(image.statistics.indirect_rays < 100 * 16 * 16 * 16);
        CHECK(mean_of(image.radiance).g > 0.1f);
    }

    // The standard errors are below 0.001.
    TEST_CASE("a solid of short mean free paths looks like a coated diffuse surface") {
        for (const float roughness : {0.1f, 0.6f}) {
            CAPTURE(roughness);
            const auto mean = [&](float mean_free_path) {
                SceneBuilder builder;
                builder.add(Sphere{{0, 0, 0}, 1},
                            builder.material(Coated{{Rgb(0.7f)}, roughness, 1.5f, Rgb(mean_free_path)}));
                builder.scene.environment = SkyEnvironment{Rgb(0.2f), Rgb(2.0f)};
                builder.scene.camera.eye = {0, 0, 2.2};
                builder.scene.lights = {PointLight{{1, 3, 4}, Rgb(20.0f)}};
                PathTracerSettings settings;
                settings.samples_per_pixel = 64;
                return estimate(builder.finish(), 24, settings);
            };
            const Estimate solid = mean(2e-4f), surface = mean(0);
            check_equal_means(solid, surface);
            CHECK(solid.error < 2e-3 * surface.mean);
        }
    }

    // Each of the 60 checks fails by chance once in 500 million times.
    TEST_CASE("walks leave a half space as the H-function tells, at scales from 1e-6 to 1e6") {
        constexpr int kWalks = 100000, kBins = 5;
        for (const float mean_free_path : {1e-6f, 1.0f, 1e6f})
            for (const double albedo : {0.3, 0.9, 0.99}) {
                CAPTURE(mean_free_path);
                CAPTURE(albedo);
                const HalfSpace space(mean_free_path, index_matched(Rgb(0.5f), Rgb(mean_free_path)));
                const float share = static_cast<float>(albedo);
                const SolidInterior interior{Rgb(share / mean_free_path), Rgb((1 - share) / mean_free_path)};
                std::array<double, kBins> sums{}, squares{};
                for (int i = 0; i < kWalks; ++i) {
                    Rgb weight;
                    const auto exit = space.walk(interior, i, weight);
                    if (!exit) continue;
                    const auto bin = static_cast<std::size_t>(std::min(exit->ray.direction.z, 0.9999f) * kBins);
                    sums[bin] += static_cast<double>(weight.g);
                    squares[bin] += static_cast<double>(sqr(weight.g));
                }
                const HFunction h(albedo);
                for (int bin = 0; bin < kBins; ++bin) {
                    CAPTURE(bin);
                    const auto b = static_cast<std::size_t>(bin);
                    const double mean = sums[b] / kWalks,
                                 truth = reflected_between(h, albedo, 0.2 * bin, 0.2 * bin + 0.2);
                    CHECK(std::abs(mean - truth) <
                          6 * std::sqrt(squares[b] / kWalks - mean * mean) / std::sqrt(kWalks));
                }
            }
    }
}
