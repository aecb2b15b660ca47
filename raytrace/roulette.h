// Russian roulette by expected contribution: how much throughput a path must have left to be worth its rays.
#pragma once

#include "common/camera/camera.h"

namespace duet::raytrace {

struct PreparedData;
struct Settings;

/// Where nothing is known of the scene: a path of a quarter of its throughput goes on for certain.
inline constexpr float kPlainWorth = 4;

/// A path goes on with a chance of its throughput × worth, where that is below 1 (survival). The worth for which error ×
/// cost of the picture are least: error is half MSE and half relMSE, each over what it is without roulette, cost is rays.
/// Every path that goes on saves its successors from standing for others (their light squared is variance), and costs its
/// rays; how both add up is known from a few paths of the picture, traced beforehand almost without roulette, which leave a
/// record of each step (Bolin and Meyer 1997, Vorba and Křivánek 2016 and Rath et al. 2022 weigh the same two; here there is
/// one number for all of a picture: README.md has what more would gain). Few paths tell little: another worth than
/// kPlainWorth has to be better by two standard errors.
///
/// At most 2,048 paths, and no more than an eighth of the pixels; kPlainWorth for pictures so small that this tells nothing.
/// The paths have a seed of their own, and neither samples nor threads nor skips decide: shards and continued films have one
/// worth. Between 1, by which no survivor stands for more than a path from the camera does, and 16.
float learned_worth(const PreparedData& prepared, const View& view, const Settings& settings);

} // namespace duet::raytrace
