// A primary sample is a point of primary sample space: all random numbers that a path is made of. Metropolis light
// transport changes it step by step, where a Sampler draws each path anew (Kelemen et al. 2002, "A Simple and Robust
// Mutation Strategy for the Metropolis Light Transport Algorithm").
#pragma once

#include "raytrace/sampling/random_sequence.h"
#include "raytrace/sampling/sampler.h"

#include <vector>

namespace duet {

/// Holds the random numbers of one path, each in [0, 1), and proposes changes of them. It has the functions of Sampler
/// with which a path reads them. Numbers that no path has read yet are drawn when they are read. Those that the last
/// paths did not read first make up for the steps that they have missed.
class PrimarySample {
public:
    /// Starts at the point that the sampler is at, except for the first block. The seed is that of all further points.
    PrimarySample(const Sampler& start, const Sampler::Block& first, std::uint64_t seed)
        : start_(start), random_(seed), blocks_{{first, 0, {}, 0}} {}

    /// Moves to a proposal: with a probability of kLargeStep to an independent point, else to one nearby. accept() or
    /// reject() must follow.
    void propose();
    /// Stays at the proposal.
    void accept();
    /// Returns to the point before the proposal.
    void reject() { proposing_ = false; }

    /// These are as in Sampler. Numbers are read in blocks: the dimension must be a multiple of Sampler::kBlock.
    void set_dimension(std::uint32_t dimension) { next_ = dimension / static_cast<std::uint32_t>(Sampler::kBlock); }
    Sampler::Block get_block(); ///< returns the next block
    std::uint32_t sample() const { return start_.sample(); }

    static constexpr float kLargeStep = 0.1f;  ///< in models/door.json, 0.3 (Kelemen et al. 2002, §5) is no better
    static constexpr float kDeviation = 0.01f; ///< standard deviation of a small step (pbrt, 3rd edition, §16.4.4)

private:
    struct Block {
        Sampler::Block values{};
        std::int64_t step = -1; ///< the number of accepted steps after which the block had these values; −1: never
        Sampler::Block proposal{};
        std::int64_t proposed = 0; ///< the number of the proposal with these values
    };
    void catch_up(Block& block);

    Sampler start_;
    raytrace::RandomSequence random_;
    std::uint32_t next_ = 0;                  ///< block to be read
    std::int64_t steps_ = 0, large_step_ = 0; ///< accepted so far, and the last of them to an independent point
    std::int64_t proposals_ = 0;
    bool proposing_ = false, large_ = false; ///< whether a proposal is open, and whether it is an independent point
    std::vector<Block> blocks_;
    std::vector<std::uint32_t> changed_; ///< blocks that the proposal has changed
};

} // namespace duet
