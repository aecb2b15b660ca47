// These tests compare robust arithmetic, frames, warps and film sums with exact integers, long double and double.
#include "common/sampling/warp.h"
#include "common/vec/frame.h"
#include "common/vec/robust.h"
#include "compare/stress/errors.h"
#include "compare/stress/trials.h"
#include "raytrace/film/film.h"

#include <array>
#include <bit>

namespace duet::compare {

namespace {

__extension__ typedef __int128 Int128; // ISO C++ has no name for it

// Differences of products --------------------------------------------------------------------------------------------

/// Returns four factors whose products are far apart, nearly equal, or nearly opposite.
std::array<float, 4> factors(Trial& trial) {
    TrialRandom& random = trial.random;
    const float a = random.sign() * random.log_uniform(1e-12f, 1e12f);
    const float b = random.sign() * random.log_uniform(1e-6f, 1e6f);
    if (trial.number() % 4 == 0)
        return {a, b, random.sign() * random.log_uniform(1e-12f, 1e12f), random.uniform(-1, 1)};
    const float near = random.log_uniform(1e-7f, 1e-2f);
    const float sign = trial.number() % 4 == 1 ? -1.0f : 1.0f;
    return {a, b, sign * b * (1 + near * random.uniform(-1, 1)), a * (1 + near * random.uniform(-1, 1))};
}

void difference_float(Trial& trial) {
    const auto [a, b, c, d] = factors(trial);
    // Products of floats are exact in double, and their difference is nearly exact.
    const double exact_value =
        static_cast<double>(a) * static_cast<double>(b) - static_cast<double>(c) * static_cast<double>(d);
    trial.note("a, b, c, d = ", exact(a), ", ", exact(b), ", ", exact(c), ", ", exact(d));
    trial.record(ulps(difference_of_products(a, b, c, d), exact_value));
    trial.record_naive(ulps(a * b - c * d, exact_value));
}

/// Returns the error of a double, in ulp of an exact integer of up to 107 bits.
double ulps_of_integer(double value, Int128 whole) {
    const Int128 off = static_cast<Int128>(value) - whole; // both are integers: exact
    Int128 size = whole < 0 ? -whole : whole;
    int bits = 0;
    for (; size > 0; size >>= 1) ++bits;
    return std::abs(static_cast<double>(off)) / std::ldexp(1.0, std::max(bits - 53, 0));
}

void difference_double(Trial& trial) {
    TrialRandom& random = trial.random;
    const auto integer = [&] { // of 1 to 53 bits, both signs
        const auto size = static_cast<std::int64_t>(random.bits() >> (11 + random.below(52)));
        return random.coin() ? size : -size;
    };
    const std::int64_t a = integer(), b = integer();
    std::int64_t c = integer(), d = integer();
    if (trial.number() % 4 != 0) { // nearly equal or opposite products
        const auto nearby = [&] { return static_cast<std::int64_t>(random.below(17)) - 8; };
        constexpr std::int64_t kLargest = std::int64_t{1} << 53;
        c = std::clamp((random.coin() ? a : -a) + nearby(), -kLargest, kLargest);
        d = std::clamp(b + nearby(), -kLargest, kLargest);
    }
    const Int128 whole = static_cast<Int128>(a) * b - static_cast<Int128>(c) * d;
    const auto [x, y, z, w] = std::array<double, 4>{static_cast<double>(a), static_cast<double>(b),
                                                    static_cast<double>(c), static_cast<double>(d)};
    trial.note("a, b, c, d = ", a, ", ", b, ", ", c, ", ", d);
    trial.record(ulps_of_integer(difference_of_products(x, y, z, w), whole));
    trial.record_naive(ulps_of_integer(x * y - z * w, whole));
}

// Directions ---------------------------------------------------------------------------------------------------------

void normalize_any_length(Trial& trial) {
    const Vec3 direction = trial.random.direction();
    const Vec3 v = direction * trial.random.log_uniform(1e-30f, 1e38f);
    const auto off = [&](Vec3 unit) { // error relative to the exact direction of the float vector v
        const Vec3d wide(v);
        return in_roundoffs(length(Vec3d(unit) - wide / length(wide)));
    };
    trial.note("v = ", exact(v));
    trial.record(off(normalize_scaled(v)));
    trial.record_naive(off(normalize(v)));
}

/// Returns a unit vector in a random direction, close to −z by a random order of magnitude, or on an axis with zeros
/// of both signs.
Vec3 normal_near_pole(Trial& trial) {
    TrialRandom& random = trial.random;
    const float zero = random.coin() ? 0.0f : -0.0f;
    switch (trial.number() % 4) {
    case 0:
        return normalize(random.direction());
    case 1: {
        Vec3 axis(zero, -zero, zero);
        axis[random.below(3)] = random.sign();
        return axis;
    }
    default:
        const float close = random.log_uniform(1e-12f, 1e-1f);
        return normalize(Vec3(close * random.uniform(-1, 1), close * random.uniform(-1, 1), -1));
    }
}

/// Returns the deviation of s, t and n from right angles, unit length and right-handedness. The deviation is that of s
/// and t; n is assumed to be exact.
double frame_error(const Frame& frame) {
    const Vec3d s(frame.s), t(frame.t), n(frame.n);
    double worst = length(cross(s, t) - n);
    for (const double off : {length(s) - 1, length(t) - 1, dot(s, t), dot(s, n), dot(t, n)})
        worst = larger_error(std::abs(off), worst);
    return in_roundoffs(worst);
}

/// Returns the frame as first published: 1/(1 + n.z) cancels near −z, except exactly at the pole (Frisvad 2012; Duff et
/// al. 2017, listing 1).
Frame frisvad_frame(Vec3 n) {
    if (n.z < -0.9999999f) return {{0, -1, 0}, {-1, 0, 0}, n};
    const float a = 1 / (1 + n.z), b = -n.x * n.y * a;
    return {{1 - n.x * n.x * a, b, -n.x}, {b, 1 - n.y * n.y * a, -n.y}, n};
}

void frames(Trial& trial) {
    const Vec3 n = normal_near_pole(trial);
    trial.note("n = ", exact(n));
    trial.record(frame_error(frame_from_normal(n)));
    trial.record_naive(frame_error(frisvad_frame(n)));
}

void frame_round_trip(Trial& trial) {
    const Vec3 n = normal_near_pole(trial), w = trial.random.direction();
    const auto off = [&](const Frame& frame) {
        return in_roundoffs(length(Vec3d(frame.to_world(frame.to_local(w))) - Vec3d(w)));
    };
    trial.note("n = ", exact(n), ", w = ", exact(w));
    trial.record(off(frame_from_normal(n)));
    trial.record_naive(off(frisvad_frame(n)));
}

// Random numbers and warps -------------------------------------------------------------------------------------------

/// Returns 32 random bits; every second trial has a value among the largest.
std::uint32_t extreme_bits(Trial& trial) {
    const std::uint32_t bits = high_bits(trial.random.bits());
    return trial.number() % 2 ? 0xffffffffu - (bits >> 22) : bits;
}

void unit_numbers(Trial& trial) {
    const std::uint32_t bits = extreme_bits(trial);
    const auto wrong = [](float x) { return !(x >= 0 && x < 1); };
    trial.note("bits = ", bits);
    trial.record_failure_if(wrong(unit_float(bits)));
    trial.record_naive_failure_if(wrong(static_cast<float>(bits) * 0x1p-32f));
}

void hemisphere_rim(Trial& trial) {
    Vec2 u{unit_float(extreme_bits(trial)), trial.random.uniform()};
    if (trial.random.coin()) u.x = kOneMinusEpsilon - u.x; // the other end of the interval
    if (trial.random.coin()) std::swap(u.x, u.y);
    const auto error = [](Vec3 w) { // a direction at or below the horizon has density 0 or is on the wrong side
        return w.z > 0 ? in_roundoffs(length(Vec3d(w)) - 1) : std::numeric_limits<double>::infinity();
    };
    const Vec2 disk = concentric_disk(u);
    trial.note("u = (", exact(u.x), ", ", exact(u.y), ")");
    trial.record(error(cosine_hemisphere(u)));
    trial.record_naive(error({disk.x, disk.y, safe_sqrt(1 - disk.x * disk.x - disk.y * disk.y)}));
}

// Film ---------------------------------------------------------------------------------------------------------------

void film_equal_samples(Trial& trial) {
    constexpr int kSamples = 10'000'000;
    const float value = trial.random.log_uniform(1e-6f, 1e6f);
    Film film(1, 1);
    float sum = 0;
    for (int i = 0; i < kSamples; ++i) {
        film.add(0, 0, static_cast<std::size_t>(i % 2), Rgb(value));
        sum += value;
    }
    trial.note("value = ", exact(value));
    trial.record(relative_error(film.mean(0, 0).r, static_cast<double>(value)));
    trial.record_naive(
        relative_error(static_cast<double>(sum / static_cast<float>(kSamples)), static_cast<double>(value)));
}

void film_bad_samples(Trial& trial) {
    TrialRandom& random = trial.random;
    constexpr std::array<float, 4> kBad{std::numeric_limits<float>::quiet_NaN(), kInfinity, -kInfinity, -1.0f};
    Film film(1, 1);
    double sum = 0;
    float naive_sum = 0;
    std::uint32_t good = 0, bad = 0;
    for (std::size_t i = 0; i < 64; ++i) {
        Rgb sample(random.uniform());
        const bool spoil = random.below(8) == 0;
        if (spoil) sample[random.below(3)] = kBad[random.below(4)];
        film.add(0, 0, 0, sample);
        naive_sum += sample.g;
        if (!spoil) sum += static_cast<double>(sample.g);
        ++(spoil ? bad : good);
    }
    const double mean = sum / good;
    trial.note(bad, " bad samples among ", good + bad);
    trial.record_failure_if(film.mean(0, 0).g != mean || film.samples(0, 0) != good || film.invalid(0, 0) != bad);
    trial.record_naive_failure_if(!(std::abs(static_cast<double>(naive_sum) / (good + bad) - mean) < 1e-3));
}

constexpr std::string_view kFourRoundings =
    "4 roundings of terms of at most 1 in an entry, and n's own length (Duff et al. 2017, §3)";

constexpr StressTest kTests[] = {
    {"arithmetic/difference-of-products", "a·b − c·d of floats: products far apart, nearly equal, nearly opposite", 1.5,
     "ulp", "Jeannerod, Louvet and Muller 2013, theorem 1.2; judged by double", "a * b - c * d", 500'000,
     trials_of<difference_float>},
    {"arithmetic/difference-of-products-double", "the same of doubles that hold integers of up to 53 bits", 1.5, "ulp",
     "Jeannerod, Louvet and Muller 2013, theorem 1.2; judged by 128-bit integers", "a * b - c * d", 500'000,
     trials_of<difference_double>},
    {"arithmetic/normalize", "a vector of length 1e-30 to 1e38 is normalized to its direction", 4, "2^-24",
     "quotient, square, two sums, root and quotient: 3.5 roundings at most along the length",
     "v / sqrt(v·v): squares vanish or overflow", 300'000, trials_of<normalize_any_length>},
    {"arithmetic/frames", "the frame about a normal is orthonormal and right-handed, also near and at −z", 8, "2^-24",
     kFourRoundings, "Frisvad 2012: 1/(1 + n.z)", 500'000, trials_of<frames>},
    {"arithmetic/frame-round-trip", "a direction taken into the frame and back is the same", 12, "2^-24",
     "the frame's own error, and three products and two sums each way", "Frisvad 2012: 1/(1 + n.z)", 300'000,
     trials_of<frame_round_trip>},
    {"arithmetic/unit-numbers", "32 random bits become a number in [0, 1), never 1", 0, "wrong",
     "an integer of 24 bits is a float; more are rounded", "float(bits) / 2^32", 1'000'000, trials_of<unit_numbers>},
    {"arithmetic/hemisphere-rim", "cosine-distributed directions have unit length and lie above the horizon", 4,
     "2^-24", "r, cos, sin, their products and the root: 4 roundings", "z = sqrt(max(0, 1 - x² - y²))", 1'000'000,
     trials_of<hemisphere_rim>},
    {"arithmetic/film-equal-samples", "ten million equal samples have that value as their mean", 0, "relative",
     "exact: 24 + 24 bits fit a double's 53", "a sum in float", 8, trials_of<film_equal_samples>},
    {"arithmetic/film-bad-samples", "NaN, infinite and negative samples are left out of the mean and counted", 0,
     "wrong", "exact: the sum of the others in the same order", "all are added", 100'000, trials_of<film_bad_samples>},
};

} // namespace

std::span<const StressTest> arithmetic_tests() { return kTests; }

} // namespace duet::compare
