// Declares primary samples. A primary sample is a point of primary sample space: all random samples that determine a
// path. Metropolis light transport changes it step by step, while a Sampler draws each path anew (Kelemen et al. 2002,
// "A Simple and Robust Mutation Strategy for the Metropolis Light Transport Algorithm").
#pragma once

#include "raytrace/sampling/random_sequence.h"
#include "raytrace/sampling/sampler.h"

#include <vector>

namespace duet {

/// Holds the random samples of one path, each in [0, 1), and proposes mutations of them. Paths read it through the same
/// functions as a Sampler. Samples are drawn when a path first reads them. Samples that previous paths did not read are
/// updated by the missed steps first.
class PrimarySample {
public:
    /// Starts at the current point of the sampler, except for the first block. `seed` determines all further points.
    PrimarySample(const Sampler& start, const Sampler::Block& first, std::uint64_t seed)
        : start_(start), random_(seed), blocks_{{first, 0, {}, 0}} {}

    /// Moves to a proposal. With probability kLargeStep it is an independent point, else a point nearby. accept() or
    /// reject() must follow.
    void propose();
    /// Makes the proposal the current point.
    void accept();
    /// Returns to the point before the proposal.
    void reject() { proposing_ = false; }

    /// set_dimension(), get_block() and sample() are like those of Sampler. The dimension must be a multiple of
    /// Sampler::kBlock.
    void set_dimension(std::uint32_t dimension) { next_ = dimension / static_cast<std::uint32_t>(Sampler::kBlock); }
    Sampler::Block get_block(); ///< returns the next block
    std::uint32_t sample() const { return start_.sample(); }

    static constexpr float kLargeStep = 0.1f;  ///< in models/door.json, 0.3 (Kelemen et al. 2002, §5) is no better
    static constexpr float kDeviation = 0.01f; ///< standard deviation of a small step (pbrt, 3rd edition, §16.4.4)

private:
    struct Block {
        Sampler::Block values{};
        std::int64_t step = -1; ///< number of accepted steps for which `values` is current; −1: never
        Sampler::Block proposal{};
        std::int64_t proposed = 0; ///< number of the proposal that `proposal` belongs to
    };
    void catch_up(Block& block);

    Sampler start_;
    raytrace::RandomSequence random_;
    std::uint32_t next_ = 0;                  ///< next block to be read
    std::int64_t steps_ = 0, large_step_ = 0; ///< accepted steps, and the number of the last large one
    std::int64_t proposals_ = 0;
    bool proposing_ = false, large_ = false; ///< whether a proposal is open, and whether it is a large step
    std::vector<Block> blocks_;
    std::vector<std::uint32_t> changed_; ///< blocks that the proposal has changed
};

} // namespace duet
