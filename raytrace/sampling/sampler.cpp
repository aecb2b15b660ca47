#include "raytrace/sampling/sampler.h"

#include "common/sampling/hash.h"
#include "common/sampling/sobol.h"
#include "common/system/name_table.h"
#include "common/vec/simd.h"

#include <algorithm>
#include <array>
#include <bit>

namespace duet {

namespace {

constexpr NameTable<SamplerKind, 5> kNames{"sampler",
                                           {{{"sobol", SamplerKind::kSobol},
                                             {"blue-noise", SamplerKind::kBlueNoise},
                                             {"stratified", SamplerKind::kStratified},
                                             {"independent", SamplerKind::kIndependent},
                                             {"center", SamplerKind::kCenter}}}};

/// Returns (numerator + fraction) / denominator, clamped below 1 because rounding can reach 1.
float stratum(std::uint32_t numerator, double fraction, std::uint32_t denominator) {
    return std::min(static_cast<float>((numerator + fraction) / denominator), kOneMinusEpsilon);
}

// The following functions pad dimensions (Kollig and Keller 2002): each pair of dimensions uses the points of the
// two-dimensional Sobol sequence with its own scrambling and its own order. The order is an Owen scrambling of the
// index, which maps each aligned block of 2^k indices to an aligned block. The first 2^k samples of each pair are
// therefore a net (Burley 2020, §5). U is std::uint32_t, or a SIMD batch for several dimensions or samplers at once.

/// Returns the seed for the shuffling of a dimension from the 64 bits of the pixel's hash. The seed is well mixed.
template <typename U> U dimension_seed(U pixel_low, U pixel_high, U dimension) {
    return mix_bits_32(mix_bits_32(dimension * U(kGoldenGamma32) + pixel_low) ^ pixel_high);
}
/// Returns the seed for the scrambling of the first (0) or second (1) coordinate of a pair of dimensions.
template <typename U> U scramble_seed(U seed, U coordinate) {
    return mix_bits_32(seed + (coordinate + U(1u)) * U(kGoldenGamma32));
}
/// Returns the index of the Sobol point that a sample uses for a pair of dimensions. Its digits are reversed (see
/// sobol.h).
template <typename U> U sobol_point(U reversed_index, U seed) {
    return reverse_bits(owen_scramble(reversed_index, seed));
}

template <typename U> Vec2T<U> sobol_2d_digits(U reversed_index, U seed) {
    const U point = sobol_point(reversed_index, seed);
    return {reverse_bits(owen_scramble(point, scramble_seed(seed, U(0u)))),
            reverse_bits(owen_scramble(sobol_second(point), scramble_seed(seed, U(1u))))};
}
Vec2 sobol_2d(std::uint32_t reversed_index, std::uint32_t seed) {
    const Vec2T<std::uint32_t> digits = sobol_2d_digits(reversed_index, seed);
    return {unit_float(digits.x), unit_float(digits.y)};
}

template <std::size_t kLanes> using UintBatch = xsimd::make_sized_batch_t<std::uint32_t, kLanes>;

/// Computes a block of four Sobol pairs from dimension `first` on, one coordinate in each lane.
Sampler::Block sobol_block(std::uint32_t reversed_index, std::uint64_t pixel, std::uint32_t first) {
    using Batch = UintBatch<kSimdLanes>;
    alignas(Batch) constexpr std::array<std::uint32_t, Sampler::kBlock> kPairs{0, 0, 2, 2, 4, 4, 6, 6},
        kCoordinates{0, 1, 0, 1, 0, 1, 0, 1};
    alignas(Batch) std::array<std::uint32_t, Sampler::kBlock> bits;
    for (std::size_t lane = 0; lane < Sampler::kBlock; lane += kSimdLanes) {
        const Batch coordinate = Batch::load_aligned(&kCoordinates[lane]);
        const Batch dimension = Batch::load_aligned(&kPairs[lane]) + Batch(first);
        const Batch seed = dimension_seed(Batch(low_bits(pixel)), Batch(high_bits(pixel)), dimension);
        const Batch point = sobol_point(Batch(reversed_index), seed);
        const Batch digits = xsimd::select(coordinate == Batch(0u), point, sobol_second(point));
        reverse_bits(owen_scramble(digits, scramble_seed(seed, coordinate))).store_aligned(&bits[lane]);
    }
    Sampler::Block samples;
    for (std::size_t i = 0; i < Sampler::kBlock; ++i) samples[i] = unit_float(bits[i]);
    return samples;
}

/// Moves the lower 16 bits to the even bit positions.
constexpr std::uint32_t spread_bits(std::uint32_t x) {
    x &= 0xffffu;
    x = (x | x << 8) & 0x00ff00ffu;
    x = (x | x << 4) & 0x0f0f0f0fu;
    x = (x | x << 2) & 0x33333333u;
    return (x | x << 1) & 0x55555555u;
}

/// Returns a correlated multi-jittered point for any `count` (Kensler 2013, §5). Each of the `count` rows contains one
/// point. Each of the columns × rows_of_cells cells of the coarse grid contains one point; the last row of cells may
/// be incomplete. No two points share a fine column.
Vec2 stratified_2d(std::uint32_t index, std::uint32_t count, std::uint64_t key) {
    const std::uint32_t round = index / count; // each further `count` samples use a new set of points
    key = stream_number(key, round);
    const auto columns = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(count)));
    const std::uint32_t rows_of_cells = (count + columns - 1) / columns;
    const std::uint32_t s = permute(index % count, count, key);
    const std::uint32_t column = permute(s % columns, columns, mix_bits(key + 1));
    const std::uint32_t row = permute(s / columns, rows_of_cells, mix_bits(key + 2));
    const std::uint64_t jitter = stream_number(key, s);
    const double fine = (row + static_cast<double>(unit_float(high_bits(jitter)))) / rows_of_cells;
    return {stratum(column, fine, columns), stratum(s, unit_float(low_bits(jitter)), count)};
}

} // namespace

