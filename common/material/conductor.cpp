#include "common/material/conductor.h"

#include "common/material/fresnel.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace duet {

namespace {

constexpr std::size_t kMeasurementCount = 15;
/// The wavelengths are in nanometers and follow from Johnson and Christy's photon energies between 3.25 and 1.51 eV.
/// Data from other sources are interpolated to these wavelengths.
constexpr std::array<double, kMeasurementCount> kWavelengths{381.5, 397.4, 413.3, 430.5, 450.9, 471.4, 495.9, 520.9,
                                                             548.6, 582.1, 616.8, 659.5, 704.5, 756.0, 821.1};
struct MeasuredMetal {
    std::string_view name;
    std::array<std::array<double, 2>, kMeasurementCount> nk;
};

// The sources are Johnson and Christy 1972, "Optical Constants of the Noble Metals", Phys. Rev. B 6; Johnson and
// Christy 1974, "Optical constants of transition metals", Phys. Rev. B 9; Rakić 1995, Appl. Opt. 34, 4755; and Rakić,
// Djurišić, Elazar and Majewski 1998, Appl. Opt. 37, 5271. The figures come from refractiveindex.info's database.
constexpr MeasuredMetal kMetals[] = {
    {"aluminium", // Rakić 1995
     {{{0.441, 4.605},
       {0.481, 4.803},
       {0.521, 5.001},
       {0.572, 5.215},
       {0.636, 5.465},
       {0.709, 5.712},
       {0.798, 6.000},
       {0.892, 6.291},
       {1.009, 6.611},
       {1.169, 6.988},
       {1.350, 7.371},
       {1.624, 7.800},
       {1.958, 8.175},
       {2.427, 8.435},
       {2.749, 8.240}}}},
    {"chromium", // Johnson and Christy 1974
     {{{1.92, 2.74},
       {2.00, 2.83},
       {2.08, 2.93},
       {2.19, 3.04},
       {2.33, 3.14},
       {2.51, 3.24},
       {2.75, 3.30},
       {2.94, 3.33},
       {3.18, 3.33},
       {3.22, 3.30},
       {3.17, 3.30},
       {3.09, 3.34},
       {3.05, 3.39},
       {3.08, 3.42},
       {3.20, 3.48}}}},
    {"cobalt", // Johnson and Christy 1974
     {{{1.53, 2.82},
       {1.57, 2.93},
       {1.61, 3.05},
       {1.67, 3.17},
       {1.74, 3.28},
       {1.81, 3.41},
       {1.88, 3.55},
       {1.97, 3.68},
       {2.05, 3.82},
       {2.13, 3.96},
       {2.19, 4.11},
       {2.25, 4.27},
       {2.31, 4.45},
       {2.40, 4.64},
       {2.53, 4.88}}}},
    {"copper", // Johnson and Christy 1972
     {{{1.33, 2.045},
       {1.32, 2.116},
       {1.28, 2.207},
       {1.25, 2.305},
       {1.24, 2.397},
       {1.25, 2.483},
       {1.22, 2.564},
       {1.18, 2.608},
       {1.02, 2.577},
       {0.70, 2.704},
       {0.30, 3.205},
       {0.22, 3.747},
       {0.21, 4.205},
       {0.24, 4.665},
       {0.26, 5.180}}}},
    {"gold", // Johnson and Christy 1972
     {{{1.46, 1.933},
       {1.47, 1.952},
       {1.46, 1.958},
       {1.45, 1.948},
       {1.38, 1.914},
       {1.31, 1.849},
       {1.04, 1.833},
       {0.62, 2.081},
       {0.43, 2.455},
       {0.29, 2.863},
       {0.21, 3.272},
       {0.14, 3.697},
       {0.13, 4.103},
       {0.14, 4.542},
       {0.16, 5.083}}}},
    {"iron", // Johnson and Christy 1974
     {{{2.12, 2.50},
       {2.24, 2.58},
       {2.35, 2.65},
       {2.48, 2.71},
       {2.59, 2.77},
       {2.67, 2.82},
       {2.74, 2.88},
       {2.86, 2.91},
       {2.95, 2.93},
       {2.94, 2.99},
       {2.88, 3.05},
       {2.92, 3.10},
       {2.86, 3.19},
       {2.87, 3.28},
       {2.94, 3.39}}}},
    {"nickel", // Johnson and Christy 1974
     {{{1.72, 2.48},
       {1.72, 2.57},
       {1.70, 2.69},
       {1.71, 2.82},
       {1.73, 2.95},
       {1.78, 3.09},
       {1.82, 3.25},
       {1.85, 3.42},
       {1.92, 3.61},
       {1.96, 3.80},
       {1.99, 4.02},
       {1.99, 4.26},
       {2.06, 4.50},
       {2.13, 4.73},
       {2.26, 4.97}}}},
    {"palladium", // Johnson and Christy 1974
     {{{1.26, 2.83},
       {1.30, 2.93},
       {1.33, 3.03},
       {1.37, 3.14},
       {1.41, 3.26},
       {1.46, 3.39},
       {1.52, 3.54},
       {1.57, 3.68},
       {1.64, 3.84},
       {1.68, 4.02},
       {1.75, 4.21},
       {1.80, 4.42},
       {1.86, 4.65},
       {1.95, 4.89},
       {2.06, 5.19}}}},
    {"platinum", // Rakić et al. 1998, Lorentz-Drude
     {{{1.674, 2.740},
       {1.717, 2.837},
       {1.759, 2.931},
       {1.803, 3.029},
       {1.853, 3.145},
       {1.902, 3.260},
       {1.960, 3.398},
       {2.019, 3.539},
       {2.087, 3.696},
       {2.175, 3.884},
       {2.272, 4.076},
       {2.399, 4.303},
       {2.541, 4.531},
       {2.708, 4.773},
       {2.918, 5.054}}}},
    {"silver", // Johnson and Christy 1972
     {{{0.05, 1.864},
       {0.05, 2.070},
       {0.05, 2.275},
       {0.04, 2.462},
       {0.04, 2.657},
       {0.05, 2.869},
       {0.05, 3.093},
       {0.05, 3.324},
       {0.06, 3.586},
       {0.05, 3.858},
       {0.06, 4.152},
       {0.05, 4.483},
       {0.04, 4.838},
       {0.03, 5.242},
       {0.04, 5.727}}}},
    {"titanium", // Johnson and Christy 1974
     {{{1.99, 2.93},
       {2.08, 2.95},
       {2.14, 2.98},
       {2.21, 3.01},
       {2.27, 3.04},
       {2.32, 3.10},
       {2.36, 3.19},
       {2.44, 3.30},
       {2.54, 3.43},
       {2.60, 3.58},
       {2.67, 3.72},
       {2.76, 3.84},
       {2.86, 3.96},
       {3.00, 4.01},
       {3.21, 4.01}}}},
    {"tungsten", // Rakić et al. 1998, Lorentz-Drude
     {{{3.268, 2.530},
       {3.310, 2.521},
       {3.339, 2.515},
       {3.358, 2.515},
       {3.370, 2.527},
       {3.376, 2.554},
       {3.386, 2.606},
       {3.408, 2.673},
       {3.453, 2.753},
       {3.535, 2.834},
       {3.634, 2.881},
       {3.735, 2.879},
       {3.776, 2.832},
       {3.723, 2.778},
       {3.541, 2.791}}}},
};

constexpr auto kNames = [] {
    std::array<std::string_view, std::size(kMetals)> names;
    for (std::size_t i = 0; i < names.size(); ++i) names[i] = kMetals[i].name;
    return names;
}();

/// This is the CIE standard illuminant D65 from 380 to 780 nm in steps of 10 nm (CIE 15:2004, table T.1).
constexpr double kD65[] = {49.98,  54.65,  82.75,  91.49,  93.43,  86.68,  104.86, 117.01, 117.81, 114.86, 115.92,
                           108.81, 109.35, 107.80, 104.79, 107.69, 104.41, 104.05, 100.00, 96.33,  95.79,  88.69,
                           90.01,  89.60,  87.70,  83.29,  83.70,  80.03,  80.21,  82.28,  78.28,  69.72,  71.61,
                           74.35,  61.60,  69.89,  75.09,  63.59,  46.42,  66.81,  63.38};
constexpr double kFirst = 385, kLast = 780, kStep = 5; // range and step of the spectral sums, in nanometers

double d65(double wavelength) {
    const double at = (wavelength - 380) / 10;
    const auto i = std::min(static_cast<std::size_t>(at), std::size(kD65) - 2);
    return lerp(kD65[i], kD65[i + 1], at - static_cast<double>(i));
}

/// Returns the CIE 1931 color-matching functions at a wavelength in nanometers, as linear Rec. 709 (Wyman, Sloan and
/// Shirley 2013, "Simple Analytic Approximations to the CIE XYZ Color Matching Functions", §2.2).
Rgbd color_matching(double w) {
    const auto gaussian = [w](double center, double below, double above) {
        return std::exp(-0.5 * sqr((w - center) / (w < center ? below : above)));
    };
    const double x =
        1.056 * gaussian(599.8, 37.9, 31.0) + 0.362 * gaussian(442.0, 16.0, 26.7) - 0.065 * gaussian(501.1, 20.4, 26.2);
    const double y = 0.821 * gaussian(568.8, 46.9, 40.5) + 0.286 * gaussian(530.9, 16.3, 31.1);
    const double z = 1.217 * gaussian(437.0, 11.8, 36.0) + 0.681 * gaussian(459.0, 26.0, 13.8);
    return {3.2404542 * x - 1.5371385 * y - 0.4985314 * z, -0.9692660 * x + 1.8760108 * y + 0.0415560 * z,
            0.0556434 * x - 0.2040259 * y + 1.0572252 * z};
}

double reflectance_at(const MeasuredMetal& metal, double wavelength, double cosine) {
    std::size_t i = 0;
    while (i + 2 < kMeasurementCount && kWavelengths[i + 1] < wavelength) ++i;
    const double f = (wavelength - kWavelengths[i]) / (kWavelengths[i + 1] - kWavelengths[i]);
    return fresnel_conductor(cosine, lerp(metal.nk[i][0], metal.nk[i + 1][0], f),
                             lerp(metal.nk[i][1], metal.nk[i + 1][1], f));
}

/// Returns the linear Rec. 709 color that the metal reflects under daylight, divided by the color of a white
/// reflector.
Rgbd spectral(const MeasuredMetal& metal, double cosine) {
    Rgbd reflected, white;
    for (double w = kFirst; w <= kLast; w += kStep) {
        const Rgbd response = color_matching(w) * d65(w);
        reflected += response * reflectance_at(metal, w, cosine);
        white += response;
    }
    return {reflected.r / white.r, reflected.g / white.g, reflected.b / white.b};
}

constexpr int kAngles = 24;
double cosine_of(int i) { return (i + 0.5) / kAngles; }

/// Returns the k for which the index n + ik has reflectance r at normal incidence: k² = (r
/// (n + 1)² − (n − 1)²)/(1 − r) (Gulbrandsen 2014, "Artist Friendly Metallic Fresnel", eq. 3).
double k_of(double r, double n) { return safe_sqrt((r * sqr(n + 1) - sqr(n - 1)) / (1 - r)); }

struct Index {
    double n, k;
};
/// Returns the index of reflectance r at normal incidence whose Fresnel curve is nearest to `curve`: the search
/// minimizes the squared difference, weighted by the cosine over the hemisphere.
Index nearest_index(double r, const std::array<double, kAngles>& curve) {
    const double low = (1 - r) / (1 + r), high = (1 + std::sqrt(r)) / (1 - std::sqrt(r));
    constexpr int kSteps = 500;
    Index best{low, 0};
    double least = 1e30;
    for (int step = 0; step <= kSteps; ++step) {
        const double n = low * std::pow(high / low, static_cast<double>(step) / kSteps), k = k_of(r, n);
        double sum = 0;
        for (int i = 0; i < kAngles; ++i)
            sum += sqr(fresnel_conductor(cosine_of(i), n, k) - curve[static_cast<std::size_t>(i)]) * cosine_of(i);
        if (sum < least) least = sum, best = {n, k};
    }
    return best;
}

const MeasuredMetal* find_metal(std::string_view name) {
    const auto* found =
        std::find_if(std::begin(kMetals), std::end(kMetals), [&](const MeasuredMetal& m) { return m.name == name; });
    return found == std::end(kMetals) ? nullptr : found;
}

} // namespace

