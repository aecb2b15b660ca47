#include "compare/kernels/measure_kernels.h"

#include "common/system/parallel.h"
#include "compare/kernels/ray_sets.h"
#include "compare/kernels/watertight.h"
#include "compare/progress.h"

#include <algorithm>
#include <memory>
#include <optional>

namespace duet::compare {

const std::vector<std::string> kWorks{"build", "camera", "camera-bulk", "bounce", "shadow"};

namespace {

constexpr std::size_t kMaxCheckedRays = 20'000; ///< number of Duet's results per kind of ray that are judged
constexpr double kBuildLimit = 40; ///< time limit for the builds with one thread count, as a multiple of `seconds`

/// Owns the Embree devices that the settings require.
class Devices {
public:
    Devices(const std::vector<EmbreeQuality>& qualities, const Scene& scene, int threads) {
        for (const EmbreeQuality& quality : qualities)
            if (auto& device = quality.avx2 ? avx2_ : widest_; !device) device.emplace(scene, threads, quality.avx2);
    }
    const EmbreeDevice& of(EmbreeQuality quality) const { return quality.avx2 ? *avx2_ : *widest_; }

private:
    std::optional<EmbreeDevice> widest_, avx2_;
};

/// Holds rays, their query, and all tracers that can run it.
struct Work {
    std::string name;
    std::vector<Ray> rays;
    std::vector<Hit> ends; ///< for shadow rays
    RayQueries ray_queries() const { return {rays, ends}; }
    Tracer ours;
    std::vector<Tracer> peers;
    // The fields below are computed from the results to all rays.
    std::vector<std::optional<Mismatches>> mismatches; ///< one per peer
    std::vector<Leaks> leaks;                          ///< one per peer; without peers, one for Duet alone
};

class SceneMeasurement {
public:
    SceneMeasurement(const KernelScene& scene, const KernelSettings& settings, const Control& control)
        : scene_(scene), settings_(settings), control_(control), oracle_(*scene.scene),
          steps_(control, static_cast<double>(thread_counts().size() * settings.works.size() + 2)) {
        table_.mesh = scene.mesh;
        table_.scene = name_of(scene.arrangement);
        table_.triangles = scene.triangle_count();
        table_.omitted_spheres = scene.omitted_spheres;
        table_.width = settings.size.width;
        table_.height = settings.size.height;
    }

    KernelResults run() {
        if (wanted("build"))
            for (const int threads : thread_counts()) measure_builds(threads);
        if (control_.stopped()) return table_;
        build_all();
        works_.reserve(kWorks.size());
        make_works();
        steps_.next().report(1);
        for (const Work& work : works_)
            for (const int threads : thread_counts()) measure_rays(work, threads);
        if (settings_.watertight > 0 && scene_.closed() && !control_.stopped()) test_watertightness();
        mark_best(table_.rows);
        return std::move(table_);
    }

private:
    bool wanted(const std::string& work) const { return std::ranges::count(settings_.works, work) > 0; }
    std::vector<int> thread_counts() const {
        return settings_.threads > 1 ? std::vector<int>{1, settings_.threads} : std::vector<int>{1};
    }
    static std::string full_name(const std::string& peer) { return embree_version() + " " + peer; }

    void measure_builds(int threads) {
        const Control control = steps_.next();
        const TimedWork ours = [&] {
            const WorkStopwatch watch = work_stopwatch(threads);
            const raytrace::Accelerator built(*scene_.scene, threads);
            return watch.seconds();
        };
        const Devices devices(settings_.peers, *scene_.scene, threads);
        std::vector<TimedWork> peers;
        for (const EmbreeQuality& quality : settings_.peers)
            peers.push_back([&devices, quality, threads] {
                const WorkStopwatch watch = work_stopwatch(threads);
                const EmbreeScene built(devices.of(quality), quality);
                return watch.seconds();
            });
        const InterleavedTimings found =
            interleave(ours, peers, settings_.repeats, kBuildLimit * settings_.seconds, control);
        if (control.stopped()) return;
        std::vector<std::string> names;
        for (const EmbreeQuality& quality : settings_.peers) names.push_back(full_name(name_of(quality)));
        add_rows("build", threads, found, names, [](double seconds) { return seconds; });
    }

