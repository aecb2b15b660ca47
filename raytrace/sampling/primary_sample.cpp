#include "raytrace/sampling/primary_sample.h"

#include "common/vec/scalar.h"

#include <algorithm>
#include <cmath>

namespace duet {

namespace {

// Returns two independent numbers of the normal distribution of mean 0 and variance 1 (Box and Muller 1958).
Vec2 normal_pair(raytrace::RandomSequence& random) {
    const float radius = std::sqrt(-2 * std::log(1 - random())), angle = 2 * kPi * random();
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

// Adds normally distributed steps to all values, modulo 1.
void move(Sampler::Block& values, float deviation, raytrace::RandomSequence& random) {
    const auto wrapped = [](float x) { return std::min(x - std::floor(x), kOneMinusEpsilon); };
    for (std::size_t i = 0; i < values.size(); i += 2) {
        const Vec2 moves = normal_pair(random) * deviation;
        values[i] = wrapped(values[i] + moves.x);
        values[i + 1] = wrapped(values[i + 1] + moves.y);
    }
}

} // namespace

void PrimarySample::propose() {
    ++proposals_;
    proposing_ = true;
    large_ = random_() < kLargeStep;
    changed_.clear();
}

void PrimarySample::accept() {
    ++steps_;
    if (large_) large_step_ = steps_;
    for (const std::uint32_t i : changed_) blocks_[i].values = blocks_[i].proposal, blocks_[i].step = steps_;
    proposing_ = false;
}

Sampler::Block PrimarySample::get_block() {
    if (blocks_.size() <= next_) blocks_.resize(next_ + 1);
    Block& block = blocks_[next_];
    if (!proposing_) {
        catch_up(block);
    } else if (block.proposed < proposals_) {
        if (large_) {
            for (float& value : block.proposal) value = random_();
        } else {
            catch_up(block);
            block.proposal = block.values;
            move(block.proposal, kDeviation, random_);
        }
        block.proposed = proposals_;
        changed_.push_back(next_);
    }
    ++next_;
    return proposing_ ? block.proposal : block.values;
}

// Brings a block to the current point, whether or not the proposal is accepted. Otherwise chains would be attracted to
// paths that read the block: each proposal of such a path would try other values, and reject dark ones. Several small
// steps of the normal distribution are combined to one with a larger deviation.
void PrimarySample::catch_up(Block& block) {
    if (block.step == steps_) return;
    if (block.step < 0 && large_step_ == 0) {
        start_.set_dimension(next_ * static_cast<std::uint32_t>(Sampler::kBlock));
        block.values = start_.get_block();
        block.step = 0;
    } else if (block.step < large_step_) {
        for (float& value : block.values) value = random_();
        block.step = large_step_;
    }
    if (block.step < steps_)
        move(block.values, kDeviation * std::sqrt(static_cast<float>(steps_ - block.step)), random_);
    block.step = steps_;
}

} // namespace duet
