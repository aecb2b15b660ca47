#include "compare/kernels/tracer.h"

#include "common/system/error.h"
#include "common/system/parallel.h"

namespace duet::compare {

namespace {

Answer answer_of(const Hit& hit) {
    return hit.valid() ? Answer{hit.t, hit.primitive, hit.object} : Answer{};
}

} // namespace

Tracer our_closest(const raytrace::Accelerator& accelerator, std::span<const Ray> rays) {
    return {"duet", [&accelerator, rays](std::size_t block, Answer* answers) {
                for (const Ray& ray : block_of(rays, block)) *answers++ = answer_of(accelerator.closest(ray));
            }};
}

Tracer our_bulk(const raytrace::Accelerator& accelerator, std::span<const Ray> rays) {
    return {"duet bulk", [&accelerator, rays](std::size_t block, Answer* answers) {
                std::array<Hit, kBatch> hits;
                for (auto rest = block_of(rays, block); !rest.empty();) {
                    const std::size_t count = std::min(kBatch, rest.size());
                    accelerator.closest(rest.first(count), std::span(hits).first(count));
                    for (const Hit& hit : std::span(hits).first(count)) *answers++ = answer_of(hit);
                    rest = rest.subspan(count);
                }
            }};
}

Tracer our_occluded(const raytrace::Accelerator& accelerator, std::span<const Ray> rays, std::span<const Hit> ends) {
    DUET_CHECK_EQ(rays.size(), ends.size());
    return {"duet", [&accelerator, rays, ends](std::size_t block, Answer* answers) {
                const Hit* end = ends.data() + block * kBlock;
                for (const Ray& ray : block_of(rays, block)) {
                    *answers++ = {end->t, accelerator.occluded(ray, *end) ? 0 : Answer::kNone};
                    ++end;
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
