// This build-time program writes the tables of common/material/rough_glass_energy.h as a source file. It integrates
// the functions of ggx.h, fresnel.h and microfacet.h numerically.
#include "common/material/fresnel.h"
#include "common/material/ggx.h"
#include "common/material/microfacet.h"
#include "common/material/rough_glass_table.h"
#include "common/sampling/hash.h"
#include "common/sampling/sobol.h"
#include "common/system/table_generator.h"

#include <memory>

using namespace duet;

namespace {

using Tables = RoughGlassTables;
constexpr int kSamples = 1024;

struct Boundary {
    float index, alpha;

    /// Calls add(reflected, cosine of wi, fraction of the light) for each sample that a single microfacet scatters.
    /// The samples are drawn from the visible normals, with weight G₂/G₁. The mode is importance, so that a sum
    /// of 1 means all light.
    template <typename Add> void scatter(bool dense, float cosine, const Add& add) const {
        const Vec3 wo(std::sqrt((1 - cosine) * (1 + cosine)), 0, cosine);
        const float relative = dense ? 1 / index : index;
        const auto weight = [&](Vec3 wi, float fraction) {
            return static_cast<double>(fraction * ggx_g2_over_g1(wo, wi, alpha)) / kSamples;
        };
        for (int i = 0; i < kSamples; ++i) {
            const Vec2 u((static_cast<float>(i) + 0.5f) / kSamples,
                         unit_float(reverse_bits(static_cast<std::uint32_t>(i))) + 0x1p-25f);
            const Vec3 h = ggx_sample_visible_normal(wo, alpha, u);
            const float cos_o = dot(wo, h), fresnel = fresnel_dielectric(max(cos_o, 0.0f), relative);
            const Vec3 mirrored = reflect(wo, h);
            if (mirrored.z > 0) add(true, mirrored.z, weight(mirrored, fresnel));
            if (!(cos_o > 0 && fresnel < 1)) continue;
            const Vec3 through = refract(wo, h, cos_o, relative);
            if (through.z < 0) add(false, -through.z, weight({through.x, through.y, -through.z}, 1 - fresnel));
        }
    }
};

struct Curves {
    Tables::Curve &gain, &energy_loss_thin, &energy_loss_dense;
};

void compute(const Boundary& boundary, Curves curves) {
    for (std::size_t i = 0; i < Tables::kAngles; ++i) {
        double reflected = 0, all = 0;
        boundary.scatter(false, Tables::cosine_of(static_cast<int>(i), boundary.alpha),
                         [&](bool back, float, double weight) {
                             all += weight;
                             if (back) reflected += weight;
                         });
        curves.gain[i] = static_cast<float>(1 / all);
        curves.energy_loss_thin[i] = static_cast<float>(std::max(1 - all, 0.0) * reflected / all);
    }
    for (std::size_t i = 0; i < Tables::kAngles; ++i) {
        double all = 0;
        boundary.scatter(true, Tables::cosine_of(static_cast<int>(i), boundary.alpha),
                         [&](bool back, float cosine, double weight) {
                             all += weight * (back ? 1.0
                                                   : static_cast<double>(Tables::look_up(
                                                         curves.gain, Tables::cosine_index(cosine, boundary.alpha))));
                         });
        curves.energy_loss_dense[i] = static_cast<float>(std::max(1 - all, 0.0));
    }
}

/// Computes the hemispherical mean 2∫ … μ dμ from the table itself, so that the lobe returns exactly the energy
/// that lookups report as lost.
float mean_of(const Tables::Curve& curve, float alpha) {
    constexpr int kSteps = 2048;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const float x = (static_cast<float>(i) + 0.5f) / kSteps, cosine = x * x; // denser at grazing angles
        sum += 4.0 * static_cast<double>(x * cosine) / kSteps *
               static_cast<double>(Tables::look_up(curve, Tables::cosine_index(cosine, alpha)));
    }
    return static_cast<float>(sum);
}

std::unique_ptr<Tables> compute_tables() {
    auto tables = std::make_unique<Tables>();
    for (std::size_t i = 0; i < Tables::kIndices; ++i)
        for (std::size_t a = 0; a < Tables::kAlphas; ++a) {
            const Boundary boundary{Tables::index_of(static_cast<int>(i)), Tables::alpha_of(static_cast<int>(a))};
            compute(boundary, {tables->gain[i][a], tables->energy_loss_thin[i][a], tables->energy_loss_dense[i][a]});
            tables->mean_energy_loss_thin[i][a] = mean_of(tables->energy_loss_thin[i][a], boundary.alpha);
            tables->mean_energy_loss_dense[i][a] = mean_of(tables->energy_loss_dense[i][a], boundary.alpha);
        }
    return tables;
}

} // namespace

int main(int count, char** arguments) {
    const TableSource source{"make_rough_glass", "common/material/rough_glass_table.h", "duet",
                             "RoughGlassTables kRoughGlassTables"};
    return generate_table(count, arguments, source, [](std::ostream& out) {
        const auto tables = compute_tables();
        write_table(out, tables->gain);
        write_table(out, tables->energy_loss_thin);
        write_table(out, tables->energy_loss_dense);
        write_table(out, tables->mean_energy_loss_thin);
        write_table(out, tables->mean_energy_loss_dense);
    });
}
