// The examiner of assignment 3. The truth is Walter et al. 2007 and Heitz 2014 in double precision, and three laws that
// hold for any right answer: the distribution is normalized, the samples follow their density, no energy appears.
#include "compare/lessons/assignments/3-material/lab.h"
#include "tests/grading/judge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

using namespace duet;
using namespace duet::grading;

LAB_TITLE("assignment-3", "Rough metal, from its paper")

namespace {

double sine2(Vec3d w) { return w.x * w.x + w.y * w.y; }
double distribution(Vec3d m, double alpha) {
    const double a2 = alpha * alpha, d = m.z * m.z * (a2 - 1) + 1;
    return a2 / (kPiDouble * d * d);
}
double lambda(Vec3d w, double alpha) { return (std::sqrt(1 + alpha * alpha * sine2(w) / (w.z * w.z)) - 1) / 2; }
Rgbd brdf(Vec3d wo, Vec3d wi, double alpha, Rgbd f0) {
    const Vec3d m = normalize(wo + wi);
    const double g2 = 1 / (1 + lambda(wo, alpha) + lambda(wi, alpha));
    const Rgbd fresnel = f0 + (Rgbd(1) - f0) * std::pow(1 - dot(wo, m), 5);
    return fresnel * (distribution(m, alpha) * g2 / (4 * wo.z * wi.z));
}

Vec3 direction(double theta, double phi) {
    return Vec3(Vec3d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)));
}

/// The upper hemisphere cut into cells of equal width in cos θ and in φ: each cell has the same solid angle.
struct Cells {
    int rows, columns;
    double solid_angle() const { return 2 * kPiDouble / (rows * columns); }
    std::size_t size() const { return static_cast<std::size_t>(rows * columns); }
    std::size_t cell_of(Vec3 w) const {
        const double phi = std::atan2(w.y, w.x) / (2 * kPiDouble) + 0.5;
        const int row = std::min(static_cast<int>(w.z * static_cast<float>(rows)), rows - 1);
        const int column = std::min(static_cast<int>(phi * columns), columns - 1);
        return static_cast<std::size_t>(row * columns + column);
    }
    /// The points of a grid of n × n in each cell, cell after cell.
    std::vector<Vec3> points(int n) const {
        std::vector<Vec3> result;
        for (int row = 0; row < rows; ++row)
            for (int column = 0; column < columns; ++column)
                for (int i = 0; i < n * n; ++i) {
                    const double z = (row + (i / n + 0.5) / n) / rows, phi = (column + (i % n + 0.5) / n) / columns;
                    result.push_back(direction(std::acos(z), 2 * kPiDouble * (phi - 0.5)));
                }
        return result;
    }
};

/// Sample points (i + ½)/n, (i·φ mod 1): evenly spread and never random, so that a right answer always passes.
std::vector<Vec2> even_points(int n) {
    std::vector<Vec2> points;
    for (int i = 0; i < n; ++i) {
        const double golden = (i + 0.5) * 0.6180339887498949;
        points.push_back({static_cast<float>((i + 0.5) / n), static_cast<float>(golden - std::floor(golden))});
    }
    return points;
}

std::vector<Vec2> random_points(Item& item, int n) {
    std::vector<Vec2> points;
    for (int i = 0; i < n; ++i) {
        const float x = static_cast<float>(item.random().uniform());
        points.push_back({x, static_cast<float>(item.random().uniform())});
    }
    return points;
}

/// ∫ D(m) cos θ dω by the midpoint rule in θ, of the student's D. D is smooth: 400 steps are right to 1e-4.
double normalization(float alpha, double power) {
    double sum = 0;
    constexpr int kSteps = 400;
    for (int i = 0; i < kSteps; ++i) {
        // θ = atan(α tan s) puts most steps where the lobe is.
        const double s = (i + 0.5) / kSteps * kPiDouble / 2, t = alpha * std::tan(s), theta = std::atan(t);
        const double stretch = alpha / (std::cos(s) * std::cos(s) * (1 + t * t)) * (kPiDouble / 2 / kSteps);
        const double d = STUDENT(ggx_distribution)(direction(theta, 0.4), alpha);
        sum += d * std::pow(std::cos(theta), power) * std::sin(theta) * 2 * kPiDouble * stretch;
    }
    return sum;
}

} // namespace

