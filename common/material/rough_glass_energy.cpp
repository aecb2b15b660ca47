#include "common/material/rough_glass_energy.h"

namespace duet {

extern const RoughGlassTables kRoughGlassTables; // written by rough_glass_table_main.cpp

RoughGlassEnergy::RoughGlassEnergy(float eta, float alpha)
    : alpha_(clamp(alpha, sqr(RoughGlassTables::kSmoothest), 1.0f)), index_(RoughGlassTables::place_of_index(max(eta, 1 / eta))),
      row_(RoughGlassTables::place_of_alpha(alpha_)) {}

float RoughGlassEnergy::look_up(const RoughGlassTables::Surface& surface, float cosine) const {
    return RoughGlassTables::look_up(surface, index_, row_, RoughGlassTables::place_of_cosine(cosine, alpha_));
}

float RoughGlassEnergy::gain(float cosine) const { return look_up(kRoughGlassTables.gain, cosine); }

RoughGlassEnergy::Lobe RoughGlassEnergy::lobe(bool dense) const {
    constexpr float kLeast = 0.0003f;
    const auto& mean_lost = dense ? kRoughGlassTables.mean_lost_dense : kRoughGlassTables.mean_lost_thin;
    const float mean = RoughGlassTables::look_up(mean_lost, index_, row_);
    if (mean < kLeast) return {};
    return {dense ? &kRoughGlassTables.lost_dense : &kRoughGlassTables.lost_thin, mean};
}

float RoughGlassEnergy::lost(const Lobe& lobe, float cosine) const {
    return lobe.table == nullptr ? 0 : look_up(*lobe.table, cosine);
}

} // namespace duet
