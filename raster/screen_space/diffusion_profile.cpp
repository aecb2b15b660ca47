#include "raster/screen_space/diffusion_profile.h"

#include <array>
#include <cmath>

namespace duet::raster {
namespace {

constexpr int kSteps = 256; ///< intervals of the table between the distances 0 and kReach

// Tabulates the radial distribution 1 − (exp(−r) + 3 exp(−r / 3)) / 4 at the distance r = x / cos φ, averaged over all
// directions φ.
std::array<float, kSteps + 2> tabulate() {
    std::array<float, kSteps + 2> table;
    constexpr int kDirections = 256;
    for (int i = 0; i <= kSteps; ++i) {
        const double x = static_cast<double>(diffusion_profile::kReach) * i / kSteps;
        double within = 0;
        for (int k = 0; k < kDirections; ++k) {
            const double r = x / std::cos((k + 0.5) / kDirections * kPiDouble / 2);
            within += 1 - (std::exp(-r) + 3 * std::exp(-r / 3)) / 4;
        }
        table[static_cast<std::size_t>(i)] = static_cast<float>(within / kDirections);
    }
    for (int i = 0; i <= kSteps; ++i) table[static_cast<std::size_t>(i)] /= table[kSteps];
    table.back() = 1;
    return table;
}

} // namespace

Floats diffusion_profile::fraction_within(const Floats& x) {
    static const std::array<float, kSteps + 2> kTable = tabulate();
    const Floats at = min(x * Floats(kSteps / kReach), Floats(static_cast<float>(kSteps)));
    const Ints whole = truncated(at);
    const Floats low = gather(kTable.data(), whole), high = gather(kTable.data() + 1, whole);
    return low + (high - low) * (at - xsimd::batch_cast<float>(whole));
}

SolidMaterials::SolidMaterials(const Scene& scene) {
    const std::size_t size = scene.materials.size() + 1;
    fraction.resize(size), solid_part.resize(size, 1), internal_reflectance.resize(size);
    for (std::vector<float>& channel : mean_free_path) channel.resize(size);
    for (std::size_t i = 1; i < size; ++i) {
        const Material& material = scene.materials[i - 1];
        if (!has_subsurface(material)) continue;
        const auto* principled = std::get_if<Principled>(&material);
        fraction[i] = principled != nullptr ? principled->subsurface.value : 1;
        if (principled != nullptr)
            solid_part[i] = max(fraction[i] * (1 - clamp(principled->metallic.value, 0.0f, 1.0f)), 1e-3f);
        internal_reflectance[i] = duet::internal_reflectance(material);
        for (std::size_t c = 0; c < 3; ++c) mean_free_path[c][i] = (*duet::mean_free_path(material))[c];
    }
}

} // namespace duet::raster