LAB_ITEM(10, "D has the values of the paper") {
    for (const float alpha : {0.1f, 0.5f, 1.0f})
        for (const double theta : {0.0, 0.2, 0.9, 1.4}) {
            const Vec3 m = direction(theta, 1.0);
            const double cosine = std::cos(theta), d = distribution(Vec3d(m), alpha);
            const float found = STUDENT(ggx_distribution)(m, alpha);
            const auto as = [](double value) { return static_cast<float>(value); };
            const float tolerance = as(2e-4 * d + 1e-7);
            item.near(
                "D", found, as(d), tolerance,
                {{as(d * kPiDouble), "The factor 1/π is missing."},
                 {as(distribution(Vec3d(m), alpha * alpha)), "You squared alpha: here alpha is the paper's alpha_g."},
                 {as(distribution(Vec3d(m), std::sqrt(alpha))), "alpha must be squared in the formula."},
                 {as(d * cosine), "The cosine is not a part of D."},
                 {as(d * std::pow(cosine, 4)), "The fourth power of the cosine in the denominator is missing."}});
        }
    item.near("D below the surface", STUDENT(ggx_distribution)(Vec3{0, 0, -1}, 0.5f), 0.0f, 0.0f);
}

LAB_ITEM(10, "D is normalized: the integral of D·cos θ over the hemisphere is 1") {
    for (const float alpha : {0.05f, 0.2f, 0.6f, 1.0f}) {
        const double integral = normalization(alpha, 1);
        item.require(
            std::abs(integral - 1) < 2e-3,
            message("The projected area of all microfacets must be that of the flat surface: expected 1, found ",
                    integral, " for alpha = ", alpha, "."));
    }
}

LAB_ITEM(10, "Λ has the values of the paper") {
    for (const float alpha : {0.1f, 0.5f, 1.0f})
        for (const double theta : {0.0, 0.3, 1.0, 1.5}) {
            const Vec3 w = direction(theta, -2.0);
            const double expected = lambda(Vec3d(w), alpha), g1 = 1 / (1 + expected);
            item.near("Λ", STUDENT(smith_lambda)(w, alpha), static_cast<float>(expected),
                      static_cast<float>(1e-4 + 1e-3 * expected),
                      {{static_cast<float>(g1), "This is G1 = 1 / (1 + Λ), not Λ."},
                       {static_cast<float>(2 * expected), "The factor ½ is missing."},
                       {static_cast<float>(expected + 0.5), "The -1 under the factor ½ is missing."}});
        }
}

