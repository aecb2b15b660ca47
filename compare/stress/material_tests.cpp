// These tests check the laws that every material obeys, and refraction against double.
#include "common/material/fresnel.h"
#include "common/material/material.h"
#include "common/sampling/warp.h"
#include "compare/stress/chi_squared.h"
#include "compare/stress/errors.h"
#include "compare/stress/log_p_value.h"
#include "compare/stress/trials.h"

#include <algorithm>
#include <array>

namespace duet::compare {

namespace {

constexpr double kWrong = std::numeric_limits<double>::infinity();

Vec3 direction_of(float z, float phi) {
    const float r = std::sqrt((1 - z) * (1 + z));
    return {r * std::cos(phi), r * std::sin(phi), z};
}

/// Returns a direction on either side; every second one is grazing by a random order of magnitude.
Vec3 outgoing(TrialRandom& random) {
    const float z = random.coin() ? random.uniform(1e-3f, 1) : random.log_uniform(1e-7f, 1e-1f);
    return direction_of(random.sign() * z, 2 * kPi * random.uniform());
}

// Dielectrics --------------------------------------------------------------------------------------------------------

struct Crossing {
    float eta; ///< index of refraction inside over outside
    Vec3 wo;
    float relative; ///< index beyond the boundary over that on wo's side
};

/// Returns a crossing at a random or grazing angle or, from inside, close to the critical angle by a random order of
/// magnitude, on either side of it.
Crossing crossing(TrialRandom& random) {
    const float eta = random.coin() ? random.uniform(1, 4) : 1 + random.log_uniform(1e-6f, 1);
    Vec3 wo = outgoing(random);
    if (random.coin() && eta > 1) {
        const float cosine = std::sqrt((eta - 1) * (eta + 1)) / eta; // sin = 1/η
        const float off = cosine * (1 + random.sign() * random.log_uniform(1e-7f, 1e-1f));
        wo = direction_of(-min(off, 1.0f), 2 * kPi * random.uniform());
    }
    return {eta, wo, wo.z > 0 ? eta : 1 / eta};
}

void critical_angle(Trial& trial) {
    const Crossing c = crossing(trial.random);
    const float cosine = abs_cos_theta(c.wo);
    const double z = static_cast<double>(cosine), eta = static_cast<double>(c.relative), eta2 = eta * eta;
    const double truth = ((eta - 1) * (eta + 1) + z * z) / eta2;
    const double size = (std::abs((eta - 1) * (eta + 1)) + z * z) / eta2; // size of the terms, without cancellation
    const auto error = [&](float cos2) { return in_roundoffs((static_cast<double>(cos2) - truth) / size); };
    trial.note("cos = ", exact(cosine), ", η = ", exact(c.relative));
    trial.record(error(cos2_refracted(cosine, c.relative)));
    trial.record_naive(error(1 - (1 - cosine * cosine) / (c.relative * c.relative)));
}

/// Returns Fresnel's reflectance in double, from both cosines.
double reflectance_of(double cos_i, double cos_t, double eta) {
    const double parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    const double perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    return (parallel * parallel + perpendicular * perpendicular) / 2;
}

/// Returns the distance of a reflectance from the range given by Fresnel's equations in double, for refracted cosines
/// within the bound of the critical-angle test. Near the critical angle reflectances are that sensitive.
double fresnel_error(float reflectance, float cosine, float eta) {
    const double z = static_cast<double>(cosine), n = static_cast<double>(eta), n2 = n * n;
    const double term = (n - 1) * (n + 1) / n2, u = static_cast<double>(kRoundoff<float>);
    const double slack = 5 * u * (std::abs(term) + z * z / n2);
    double low = 2, high = -1;
    for (const double off : {-slack, 0.0, slack}) {
        const double cos2 = term + z * z / n2 + off, r = n == 1 ? 0 : reflectance_of(z, std::sqrt(max(0.0, cos2)), n);
        low = std::min(low, r);
        high = std::max(high, r);
    }
    const double r = static_cast<double>(reflectance);
    if (!(r >= 0 && r <= 1)) return kWrong;
    return in_roundoffs(std::max({0.0, low - r, r - high}));
}

/// Returns Fresnel's reflectance by the textbook form: sines from cosines, Snell's law, cosines from sines.
float textbook_fresnel(float cos_i, float eta) {
    const float sin_t = std::sqrt(std::max(0.0f, 1 - cos_i * cos_i)) / eta;
    if (sin_t >= 1) return 1;
    const float cos_t = std::sqrt(std::max(0.0f, 1 - sin_t * sin_t));
    const float parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    const float perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    return (parallel * parallel + perpendicular * perpendicular) / 2;
}

void fresnel(Trial& trial) {
    const Crossing c = crossing(trial.random);
    const float cosine = abs_cos_theta(c.wo);
    trial.note("cos = ", exact(cosine), ", η = ", exact(c.relative));
    trial.record(fresnel_error(fresnel_dielectric(cosine, c.relative), cosine, c.relative));
    trial.record_naive(fresnel_error(textbook_fresnel(cosine, c.relative), cosine, c.relative));
}

/// Returns the error relative to Snell's law in double for the same floats: tangential components and the squared
/// cosine.
double refraction_error(const Crossing& c, Vec3 wi) {
    const Vec3d wo = normalize(Vec3d(c.wo));
    const double eta = static_cast<double>(c.relative);
    const double cos2 = ((eta - 1) * (eta + 1) + wo.z * wo.z) / (eta * eta);
    const double z = static_cast<double>(wi.z);
    if (z * wo.z > 0) return kWrong;
    const double x = static_cast<double>(wi.x) + wo.x / eta, y = static_cast<double>(wi.y) + wo.y / eta;
    const double terms =
        std::max(1.0, 1 / (eta * eta)); // bounds the squared sine on wi's side, as wo's length is uncertain
    return in_roundoffs(larger_error(larger_error(std::abs(x), std::abs(y)), std::abs(z * z - cos2)) / terms);
}

/// Implements refract() of Ray Tracing in One Weekend, §11.2, with n on the side of wo.
Vec3 textbook_refract(Vec3 wo, float relative) {
    const Vec3 n(0, 0, wo.z > 0 ? 1.0f : -1.0f), uv = -wo;
    const float cos_theta = std::fmin(dot(-uv, n), 1.0f);
    const Vec3 across = (uv + n * cos_theta) * (1 / relative);
    return across - n * std::sqrt(std::fabs(1 - length_squared(across)));
}

void refraction(Trial& trial) {
    const Crossing c = crossing(trial.random);
    const DielectricBsdf glass{c.eta, Rgb(1.0f)};
    const auto s = glass.sample(c.wo, kOneMinusEpsilon, {}, TransportMode::kRadiance);
    trial.note("wo = ", exact(c.wo), ", η = ", exact(c.eta));
    if (!s) return trial.record(kWrong);
    // This is total internal reflection, possibly early by one rounding, or all but 2^-24 is reflected.
    if (!s->transmitted) {
        const double eta = static_cast<double>(c.relative), z = static_cast<double>(abs_cos_theta(c.wo));
        const double cos2 = std::max(0.0, ((eta - 1) * (eta + 1) + z * z) / (eta * eta));
        const double refracted = 1 - reflectance_of(z, std::sqrt(cos2), eta);
        return trial.record(in_roundoffs(std::min(cos2 / std::max(1.0, 1 / (eta * eta)), refracted)));
    }
    trial.record(refraction_error(c, s->wi));
    trial.record_naive(refraction_error(c, textbook_refract(c.wo, c.relative)));
}

void glass_energy(Trial& trial) {
    const Crossing c = crossing(trial.random);
    const DielectricBsdf glass{c.eta, Rgb(1.0f)};
    trial.note("wo = ", exact(c.wo), ", η = ", exact(c.eta));
    const auto first = glass.sample(c.wo, 0, {}, TransportMode::kImportance);
    const auto last = glass.sample(c.wo, kOneMinusEpsilon, {}, TransportMode::kImportance);
    if (!first || !last || !is_finite(first->wi) || !is_finite(last->wi)) return trial.record(kWrong);
    double sum = static_cast<double>(first->pdf);
    if (last->transmitted != first->transmitted) sum += static_cast<double>(last->pdf);
    for (const BsdfSample& s : {*first, *last})
        if (!(s.weight == Rgb(1.0f))) return trial.record(kWrong);
    trial.record(in_roundoffs(sum - 1));
    trial.record_naive(in_roundoffs(static_cast<double>(textbook_fresnel(abs_cos_theta(c.wo), c.relative)) +
                                    (1 - static_cast<double>(first->pdf)) - 1));
}

// All materials ------------------------------------------------------------------------------------------------------

struct Named {
    std::string_view name;
    Bsdf bsdf;
    bool lossless; ///< has an albedo of 1
};

const std::array<Named, 8>& rough_materials() {
    static const std::array<Named, 8> all{
        {{"diffuse", DiffuseBsdf{Rgb(1.0f)}, true},
         {"metal of alpha 1", MetalBsdf{Rgb(1.0f), 1.0f}, false},
         {"metal of alpha 0.3", MetalBsdf{Rgb(0.9f, 0.6f, 0.3f), 0.3f}, false},
         {"metal of alpha 0.05", MetalBsdf{Rgb(1.0f), 0.05f}, false},
         {"gold of alpha 0.3", MetalBsdf{*find_conductor("gold"), 0.3f}, false},
         {"clay", RoughDiffuseBsdf{Rgb(1.0f), 0.7f}, false},
         {"clear coat", LayeredBsdf({Rgb(0.9f, 0.6f, 0.3f), 0.5f, 0.04f, 0.7f, 0.8f, 0.6f}), false},
         {"metal of alpha 0.001", MetalBsdf{Rgb(0.5f), 0.001f}, false}}};
    return all;
}

const std::array<Named, 4>& specular_materials() {
    static const std::array<Named, 4> all{{{"mirror", MetalBsdf{Rgb(1.0f), 0}, true},
                                           {"glass", DielectricBsdf{1.5f, Rgb(1.0f)}, true},
                                           {"diamond", DielectricBsdf{2.4f, Rgb(1.0f)}, true},
                                           {"window", ThinDielectricBsdf{1.5f, Rgb(1.0f)}, true}}};
    return all;
}

const Named& any_material(TrialRandom& random) {
    constexpr std::uint32_t kRough = 8;
    const std::uint32_t i = random.below(kRough + 4);
    return i < kRough ? rough_materials()[i] : specular_materials()[i - kRough];
}

/// Returns the factor by which radiance scales across a boundary toward wo. L/n² is constant (Veach 1997, §5.2), so
/// the sample's weight scales in the same way. The factor is 1 for importance.
double radiance_spread(const Bsdf& bsdf, Vec3 wo, const BsdfSample& s, TransportMode mode) {
    const auto* glass = std::get_if<DielectricBsdf>(&bsdf);
    if (glass == nullptr || !s.transmitted || mode == TransportMode::kImportance) return 1;
    const double relative = static_cast<double>(wo.z > 0 ? glass->eta : 1 / glass->eta);
    return 1 / (relative * relative);
}

void furnace(Trial& trial) {
    TrialRandom& random = trial.random;
    const Named& m = any_material(random);
    const Vec3 wo = outgoing(random);
    const float lobe = random.uniform();
    const TransportMode mode = random.coin() ? TransportMode::kRadiance : TransportMode::kImportance;
    const auto s = sample(m.bsdf, wo, lobe, random.uniform_2d(), mode);
    trial.note(m.name, ", wo = ", exact(wo), mode == TransportMode::kRadiance ? ", radiance" : ", importance");
    if (!s) return trial.record(m.lossless ? kWrong : 0); // lost to a second bounce between microfacets
    const double largest =
        static_cast<double>(max(max(s->weight.r, s->weight.g), s->weight.b)) / radiance_spread(m.bsdf, wo, *s, mode);
    if (!is_finite(s->weight) || !is_finite(s->wi) || !(s->pdf > 0)) return trial.record(kWrong);
    if (!(min(min(s->weight.r, s->weight.g), s->weight.b) >= 0)) return trial.record(kWrong);
    if (m.lossless) return trial.record(in_roundoffs(largest - 1));
    // Where lobes share the samples, one may be sampled less often than its contribution requires; its weights
    // are still bounded.
    constexpr double kLargest = 10;
    trial.record(largest <= kLargest ? 0 : kWrong);
}

double unlike(Rgb a, Rgb b) {
    double worst = 0;
    for (std::size_t c = 0; c < 3; ++c) {
        worst = larger_error(relative_error(static_cast<double>(a[c]), static_cast<double>(b[c])), worst);
    }
    return in_roundoffs(worst);
}

void weights(Trial& trial) {
    TrialRandom& random = trial.random;
    const Named& m = rough_materials()[random.below(8)];
    const Vec3 wo = outgoing(random);
    const auto s = sample(m.bsdf, wo, random.uniform(), random.uniform_2d());
    if (!s) return;
    const float density = pdf(m.bsdf, wo, s->wi);
    trial.note(m.name, ", wo = ", exact(wo), ", wi = ", exact(s->wi), ", pdf = ", exact(density));
    if (!(density == s->pdf)) return trial.record(kWrong);
    trial.record(unlike(eval(m.bsdf, wo, s->wi) * (abs_cos_theta(s->wi) / density), s->weight));
}

void reciprocity(Trial& trial) {
    TrialRandom& random = trial.random;
    const Named& m = rough_materials()[random.below(8)];
    const Vec3 a = outgoing(random);
    Vec3 b = outgoing(random);
    if (random.coin()) // near the mirror direction, where narrow lobes lie
        b = normalize(Vec3(-a.x, -a.y, a.z) + random.direction() * random.log_uniform(1e-4f, 1e-1f));
    if (!same_hemisphere(a, b)) b.z = -b.z;
    const Rgb forth = eval(m.bsdf, a, b), back = eval(m.bsdf, b, a);
    const Rgb below = eval(m.bsdf, {a.x, a.y, -a.z}, {b.x, b.y, -b.z});
    trial.note(m.name, ", ", exact(a), " and ", exact(b));
    if (!is_finite(forth) || !(below == forth)) return trial.record(kWrong);
    trial.record(unlike(forth, back));
}

StressResult chi_squared_test(const StressTest& test, const StressSetting& setting) {
    constexpr std::array<float, 5> kCosines{1.0f, 0.6f, 0.1f, 1e-3f, -0.6f};
    return run_trials(test, setting, [&](Trial& trial) {
        const auto number = static_cast<std::size_t>(trial.number());
        const Named& m = rough_materials()[number % 7]; // without the narrowest lobe, which the cells do not resolve
        const Vec3 wo = direction_of(kCosines[number / 7 % 5], 2 * kPi * trial.random.uniform());
        const auto* metal = std::get_if<MetalBsdf>(&m.bsdf);
        DirectionTest cells; // cells narrow toward the mirror direction, where a narrow lobe lies
        if (!is_diffuse(m.bsdf))
            cells.axis = {-wo.x, -wo.y, wo.z}, cells.axis_power = metal != nullptr && metal->alpha < 0.1f ? 4 : 2;
        cells.samples = 50'000;
        cells.seed = trial.random.bits();
        cells.subdivisions = 12; // the density is discontinuous at the horizon, which intersects cells
        const DirectionResult result = test_directions(
            cells,
            [&](Vec2 u) -> std::optional<Vec3> {
                const auto s = sample(m.bsdf, wo, trial.random.uniform(), u);
                return s ? std::optional(s->wi) : std::nullopt;
            },
            [&](Vec3 wi) { return static_cast<double>(pdf(m.bsdf, wo, wi)); });
        trial.note(m.name, ", wo = ", exact(wo), ": ", result.chi_squared.details, ", integral ", result.integral);
        const bool complete = result.integral < 1.003 && result.integral > (is_diffuse(m.bsdf) ? 0.997 : 0.4);
        trial.record(complete ? family_log_p_value(result.chi_squared.p_value, trial.count()) : kWrong);
    });
}

/// Compares two estimates of a material's albedo: from its own samples and from uniform directions.
void albedo(Trial& trial) {
    TrialRandom& random = trial.random;
    const Named& m =
        rough_materials()[static_cast<std::size_t>(trial.number()) % 7]; // wide enough for uniform sampling
    const Vec3 wo = direction_of(random.sign() * random.uniform(0.2f, 1), 2 * kPi * random.uniform());
    constexpr int kSamples = 50'000;
    double own = 0, own2 = 0, uniform = 0, uniform2 = 0;
    for (int i = 0; i < kSamples; ++i) {
        const auto s = sample(m.bsdf, wo, random.uniform(), random.uniform_2d());
        const double a = s ? static_cast<double>(s->weight.r) : 0;
        const Vec3 wi = random.direction();
        const double b = static_cast<double>(eval(m.bsdf, wo, wi).r * abs_cos_theta(wi) / kUniformSpherePdf);
        own += a / kSamples, own2 += a * a / kSamples;
        uniform += b / kSamples, uniform2 += b * b / kSamples;
    }
    const double error = std::sqrt((own2 - own * own + uniform2 - uniform * uniform) / kSamples);
    trial.note(m.name, ", wo = ", exact(wo), ": ", own, " and ", uniform, " ± ", error);
    trial.record(family_log_p_value(two_sided_p((own - uniform) / error), trial.count()));
}

constexpr std::string_view kSidak = "odds of a false alarm 1e-6 for the row (Šidák 1967)";

constexpr StressTest kTests[] = {
    {"material/critical-angle", "the refracted cosine's square, near the critical angle too", 5, "2^-24 of its terms",
     "5 roundings; judged by double", "1 - sin²/η²", 1'000'000, trials_of<critical_angle>},
    {"material/fresnel", "the reflectance of dielectrics, grazing and near the critical angle too, is in [0, 1]", 8,
     "2^-24", "Born and Wolf 1999, §1.5.2 in double; cos² within the bound above", "sines from cosines", 500'000,
     trials_of<fresnel>},
    {"material/refraction", "Snell's law, grazing and near the critical angle too", 8, "2^-24 of its terms",
     "tangential parts and squared cosine; judged by double", "Ray Tracing in One Weekend, §11.2", 500'000,
     trials_of<refraction>},
    {"material/glass-energy", "reflection and refraction take all the light between them, each sample all of its share",
     1, "2^-24", "R + (1 - R) is rounded once", "sines from cosines", 500'000, trials_of<glass_energy>},
    {"material/furnace",
     "samples of lossless materials send on what they received; no weight of any other is beyond 10", 8, "2^-24",
     "8 roundings: F·G₂/G₁ at most 1 (Heitz 2014); radiance crosses a boundary as L/n² (Veach 1997)", "", 1'000'000,
     trials_of<furnace>},
    {"material/weights", "a sample's weight is f·|cos|/pdf, its density that of pdf()", 9.01, "2^-24",
     "9 roundings: 6 of f·|cos|/pdf, 3 of the weight; D, F and G1's terms are the same numbers in both", "", 500'000,
     trials_of<weights>, 0.95},
    {"material/reciprocity", "f(a, b) = f(b, a), the same from below", 0, "2^-24",
     "Helmholtz; every operation is symmetric", "", 500'000, trials_of<reciprocity>},
    {"material/chi-squared", "directions are distributed as pdf says: 7 materials, 5 angles, both sides", 6,
     "-log10 odds", kSidak, "", 35, chi_squared_test},
    {"material/albedo", "own and uniform directions estimate the same albedo", 6, "-log10 odds", kSidak, "", 40,
     trials_of<albedo>},
};

} // namespace

std::span<const StressTest> material_tests() { return kTests; }

} // namespace duet::compare