std::span<const std::string_view> conductor_names() { return kNames; }

Rgbd spectral_reflectance(std::string_view name, double cosine) {
    const MeasuredMetal* metal = find_metal(name);
    return metal != nullptr ? spectral(*metal, cosine) : Rgbd();
}

std::optional<Conductor> find_conductor(std::string_view name) {
    const MeasuredMetal* metal = find_metal(name);
    if (metal == nullptr) return std::nullopt;
    std::array<Rgbd, kAngles> curves;
    for (int i = 0; i < kAngles; ++i) curves[static_cast<std::size_t>(i)] = spectral(*metal, cosine_of(i));
    const Rgbd f0 = spectral(*metal, 1);
    Conductor result;
    for (std::size_t c = 0; c < 3; ++c) {
        // The colors of saturated metals lie slightly outside the Rec. 709 gamut, so they are clamped.
        const double r = clamp(f0[c], 0.001, 0.9995);
        std::array<double, kAngles> curve;
        for (std::size_t i = 0; i < curve.size(); ++i) curve[i] = curves[i][c];
        const Index index = nearest_index(r, curve);
        double mean = 0;
        for (int i = 0; i < kAngles; ++i)
            mean += 2 * cosine_of(i) / kAngles * fresnel_conductor(cosine_of(i), index.n, index.k);
        result.n[c] = static_cast<float>(index.n);
        result.k[c] = static_cast<float>(index.k);
        result.f0[c] = static_cast<float>(r);
        result.average_fresnel[c] = static_cast<float>(mean);
    }
    return result;
}

} // namespace duet