LAB_ITEM(15, "the BRDF has the values of the papers") {
    const Rgb f0(0.9f, 0.6f, 0.3f);
    for (int i = 0; i < 60; ++i) {
        const float alpha = static_cast<float>(item.random().uniform(0.1, 1));
        const Vec3 wo = direction(item.random().uniform(0, 1.4), item.random().uniform(0, 6));
        const Vec3 wi = direction(item.random().uniform(0, 1.4), item.random().uniform(0, 6));
        const auto found = STUDENT(metal_eval)(wo, std::vector<Vec3>{wi}, alpha, f0);
        item.require(found.size() == 1,
                     message("One value is expected for each wi: expected 1, found ", found.size(), "."));
        const Rgbd f = brdf(Vec3d(wo), Vec3d(wi), alpha, Rgbd(f0));
        const double lo = lambda(Vec3d(wo), alpha), li = lambda(Vec3d(wi), alpha);
        const auto times = [&](double factor) { return Rgb(f * factor); };
        const Rgb without_fresnel(brdf(Vec3d(wo), Vec3d(wi), alpha, Rgbd(1))); // F of a perfect mirror is 1
        const auto with_fresnel = [&](double schlick) {
            return Rgb(brdf(Vec3d(wo), Vec3d(wi), alpha, Rgbd(1)) * (Rgbd(f0) + (Rgbd(1) - Rgbd(f0)) * schlick));
        };
        const double beside = 1 - dot(Vec3d(wo), normalize(Vec3d(wo) + Vec3d(wi)));
        item.near("the BRDF", found[0], Rgb(f), static_cast<float>(1e-3 * max_component(f) + 1e-5),
                  {{times(wi.z), "The BRDF has no cosine in it: the cosine of wi belongs to the integral."},
                   {times(4), "The 4 in the denominator is missing."},
                   {times(4 * wo.z * wi.z), "The denominator 4·cos θo·cos θi is missing."},
                   {times((1 + lo + li) / ((1 + lo) * (1 + li))),
                    "G2 isn't G1(wo)·G1(wi): the contract asks for 1 / (1 + Λ(wo) + Λ(wi))."},
                   {times(1 + lo + li), "The masking term G2 is missing."},
                   {without_fresnel, "The Fresnel term F is missing."},
                   {with_fresnel(0), "This is F = f0: the part (1 - f0)·(1 - wo·m)⁵ is missing."},
                   {with_fresnel(beside), "In Schlick's formula 1 - wo·m is raised to the fifth power."},
                   {with_fresnel(std::pow(1 - wo.z, 5)),
                    "Schlick's formula takes the angle between wo and m, not that between wo and the surface's n."}});
        const auto swapped = STUDENT(metal_eval)(wi, std::vector<Vec3>{wo}, alpha, f0);
        item.near("the BRDF with wo and wi exchanged (Helmholtz reciprocity)", swapped.at(0), found[0],
                  1e-3f * max_component(found[0]) + 1e-5f,
                  {{with_fresnel(std::pow(1 - wi.z, 5)),
                    "Schlick's formula takes the angle between wo and m, not that between wo and the surface's n."}});
    }
    const auto below = STUDENT(metal_eval)(Vec3{0, 0, 1}, std::vector<Vec3>{{0.6f, 0, -0.8f}}, 0.5f, f0);
    item.near("the BRDF of a wi below the surface", below.at(0), Rgb(0), 0.0f);
}

LAB_ITEM(20, "samples follow their density (chi-squared)") {
    const Cells cells{16, 32};
    constexpr int kSamples = 60000, kGrid = 6;
    for (const auto& [theta, alpha] : {std::pair{0.3, 0.4f}, std::pair{1.1, 0.3f}, std::pair{1.3, 0.8f}}) {
        const Vec3 wo = direction(theta, 0.7);
        std::vector<double> counts(cells.size() + 1, 0.0), expected(cells.size() + 1, 0.0);
        const auto samples = STUDENT(metal_sample)(wo, alpha, random_points(item, kSamples));
        item.require(samples.size() == kSamples, "One direction is expected for each pair of random numbers.");
        for (const Vec3 wi : samples) {
            const float size = length(wi);
            item.require(size == 0 || std::abs(size - 1) < 1e-3f,
                         message("A direction must have length 1, or be (0, 0, 0): found length ", size, "."));
            item.require(wi.z >= 0, "A direction below the surface must be returned as (0, 0, 0).");
            ++counts[size == 0 ? cells.size() : cells.cell_of(wi)];
        }
        const auto densities = STUDENT(metal_pdf)(wo, cells.points(kGrid), alpha);
        double inside = 0;
        for (std::size_t i = 0; i < densities.size(); ++i) {
            const double part = densities[i] * cells.solid_angle() / (kGrid * kGrid) * kSamples;
            expected[i / (kGrid * kGrid)] += part;
            inside += part;
        }
        const double integral = inside / kSamples;
        item.require(integral < 1.01, message("The density integrates to ", integral,
                                              " over the hemisphere: more than 1 can't be. "
                                              "Is the change of variables from m to wi, 1 / (4·(wo·m)), there?"));
        const double lost = counts[cells.size()] / kSamples;
        item.require(std::abs(1 - integral - lost) < 0.015,
                     message("The density integrates to ", integral, ", so ", 1 - integral,
                             " of the samples should lie below the surface, but ", lost,
                             " do. Check that sample and density use the same alpha."));
        expected[cells.size()] = kSamples - inside;
        // Cells that expect few samples are pooled, so that each term of the statistic is nearly normal.
        double chi2 = 0, pooled_count = 0, pooled_expected = 0;
        int freedom = -1;
        for (std::size_t i = 0; i < counts.size(); ++i) {
            if (expected[i] < 20) {
                pooled_count += counts[i], pooled_expected += expected[i];
                continue;
            }
            // The grid's own error of the expected count, about 1 %, counts as noise.
            const double variance = expected[i] + std::pow(0.01 * expected[i], 2);
            chi2 += std::pow(counts[i] - expected[i], 2) / variance, ++freedom;
        }
        if (pooled_expected > 5) chi2 += std::pow(pooled_count - pooled_expected, 2) / (pooled_expected + 1), ++freedom;
        // Wilson and Hilferty's normal approximation; 5 standard deviations: a right answer fails once in 3 million
        // runs.
        const double z = (std::cbrt(chi2 / freedom) - 1 + 2.0 / (9 * freedom)) / std::sqrt(2.0 / (9 * freedom));
        item.require(z < 5,
                     message("The directions drawn aren't spread as metal_pdf says: chi-squared is ", chi2,
                             " where about ", freedom, " is expected (alpha = ", alpha, ", wo at ", degrees(theta),
                             " degrees). Check that sample and density use the same alpha, and the factor cos θm of "
                             "the density of m."));
    }
}

