// Sample points: each number is a function of (seed, pixel, sample, dimension) and of nothing else, so pictures do not
// depend on threads, tiles or passes.
#pragma once

#include "common/vec/vec.h"

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>

namespace duet {

enum class SamplerKind {
    kSobol,       ///< Owen-scrambled Sobol points, padded by pairs of dimensions (Burley 2020)
    kBlueNoise,   ///< the same, neighbouring pixels sharing a sequence; needs the number of samples
    kStratified,  ///< jittered strata, shuffled by dimension; needs the number of samples
    kIndependent, ///< independent uniform numbers
    kCenter,      ///< pixel and lens centre, shutter open; all other dimensions as kSobol: for parity of the pipelines
};
/// "sobol", "blue-noise", "stratified", "independent", "center"; throws Error for another name.
SamplerKind sampler_kind(std::string_view name);
std::string_view sampler_name(SamplerKind kind);
/// Whether its samples depend on how many the pixel is to get.
bool depends_on_count(SamplerKind kind);

/// The numbers in [0, 1) that a camera ray uses.
struct CameraNumbers {
    Vec2 pixel{0.5f, 0.5f}, lens{0.5f, 0.5f};
    float time = 0;
};

/// The numbers of one sample of one pixel, drawn in order of dimension. All samples of a pixel are points of one
/// sequence, well spread together; or they fall into two replicates, scrambled independently of each other: sample i is
/// point i/2 of replicate i mod 2. Their difference is what the film estimates its variance from, and costs as much as
/// spreading all together gains: up to half of the squared error.
class Sampler {
public:
    /// samples_per_pixel: how many samples the pixel will get (stratified and blue-noise need it). replicates: 1 or 2.
    Sampler(SamplerKind kind, std::uint64_t seed, int samples_per_pixel, std::uint32_t replicates = 1);

    /// To dimension 0 of sample `index` of a pixel.
    void start(int pixel_x, int pixel_y, std::uint32_t index) { start({this, 1}, pixel_x, pixel_y, index); }
    /// The same of samplers of one kind and seed, each to the next sample of the pixel: what they share is found once.
    static void start(std::span<Sampler> samplers, int pixel_x, int pixel_y, std::uint32_t index);
    /// To a given dimension of the current sample: gives each bounce dimensions of its own.
    void set_dimension(std::uint32_t dimension) { dimension_ = dimension; }
    std::uint32_t dimension() const { return dimension_; }
    /// The current sample, as start() was told, and its replicate.
    std::uint32_t sample() const { return sample_; }
    std::uint32_t replicate() const { return replicate_; }

    /// The next one or two dimensions: numbers in [0, 1).
    float get_1d();
    Vec2 get_2d();
    /// The next eight dimensions as four pairs: what get_2d would give four times, for little more than one costs.
    static constexpr std::size_t kBlock = 8;
    using Block = std::array<float, kBlock>;
    Block get_block();
    /// get_block of two samplers of one kind that stand at the same dimension: for less than twice the work, where the
    /// machine has room for both at once.
    static std::pair<Block, Block> get_blocks(Sampler& a, Sampler& b);
    /// What get_2d gives at some dimensions, of all samplers of one kind, or of some of them in the order of `which`: many
    /// at once, those of a dimension after those of the one before. They stay where they are.
    static void pairs(std::span<const Sampler> samplers, std::span<const std::uint32_t> dimensions,
                      std::span<Vec2> numbers);
    static void pairs(std::span<const Sampler> samplers, std::span<const std::uint32_t> which,
                      std::span<const std::uint32_t> dimensions, std::span<Vec2> numbers);
    /// What the camera asks for besides the place in the pixel.
    struct CameraNeeds {
        bool lens = false, time = false;
    };
    /// The first three pairs, for the camera; what it does not ask for is as in CameraNumbers, and so is all of kCenter.
    CameraNumbers camera_numbers(CameraNeeds needs) const;
    /// Those of many of one kind.
    static void camera_numbers(std::span<const Sampler> samplers, CameraNeeds needs, std::span<CameraNumbers> numbers);

private:
    bool is_sobol() const {
        return kind_ == SamplerKind::kSobol || kind_ == SamplerKind::kBlueNoise || kind_ == SamplerKind::kCenter;
    }
    void share_sequence(std::uint32_t pixel_x, std::uint32_t pixel_y);
    template <typename At>
    static void pairs_of(const At& at, std::size_t size, std::span<const std::uint32_t> dimensions, std::span<Vec2> numbers);

    SamplerKind kind_;
    std::uint64_t seed_;
    std::uint32_t samples_per_replicate_, replicates_;
    std::uint64_t pixel_hash_ = 0;
    std::uint32_t sample_ = 0, index_ = 0, reversed_index_ = 0, replicate_ = 0, dimension_ = 0;
};

} // namespace duet