SamplerKind sampler_kind(std::string_view name) { return kNames.value(name); }

std::string_view sampler_name(SamplerKind kind) { return kNames.name(kind); }

bool needs_sample_count(SamplerKind kind) {
    return kind == SamplerKind::kStratified || kind == SamplerKind::kBlueNoise;
}

Sampler::Sampler(SamplerKind kind, std::uint64_t seed, int samples_per_pixel, std::uint32_t replicates)
    : kind_(kind), seed_(mix_bits(seed + kGoldenGamma)),
      samples_per_replicate_((static_cast<std::uint32_t>(std::max(samples_per_pixel, 1)) + replicates - 1) /
                             replicates),
      replicates_(replicates) {
    DUET_CHECK(replicates == 1 || replicates == 2);
}

void Sampler::start(std::span<Sampler> samplers, int pixel_x, int pixel_y, std::uint32_t index) {
    if (samplers.empty()) return;
    const std::uint64_t pixel =
        (static_cast<std::uint64_t>(static_cast<std::uint32_t>(pixel_y)) << 32) | static_cast<std::uint32_t>(pixel_x);
    const std::uint64_t hash = hash_combine(samplers[0].seed_, pixel);
    const std::array<std::uint64_t, 2> hashes{hash_combine(hash, 0), hash_combine(hash, 1)}; // one per replicate
    for (Sampler& s : samplers) {
        s.sample_ = index++;
        s.replicate_ = s.sample_ & (s.replicates_ - 1); // sample_ % replicates_, since replicates_ is 1 or 2
        s.index_ = s.sample_ >> (s.replicates_ - 1);
        s.dimension_ = 0;
        s.pixel_hash_ = hashes[s.replicate_];
        if (s.kind_ == SamplerKind::kBlueNoise)
            s.share_sequence(static_cast<std::uint32_t>(pixel_x), static_cast<std::uint32_t>(pixel_y));
        s.reversed_index_ = reverse_bits(s.index_);
    }
}

// Pixels along a Z-curve use consecutive blocks of one sequence (Ahmed and Wonka 2020, "Screen-Space Blue-Noise
// Diffusion of Monte Carlo Sampling Error via Hierarchical Ordering of Pixels", §4). The samples of 4, 16, 64, …
// neighboring pixels are therefore nets, too. The errors of neighbors cancel, and the remaining noise has little energy
// at the low frequencies, which are the most visible. The scrambling of the index starts at its uppermost digits and
// thus shuffles the four quarters of each square of pixels. A sequence has only 2³² points, so the image is divided
// into tiles with one sequence each.
void Sampler::share_sequence(std::uint32_t pixel_x, std::uint32_t pixel_y) {
    const int digits = static_cast<int>(std::bit_width(samples_per_replicate_ - 1)); // bits of a sample index
    const int side = std::max((32 - digits) / 2 - 1, 0); // a tile has 2^side × 2^side pixels
    const std::uint32_t mask = (1u << side) - 1;
    const std::uint32_t curve = spread_bits(pixel_x & mask) | spread_bits(pixel_y & mask) << 1;
    const std::uint64_t tile = (static_cast<std::uint64_t>(pixel_y >> side) << 32) | (pixel_x >> side);
    pixel_hash_ = hash_combine(hash_combine(seed_, tile), replicate_);
    const std::uint32_t round = index_ >> digits; // each further 2^digits samples use a new sequence
    if (round > 0) pixel_hash_ = hash_combine(pixel_hash_, round);
    index_ = (curve << digits) | (index_ & ((1u << digits) - 1));
}

