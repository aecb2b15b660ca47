#include "compare/kernels/tracer.h"

#include "common/system/error.h"
#include "common/system/parallel.h"

namespace duet::compare {

namespace {

RayResult to_ray_result(const Hit& hit) {
    return hit.valid() ? RayResult{hit.t, hit.primitive, hit.object} : RayResult{};
}

} // namespace

Tracer duet_closest(const raytrace::Accelerator& accelerator, std::span<const Ray> rays) {
    return {"duet", [&accelerator, rays](std::size_t block, RayResult* ray_results) {
                for (const Ray& ray : block_of(rays, block)) *ray_results++ = to_ray_result(accelerator.closest(ray));
            }};
}

Tracer duet_batched(const raytrace::Accelerator& accelerator, std::span<const Ray> rays) {
    return {"duet bulk", [&accelerator, rays](std::size_t block, RayResult* ray_results) {
                std::array<Hit, kBatch> hits;
                for (auto rest = block_of(rays, block); !rest.empty();) {
                    const std::size_t count = std::min(kBatch, rest.size());
                    accelerator.closest(rest.first(count), std::span(hits).first(count));
                    for (const Hit& hit : std::span(hits).first(count)) *ray_results++ = to_ray_result(hit);
                    rest = rest.subspan(count);
                }
            }};
}

Tracer duet_occluded(const raytrace::Accelerator& accelerator, std::span<const Ray> rays, std::span<const Hit> ends) {
    DUET_CHECK_EQ(rays.size(), ends.size());
    return {"duet", [&accelerator, rays, ends](std::size_t block, RayResult* ray_results) {
                const Hit* end = ends.data() + block * kBlock;
                for (const Ray& ray : block_of(rays, block)) {
                    *ray_results++ = {end->t, accelerator.occluded(ray, *end) ? 0 : RayResult::kNone};
                    ++end;
                }
            }};
}

std::vector<RayResult> trace_all(const Tracer& tracer, std::size_t rays, int threads) {
    std::vector<RayResultBlock> blocks(block_count(rays));
    parallel_for(blocks.size(), threads, [&](std::size_t i) { tracer.trace(i, blocks[i].ray_results.data()); });
    std::vector<RayResult> all;
    all.reserve(rays);
    for (const RayResultBlock& block : blocks)
        all.insert(all.end(), block.ray_results.begin(),
                   block.ray_results.begin() + static_cast<std::ptrdiff_t>(std::min(kBlock, rays - all.size())));
    return all;
}

} // namespace duet::compare
