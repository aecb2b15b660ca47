// A wavefront is a set of paths that advance together, vertex by vertex. This file only schedules them: it sorts the
// paths by what their rays have hit, and advances those at batched surfaces (PlainSurfaces) of one kind in batches.
#include "raytrace/acceleration/sort_by_class.h"
#include "raytrace/integrator/path.h"
#include "raytrace/wavefront/batch.h"

#include "common/system/error.h"

#include <algorithm>
#include <array>
#include <vector>

namespace duet::raytrace {

namespace {

// Draws only the random samples that the vertices of paths use.
class UsedNumbers {
public:
    /// `numbers` is indexed by path; `which` are the paths.
    void draw(std::span<const Sampler> samplers, std::span<const std::uint32_t> which, int depth,
              const NumbersUsed& used, std::vector<VertexNumbers>& numbers) {
        const std::array<bool, 4> is_used{used.direction, used.light, used.light || used.lobe, used.roulette};
        std::array<std::uint32_t, 4> dimensions;
        std::size_t count = 0;
        for (std::uint32_t pair = 0; pair < 4; ++pair)
            if (is_used[pair]) dimensions[count++] = vertex_dimension(depth) + 2 * pair;
        pairs_.resize(count * which.size());
        Sampler::pairs(samplers, which, std::span(dimensions).first(count), pairs_);
        const Vec2* next = pairs_.data();
        const auto take = [&](std::size_t pair, const auto& set) {
            if (!is_used[pair]) return;
            for (const std::uint32_t i : which) set(numbers[i], *next++);
        };
        take(0, [](VertexNumbers& u, Vec2 pair) { u.bsdf = pair; });
        take(1, [](VertexNumbers& u, Vec2 pair) { u.light = pair; });
        take(2, [](VertexNumbers& u, Vec2 pair) { u.light_choice = pair.x, u.lobe = pair.y; });
        take(3, [](VertexNumbers& u, Vec2 pair) { u.roulette = pair.x; });
    }

private:
    std::vector<Vec2> pairs_;
};

// Sorts paths by the class of what their rays have hit (PlainSurfaces).
class ByClass {
public:
    explicit ByClass(std::size_t most) : classes_(most), sorted_(most) {}