Vec2 Sampler::get_2d() {
    const std::uint32_t dimension = dimension_;
    dimension_ += 2;
    if (is_sobol())
        return sobol_2d(reversed_index_, dimension_seed(low_bits(pixel_hash_), high_bits(pixel_hash_), dimension));
    const std::uint64_t key = stream_number(pixel_hash_, dimension);
    if (kind_ == SamplerKind::kStratified) return stratified_2d(index_, samples_per_replicate_, key);
    const std::uint64_t bits = stream_number(key, index_);
    return {unit_float(high_bits(bits)), unit_float(low_bits(bits))};
}

Sampler::Block Sampler::get_block() {
    std::array<float, kBlock> samples;
    if (is_sobol()) {
        samples = sobol_block(reversed_index_, pixel_hash_, dimension_);
        dimension_ += kBlock;
        return samples;
    }
    for (std::size_t i = 0; i < kBlock; i += 2) {
        const Vec2 pair = get_2d();
        samples[i] = pair.x;
        samples[i + 1] = pair.y;
    }
    return samples;
}

// Implements both overloads of get_2d_batch(). at(k) returns the k-th of `size` samplers.
template <typename At>
void Sampler::get_2d_batch_of(const At& at, std::size_t size, std::span<const std::uint32_t> dimensions,
                              std::span<Vec2> samples) {
    DUET_CHECK_EQ(samples.size(), size * dimensions.size());
    if (samples.empty()) return;
    if (!at(0).is_sobol()) {
        for (std::size_t d = 0; d < dimensions.size(); ++d)
            for (std::size_t k = 0; k < size; ++k) {
                Sampler sampler = at(k);
                sampler.set_dimension(dimensions[d]);
                samples[d * size + k] = sampler.get_2d();
            }
        return;
    }
    constexpr std::size_t kLanes = kMaxSimdLanes;
    using Batch = UintBatch<kLanes>;
    for (std::size_t done = 0; done < size; done += kLanes) {
        const std::size_t batch = std::min(size - done, kLanes);
        alignas(Batch) std::array<std::uint32_t, kLanes> index, low, high, x, y;
        for (std::size_t i = 0; i < kLanes; ++i) { // excess lanes repeat the first one
            const Sampler& s = at(done + (i < batch ? i : 0));
            index[i] = s.reversed_index_, low[i] = low_bits(s.pixel_hash_), high[i] = high_bits(s.pixel_hash_);
        }
        const auto load = [](const auto& lanes) { return Batch::load_aligned(lanes.data()); };
        const Batch indices = load(index), lows = load(low), highs = load(high);
        for (std::size_t d = 0; d < dimensions.size(); ++d) {
            const Vec2T<Batch> digits = sobol_2d_digits(indices, dimension_seed(lows, highs, Batch(dimensions[d])));
            digits.x.store_aligned(x.data());
            digits.y.store_aligned(y.data());
            Vec2* to = &samples[d * size + done];
            for (std::size_t i = 0; i < batch; ++i) to[i] = {unit_float(x[i]), unit_float(y[i])};
        }
    }
}

void Sampler::get_2d_batch(std::span<const Sampler> samplers, std::span<const std::uint32_t> dimensions,
                           std::span<Vec2> samples) {
    get_2d_batch_of([&](std::size_t k) -> const Sampler& { return samplers[k]; }, samplers.size(), dimensions, samples);
}

void Sampler::get_2d_batch(std::span<const Sampler> samplers, std::span<const std::uint32_t> subset,
                           std::span<const std::uint32_t> dimensions, std::span<Vec2> samples) {
    get_2d_batch_of([&](std::size_t k) -> const Sampler& { return samplers[subset[k]]; }, subset.size(), dimensions,
                    samples);
}

CameraRaySample Sampler::camera_ray_samples(CameraNeeds needs) const {
    CameraRaySample samples;
    camera_ray_samples({this, 1}, needs, {&samples, 1});
    return samples;
}

void Sampler::camera_ray_samples(std::span<const Sampler> samplers, CameraNeeds needs,
                                 std::span<CameraRaySample> samples) {
    std::fill(samples.begin(), samples.end(), CameraRaySample());
    if (samplers.empty() || samplers[0].kind_ == SamplerKind::kCenter) return;
    constexpr std::size_t kBatchSize = 64;
    std::array<Vec2, kBatchSize> drawn;
    for (std::size_t done = 0; done < samplers.size(); done += kBatchSize) {
        const auto batch = samplers.subspan(done, std::min(kBatchSize, samplers.size() - done));
        const auto draw = [&](std::uint32_t dimension, const auto& set) {
            get_2d_batch(batch, {&dimension, 1}, std::span(drawn).first(batch.size()));
            for (std::size_t i = 0; i < batch.size(); ++i) set(samples[done + i], drawn[i]);
        };
        draw(0, [](CameraRaySample& u, Vec2 pair) { u.pixel = pair; });
        if (needs.lens) draw(2, [](CameraRaySample& u, Vec2 pair) { u.lens = pair; });
        if (needs.time) draw(4, [](CameraRaySample& u, Vec2 pair) { u.time = pair.x; });
    }
}

} // namespace duet
