#include "raytrace/sampling/primary_sample.h"

#include "common/sampling/hash.h"
#include "common/vec/scalar.h"

#include <algorithm>
#include <cmath>

namespace duet {

PrimarySample::Random::Random(std::uint64_t seed) : state_(mix_bits(seed + kGoldenGamma)) {}

float PrimarySample::Random::uniform() { return unit_float(high_bits(stream_number(state_, drawn_++))); }

// This is the transform of Box and Muller 1958.
Vec2 PrimarySample::Random::normal_pair() {
    const float radius = std::sqrt(-2 * std::log(1 - uniform())), angle = 2 * kPi * uniform();
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

void PrimarySample::propose() {
    ++steps_;
    large_ = random_.uniform() < kLargeStep;
    changed_.clear();
}

void PrimarySample::accept() {
    if (large_) large_step_ = steps_;
}

void PrimarySample::reject() {
    for (const std::uint32_t i : changed_) {
        Block& block = blocks_[i];
        block.values = block.backup, block.step = block.backup_step;
    }
    --steps_;
}

Sampler::Block PrimarySample::get_block() {
    if (blocks_.size() <= next_) blocks_.resize(next_ + 1);
    Block& block = blocks_[next_];
    if (block.step < steps_) {
        block.backup = block.values, block.backup_step = block.step;
        changed_.push_back(next_);
        catch_up(block);
        block.step = steps_;
    }
    ++next_;
    return block.values;
}

// Several small steps of the normal distribution are one of a larger deviation.
void PrimarySample::catch_up(Block& block) {
    const std::int64_t last_large = large_ ? steps_ : large_step_;
    if (block.step < 0 && last_large == 0) {
        start_.set_dimension(next_ * static_cast<std::uint32_t>(Sampler::kBlock));
        block.values = start_.get_block();
        block.step = 0;
    } else if (block.step < last_large) {
        for (float& value : block.values) value = random_.uniform();
        block.step = last_large;
    }
    if (block.step == steps_) return;
    const float deviation = kDeviation * std::sqrt(static_cast<float>(steps_ - block.step));
    const auto move = [](float& value, float by) {
        value += by;
        value = std::min(value - std::floor(value), kOneMinusEpsilon);
    };
    for (std::size_t i = 0; i < block.values.size(); i += 2) {
        const Vec2 moves = random_.normal_pair() * deviation;
        move(block.values[i], moves.x);
        move(block.values[i + 1], moves.y);
    }
}

} // namespace duet
