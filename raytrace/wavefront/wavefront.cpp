// Schedules a wavefront, a set of paths that advance together, vertex by vertex. It sorts the paths by the surfaces
// that their rays hit, and advances those at batched surfaces (BatchedSurfaces) of one kind in batches.
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
class UsedDimensionSampler {
public:
    /// `random_samples` is indexed by path; `indices` holds the indices of the paths.
    void draw(std::span<const Sampler> samplers, std::span<const std::uint32_t> indices, int depth,
              const UsedDimensions& used, std::vector<VertexRandomSamples>& random_samples) {
        const std::array<bool, 4> is_used{used.direction, used.light, used.light || used.lobe, used.roulette};
        std::array<std::uint32_t, 4> dimensions;
        std::size_t count = 0;
        for (std::uint32_t pair = 0; pair < 4; ++pair)
            if (is_used[pair]) dimensions[count++] = vertex_dimension(depth) + 2 * pair;
        pairs_.resize(count * indices.size());
        Sampler::get_2d_batch(samplers, indices, std::span(dimensions).first(count), pairs_);
        const Vec2* next = pairs_.data();
        const auto take = [&](std::size_t pair, const auto& set) {
            if (!is_used[pair]) return;
            for (const std::uint32_t i : indices) set(random_samples[i], *next++);
        };
        take(0, [](VertexRandomSamples& u, Vec2 pair) { u.bsdf = pair; });
        take(1, [](VertexRandomSamples& u, Vec2 pair) { u.light = pair; });
        take(2, [](VertexRandomSamples& u, Vec2 pair) { u.light_choice = pair.x, u.lobe = pair.y; });
        take(3, [](VertexRandomSamples& u, Vec2 pair) { u.roulette = pair.x, u.distance = pair.y; });
    }

private:
    std::vector<Vec2> pairs_;
};

// Sorts paths by the class of their rays' hits (BatchedSurfaces).
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
    static constexpr std::size_t kClasses = BatchedSurfaces::kClasses;
    std::vector<std::uint8_t> classes_;
    std::vector<std::uint32_t> sorted_;
    std::array<std::uint32_t, kClasses> ends_{};
};