LAB_ITEM(15, "the mean of f·cos/pdf over samples is the albedo") {
    for (const auto& [theta, alpha] : {std::pair{0.2, 0.3f}, std::pair{1.0, 0.6f}, std::pair{0.4, 0.1f}}) {
        const Vec3 wo = direction(theta, 0);
        const Cells cells{400, 800};
        double albedo = 0;
        for (const Vec3 wi : cells.points(1))
            albedo += brdf(Vec3d(wo), Vec3d(wi), alpha, Rgbd(1)).r * wi.z * cells.solid_angle();
        const auto wi = STUDENT(metal_sample)(wo, alpha, even_points(20000));
        const auto f = STUDENT(metal_eval)(wo, wi, alpha, Rgb(1));
        const auto pdf = STUDENT(metal_pdf)(wo, wi, alpha);
        item.require(f.size() == wi.size() && pdf.size() == wi.size(), "One value is expected for each direction.");
        double mean = 0, squares = 0;
        for (std::size_t i = 0; i < wi.size(); ++i)
            if (length_squared(wi[i]) > 0) {
                item.require(pdf[i] > 0, "A direction was drawn whose density is 0.");
                const double weight = f[i].r * wi[i].z / pdf[i];
                mean += weight / static_cast<double>(wi.size());
                squares += weight * weight / static_cast<double>(wi.size());
            }
        item.require(!(squares > 3 * mean * mean),
                     message("The weights f·cos/pdf of your samples are very unequal (alpha = ", alpha,
                             "): the mean of their squares is ", squares / (mean * mean),
                             " times the square of their mean; expected at most 3. The directions must be drawn where "
                             "the BRDF is large, about the mirror direction."));
        item.require(std::abs(mean - albedo) < 0.01 * albedo + 0.002,
                     message("Sampling white metal (f0 = 1, alpha = ", alpha, ") gives a mean weight of ", mean,
                             "; the integral of f·cos is ", albedo, "."));
    }
}

LAB_ITEM(20, "the white furnace: metal that absorbs nothing never returns more than it gets") {
    for (const float alpha : {0.1f, 0.5f, 1.0f})
        for (const double theta : {0.1, 0.8, 1.3, 1.5}) {
            const Vec3 wo = direction(theta, 0);
            const auto wi = STUDENT(metal_sample)(wo, alpha, even_points(20000));
            const auto f = STUDENT(metal_eval)(wo, wi, alpha, Rgb(1));
            const auto pdf = STUDENT(metal_pdf)(wo, wi, alpha);
            double albedo = 0;
            for (std::size_t i = 0; i < std::min({wi.size(), f.size(), pdf.size()}); ++i)
                if (length_squared(wi[i]) > 0 && pdf[i] > 0)
                    albedo += f[i].r * wi[i].z / pdf[i] / static_cast<double>(wi.size());
            item.require(albedo < 1.005,
                         message("In a room that shines with radiance 1 from everywhere this metal shows ", albedo,
                                 " (alpha = ", alpha, ", ", degrees(theta), " degrees): it makes light from nothing."));
            item.require(albedo > 0.29,
                         message("In a room that shines with radiance 1 from everywhere this metal shows only ", albedo,
                                 " (alpha = ", alpha, ", ", degrees(theta),
                                 " degrees): single reflections return 0.3 and more."));
        }
}

