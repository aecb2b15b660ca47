#include "compare/kernels/measure_kernels.h"

#include "common/system/parallel.h"
#include "common/system/stopwatch.h"
#include "compare/kernels/kernels.h"
#include "compare/kernels/ray_sets.h"
#include "compare/kernels/watertight.h"

#include <algorithm>
#include <memory>
#include <optional>

namespace duet::compare {

const std::vector<std::string> kWorks{"build", "camera", "camera-bulk", "bounce", "shadow"};

namespace {

constexpr std::size_t kJudged = 20'000; ///< of our answers to each kind of ray
constexpr double kBuildLimit = 40; ///< builds of one number of threads end after this many times `seconds`, but three

/// Fractions done of one scene: each step takes its share in turn.
class Steps {
public:
    Steps(const Control& whole, std::size_t count) : whole_(whole), share_(1 / static_cast<double>(count)) {}
    /// For the next step.
    Control next() {
        const double begin = done_;
        done_ += share_;
        return {whole_.stop, [this, begin](double part) { whole_.report(begin + part * share_); }};
    }

private:
    const Control& whole_;
    double share_, done_ = 0;
};

/// Rays, the question they ask, and all who answer.
struct Work {
    std::string name;
    Question question = Question::kClosest;
    std::vector<Ray> rays;
    Tracer ours;
    std::vector<Tracer> peers;
    // From the answers to all rays:
    std::vector<std::optional<Mismatches>> mismatches; ///< one a peer
    std::vector<Leaks> leaks;                          ///< one a peer; where there is none, ours alone
};

class SceneMeasurement {
public:
    SceneMeasurement(const KernelScene& scene, const MeasureKernels& settings, const Control& control)
        : scene_(scene), settings_(settings), control_(control), judge_(*scene.scene),
          steps_(control, thread_counts().size() * settings.works.size() + 2) {
        table_.mesh = scene.mesh;
        table_.scene = name_of(scene.arrangement);
        table_.triangles = scene.triangles().triangles.size();
        table_.left_out = scene.left_out;
        table_.width = settings.size.width;
        table_.height = settings.size.height;
    }

