// Declares samplers, which generate the random samples of a pixel. Each number depends only on the seed, the pixel, the
// sample index and the dimension, so images do not depend on threads, tiles or passes.
#pragma once

#include "common/vec/vec.h"

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace duet {

enum class SamplerKind {
    kSobol,       ///< Owen-scrambled Sobol points, padded by pairs of dimensions (Burley 2020)
    kBlueNoise,   ///< like kSobol, but neighboring pixels share a sequence; needs the number of samples
    kStratified,  ///< jittered strata, shuffled for each dimension; needs the number of samples
    kIndependent, ///< independent uniform samples
    kCenter,      ///< pixel and lens center, shutter opening time; else like kSobol (for parity of the pipelines)
};
/// Returns the sampler named "sobol", "blue-noise", "stratified", "independent" or "center". Throws an Error for
/// another name.
SamplerKind sampler_kind(std::string_view name);
/// Returns the name that sampler_kind() accepts for a sampler.
std::string_view sampler_name(SamplerKind kind);
/// Returns whether the samples depend on the number of samples per pixel.
bool needs_sample_count(SamplerKind kind);

/// Holds the random samples in [0, 1) of one camera ray.
struct CameraRaySample {
    Vec2 pixel{0.5f, 0.5f}, lens{0.5f, 0.5f};
    float time = 0;
};

/// Provides the dimensions of one sample of one pixel in order. With one replicate, all samples of a pixel are points
/// of one well-distributed sequence. With two replicates, there are two sequences, scrambled independently: sample i is
/// point ⌊i/2⌋ of replicate i mod 2. The film estimates the variance from the difference of the replicates. The
/// disadvantage of two replicates is their error: a single sequence can reach half the squared error.
class Sampler {
public:
    /// kStratified and kBlueNoise need the number of samples per pixel. The number of replicates must be 1 or 2.
    Sampler(SamplerKind kind, std::uint64_t seed, int samples_per_pixel, std::uint32_t replicates = 1);

    /// Moves to dimension 0 of sample `index` of a pixel.
    void start(int pixel_x, int pixel_y, std::uint32_t index) { start({this, 1}, pixel_x, pixel_y, index); }
    /// Starts several samplers of the same kind and seed on consecutive samples of a pixel, from sample `index` on.
    /// Values that they share are computed only once.
    static void start(std::span<Sampler> samplers, int pixel_x, int pixel_y, std::uint32_t index);
    /// Moves to a given dimension of the current sample. The path tracer uses it to give each bounce its own
    /// dimensions.
    void set_dimension(std::uint32_t dimension) { dimension_ = dimension; }
    std::uint32_t dimension() const { return dimension_; }
    /// Returns the index of the current sample.
    std::uint32_t sample() const { return sample_; }
    /// Returns the replicate (0 or 1) of the current sample.
    std::uint32_t replicate() const { return replicate_; }

    /// Returns the next two dimensions: two numbers in [0, 1).
    Vec2 get_2d();
    /// This is the number of dimensions in a block.
    static constexpr std::size_t kBlock = 8;
    using Block = std::array<float, kBlock>;
    /// Returns the next eight dimensions as four pairs. The result equals that of four calls of get_2d(), but costs
    /// little more than one call.
    Block get_block();
    /// Computes the results of get_2d() for many samplers of the same kind at the given dimensions with SIMD. With n
    /// samplers, samples[d * n + k] is the pair of sampler k at dimensions[d]. The samplers do not advance.
    static void get_2d_batch(std::span<const Sampler> samplers, std::span<const std::uint32_t> dimensions,
                             std::span<Vec2> samples);
    /// This overload takes a subset of the samplers: sampler k is samplers[subset[k]], and n is subset.size().
    static void get_2d_batch(std::span<const Sampler> samplers, std::span<const std::uint32_t> subset,
                             std::span<const std::uint32_t> dimensions, std::span<Vec2> samples);
    /// Selects the camera samples that are needed in addition to the position in the pixel.
    struct CameraNeeds {
        bool lens = false, time = false;
    };
    /// Returns the camera samples, which are the first three pairs of dimensions. Samples that are not needed have the
    /// defaults of CameraRaySample. kCenter returns only defaults. The sampler does not advance.
    CameraRaySample camera_ray_samples(CameraNeeds needs) const;
    /// Computes the camera samples of many samplers of the same kind.
    static void camera_ray_samples(std::span<const Sampler> samplers, CameraNeeds needs,
                                   std::span<CameraRaySample> samples);

private:
    bool is_sobol() const {
        return kind_ == SamplerKind::kSobol || kind_ == SamplerKind::kBlueNoise || kind_ == SamplerKind::kCenter;
    }
    void share_sequence(std::uint32_t pixel_x, std::uint32_t pixel_y);
    template <typename At>
    static void get_2d_batch_of(const At& at, std::size_t size, std::span<const std::uint32_t> dimensions,
                                std::span<Vec2> samples);

    SamplerKind kind_;
    std::uint64_t seed_;
    std::uint32_t samples_per_replicate_, replicates_;
    std::uint64_t pixel_hash_ = 0;
    std::uint32_t sample_ = 0, index_ = 0, reversed_index_ = 0, replicate_ = 0, dimension_ = 0;
};

} // namespace duet