namespace {

/// The radiance of a studio: dim, with three white panels, a warm floor and a blue wall behind the viewer.
Rgb studio(Vec3 w) {
    const auto panel = [&](Vec3 middle, float size) {
        const float t = std::clamp((dot(w, normalize(middle)) - size) / (1 - size) * 2, 0.0f, 1.0f);
        return t * t * (3 - 2 * t); // soft at the edge
    };
    const Rgb wall = w.y < 0 ? Rgb(0.30f, 0.20f, 0.12f) * (1 + w.y) : Rgb(0.10f, 0.16f, 0.28f) * (1 - 0.7f * w.y);
    return wall + Rgb(6) * panel({-0.8f, 0.7f, 0.6f}, 0.955f) + Rgb(2.5f, 2.8f, 3.2f) * panel({1, 0.25f, 0.1f}, 0.93f) +
           Rgb(3.5f, 2.4f, 1.4f) * panel({0.1f, 1, -0.6f}, 0.96f);
}

/// What a sphere of the student's metal shows where its normal makes an angle with the direction to the viewer: the
/// directions about the normal, and their weights f·cos/pdf. The viewer lies in the plane of x and z.
struct Lobe {
    std::vector<Vec3> directions;
    std::vector<Rgb> weights;
};
Lobe lobe(double theta, float alpha, Rgb f0, int samples) {
    const Vec3 wo = direction(theta, 0);
    Lobe result{STUDENT(metal_sample)(wo, alpha, even_points(samples)), {}};
    const auto f = STUDENT(metal_eval)(wo, result.directions, alpha, f0);
    const auto pdf = STUDENT(metal_pdf)(wo, result.directions, alpha);
    for (std::size_t i = 0; i < std::min({result.directions.size(), f.size(), pdf.size()}); ++i)
        result.weights.push_back(pdf[i] > 0 ? f[i] * (result.directions[i].z / pdf[i]) : Rgb(0));
    return result;
}

} // namespace

LAB_ITEM(0, "the picture: gold, copper and silver, from smooth to rough") {
    constexpr int kSize = 128, kAngles = 64, kSamples = 600;
    const std::array<Rgb, 3> metals{Rgb(1.0f, 0.71f, 0.29f), Rgb(0.95f, 0.64f, 0.54f), Rgb(0.97f, 0.96f, 0.91f)};
    const std::array<float, 3> alphas{0.08f, 0.25f, 0.5f};
    ImageRgb image(3 * kSize, kSize, Rgb(0.015f));
    for (std::size_t sphere = 0; sphere < 3; ++sphere) {
        std::vector<Lobe> lobes;
        for (int i = 0; i < kAngles; ++i)
            lobes.push_back(lobe((i + 0.5) / kAngles * kPiDouble / 2, alphas[sphere], metals[sphere], kSamples));
        for (int y = 0; y < kSize; ++y)
            for (int x = 0; x < kSize; ++x) {
                const float nx = ((static_cast<float>(x) + 0.5f) / (kSize / 2) - 1) * 1.06f,
                            ny = (1 - (static_cast<float>(y) + 0.5f) / (kSize / 2)) * 1.06f;
                if (nx * nx + ny * ny > 0.9999f) continue;
                // The viewer is at infinity on +z. In the local frame of n, s points toward the viewer's side.
                const Vec3 n{nx, ny, std::sqrt(1 - nx * nx - ny * ny)};
                const Vec3 t = normalize(cross(n, Vec3{0, 0, 1})), s = cross(t, n);
                const Lobe& here = lobes[static_cast<std::size_t>(std::acos(n.z) / kPi * 2 * kAngles)];
                Rgb& pixel = image(static_cast<int>(sphere) * kSize + x, y) = Rgb(0);
                for (std::size_t i = 0; i < here.weights.size(); ++i) {
                    const Vec3 w = here.directions[i];
                    pixel += here.weights[i] * studio(s * w.x + t * w.y + n * w.z) * (1.0f / kSamples);
                }
            }
    }
    item.show("your metals", image);
}