    void build_all() {
        accelerator_.emplace(*scene_.scene, settings_.threads);
        if (settings_.peers.empty()) {
            if (wanted("build")) table_.rows.push_back(memory_row());
            return;
        }
        devices_.emplace(settings_.peers, *scene_.scene, settings_.threads);
        for (const EmbreeQuality& quality : settings_.peers) {
            embree_.push_back(std::make_unique<EmbreeScene>(devices_->of(quality), quality));
            if (!wanted("build")) continue;
            KernelRow row = memory_row();
            row.peer_name = full_name(name_of(quality));
            row.peer = per_triangle(embree_.back()->memory_bytes());
            const double ratio = row.peer / row.ours;
            row.ratio = {ratio, ratio, ratio};
            table_.rows.push_back(row);
        }
    }
    double per_triangle(std::int64_t bytes) const {
        return static_cast<double>(bytes) / static_cast<double>(table_.triangles);
    }
    KernelRow memory_row() const {
        KernelRow row;
        row.work = "memory";
        row.threads = settings_.threads;
        row.ours = per_triangle(accelerator_->memory_bytes());
        row.repeats = 1;
        return row;
    }

    void make_works() {
        const int threads = settings_.threads;
        const auto [width, height] = settings_.size;
        std::vector<Ray> camera = camera_rays(scene_.camera, width, height, PixelOrder::kRows, threads);
        if (wanted("bounce"))
            add_work("bounce", bounce_rays(scene_, *accelerator_, camera, settings_.seed, threads), {});
        if (wanted("shadow")) {
            ShadowRays shadow = shadow_rays(scene_, *accelerator_, camera, settings_.seed, threads);
            add_work("shadow", std::move(shadow.rays), std::move(shadow.ends));
        }
        if (wanted("camera")) add_work("camera", std::move(camera), {});
        if (wanted("camera-bulk"))
            add_work("camera-bulk", camera_rays(scene_.camera, width, height, PixelOrder::kZCurve, threads), {});
        const auto place = [](const Work& work) { return std::ranges::find(kWorks, work.name); };
        std::ranges::sort(works_, {}, place);
    }

    /// Traces all rays with every tracer and counts mismatches and leaks. A workload without rays is omitted.
    void add_work(std::string name, std::vector<Ray> rays, std::vector<Hit> ends) {
        if (rays.empty() || control_.stopped()) return;
        works_.push_back({std::move(name), std::move(rays), std::move(ends), {}, {}, {}, {}});
        Work& work = works_.back(); // does not move, because the capacity is reserved
        const RayQueries ray_queries = work.ray_queries();
        work.ours = !ray_queries.closest()       ? duet_occluded(*accelerator_, work.rays, work.ends)
                    : work.name == "camera-bulk" ? duet_batched(*accelerator_, work.rays)
                                                 : duet_closest(*accelerator_, work.rays);
        const std::vector<RayResult> ours = trace_all(work.ours, work.rays.size(), settings_.threads);
        const std::size_t stride = (work.rays.size() + kMaxCheckedRays - 1) / kMaxCheckedRays;
        table_.judged.push_back({work.name, check_answers(oracle_, ray_queries, ours, stride, settings_.threads)});
        const std::int64_t our_leaks = leaks_of(work, ours);
        work.peers = peer_tracers(work);
        for (const Tracer& peer : work.peers) {
            const std::vector<RayResult> theirs = trace_all(peer, work.rays.size(), settings_.threads);
            work.mismatches.push_back(compare_results(oracle_, ray_queries, ours, theirs, settings_.threads));
            work.leaks.push_back({our_leaks, leaks_of(work, theirs)});
        }
        if (work.peers.empty()) work.leaks.push_back({our_leaks, 0});
    }

    /// Returns tracers for all forms in which the peer can process a workload.
    std::vector<Tracer> peer_tracers(const Work& work) const {
        std::vector<Tracer> tracers;
        const auto add = [&](std::size_t i, Tracer tracer, const std::string& name_suffix) {
            tracer.name =
                full_name(name_of(settings_.peers[i])) + (tracer.name.empty() ? "" : " " + tracer.name) + name_suffix;
            tracers.push_back(std::move(tracer));
        };
        for (std::size_t i = 0; i < embree_.size(); ++i) {
            const EmbreeScene& embree = *embree_[i];
            if (!work.ray_queries().closest()) {
                add(i, embree.occluded(work.rays), "");
            } else if (work.name == "camera-bulk") {
                for (const EmbreeForm form : embree_bulk_forms()) add(i, embree.closest(work.rays, form, true), "");
                add(i, embree.closest(work.rays, EmbreeForm::kPackets16, false), " incoherent");
            } else {
                add(i, embree.closest(work.rays, EmbreeForm::kSingle, work.name == "camera"), "");
            }
        }
        return tracers;
    }

