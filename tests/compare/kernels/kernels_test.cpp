#include "compare/kernels/interleave.h"
#include "compare/kernels/kernels.h"
#include "compare/kernels/measure_kernels.h"
#include "compare/kernels/ray_sets.h"
#include "compare/kernels/watertight.h"
#include "compare/stress/accelerated_scene.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <set>
#include <sstream>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

using namespace duet;
using namespace duet::compare;

namespace {

const std::filesystem::path kModels = std::filesystem::path(DUET_SOURCE_DIR) / "models";

Camera outside_camera() {
    Camera camera;
    camera.eye = {2, 1.5, 3};
    return camera;
}

KernelScene lump(Arrangement arrangement, int levels = 3) {
    Mesh mesh = icosphere(levels, 0.1f);
    if (arrangement == Arrangement::kRoom) mesh = enclosed(std::move(mesh), Vec3(), 4);
    return make_kernel_scene("lump", arrangement, std::move(mesh), outside_camera());
}

TracerFactory ours_for(const raytrace::Accelerator& accelerator) {
    return [&](std::span<const Ray> rays) { return duet_closest(accelerator, rays); };
}

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("ranges") {
        CHECK(median_range({3}).median == 3);
        const MedianRange range = median_range({4, 1, 3, 8});
        CHECK(range.min == 1);
        CHECK(range.median == 3); // the lower of the two middle values
        CHECK(range.max == 8);
    }

    TEST_CASE("ours runs beside every peer's measurement, and ratios are of neighbors") {
        std::string order;
        double pace = 1; // the CPU becomes slower, which must hardly affect the ratios
        const auto timed = [&](char name, double seconds) -> TimedWork {
            return [&order, &pace, name, seconds] {
                order += name;
                pace *= 1.01;
                return seconds * pace;
            };
        };
        const InterleavedTimings found =
            interleave(timed('o', 2), {timed('a', 4), timed('b', 1), timed('c', 6)}, 5, 1e9, Control{});
        CHECK(order.substr(0, 12) == "oabocoaboco" + std::string("a"));
        CHECK(found.repeats == 5);
        REQUIRE(found.peers.size() == 3);
        CHECK(found.peers[0].ratio.median == doctest::Approx(2).epsilon(0.011));
        CHECK(found.peers[1].ratio.median == doctest::Approx(0.5).epsilon(0.011));
        CHECK(found.peers[2].ratio.median == doctest::Approx(3).epsilon(0.011));
        for (const PairedTiming& versus : found.peers)
            CHECK(versus.theirs / versus.ours == versus.ratio.median); // one pair
        // The time limit was reached.
        CHECK(interleave(timed('o', 1), {timed('a', 1)}, 10, 0, Control{}).repeats == kMinRepeatsForVerdict);
        CHECK(interleave(timed('o', 1), {}, 4, 1e9, Control{}).peers.empty());
    }

    TEST_CASE("a subset is whole groups, spread over the set, of about the length requested") {
        constexpr std::size_t kGroupRays = kBlock * RaySubset::kGroup;
        for (const std::size_t rays : {std::size_t{1}, kGroupRays - 1, kGroupRays, 100 * kGroupRays + 17}) {
            const RaySubset all = choose_ray_subset(rays, 1e9, 1e-3 * static_cast<double>(rays) / 1e6);
            CHECK(all.rays == rays);
            const std::size_t groups = (rays + kGroupRays - 1) / kGroupRays;
            CHECK(std::set(all.groups.begin(), all.groups.end()).size() == groups);
            CHECK(choose_ray_subset(rays, 1e6, 10 * static_cast<double>(groups * kGroupRays) / 1e6).passes == 10);
        }
        const RaySubset tenth = choose_ray_subset(1000 * kGroupRays, 1e6, 0.1 * static_cast<double>(kGroupRays) / 1e3);
        CHECK(tenth.passes == 1);
        CHECK(tenth.rays == 100 * kGroupRays);
        CHECK(tenth.groups.front() == 0);
        CHECK(tenth.groups.back() == 990);
        CHECK(choose_ray_subset(0, 1e6, 1).groups.empty());
    }

    TEST_CASE("one by one, in bulk and in any number of threads the answers are the same") {
        const KernelScene scene = lump(Arrangement::kRoom);
        const raytrace::Accelerator accelerator(*scene.scene, 1);
        const auto rays = camera_rays(scene.camera, 70, 50, PixelOrder::kZCurve, 1);
        const auto one = trace_all(duet_closest(accelerator, rays), rays.size(), 1);
        REQUIRE(one.size() == rays.size());
        for (const auto& other : {trace_all(duet_closest(accelerator, rays), rays.size(), 3),
                                  trace_all(duet_batched(accelerator, rays), rays.size(), 1)})
            CHECK(std::ranges::equal(one, other, [](const RayResult& a, const RayResult& b) {
                return a.t == b.t && a.triangle == b.triangle;
            }));
    }

