// This build-time program writes the tables of common/material/ggx_albedo.h as a source file. It integrates the
// functions of common/material/ggx.h numerically.
#include "common/material/ggx.h"
#include "common/material/ggx_albedo_table.h"
#include "common/sampling/hash.h"
#include "common/sampling/sobol.h"
#include "common/system/table_generator.h"

#include <memory>

using namespace duet;

namespace {

constexpr int kSamples = 1024;

struct Entry {
    double energy_loss = 0, schlick_weight = 0;
};
/// Integrates the single-scattering albedo over wi, by samples of visible normals. Their weight is G₂/G₁.
Entry integrate(float alpha, float cosine) {
    const Vec3 wo(std::sqrt((1 - cosine) * (1 + cosine)), 0, cosine);
    double energy = 0, offset = 0, energy_loss = 0;
    for (int i = 0; i < kSamples; ++i) {
        const Vec2 u((static_cast<float>(i) + 0.5f) / kSamples,
                     unit_float(reverse_bits(static_cast<std::uint32_t>(i))) + 0x1p-25f);
        const Vec3 h = ggx_sample_visible_normal(wo, alpha, u), wi = reflect(wo, h);
        const double weight = wi.z > 0 ? static_cast<double>(ggx_g2_over_g1(wo, wi, alpha)) : 0;
        const double x = 1 - static_cast<double>(dot(wo, h));
        energy += weight;
        energy_loss += 1 - weight;
        offset += weight * x * x * x * x * x;
    }
    return {energy_loss / kSamples, energy > 0 ? offset / energy : 0};
}

/// Computes the hemispherical means 2∫ … μ dμ from the tables themselves, so that the multiple-scattering lobe
/// returns exactly the energy that lookups report as lost.
void add_means(GgxAlbedoTables& tables, std::size_t row, float alpha) {
    constexpr int kSteps = 2048;
    double energy_loss = 0, schlick_weight = 0;
    for (int i = 0; i < kSteps; ++i) {
        const float x = (static_cast<float>(i) + 0.5f) / kSteps, cosine = x * x; // denser at grazing angles
        const double step = 4.0 * static_cast<double>(x * cosine) / kSteps;
        const float loss = tables.energy_loss_at(alpha, cosine);
        energy_loss += step * static_cast<double>(loss);
        schlick_weight += step * static_cast<double>((1 - loss) * tables.schlick_weight_at(alpha, cosine));
    }
    tables.mean_energy_loss[row] = static_cast<float>(energy_loss);
    tables.mean_schlick_weight[row] = static_cast<float>(schlick_weight);
}

std::unique_ptr<GgxAlbedoTables> compute_tables() {
    auto tables = std::make_unique<GgxAlbedoTables>();
    constexpr std::size_t kSize = GgxAlbedoTables::kSize;
    for (std::size_t row = 0; row < kSize; ++row) {
        const float alpha = sqr(GgxAlbedoTables::roughness_of(static_cast<int>(row)));
        for (std::size_t column = 0; column < kSize; ++column) {
            const float x = static_cast<float>(column) / (kSize - 1);
            tables->energy_loss[row][column] =
                static_cast<float>(integrate(alpha, GgxAlbedoTables::cosine_of_steepness(alpha, x)).energy_loss);
            tables->schlick_weight[row][column] =
                static_cast<float>(integrate(alpha, std::max(x * x, 1e-7f)).schlick_weight);
        }
    }
    for (std::size_t row = 0; row < kSize; ++row)
        add_means(*tables, row, sqr(GgxAlbedoTables::roughness_of(static_cast<int>(row))));
    return tables;
}

} // namespace

int main(int count, char** arguments) {
    const TableSource source{"make_ggx_albedo", "common/material/ggx_albedo_table.h", "duet",
                             "GgxAlbedoTables kGgxAlbedoTables"};
    return generate_table(count, arguments, source, [](std::ostream& out) {
        const auto tables = compute_tables();
        write_table(out, tables->energy_loss);
        write_table(out, tables->schlick_weight);
        write_table(out, tables->mean_energy_loss);
        write_table(out, tables->mean_schlick_weight);
    });
}