    std::int64_t leaks_of(const Work& work, const std::vector<RayResult>& ray_results) const {
        if (!scene_.enclosed || !work.ray_queries().closest()) return 0;
        return std::ranges::count_if(ray_results, [](const RayResult& a) { return !a.hit(); });
    }

    void measure_rays(const Work& work, int threads) {
        const Control control = steps_.next();
        if (control.stopped()) return;
        std::vector<RayResultBlock> ray_results(block_count(work.rays.size()));
        const auto timed = [&](const Tracer& tracer, const RaySubset& subset) -> TimedWork {
            return [&, subset] { return trace_seconds(tracer, subset, threads, ray_results); };
        };
        // A short measurement determines how many rays can be traced in the requested time.
        const RaySubset pilot = choose_ray_subset(work.rays.size(), 1e6, 0.1 * threads);
        const double rate = static_cast<double>(pilot.rays) / timed(work.ours, pilot)();
        const RaySubset subset = choose_ray_subset(work.rays.size(), rate, settings_.seconds);
        std::vector<TimedWork> peers;
        std::vector<std::string> names;
        for (const Tracer& peer : work.peers) {
            peers.push_back(timed(peer, subset));
            names.push_back(peer.name);
        }
        const InterleavedTimings found =
            interleave(timed(work.ours, subset), peers, settings_.repeats, kNoLimit, control);
        if (control.stopped()) return;
        const std::size_t first = table_.rows.size();
        add_rows(work.name, threads, found, names,
                 [&](double seconds) { return static_cast<double>(subset.rays) / seconds / 1e6; });
        for (std::size_t i = first; i < table_.rows.size(); ++i) {
            KernelRow& row = table_.rows[i];
            row.rays = subset.rays;
            if (!work.peers.empty()) row.mismatches = work.mismatches[i - first];
            if (scene_.enclosed && work.ray_queries().closest()) row.leaks = work.leaks[i - first];
        }
    }

    /// Adds one row per peer, or one for Duet alone.
    template <typename Figure>
    void add_rows(const std::string& work, int threads, const InterleavedTimings& found,
                  const std::vector<std::string>& names, const Figure& figure) {
        KernelRow row;
        row.work = work;
        row.threads = threads;
        row.ours = figure(found.seconds);
        row.repeats = found.repeats;
        if (names.empty()) table_.rows.push_back(row);
        for (std::size_t i = 0; i < names.size(); ++i) {
            row.peer_name = names[i];
            row.ours = figure(found.peers[i].ours);
            row.peer = figure(found.peers[i].theirs);
            row.ratio = found.peers[i].ratio;
            table_.rows.push_back(row);
        }
    }

    void test_watertightness() {
        std::vector<TracerFactory> kernels{
            [&](std::span<const Ray> rays) { return duet_closest(*accelerator_, rays); },
            [&](std::span<const Ray> rays) { return duet_batched(*accelerator_, rays); }};
        std::vector<std::string> names{"duet", "duet bulk"};
        for (std::size_t i = 0; i < embree_.size(); ++i) {
            kernels.push_back([this, i](std::span<const Ray> rays) {
                return embree_[i]->closest(rays, EmbreeForm::kSingle, false);
            });
            names.push_back(full_name(name_of(settings_.peers[i])));
        }
        const Watertight found = test_watertight(scene_, oracle_, kernels, settings_.watertight, settings_.seed,
                                                 settings_.threads, steps_.next());
        for (std::size_t i = 0; i < names.size(); ++i)
            table_.watertight.push_back({names[i], found.kernels[i].misses, found.kernels[i].faults});
    }

    static constexpr double kNoLimit = 1e9; // seconds

    const KernelScene& scene_;
    const KernelSettings& settings_;
    const Control& control_;
    HitOracle oracle_;
    ProgressSteps steps_;
    KernelResults table_;
    std::optional<raytrace::Accelerator> accelerator_;
    std::optional<Devices> devices_;
    std::vector<std::unique_ptr<EmbreeScene>> embree_;
    std::vector<Work> works_;
};

} // namespace

KernelResults measure_kernels(const KernelScene& scene, const KernelSettings& settings, const Control& control) {
    return SceneMeasurement(scene, settings, control).run();
}

} // namespace duet::compare