template <bool kHasMedia> class Wavefront {
public:
    Wavefront(const RenderPlan& plan, std::span<Ray> rays, std::span<Hit> hits, std::span<Sampler> samplers,
              RayCounts& counts)
        : plan_(plan), rays_(rays), hits_(hits), samplers_(samplers), counts_(counts), by_class_(rays.size()),
          random_samples_(rays.size()), shadows_(plan) {
        DUET_CHECK_EQ(rays.size(), hits.size());
        DUET_CHECK_EQ(rays.size(), samplers.size());
        paths_.reserve(rays.size());
        active_.reserve(rays.size());
        for (std::uint32_t i = 0; i < rays.size(); ++i) {
            paths_.emplace_back(plan, samplers[i], counts);
            active_.push_back(i);
        }
    }

    void trace(std::span<Rgb> radiances) {
        for (int depth = 0; !active_.empty(); ++depth) {
            advance(depth);
            shadows_.trace([&](std::uint32_t i, Rgb light) { paths_[i].add(light); });
            plan_.prepared.accelerator.closest_of_incoherent(rays_, active_, hits_);
        }
        for (std::size_t i = 0; i < paths_.size(); ++i) radiances[i] = paths_[i].result();
    }

private:
    using Kind = BatchedSurfaces::Kind;
    // Fewer paths than this are not advanced as a batch. With SSE4.2 a batch has only two lanes, so no batches form.
    static constexpr std::size_t kMinBatch = 3;

    void advance(int depth) {
        if (depth == plan_.max_depth) return end(depth);
        by_class_.sort(active_, [&](std::uint32_t i) { return plan_.batched.class_of(hits_[i]); });
        active_.clear();
        escape(by_class_.of(BatchedSurfaces::kMiss), depth);
        const auto others = by_class_.of(BatchedSurfaces::kOther);
        draw_all(others, depth);
        for (const std::uint32_t i : others) advance_alone(i, depth);
        for (std::size_t k = 0; k < Kind::kCount; ++k)
            if (!by_class_.of(k).empty()) advance_batches(Kind::of_index(k), by_class_.of(k), depth);
    }
    // Draws all random samples that a vertex may use.
    void draw_all(std::span<const std::uint32_t> indices, int depth) {
        const UsedDimensions all{true, plan_.lights != nullptr, true,
                                 (plan_.russian_roulette && depth > 0) || plan_.random_distances};
        dimension_sampler_.draw(samplers_, indices, depth, all, random_samples_);
    }
    // Ends all paths, which have reached the greatest depth.
    void end(int depth) {
        if (plan_.random_distances) draw_all(active_, depth);
        for (const std::uint32_t i : active_) paths_[i].advance(rays_[i], hits_[i], depth, random_samples_[i]);
        active_.clear();
    }
    void advance_alone(std::uint32_t i, int depth) {
        if (paths_[i].advance(rays_[i], hits_[i], depth, random_samples_[i])) active_.push_back(i);
    }

    void escape(std::span<const std::uint32_t> indices, int depth) {
        const Environment* environment = plan_.environment;
        if (!kHasMedia && environment == nullptr) return;
        if constexpr (!kHasMedia) {
            if (const auto* even = std::get_if<ConstantEnvironment>(environment))
                return escape_to(*even, indices, depth);
            if (const auto* sky = std::get_if<SkyEnvironment>(environment)) return escape_to(*sky, indices, depth);
        }
        // A ray that hits nothing uses random samples only if media may scatter the path on its way.
        if (plan_.random_distances) draw_all(indices, depth);
        for (const std::uint32_t i : indices) advance_alone(i, depth);
    }
    // Adds the light of an environment that is not sampled as a light, in a loop without calls.
    template <typename Sky> void escape_to(const Sky& sky, std::span<const std::uint32_t> indices, int depth) {
        for (const std::uint32_t i : indices)
            paths_[i].add_found(radiance(sky, rays_[i].direction), 0, LightSource::kEnvironment, depth);
    }

    BatchPath batch_path(std::uint32_t i) {
        const Hit& hit = hits_[i];
        return {i,
                &rays_[i],
                &hit,
                &plan_.batched.shape(hit),
                &plan_.batched.bsdf(hit),
                &random_samples_[i],
                &paths_[i].state()};
    }
    void advance_batches(Kind kind, std::span<const std::uint32_t> indices, int depth) {
        dimension_sampler_.draw(samplers_, indices, depth, used_dimensions(plan_, kind.bsdf_kind, depth),
                                random_samples_);
        if constexpr (kPathLanes >= kMinBatch)
            for (; indices.size() >= kMinBatch; indices = indices.subspan(std::min(indices.size(), kPathLanes))) {
                std::array<BatchPath, kPathLanes> some;
                const std::size_t size = std::min(indices.size(), kPathLanes);
                for (std::size_t k = 0; k < size; ++k) some[k] = batch_path(indices[k]);
                advance_batch(plan_, kind, std::span(some).first(size), depth, shadows_, counts_);
                for (std::size_t k = 0; k < size; ++k)
                    if (some[k].continues) active_.push_back(indices[k]);
            }
        for (const std::uint32_t i : indices) advance_alone(i, depth);
    }

    const RenderPlan& plan_;
    const std::span<Ray> rays_;
    const std::span<Hit> hits_;
    const std::span<Sampler> samplers_;
    RayCounts& counts_;
    std::vector<Path<RadianceSum, kHasMedia>> paths_;
    std::vector<std::uint32_t> active_;
    ByClass by_class_;
    std::vector<VertexRandomSamples> random_samples_;
    UsedDimensionSampler dimension_sampler_;
    ShadowRays shadows_;
};

} // namespace

void path_radiances(const RenderPlan& plan, std::span<Ray> rays, std::span<Hit> hits, std::span<Sampler> samplers,
                    std::span<Rgb> radiances, RayCounts& counts) {
    if (plan.needs_medium_stack) return Wavefront<true>(plan, rays, hits, samplers, counts).trace(radiances);
    Wavefront<false>(plan, rays, hits, samplers, counts).trace(radiances);
}

} // namespace duet::raytrace