    /// Sorts `paths`. class_of(path) must be below kClasses.
    template <typename ClassOf> void sort(std::span<const std::uint32_t> paths, const ClassOf& class_of) {
        ends_ = sort_by_class<kClasses>(paths, class_of, classes_, sorted_);
    }
    std::span<const std::uint32_t> of(std::size_t c) const {
        const std::uint32_t begin = c == 0 ? 0 : ends_[c - 1];
        return std::span(sorted_).subspan(begin, ends_[c] - begin);
    }

private:
    static constexpr std::size_t kClasses = PlainSurfaces::kClasses;
    std::vector<std::uint8_t> classes_;
    std::vector<std::uint32_t> sorted_;
    std::array<std::uint32_t, kClasses> ends_{};
};

template <bool kInsides> class Wavefront {
public:
    Wavefront(const RenderPlan& plan, std::span<Ray> rays, std::span<Hit> hits, std::span<Sampler> samplers,
          RayCounts& counts)
        : plan_(plan), rays_(rays), hits_(hits), samplers_(samplers), counts_(counts), by_class_(rays.size()),
          numbers_(rays.size()), shadows_(plan) {
        DUET_CHECK_EQ(rays.size(), hits.size());
        DUET_CHECK_EQ(rays.size(), samplers.size());
        paths_.reserve(rays.size());
        going_.reserve(rays.size());
        for (std::uint32_t i = 0; i < rays.size(); ++i) {
            paths_.emplace_back(plan, samplers[i], counts);
            going_.push_back(i);
        }
    }

    void trace(std::span<Rgb> radiances) {
        for (int depth = 0; !going_.empty(); ++depth) {
            advance(depth);
            shadows_.send([&](std::uint32_t i, Rgb light) { paths_[i].add(light); });
            find_hits();
        }
        for (std::size_t i = 0; i < paths_.size(); ++i) radiances[i] = paths_[i].result();
    }

private:
    using Kind = PlainSurfaces::Kind;
    static constexpr std::size_t kFewest = 3; // fewest paths that are advanced as a batch

    void find_hits() {
        const Accelerator& accelerator = plan_.prepared.accelerator;
        if (accelerator.gathers_scattered()) return accelerator.closest_of_scattered(rays_, going_, hits_);
        for (const std::uint32_t i : going_) hits_[i] = accelerator.closest(rays_[i]);
    }

    void advance(int depth) {
        if (depth == plan_.max_depth) return end(depth);
        by_class_.sort(going_, [&](std::uint32_t i) { return plan_.plain.class_of(hits_[i]); });
        going_.clear();
        escape(by_class_.of(PlainSurfaces::kNothing), depth);
        const auto others = by_class_.of(PlainSurfaces::kOther);
        const NumbersUsed all{true, plan_.lights != nullptr, true, plan_.russian_roulette && depth > 0};
        used_numbers_.draw(samplers_, others, depth, all, numbers_);
        for (const std::uint32_t i : others) advance_alone(i, depth);
        for (std::size_t k = 0; k < Kind::kCount; ++k)
            if (!by_class_.of(k).empty()) advance_batches(Kind::of_index(k), by_class_.of(k), depth);
    }
    // Ends all paths, which have reached the greatest depth.
    void end(int depth) {
        for (const std::uint32_t i : going_) paths_[i].advance(rays_[i], hits_[i], depth, VertexNumbers());
        going_.clear();
    }
    void advance_alone(std::uint32_t i, int depth) {
        if (paths_[i].advance(rays_[i], hits_[i], depth, numbers_[i])) going_.push_back(i);
    }

    void escape(std::span<const std::uint32_t> which, int depth) {
        const Environment* environment = plan_.environment;
        if (!kInsides && environment == nullptr) return;
        if constexpr (!kInsides) {
            if (const auto* even = std::get_if<ConstantEnvironment>(environment)) return escape_to(*even, which, depth);
            if (const auto* sky = std::get_if<SkyEnvironment>(environment)) return escape_to(*sky, which, depth);
        }
        for (const std::uint32_t i : which) paths_[i].advance(rays_[i], hits_[i], depth, VertexNumbers());
    }
    // Adds the light of an environment that is not sampled as a light, in a loop without calls.
    template <typename Sky> void escape_to(const Sky& sky, std::span<const std::uint32_t> which, int depth) {
        for (const std::uint32_t i : which)
            paths_[i].add_found(radiance(sky, rays_[i].direction), 0, LightSource::kEnvironment, depth);
    }

    BatchPath batch_path(std::uint32_t i) {
        const Hit& hit = hits_[i];
        return {i, &rays_[i], &hit, &plan_.plain.shape(hit), &plan_.plain.bsdf(hit), &numbers_[i], &paths_[i].state()};
    }
    void advance_batches(Kind kind, std::span<const std::uint32_t> which, int depth) {
        used_numbers_.draw(samplers_, which, depth, numbers_used(plan_, kind.scattering, depth), numbers_);
        for (; which.size() >= kFewest; which = which.subspan(std::min(which.size(), kPathLanes))) {
            std::array<BatchPath, kPathLanes> some;
            const std::size_t size = std::min(which.size(), kPathLanes);
            for (std::size_t k = 0; k < size; ++k) some[k] = batch_path(which[k]);
            advance_batch(plan_, kind, std::span(some).first(size), depth, shadows_, counts_);
            for (std::size_t k = 0; k < size; ++k)
                if (some[k].goes_on) going_.push_back(which[k]);
        }
        for (const std::uint32_t i : which) advance_alone(i, depth);
    }

    const RenderPlan& plan_;
    const std::span<Ray> rays_;
    const std::span<Hit> hits_;
    const std::span<Sampler> samplers_;
    RayCounts& counts_;
    std::vector<Path<Sum, kInsides>> paths_;
    std::vector<std::uint32_t> going_;
    ByClass by_class_;
    std::vector<VertexNumbers> numbers_;
    UsedNumbers used_numbers_;
    ShadowRays shadows_;
};

} // namespace

void path_radiances(const RenderPlan& plan, std::span<Ray> rays, std::span<Hit> hits, std::span<Sampler> samplers,
                    std::span<Rgb> radiances, RayCounts& counts) {
    if (plan.insides) return Wavefront<true>(plan, rays, hits, samplers, counts).trace(radiances);
    Wavefront<false>(plan, rays, hits, samplers, counts).trace(radiances);
}

} // namespace duet::raytrace