    TEST_CASE("points inside lie inside; a closed mesh lets no ray out, one with a hole does") {
        const KernelScene scene = lump(Arrangement::kAlone);
        REQUIRE(scene.triangles().closed.value());
        const HitOracle oracle(*scene.scene);
        for (const Vec3& p : points_inside(scene, oracle, 200, 1)) REQUIRE(length(p) < 1.1f);
        const raytrace::Accelerator accelerator(*scene.scene, 1);
        const TracerFactory bulk = [&](std::span<const Ray> rays) { return duet_batched(accelerator, rays); };
        const Watertight tight =
            test_watertight(scene, oracle, {ours_for(accelerator), bulk}, 100'000, 0, 2, Control{});
        CHECK(tight.rays == 100'000);
        for (const Watertight::Kernel& kernel : tight.kernels) {
            CHECK(kernel.misses == 0);
            CHECK(kernel.faults.rays == 100'000);
            CHECK_FALSE(kernel.faults.any());
        }

        Mesh holed = scene.triangles();
        holed.triangles.pop_back();
        const KernelScene leaky = make_kernel_scene("holed", Arrangement::kAlone, holed, scene.camera);
        REQUIRE_FALSE(leaky.closed());
        const raytrace::Accelerator other(*leaky.scene, 1);
        const auto found = test_watertight(scene, oracle, {ours_for(other)}, 100'000, 0, 2, Control{}).kernels.front();
        CHECK(found.misses > 10); // one of 1280 triangles is missing
        CHECK(found.misses < 1000);
        CHECK(found.faults.edge + found.faults.wrong == found.misses);
        CHECK(found.faults.edge > 0); // at the rim of the missing triangle, where the surface continues
    }

    TEST_CASE("rooms and instances are watertight, too; a kernel that slips through edges is caught though none "
              "escape") {
        for (const Arrangement arrangement : {Arrangement::kRoom, Arrangement::kInstances}) {
            const KernelScene scene = arrangement == Arrangement::kRoom
                                          ? lump(arrangement)
                                          : load_kernel_scene(kModels / "meshes/pear.obj", arrangement);
            CAPTURE(name_of(arrangement));
            REQUIRE(scene.closed());
            const HitOracle oracle(*scene.scene);
            const raytrace::Accelerator accelerator(*scene.scene, 1);
            // This tracer ignores hits too close to an edge and returns the surface behind them.
            const TracerFactory slipping = [&](std::span<const Ray> rays) {
                return Tracer{
                    "", [&accelerator, rays](std::size_t block, RayResult* ray_results) {
                        for (Ray ray : block_of(rays, block)) {
                            Hit hit = accelerator.closest(ray);
                            if (min(min(hit.u, hit.v), 1 - hit.u - hit.v) < 1e-7f) {
                                ray.t_min = hit.t * (1 + 1e-4f);
                                hit = accelerator.closest(ray);
                            }
                            *ray_results++ = {hit.t, hit.valid() ? hit.primitive : RayResult::kNone, hit.object};
                        }
                    }};
            };
            const Watertight found =
                test_watertight(scene, oracle, {ours_for(accelerator), slipping}, 50'000, 0, 2, Control{});
            CHECK(found.kernels[0].misses == 0);
            CHECK_FALSE(found.kernels[0].faults.any());
            CHECK(found.kernels[1].faults.edge > 100);
        }
    }

    TEST_CASE("the JSON has a row for each work and number of threads, with the keys of the design") {
        for (const Arrangement arrangement : {Arrangement::kAlone, Arrangement::kRoom}) {
            const KernelScene scene = lump(arrangement);
            KernelSettings settings;
            settings.works = kWorks;
            if (!embree_version().empty()) settings.peers = {{false, false}, {true, true}};
            settings.size = {64, 48};
            settings.threads = 2;
            settings.repeats = 1;
            settings.seconds = 1e-3;
            settings.watertight = 5000;
            const KernelResults table = measure_kernels(scene, settings, Control{});
            std::set<std::pair<std::string, int>> seen;
            const bool peer = !settings.peers.empty();
            for (const nlohmann::json& row : rows_json(table)) {
                CAPTURE(row.dump());
                seen.insert({row.at("work").get<std::string>(), row.at("threads").get<int>()});
                CHECK(row.at("mesh") == "lump");
                CHECK(row.at("scene") == name_of(arrangement));
                CHECK(row.at("triangles") == (arrangement == Arrangement::kRoom ? 1294 : 1280));
                CHECK(row.at("ours").get<double>() > 0);
                CHECK(row.at("peer").is_number() == peer);
                CHECK(row.at("peer_name").is_string() == peer);
                if (!peer) continue;
                const auto& ratio = row.at("ratio");
                CHECK(ratio.at("min").get<double>() > 0);
                CHECK(ratio.at("min") <= ratio.at("median"));
                CHECK(ratio.at("median") <= ratio.at("max"));
                if (row.contains("mismatches")) {
                    CHECK(row["mismatches"].at("ours_wrong") == 0);
                    CHECK(row["mismatches"].at("ours_edge_faults") == 0);
                    CHECK(row["mismatches"].at("rays").get<int>() > 0);
                }
                if (row.contains("leaks")) CHECK(row["leaks"].at("ours") == 0);
            }
            for (const std::string& work : kWorks)
                for (const int threads : {1, 2}) CHECK(seen.count({work, threads}) == 1);
            CHECK(seen.count({"memory", 2}) == 1);
            const nlohmann::json aimed = watertight_json(table);
            REQUIRE(aimed.size() == 2 + settings.peers.size());
            for (const std::size_t ours : {0u, 1u})
                for (const char* key : {"misses", "edge_faults", "wrong"}) CHECK(aimed[ours].at(key) == 0);
            for (const nlohmann::json& judged : judged_json(table)) {
                CHECK(judged.at("rays").get<int>() > 0);
                CHECK(judged.at("wrong") == 0);
                CHECK(judged.at("edge_faults") == 0);
            }
            CHECK(table.judged.size() == 4);
            CHECK(kernel_failures(table).empty());
        }
    }

    TEST_CASE("faults are reported: wrong answers, leaks, misses, edge faults; the peer's are not ours") {
        KernelResults table;
        CHECK(kernel_failures(table).empty());
        table.watertight = {{"duet", 2, {10, 0, 0}}, {"embree", 5, {10, 5, 5}}};
        KernelRow row;
        row.work = "bounce";
        row.mismatches = Mismatches{10, 0, 0, 0, 1, {1, 0, 1}, {1, 1, 1}};
        row.leaks = Leaks{1, 7};
        table.rows = {row, row};
        table.rows[1].threads = 2; // the same results: reported once
        CHECK(kernel_failures(table).size() == 3);
        table.judged = {{"bounce", {100, 1, 1}}};
        CHECK(kernel_failures(table).size() == 5);
        table.judged.clear();
        table.watertight.front() = {"duet bulk", 0, {10, 1, 0}};
        table.rows.front().mismatches->ours = {1, 1, 0};
        CHECK(kernel_failures(table).size() == 3);
        table.watertight.front().faults.edge = 0;
        table.rows.front().mismatches->ours.edge = 0;
        table.rows.front().leaks->ours = table.rows.back().leaks->ours = 0;
        CHECK(kernel_failures(table).empty());
    }

    TEST_CASE("the best of the peer's settings is that beside which we do worst") {
        std::vector<KernelRow> rows(4);
        const std::array<const char*, 4> works{"bounce", "bounce", "build", "build"};
        for (std::size_t i = 0; i < rows.size(); ++i) {
            rows[i].work = works[i];
            rows[i].peer_name = "peer";
            rows[i].ratio.median = 2.0 - static_cast<double>(i % 2);
            // A higher rate in a faster phase of the CPU does not mean a better ratio.
            rows[i].peer = 1.0 - static_cast<double>(i % 2);
        }
        mark_best(rows);
        CHECK_FALSE(rows[0].best);
        CHECK(rows[1].best);
        CHECK_FALSE(rows[2].best);
        CHECK(rows[3].best);
        rows[2].ratio.median = rows[3].ratio.median; // the first of equal ratios is marked
        mark_best(rows);
        CHECK(rows[2].best);
        CHECK_FALSE(rows[3].best);
        CHECK(verdict({1.01, 1.1, 1.2}, 5) == "ahead");
        CHECK(verdict({0.9, 1.1, 1.2}, 7) == "even");
        CHECK(verdict({0.8, 0.9, 0.99}, 5) == "behind");
        CHECK(verdict({1.01, 1.1, 1.2}, 4) == "too few");
    }

    TEST_CASE("the table: what nothing explains comes first, single camera rays are marked") {
        KernelResults table;
        table.mesh = "lump";
        for (const char* work : {"camera", "bounce", "shadow"}) {
            KernelRow row;
            row.work = work;
            row.peer_name = "peer";
            row.mismatches = Mismatches{1000, 5, 0, 0, 0, {}, {}};
            row.ratio = {1, 1, 1};
            row.repeats = 3;
            table.rows.push_back(row);
            row.peer_name = "another setting"; // differs for fewer rays
            row.mismatches->tie = 1;
            table.rows.push_back(row);
        }
        table.rows.back().mismatches = Mismatches{1000, 0, 0, 0, 1, {1, 0, 1}, {1, 0, 0}};
        mark_best(table.rows);
        std::ostringstream out;
        print_table(out, table);
        const std::string text = out.str();
        CAPTURE(text);
        CHECK(text.find("camera *") != std::string::npos);
        CHECK(text.find("* one by one") != std::string::npos);
        CHECK(text.find("bounce *") == std::string::npos);
        CHECK(text.find("too few") != std::string::npos);
        const std::string checks = text.substr(text.find("where both differ"));
        CHECK(checks.find("shadow !") < checks.find("camera"));
        CHECK(checks.find("shadow !") < checks.find("bounce"));
        // The other setting has fewer differences, but one is unexplained.
        CHECK(checks.find("another setting") != std::string::npos);
    }

#if defined(__GLIBC__) && !defined(DUET_SANITIZED)
    TEST_CASE("the accelerator's account of its memory is what it has allocated") {
        const KernelScene scene = lump(Arrangement::kAlone, 6); // 81,920 triangles
        const auto allocated = [] {
            const struct mallinfo2 info = mallinfo2();
            return static_cast<double>(info.uordblks + info.hblkhd);
        };
        const double before = allocated();
        const raytrace::Accelerator accelerator(*scene.scene, 1);
        const double grown = allocated() - before;
        // Each of two arrays may be rounded up to large pages and aligned to them.
        CHECK(grown < 1.02 * static_cast<double>(accelerator.memory_bytes()) + 4 * (2 << 20));
        CHECK(grown > 0.98 * static_cast<double>(accelerator.memory_bytes()));
    }
#endif

    TEST_CASE("Embree's answers are ours but for ties and edges, one by one and in packets" *
              doctest::skip(embree_version().empty())) {
        const KernelScene scene = lump(Arrangement::kRoom, 4);
        const raytrace::Accelerator accelerator(*scene.scene, 1);
        const HitOracle oracle(*scene.scene);
        const EmbreeDevice widest(*scene.scene, 1), avx2(*scene.scene, 1, true);
        const auto camera = camera_rays(scene.camera, 100, 70, PixelOrder::kZCurve, 1);
        const auto bounce = bounce_rays(scene, accelerator, camera, 0, 1);
        const ShadowRays shadow = shadow_rays(scene, accelerator, camera, 0, 1);
        std::vector<EmbreeForm> forms = embree_bulk_forms();
        forms.push_back(EmbreeForm::kSingle);
        for (const EmbreeQuality quality : embree_qualities()) {
            CAPTURE(name_of(quality));
            const EmbreeScene embree(quality.avx2 ? avx2 : widest, quality);
            CHECK(embree.memory_bytes() > 20 * std::ssize(scene.triangles().triangles));
            CHECK(embree.memory_bytes() < 400 * std::ssize(scene.triangles().triangles));
            for (const std::vector<Ray>& rays : {camera, bounce}) {
                const auto ours = trace_all(duet_closest(accelerator, rays), rays.size(), 1);
                for (const EmbreeForm form : forms)
                    for (const bool coherent : {false, true}) {
                        const auto theirs = trace_all(embree.closest(rays, form, coherent), rays.size(), 1);
                        const Mismatches found = compare_results(oracle, {rays, {}}, ours, theirs, 1);
                        CHECK(found.unexplained == 0);
                        CHECK(found.ours.edge == 0);
                        CHECK(found.differ() < 100);
                    }
            }
            const auto ours = trace_all(duet_occluded(accelerator, shadow.rays, shadow.ends), shadow.rays.size(), 1);
            const auto theirs = trace_all(embree.occluded(shadow.rays), shadow.rays.size(), 1);
            CHECK(compare_results(oracle, {shadow.rays, shadow.ends}, ours, theirs, 1).unexplained == 0);
        }
    }

    TEST_CASE("Embree's instances are ours" * doctest::skip(embree_version().empty())) {
        const KernelScene scene = load_kernel_scene(kModels / "meshes/pear.obj", Arrangement::kInstances);
        const raytrace::Accelerator accelerator(*scene.scene, 1);
        const HitOracle oracle(*scene.scene);
        const EmbreeDevice device(*scene.scene, 1);
        const EmbreeScene embree(device, {false, false});
        const auto camera = camera_rays(scene.camera, 100, 70, PixelOrder::kZCurve, 1);
        const auto ours = trace_all(duet_closest(accelerator, camera), camera.size(), 1);
        CHECK(std::ranges::count_if(ours, [](const RayResult& a) { return a.object < 27; }) > 2000);
        std::vector<EmbreeForm> forms = embree_bulk_forms();
        forms.push_back(EmbreeForm::kSingle);
        for (const EmbreeForm form : forms) {
            const auto theirs = trace_all(embree.closest(camera, form, true), camera.size(), 1);
            const Mismatches found = compare_results(oracle, {camera, {}}, ours, theirs, 1);
            CHECK(found.unexplained == 0);
            CHECK(found.differ() < 70);
        }
    }
}
