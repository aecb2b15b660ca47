#include "raster/lighting/ggx_fit.h"

#include "common/material/ggx.h"
#include "common/sampling/sobol.h"
#include "common/system/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace duet::raster {
namespace {

// Table entries are at equal steps of roughness and of √(1 − cos). The table is smooth in both.
float roughness_of(int row, int side) {
    return lerp(kSmoothest, kRoughest, static_cast<float>(row) / static_cast<float>(side - 1));
}
float cosine_of(int column, int side) {
    const float x = static_cast<float>(column) / static_cast<float>(side - 1);
    return std::max(1 - x * x, 1e-3f);
}

constexpr int kMomentSamples = 512, kFitSamples = 160;

Vec2d point(int i, int count) {
    return {(i + 0.5) / count, reverse_bits(static_cast<std::uint32_t>(i)) * 0x1p-32 + 0x1p-33};
}

Vec3d viewer(double cosine) { return {std::sqrt((1 - cosine) * (1 + cosine)), 0, cosine}; }

/// Represents the GGX lobe without its Fresnel term, D G₂ / (4 cos θₒ), which includes the cosine, and its sampling
/// density.
struct Lobe {
    double alpha;
    Vec3d wo;

    double value(Vec3d wi) const {
        if (!(wi.z > 0)) return 0;
        return ggx_reflection(wo, wi, normalize(wo + wi), alpha) * wi.z;
    }
    double pdf(Vec3d wi) const { return wi.z > 0 ? ggx_reflection_pdf(wo, normalize(wo + wi), alpha) : 0; }
    Vec3d sample(Vec2d u) const { return reflect(wo, ggx_sample_visible_normal(wo, alpha, u)); }
    double weight(Vec3d wi) const { return wi.z > 0 ? ggx_g2_over_g1(wo, wi, alpha) : 0; }
};

/// Holds the lobe's albedo (`energy`) and its mean direction, not normalized.
struct Moments {
    double energy = 0;
    Vec3d mean;
};
Moments moments(const Lobe& lobe) {
    Moments sum;
    for (int i = 0; i < kMomentSamples; ++i) {
        const Vec3d wi = lobe.sample(point(i, kMomentSamples));
        const double weight = lobe.weight(wi) / kMomentSamples;
        if (weight == 0) continue;
        sum.energy += weight;
        sum.mean += wi * weight;
    }
    sum.mean.y = 0;
    return sum;
}

/// Holds the parameters of Heitz et al. 2016: the scales along the lobe's axes and its skew, in a frame about its mean
/// direction (sin, 0, cos).
struct Parameters {
    double m11 = 1, m22 = 1, m13 = 0;
};
LobeMatrix matrix(const Parameters& p, Vec3d mean) {
    const double a = std::max(p.m11, 1e-7), b = std::max(p.m22, 1e-7);
    // The matrix is [X Y Z] · [m11 0 m13; 0 m22 0; 0 0 1] with X = (z, 0, −x) and Z = (x, 0, z).
    return {static_cast<float>(mean.z * a), static_cast<float>(mean.z * p.m13 + mean.x), static_cast<float>(b),
            static_cast<float>(-mean.x * a), static_cast<float>(-mean.x * p.m13 + mean.z)};
}

/// Represents a linearly transformed cosine by its density.
struct Cosine {
    double i11, i13, i22, i31, i33, determinant; ///< elements and determinant of the inverse matrix
    LobeMatrix m;

    explicit Cosine(const LobeMatrix& lobe) : m(lobe) {
        const double m11 = static_cast<double>(m.m11), m13 = static_cast<double>(m.m13),
                     m22 = static_cast<double>(m.m22),
                     m31 = static_cast<double>(m.m31), m33 = static_cast<double>(m.m33);
        const double d = m11 * m33 - m13 * m31;
        i11 = m33 / d, i13 = -m13 / d, i31 = -m31 / d, i33 = m11 / d, i22 = 1 / m22;
        determinant = std::abs(i22 / d);
    }
    double pdf(Vec3d w) const {
        const Vec3d o(i11 * w.x + i13 * w.z, i22 * w.y, i31 * w.x + i33 * w.z);
        const double l2 = length_squared(o);
        return std::max(o.z, 0.0) / kPiDouble * determinant / (l2 * l2);
    }
    Vec3d sample(Vec2d u) const {
        const double r = std::sqrt(u.x), phi = 2 * kPiDouble * u.y;
        const Vec3d o(r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - u.x));
        return normalize(Vec3d(static_cast<double>(m.m11) * o.x + static_cast<double>(m.m13) * o.z,
                               static_cast<double>(m.m22) * o.y,
                               static_cast<double>(m.m31) * o.x + static_cast<double>(m.m33) * o.z));
    }
};

