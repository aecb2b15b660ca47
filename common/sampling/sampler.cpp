#include "common/sampling/sampler.h"

#include "common/sampling/hash.h"
#include "common/sampling/sobol.h"
#include "common/system/error.h"
#include "common/vec/simd.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

namespace duet {

namespace {

constexpr std::array<std::pair<std::string_view, SamplerKind>, 5> kNames{{{"sobol", SamplerKind::kSobol},
                                                                          {"blue-noise", SamplerKind::kBlueNoise},
                                                                          {"stratified", SamplerKind::kStratified},
                                                                          {"independent", SamplerKind::kIndependent},
                                                                          {"center", SamplerKind::kCenter}}};

/// (numerator + fraction)/denominator, kept below 1 where rounding would reach it.
float stratum(std::uint32_t numerator, double fraction, std::uint32_t denominator) {
    return std::min(static_cast<float>((numerator + fraction) / denominator), kOneMinusEpsilon);
}

// Padding (Kollig and Keller 2002): the points of each pair of dimensions are those of the plane's Sobol sequence,
// scrambled anew and visited in an order of their own. Shuffling the index by an Owen scrambling keeps every aligned
// block of 2^k indices together, so that the first 2^k samples of each pair are a net (Burley 2020, §5). Everything is
// computed for one number or, U being a batch, for several dimensions at once.

/// The seed of a dimension's shuffling, well mixed, from the pixel's 64 bits.
template <typename U> U dimension_seed(U pixel_low, U pixel_high, U dimension) {
    return mix_bits_32(mix_bits_32(dimension * U(kGoldenStep32) + pixel_low) ^ pixel_high);
}
/// The seed of the scrambling of its first (0) or second (1) coordinate.
template <typename U> U scramble_seed(U seed, U coordinate) {
    return mix_bits_32(seed + (coordinate + U(1u)) * U(kGoldenStep32));
}
/// The point of a pair that the sample visits, its digits reversed.
template <typename U> U sobol_point(U reversed_index, U seed) {
    return reverse_bits(owen_scramble(reversed_index, seed));
}

float sobol_1d(std::uint32_t reversed_index, std::uint32_t seed) {
    const std::uint32_t point = sobol_point(reversed_index, seed);
    return unit_float(reverse_bits(owen_scramble(point, scramble_seed(seed, 0u))));
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

/// Pairs of dimensions from `first` on, a number a lane: of one sample of a pixel, or of two one after the other.
template <std::size_t kLanes> using WholeBatch = xsimd::make_sized_batch_t<std::uint32_t, kLanes>;
template <std::size_t kLanes>
WholeBatch<kLanes> sobol_lanes(std::size_t lane, WholeBatch<kLanes> reversed_index, WholeBatch<kLanes> pixel_low,
                               WholeBatch<kLanes> pixel_high, std::uint32_t first) {
    using Batch = WholeBatch<kLanes>;
    alignas(64) constexpr std::array<std::uint32_t, 16> kPairs{0, 0, 2, 2, 4, 4, 6, 6, 0, 0, 2, 2, 4, 4, 6, 6};
    alignas(64) constexpr std::array<std::uint32_t, 16> kCoordinates{0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1};
    const Batch coordinate = Batch::load_aligned(&kCoordinates[lane]);
    const Batch seed = dimension_seed(pixel_low, pixel_high, Batch::load_aligned(&kPairs[lane]) + Batch(first));
    const Batch point = sobol_point(reversed_index, seed);
    const Batch digits = xsimd::select(coordinate == Batch(0u), point, sobol_second(point));
    return reverse_bits(owen_scramble(digits, scramble_seed(seed, coordinate)));
}

Sampler::Block block_of(const std::uint32_t* bits) {
    Sampler::Block numbers;
    for (std::size_t i = 0; i < Sampler::kBlock; ++i) numbers[i] = unit_float(bits[i]);
    return numbers;
}

Sampler::Block sobol_block(std::uint32_t reversed_index, std::uint64_t pixel, std::uint32_t first) {
    using Batch = WholeBatch<kSimdLanes>;
    alignas(Batch) std::array<std::uint32_t, Sampler::kBlock> bits;
    for (std::size_t lane = 0; lane < Sampler::kBlock; lane += kSimdLanes)
        sobol_lanes<kSimdLanes>(lane, Batch(reversed_index), Batch(low_bits(pixel)), Batch(high_bits(pixel)), first)
            .store_aligned(&bits[lane]);
    return block_of(bits.data());
}

std::pair<Sampler::Block, Sampler::Block> sobol_blocks(std::array<std::uint32_t, 2> reversed_index,
                                                       std::array<std::uint64_t, 2> pixel, std::uint32_t first) {
#if XSIMD_WITH_AVX512F
    constexpr std::size_t kLanes = 2 * Sampler::kBlock;
    const auto both = [](std::uint32_t a, std::uint32_t b) { return whole_halves<kLanes>(a, b); };
    alignas(64) std::array<std::uint32_t, kLanes> bits;
    sobol_lanes<kLanes>(0, both(reversed_index[0], reversed_index[1]), both(low_bits(pixel[0]), low_bits(pixel[1])),
                        both(high_bits(pixel[0]), high_bits(pixel[1])), first)
        .store_aligned(bits.data());
    return {block_of(bits.data()), block_of(bits.data() + Sampler::kBlock)};
#else
    return {sobol_block(reversed_index[0], pixel[0], first), sobol_block(reversed_index[1], pixel[1], first)};
#endif
}

/// The lower 16 bits at even places.
constexpr std::uint32_t spread_bits(std::uint32_t x) {
    x &= 0xffffu;
    x = (x | x << 8) & 0x00ff00ffu;
    x = (x | x << 4) & 0x0f0f0f0fu;
    x = (x | x << 2) & 0x33333333u;
    return (x | x << 1) & 0x55555555u;
}

float stratified_1d(std::uint32_t index, std::uint32_t count, std::uint64_t key) {
    const std::uint32_t round = index / count;
    key = stream_number(key, round);
    const std::uint32_t s = permute(index % count, count, key);
    return stratum(s, unit_float(high_bits(stream_number(key, s))), count);
}

/// Correlated multi-jittered points for any count: one in each of `count` rows, one in each of columns × rows_of_cells
/// cells of the coarse grid (the last row of cells may be incomplete), and no two in one fine column (Kensler 2013,
/// §5).
Vec2 stratified_2d(std::uint32_t index, std::uint32_t count, std::uint64_t key) {
    const std::uint32_t round = index / count; // beyond the promised number of samples: a fresh set
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

SamplerKind sampler_kind(std::string_view name) {
    for (const auto& [known, kind] : kNames)
        if (known == name) return kind;
    throw Error(message("unknown sampler '", name, "': expected sobol, blue-noise, stratified, independent or center"));
}

bool depends_on_count(SamplerKind kind) {
    return kind == SamplerKind::kStratified || kind == SamplerKind::kBlueNoise;
}

std::string_view sampler_name(SamplerKind kind) {
    for (const auto& [name, known] : kNames)
        if (known == kind) return name;
    return {};
}

Sampler::Sampler(SamplerKind kind, std::uint64_t seed, int samples_per_pixel, std::uint32_t replicates)
    : kind_(kind), seed_(mix_bits(seed + kGoldenStep)),
      samples_per_replicate_((static_cast<std::uint32_t>(std::max(samples_per_pixel, 1)) + replicates - 1) / replicates),
      replicates_(replicates) {
    DUET_CHECK(replicates == 1 || replicates == 2);
}

void Sampler::start(std::span<Sampler> samplers, int pixel_x, int pixel_y, std::uint32_t index) {
    if (samplers.empty()) return;
    const std::uint64_t pixel =
        (static_cast<std::uint64_t>(static_cast<std::uint32_t>(pixel_y)) << 32) | static_cast<std::uint32_t>(pixel_x);
    const std::uint64_t hash = hash_combine(samplers[0].seed_, pixel);
    const std::array<std::uint64_t, 2> hashes{hash_combine(hash, 0), hash_combine(hash, 1)}; // by replicate
    for (Sampler& s : samplers) {
        s.sample_ = index++;
        s.replicate_ = s.sample_ & (s.replicates_ - 1); // 1 or 2: the remainder, without a division
        s.index_ = s.sample_ >> (s.replicates_ - 1);
        s.dimension_ = 0;
        s.pixel_hash_ = hashes[s.replicate_];
        if (s.kind_ == SamplerKind::kBlueNoise)
            s.share_sequence(static_cast<std::uint32_t>(pixel_x), static_cast<std::uint32_t>(pixel_y));
        s.reversed_index_ = reverse_bits(s.index_);
    }
}

// Pixels along a Z-curve take consecutive blocks of one sequence: blocks of 4, 16, 64 … pixels are nets together, too,
// so that errors of neighbours cancel, and what noise is left has little of the low frequencies that eyes see (Ahmed
// and Wonka 2020, «Screen-Space Blue-Noise Diffusion of Monte Carlo Sampling Error via Hierarchical Ordering of Pixels»,
// §4; the scrambling of the index, which its uppermost digits lead, shuffles the four quarters of each square). A
// sequence has 2³² points: tiles of as many pixels as it has blocks have one of their own.
void Sampler::share_sequence(std::uint32_t pixel_x, std::uint32_t pixel_y) {
    const int digits = static_cast<int>(std::bit_width(samples_per_replicate_ - 1)); // of the index within a pixel
    const int side = std::max((32 - digits) / 2 - 1, 0);  // of a tile: 2^side pixels
    const std::uint32_t mask = (1u << side) - 1;
    const std::uint32_t curve = spread_bits(pixel_x & mask) | spread_bits(pixel_y & mask) << 1;
    const std::uint64_t tile = (static_cast<std::uint64_t>(pixel_y >> side) << 32) | (pixel_x >> side);
    pixel_hash_ = hash_combine(hash_combine(seed_, tile), replicate_);
    const std::uint32_t round = index_ >> digits; // beyond the promised number of samples: fresh sequences
    if (round > 0) pixel_hash_ = hash_combine(pixel_hash_, round);
    index_ = (curve << digits) | (index_ & ((1u << digits) - 1));
}

float Sampler::get_1d() {
    const std::uint32_t dimension = dimension_++;
    if (is_sobol()) return sobol_1d(reversed_index_, dimension_seed(low_bits(pixel_hash_), high_bits(pixel_hash_), dimension));
    const std::uint64_t key = stream_number(pixel_hash_, dimension);
    if (kind_ == SamplerKind::kStratified) return stratified_1d(index_, samples_per_replicate_, key);
    return unit_float(high_bits(stream_number(key, index_)));
}

Vec2 Sampler::get_2d() {
    const std::uint32_t dimension = dimension_;
    dimension_ += 2;
    if (is_sobol()) return sobol_2d(reversed_index_, dimension_seed(low_bits(pixel_hash_), high_bits(pixel_hash_), dimension));
    const std::uint64_t key = stream_number(pixel_hash_, dimension);
    if (kind_ == SamplerKind::kStratified) return stratified_2d(index_, samples_per_replicate_, key);
    const std::uint64_t bits = stream_number(key, index_);
    return {unit_float(high_bits(bits)), unit_float(low_bits(bits))};
}

Sampler::Block Sampler::get_block() {
    std::array<float, kBlock> numbers;
    if (is_sobol()) {
        numbers = sobol_block(reversed_index_, pixel_hash_, dimension_);
        dimension_ += kBlock;
        return numbers;
    }
    for (std::size_t i = 0; i < kBlock; i += 2) {
        const Vec2 pair = get_2d();
        numbers[i] = pair.x;
        numbers[i + 1] = pair.y;
    }
    return numbers;
}

std::pair<Sampler::Block, Sampler::Block> Sampler::get_blocks(Sampler& a, Sampler& b) {
    if (!a.is_sobol()) {
        const Block first = a.get_block();
        return {first, b.get_block()};
    }
    const auto numbers = sobol_blocks({a.reversed_index_, b.reversed_index_}, {a.pixel_hash_, b.pixel_hash_}, a.dimension_);
    a.dimension_ += kBlock;
    b.dimension_ += kBlock;
    return numbers;
}

// at(k): the k-th sampler.
template <typename At>
void Sampler::pairs_of(const At& at, std::size_t size, std::span<const std::uint32_t> dimensions, std::span<Vec2> numbers) {
    DUET_CHECK_EQ(numbers.size(), size * dimensions.size());
    if (numbers.empty()) return;
    if (!at(0).is_sobol()) {
        for (std::size_t d = 0; d < dimensions.size(); ++d)
            for (std::size_t k = 0; k < size; ++k) {
                Sampler sampler = at(k);
                sampler.set_dimension(dimensions[d]);
                numbers[d * size + k] = sampler.get_2d();
            }
        return;
    }
    constexpr std::size_t kLanes = kMaxSimdLanes;
    using Batch = WholeBatch<kLanes>;
    for (std::size_t done = 0; done < size; done += kLanes) {
        const std::size_t some = std::min(size - done, kLanes);
        alignas(Batch) std::array<std::uint32_t, kLanes> index, low, high, x, y;
        for (std::size_t i = 0; i < kLanes; ++i) { // lanes too many are filled with the first's
            const Sampler& s = at(done + (i < some ? i : 0));
            index[i] = s.reversed_index_, low[i] = low_bits(s.pixel_hash_), high[i] = high_bits(s.pixel_hash_);
        }
        const auto load = [](const auto& lanes) { return Batch::load_aligned(lanes.data()); };
        const Batch indices = load(index), lows = load(low), highs = load(high);
        for (std::size_t d = 0; d < dimensions.size(); ++d) {
            const Vec2T<Batch> digits = sobol_2d_digits(indices, dimension_seed(lows, highs, Batch(dimensions[d])));
            digits.x.store_aligned(x.data());
            digits.y.store_aligned(y.data());
            Vec2* to = &numbers[d * size + done];
            for (std::size_t i = 0; i < some; ++i) to[i] = {unit_float(x[i]), unit_float(y[i])};
        }
    }
}

void Sampler::pairs(std::span<const Sampler> samplers, std::span<const std::uint32_t> dimensions, std::span<Vec2> numbers) {
    pairs_of([&](std::size_t k) -> const Sampler& { return samplers[k]; }, samplers.size(), dimensions, numbers);
}

void Sampler::pairs(std::span<const Sampler> samplers, std::span<const std::uint32_t> which,
                    std::span<const std::uint32_t> dimensions, std::span<Vec2> numbers) {
    pairs_of([&](std::size_t k) -> const Sampler& { return samplers[which[k]]; }, which.size(), dimensions, numbers);
}

CameraNumbers Sampler::camera_numbers(CameraNeeds needs) const {
    CameraNumbers numbers;
    camera_numbers({this, 1}, needs, {&numbers, 1});
    return numbers;
}

void Sampler::camera_numbers(std::span<const Sampler> samplers, CameraNeeds needs, std::span<CameraNumbers> numbers) {
    std::fill(numbers.begin(), numbers.end(), CameraNumbers());
    if (samplers.empty() || samplers[0].kind_ == SamplerKind::kCenter) return;
    constexpr std::size_t kSome = 64;
    std::array<Vec2, kSome> drawn;
    for (std::size_t done = 0; done < samplers.size(); done += kSome) {
        const auto some = samplers.subspan(done, std::min(kSome, samplers.size() - done));
        const auto draw = [&](std::uint32_t dimension, const auto& set) {
            pairs(some, {&dimension, 1}, std::span(drawn).first(some.size()));
            for (std::size_t i = 0; i < some.size(); ++i) set(numbers[done + i], drawn[i]);
        };
        draw(0, [](CameraNumbers& u, Vec2 pair) { u.pixel = pair; });
        if (needs.lens) draw(2, [](CameraNumbers& u, Vec2 pair) { u.lens = pair; });
        if (needs.time) draw(4, [](CameraNumbers& u, Vec2 pair) { u.time = pair.x; });
    }
}

} // namespace duet