    KernelTable run() {
        if (wanted("build"))
            for (const int threads : thread_counts()) measure_builds(threads);
        if (control_.stopped()) return table_;
        build_all();
        make_works();
        steps_.next().report(1);
        for (const Work& work : works_)
            for (const int threads : thread_counts()) measure_rays(work, threads);
        if (settings_.watertight > 0 && scene_.triangles().closed && !control_.stopped()) aim_at_weak_places();
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
        const Timed ours = [&] {
            const Stopwatch watch;
            const raytrace::Accelerator built(*scene_.scene, threads);
            return watch.seconds();
        };
        std::optional<EmbreeDevice> device;
        if (!settings_.peers.empty()) device.emplace(scene_.triangles(), threads);
        std::vector<Timed> peers;
        for (const EmbreeQuality& quality : settings_.peers)
            peers.push_back([&device, quality] {
                const Stopwatch watch;
                const EmbreeScene built(*device, quality);
                return watch.seconds();
            });
        const Interleaved found = interleave(ours, peers, settings_.repeats, kBuildLimit * settings_.seconds, control);
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
        device_.emplace(scene_.triangles(), settings_.threads);
        for (const EmbreeQuality& quality : settings_.peers) {
            embree_.push_back(std::make_unique<EmbreeScene>(*device_, quality));
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
            add_work({"bounce",
                      Question::kClosest,
                      bounce_rays(scene_, *accelerator_, camera, settings_.seed, threads),
                      {},
                      {},
                      {},
                      {}},
                     {1});
        if (wanted("shadow"))
            add_work({"shadow",
                      Question::kOccluded,
                      shadow_rays(scene_, *accelerator_, camera, settings_.seed, threads),
                      {},
                      {},
                      {},
                      {}},
                     {1});
        if (wanted("camera")) add_work({"camera", Question::kClosest, std::move(camera), {}, {}, {}, {}}, {1});
        if (wanted("camera-bulk"))
            add_work({"camera-bulk",
                      Question::kClosest,
                      camera_rays(scene_.camera, width, height, PixelOrder::kZCurve, threads),
                      {},
                      {},
                      {},
                      {}},
                     {16, 8});
        const auto place = [](const Work& work) { return std::ranges::find(kWorks, work.name); };
        std::ranges::sort(works_, {}, place);
    }

    /// Asks everybody about all rays, and counts where they differ and what leaks. A work without rays is none.
    void add_work(Work work, const std::vector<int>& widths) {
        if (work.rays.empty() || control_.stopped()) return;
        works_.push_back(std::move(work));
        Work& added = works_.back();
        const bool any = added.question == Question::kOccluded;
        added.ours = any                           ? our_occluded(*accelerator_, added.rays)
                     : added.name == "camera-bulk" ? our_bulk(*accelerator_, added.rays)
                                                   : our_closest(*accelerator_, added.rays);
        const std::vector<Answer> ours = all_answers(added.ours, added.rays.size(), settings_.threads);
        const std::size_t stride = (added.rays.size() + kJudged - 1) / kJudged;
        table_.judged.push_back(
            {added.name, judge_answers(judge_, added.question, added.rays, ours, stride, settings_.threads)});
        const std::int64_t our_leaks = leaks_of(added, ours);
        table_.our_leaks += our_leaks;
        for (std::size_t i = 0; i < embree_.size(); ++i)
            for (const int width : widths) {
                const bool coherent = added.name.starts_with("camera");
                Tracer tracer =
                    any ? embree_[i]->occluded(added.rays) : embree_[i]->closest(added.rays, width, coherent);
                tracer.name = full_name(name_of(settings_.peers[i])) + (tracer.name.empty() ? "" : " " + tracer.name);
                const std::vector<Answer> theirs = all_answers(tracer, added.rays.size(), settings_.threads);
                added.mismatches.push_back(
                    compare_answers(judge_, added.question, added.rays, ours, theirs, settings_.threads));
                added.leaks.push_back({our_leaks, leaks_of(added, theirs)});
                added.peers.push_back(std::move(tracer));
            }
        if (embree_.empty()) added.leaks.push_back({our_leaks, 0});
    }

    std::int64_t leaks_of(const Work& work, const std::vector<Answer>& answers) const {
        if (!scene_.enclosed || work.question == Question::kOccluded) return 0;
        return std::ranges::count_if(answers, [](const Answer& a) { return !a.hit(); });
    }

    void measure_rays(const Work& work, int threads) {
        const Control control = steps_.next();
        if (control.stopped()) return;
        std::vector<AnswerBlock> answers(block_count(work.rays.size()));
        const auto timed = [&](const Tracer& tracer, const Portion& portion) -> Timed {
            return [&, portion] { return trace_seconds(tracer, portion, threads, answers); };
        };
        // A first look says how many rays take the time that was asked for.
        const Portion look = portion_of(work.rays.size(), 1e6, 0.1 * threads);
        const double rate = static_cast<double>(look.rays) / timed(work.ours, look)();
        const Portion portion = portion_of(work.rays.size(), rate, settings_.seconds);
        std::vector<Timed> peers;
        std::vector<std::string> names;
        for (const Tracer& peer : work.peers) {
            peers.push_back(timed(peer, portion));
            names.push_back(peer.name);
        }
        const Interleaved found = interleave(timed(work.ours, portion), peers, settings_.repeats, kNoLimit, control);
        if (control.stopped()) return;
        const std::size_t first = table_.rows.size();
        add_rows(work.name, threads, found, names,
                 [&](double seconds) { return static_cast<double>(portion.rays) / seconds / 1e6; });
        for (std::size_t i = first; i < table_.rows.size(); ++i) {
            KernelRow& row = table_.rows[i];
            row.rays = portion.rays;
            if (!work.peers.empty()) row.mismatches = work.mismatches[i - first];
            if (scene_.enclosed && work.question == Question::kClosest) row.leaks = work.leaks[i - first];
        }
    }

    /// A row a peer, or one of ours alone.
    template <typename Figure>
    void add_rows(const std::string& work, int threads, const Interleaved& found, const std::vector<std::string>& names,
                  const Figure& figure) {
        KernelRow row;
        row.work = work;
        row.threads = threads;
        row.ours = figure(found.seconds);
        row.repeats = found.repeats;
        if (names.empty()) table_.rows.push_back(row);
        for (std::size_t i = 0; i < names.size(); ++i) {
            row.peer_name = names[i];
            row.peer = figure(found.peers[i].seconds);
            row.ratio = found.peers[i].ratio;
            table_.rows.push_back(row);
        }
    }

    void aim_at_weak_places() {
        std::vector<TracerFor> kernels{[&](std::span<const Ray> rays) { return our_closest(*accelerator_, rays); }};
        std::vector<std::string> names{"duet"};
        for (std::size_t i = 0; i < embree_.size(); ++i) {
            kernels.push_back([this, i](std::span<const Ray> rays) { return embree_[i]->closest(rays, 1, false); });
            names.push_back(full_name(name_of(settings_.peers[i])));
        }
        const Watertight found = test_watertight(scene_, judge_, kernels, settings_.watertight, settings_.seed,
                                                 settings_.threads, steps_.next());
        for (std::size_t i = 0; i < names.size(); ++i)
            table_.watertight.push_back({names[i], found.rays, found.misses[i]});
    }

    static constexpr double kNoLimit = 1e9; // seconds

    const KernelScene& scene_;
    const MeasureKernels& settings_;
    const Control& control_;
    Judge judge_;
    Steps steps_;
    KernelTable table_;
    std::optional<raytrace::Accelerator> accelerator_;
    std::optional<EmbreeDevice> device_;
    std::vector<std::unique_ptr<EmbreeScene>> embree_;
    std::vector<Work> works_;
};

} // namespace

KernelTable measure_kernels(const KernelScene& scene, const MeasureKernels& settings, const Control& control) {
    return SceneMeasurement(scene, settings, control).run();
}

} // namespace duet::compare
