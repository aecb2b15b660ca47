#include "compare/kernels/tracer.h"

#include "common/system/parallel.h"

namespace duet::compare {

namespace {

Answer answer_of(const Hit& hit) { return {hit.t, hit.valid() ? hit.primitive : Answer::kNone}; }

} // namespace

Tracer our_closest(const raytrace::Accelerator& accelerator, std::span<const Ray> rays) {
    return {"duet", [&accelerator, rays](std::size_t block, Answer* answers) {
                for (const Ray& ray : block_of(rays, block)) *answers++ = answer_of(accelerator.closest(ray));
            }};
}

Tracer our_bulk(const raytrace::Accelerator& accelerator, std::span<const Ray> rays) {
    return {"duet bulk", [&accelerator, rays](std::size_t block, Answer* answers) {
                const std::span<const Ray> some = block_of(rays, block);
                std::array<Hit, kBlock> hits;
                accelerator.closest(some, std::span(hits).first(some.size()));
                for (std::size_t i = 0; i < some.size(); ++i) answers[i] = answer_of(hits[i]);
            }};
}

Tracer our_occluded(const raytrace::Accelerator& accelerator, std::span<const Ray> rays) {
    return {"duet", [&accelerator, rays](std::size_t block, Answer* answers) {
                for (const Ray& ray : block_of(rays, block)) {
                    Hit end; // a mere distance
                    end.t = ray.t_max;
                    *answers++ = {ray.t_max, accelerator.occluded(ray, end) ? 0 : Answer::kNone};
                }
            }};
}

std::vector<Answer> all_answers(const Tracer& tracer, std::size_t rays, int threads) {
    std::vector<AnswerBlock> blocks(block_count(rays));
    parallel_for(blocks.size(), threads, [&](std::size_t i) { tracer.trace(i, blocks[i].answers.data()); });
    std::vector<Answer> all;
    all.reserve(rays);
    for (const AnswerBlock& block : blocks)
        all.insert(all.end(), block.answers.begin(),
                   block.answers.begin() + static_cast<std::ptrdiff_t>(std::min(kBlock, rays - all.size())));
    return all;
}

} // namespace duet::compare
