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
    std::array<double, kMeasurementCount> n, k; ///< complex index of refraction n + ik at each wavelength
};

// The sources are Johnson and Christy 1972, "Optical Constants of the Noble Metals", Phys. Rev. B 6; Johnson and
// Christy 1974, "Optical constants of transition metals", Phys. Rev. B 9; Rakić 1995, Appl. Opt. 34, 4755; and Rakić,
// Djurišić, Elazar and Majewski 1998, Appl. Opt. 37, 5271. The figures come from refractiveindex.info's database.
constexpr MeasuredMetal kMetals[] = {
    {"aluminium", // Rakić 1995
     {0.441, 0.481, 0.521, 0.572, 0.636, 0.709, 0.798, 0.892, 1.009, 1.169, 1.350, 1.624, 1.958, 2.427, 2.749},
     {4.605, 4.803, 5.001, 5.215, 5.465, 5.712, 6.000, 6.291, 6.611, 6.988, 7.371, 7.800, 8.175, 8.435, 8.240}},
    {"chromium", // Johnson and Christy 1974
     {1.92, 2.00, 2.08, 2.19, 2.33, 2.51, 2.75, 2.94, 3.18, 3.22, 3.17, 3.09, 3.05, 3.08, 3.20},
     {2.74, 2.83, 2.93, 3.04, 3.14, 3.24, 3.30, 3.33, 3.33, 3.30, 3.30, 3.34, 3.39, 3.42, 3.48}},
    {"cobalt", // Johnson and Christy 1974
     {1.53, 1.57, 1.61, 1.67, 1.74, 1.81, 1.88, 1.97, 2.05, 2.13, 2.19, 2.25, 2.31, 2.40, 2.53},
     {2.82, 2.93, 3.05, 3.17, 3.28, 3.41, 3.55, 3.68, 3.82, 3.96, 4.11, 4.27, 4.45, 4.64, 4.88}},
    {"copper", // Johnson and Christy 1972
     {1.33, 1.32, 1.28, 1.25, 1.24, 1.25, 1.22, 1.18, 1.02, 0.70, 0.30, 0.22, 0.21, 0.24, 0.26},
     {2.045, 2.116, 2.207, 2.305, 2.397, 2.483, 2.564, 2.608, 2.577, 2.704, 3.205, 3.747, 4.205, 4.665, 5.180}},
    {"gold", // Johnson and Christy 1972
     {1.46, 1.47, 1.46, 1.45, 1.38, 1.31, 1.04, 0.62, 0.43, 0.29, 0.21, 0.14, 0.13, 0.14, 0.16},
     {1.933, 1.952, 1.958, 1.948, 1.914, 1.849, 1.833, 2.081, 2.455, 2.863, 3.272, 3.697, 4.103, 4.542, 5.083}},
    {"iron", // Johnson and Christy 1974
     {2.12, 2.24, 2.35, 2.48, 2.59, 2.67, 2.74, 2.86, 2.95, 2.94, 2.88, 2.92, 2.86, 2.87, 2.94},
     {2.50, 2.58, 2.65, 2.71, 2.77, 2.82, 2.88, 2.91, 2.93, 2.99, 3.05, 3.10, 3.19, 3.28, 3.39}},
    {"nickel", // Johnson and Christy 1974
     {1.72, 1.72, 1.70, 1.71, 1.73, 1.78, 1.82, 1.85, 1.92, 1.96, 1.99, 1.99, 2.06, 2.13, 2.26},
     {2.48, 2.57, 2.69, 2.82, 2.95, 3.09, 3.25, 3.42, 3.61, 3.80, 4.02, 4.26, 4.50, 4.73, 4.97}},
    {"palladium", // Johnson and Christy 1974
     {1.26, 1.30, 1.33, 1.37, 1.41, 1.46, 1.52, 1.57, 1.64, 1.68, 1.75, 1.80, 1.86, 1.95, 2.06},
     {2.83, 2.93, 3.03, 3.14, 3.26, 3.39, 3.54, 3.68, 3.84, 4.02, 4.21, 4.42, 4.65, 4.89, 5.19}},
    {"platinum", // Rakić et al. 1998, Lorentz-Drude
     {1.674, 1.717, 1.759, 1.803, 1.853, 1.902, 1.960, 2.019, 2.087, 2.175, 2.272, 2.399, 2.541, 2.708, 2.918},
     {2.740, 2.837, 2.931, 3.029, 3.145, 3.260, 3.398, 3.539, 3.696, 3.884, 4.076, 4.303, 4.531, 4.773, 5.054}},
    {"silver", // Johnson and Christy 1972
     {0.05, 0.05, 0.05, 0.04, 0.04, 0.05, 0.05, 0.05, 0.06, 0.05, 0.06, 0.05, 0.04, 0.03, 0.04},
     {1.864, 2.070, 2.275, 2.462, 2.657, 2.869, 3.093, 3.324, 3.586, 3.858, 4.152, 4.483, 4.838, 5.242, 5.727}},
    {"titanium", // Johnson and Christy 1974
     {1.99, 2.08, 2.14, 2.21, 2.27, 2.32, 2.36, 2.44, 2.54, 2.60, 2.67, 2.76, 2.86, 3.00, 3.21},
     {2.93, 2.95, 2.98, 3.01, 3.04, 3.10, 3.19, 3.30, 3.43, 3.58, 3.72, 3.84, 3.96, 4.01, 4.01}},
    {"tungsten", // Rakić et al. 1998, Lorentz-Drude
     {3.268, 3.310, 3.339, 3.358, 3.370, 3.376, 3.386, 3.408, 3.453, 3.535, 3.634, 3.735, 3.776, 3.723, 3.541},
     {2.530, 2.521, 2.515, 2.515, 2.527, 2.554, 2.606, 2.673, 2.753, 2.834, 2.881, 2.879, 2.832, 2.778, 2.791}},
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
    return fresnel_conductor(cosine, lerp(metal.n[i], metal.n[i + 1], f), lerp(metal.k[i], metal.k[i + 1], f));
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