/// Estimates ∫ |f − t|^power dw for the normalized lobe f and the fitted cosine t, from samples of both. `power` is 1
/// or 3.
double difference(const Lobe& lobe, double energy, const LobeMatrix& fit, int power, int samples) {
    const Cosine cosine(fit);
    double sum = 0;
    const auto add = [&](Vec3d w) {
        const double density = lobe.pdf(w) + cosine.pdf(w);
        if (!(density > 0)) return;
        const double d = std::abs(lobe.value(w) / energy - cosine.pdf(w));
        sum += (power == 3 ? d * d * d : d) / density;
    };
    for (int i = 0; i < samples; ++i) {
        add(lobe.sample(point(i, samples)));
        add(cosine.sample(point(i, samples)));
    }
    return sum / samples;
}

using Simplex = std::array<double, 3>;

/// Minimizes a function of three variables (Nelder and Mead 1965, "A Simplex Method for Function Minimization").
template <typename F> Simplex minimize(const F& f, const Simplex& start, double step) {
    std::array<std::pair<double, Simplex>, 4> s;
    for (std::size_t i = 0; i < 4; ++i) {
        s[i].second = start;
        if (i > 0) s[i].second[i - 1] += step * std::max(std::abs(start[i - 1]), 0.1);
        s[i].first = f(s[i].second);
    }
    const auto less = [](const auto& a, const auto& b) { return a.first < b.first; };
    for (int turn = 0; turn < 80; ++turn) {
        std::sort(s.begin(), s.end(), less);
        if (s[3].first - s[0].first <= 1e-5 * s[0].first) break;
        Simplex middle{};
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t k = 0; k < 3; ++k) middle[k] += s[i].second[k] / 3;
        const auto along = [&](double t) {
            Simplex p;
            for (std::size_t k = 0; k < 3; ++k) p[k] = middle[k] + t * (s[3].second[k] - middle[k]);
            return std::pair(f(p), p);
        };
        const auto reflected = along(-1);
        if (reflected.first < s[0].first) {
            const auto expanded = along(-2);
            s[3] = less(expanded, reflected) ? expanded : reflected;
        } else if (reflected.first < s[2].first) {
            s[3] = reflected;
        } else {
            const auto contracted = along(reflected.first < s[3].first ? -0.5 : 0.5);
            if (contracted.first < std::min(reflected.first, s[3].first)) {
                s[3] = contracted;
                continue;
            }
            for (std::size_t i = 1; i < 4; ++i) {
                for (std::size_t k = 0; k < 3; ++k) s[i].second[k] = (s[i].second[k] + s[0].second[k]) / 2;
                s[i].first = f(s[i].second);
            }
        }
    }
    return std::min_element(s.begin(), s.end(), less)->second;
}

/// Fits one entry. The search starts from `parameters`, which are those of a neighboring entry, and stores the result
/// there.
LobeMatrix fit(float alpha, float cosine, Parameters& parameters) {
    const Lobe lobe{static_cast<double>(alpha), viewer(static_cast<double>(cosine))};
    const Moments m = moments(lobe);
    const Vec3d mean = normalize(m.mean);
    const bool round = cosine >= 1; // at normal incidence the lobe is rotationally symmetric
    const auto from = [&](const Simplex& s) {
        return round ? Parameters{s[0], s[0], 0} : Parameters{s[0], s[1], s[2]};
    };
    const Vec3d axis = round ? Vec3d(0, 0, 1) : mean;
    const Simplex best = minimize(
        [&](const Simplex& s) { return difference(lobe, m.energy, matrix(from(s), axis), 3, kFitSamples); },
        {parameters.m11, parameters.m22, parameters.m13}, 0.05);
    parameters = from(best);
    parameters.m11 = std::max(parameters.m11, 1e-7), parameters.m22 = std::max(parameters.m22, 1e-7);
    return matrix(parameters, axis);
}

} // namespace

/// Fits normal incidence first, from the greatest roughness down, then each row from normal incidence to grazing
/// angles. Each fit starts from the neighboring entry's parameters.
GgxTable<5, kLobeSide> compute_lobe_table() {
    std::array<Parameters, kLobeSide> straight;
    Parameters p;
    for (int row = kLobeSide - 1; row >= 0; --row) {
        fit(sqr(roughness_of(row, kLobeSide)), 1, p);
        straight[static_cast<std::size_t>(row)] = p;
    }
    GgxTable<5, kLobeSide> table;
    parallel_for(kLobeSide, 0, [&](std::size_t i) {
        const int row = static_cast<int>(i);
        Parameters along = straight[i];
        for (int column = 0; column < kLobeSide; ++column) {
            const LobeMatrix lobe = fit(sqr(roughness_of(row, kLobeSide)), cosine_of(column, kLobeSide), along);
            table(row, column) = {lobe.m11, lobe.m13, lobe.m22, lobe.m31, lobe.m33};
        }
    });
    return table;
}

double lobe_distance(float alpha, float cosine, const LobeMatrix& lobe) {
    const Lobe exact{static_cast<double>(alpha), viewer(static_cast<double>(cosine))};
    return difference(exact, moments(exact).energy, lobe, 1, 4096);
}

} // namespace duet::raster
