#include "raster/shader/texture_sampler.h"

#include "common/system/error.h"
#include "common/texture/anisotropic_probes.h"
#include "common/texture/texel_index.h"
#include "raster/geometry/packet_lookup.h"

namespace duet::raster {

TextureSampler::TextureSampler(const ImageRgb& image, const std::vector<ImageRgb>& smaller) {
    if (smaller.size() >= kPacketSize)
        throw Error(message(smaller.size() + 1, " sizes of an image: expected at most ", kPacketSize));
    const auto add = [&](const ImageRgb& one) {
        const auto level = static_cast<std::size_t>(levels_++);
        level_texels_[level] = &one.pixels().data()->r;
        widths_[level] = static_cast<float>(one.width()); // integers below 2^24
        heights_[level] = static_cast<float>(one.height());
    };
    add(image);
    for (const ImageRgb& one : smaller) add(one);
}

std::vector<TextureSampler> texture_samplers(const TextureSet& textures) {
    std::vector<TextureSampler> result(textures.images.size());
    for (std::size_t i = 0; i < textures.mip_levels.size(); ++i)
        if (!textures.mip_levels[i].empty()) result[i] = TextureSampler(textures.images[i], textures.mip_levels[i]);
    return result;
}

/// Loads the 2 × 2 texels around each lane's position. Their addresses are computed with SIMD. Because the texels of
/// different lanes are far apart, each is loaded separately, with its three channels in one register.
class TextureSampler::TexelQuads {
public:
    /// Selects a mipmap level per lane. Level 0 is the largest; levels beyond the last are clamped.
    TexelQuads(const TextureSampler& of, const Ints& level) {
        const Ints clamped = min(level, Ints(of.levels_ - 1));
        width_ = raster::look_up(of.widths_, clamped);
        height_ = raster::look_up(of.heights_, clamped);
        raster::look_up(of.level_texels_, clamped, level_texels_);
    }
    /// Sets the positions, in [0, 1). (v points up, but rows are stored from the top.)
    void set_uv(const Vec2T<Floats>& uv) {
        const TexelPair<Floats> x(uv.x, width_), y(uv.y, height_);
        const Ints left = truncated(x.first) * Ints(3), right = truncated(x.second) * Ints(3);
        const Ints stride = truncated(width_) * Ints(3), top = truncated(height_) - Ints(1);
        const Ints lower = (top - truncated(y.first)) * stride, upper = (top - truncated(y.second)) * stride;
        (lower + left).store_aligned(lower_left_.data());
        (lower + right).store_aligned(lower_right_.data());
        (upper + left).store_aligned(upper_left_.data());
        (upper + right).store_aligned(upper_right_.data());
        x.weight.store_aligned(weight_x_.data());
        y.weight.store_aligned(weight_y_.data());
    }
    Quads color(std::size_t lane) const {
        const auto texel = [&](const Offsets& offsets) { return load_three(at(lane, offsets)); };
        return bilinear(texel(lower_left_), texel(lower_right_), texel(upper_left_), texel(upper_right_),
                        Quads(weight_x_[lane]), Quads(weight_y_[lane]));
    }

private:
    using Offsets = std::array<std::int32_t, Floats::size>;
    const float* at(std::size_t lane, const Offsets& offsets) const {
        return level_texels_[lane] + static_cast<std::uint32_t>(offsets[lane]);
    }

    Floats width_, height_;
    alignas(64) Offsets lower_left_, lower_right_, upper_left_, upper_right_; ///< offsets in floats, below 2^32
    alignas(64) std::array<float, Floats::size> weight_x_, weight_y_;
    alignas(64) std::array<const float*, Floats::size> level_texels_;
};

RgbT<Floats> TextureSampler::sample(const ImageTexture& texture, const TextureCoordinates& coordinates) const {
    const auto scaled = [](const Vec2T<Floats>& v, float x, float y) {
        return Vec2T<Floats>(v.x * Floats(x), v.y * Floats(y));
    };
    const auto in_period = [](const Vec2T<Floats>& v) { return Vec2T<Floats>(wrap_repeat(v.x), wrap_repeat(v.y)); };
    const float width = widths_[0], height = heights_[0], scale_x = texture.scale.x, scale_y = texture.scale.y;
    const auto in_texels = [&](const Vec2T<Floats>& duv) { return scaled(duv, scale_x * width, scale_y * height); };
    const AnisotropicProbesT<Floats> probes = anisotropic_probes(
        in_texels(coordinates.duv_dx), in_texels(coordinates.duv_dy), max_anisotropy(texture.filter));
    const Vec2T<Floats> middle = in_period(scaled(coordinates.uv, scale_x, scale_y)),
                        step = scaled(probes.step, 1 / width, 1 / height);

    const Ints level = truncated(probes.level);
    TexelQuads fine(*this, level), coarse(*this, level + Ints(1));
    const std::uint32_t between =
        lane_bits(probes.blend > Floats(0.0f)) & coordinates.lanes; // lanes that blend two levels
    const Lanes<Floats> blend(probes.blend);

    std::array<Quads, Floats::size> sums;
    sums.fill(Quads(0.0f));
    for (float i = 0;; ++i) {
        const std::uint32_t probed = lane_bits(Floats(i) < probes.count) & coordinates.lanes;
        if (probed == 0) break;
        const Vec2T<Floats> uv =
            in_period(middle + step * Floats(Floats(i) - Floats(0.5f) * (probes.count - Floats(1.0f))));
        fine.set_uv(uv);
        if ((probed & between) != 0) coarse.set_uv(uv);
        for (const std::size_t lane : SetBits(probed)) {
            Quads color = fine.color(lane);
            if ((between >> lane & 1) != 0) color = duet::lerp_fused(color, coarse.color(lane), Quads(blend[lane]));
            sums[lane] = sums[lane] + color;
        }
    }
    const auto columns =
        load_columns<Floats::size>([&](std::size_t lane) { return reinterpret_cast<const float*>(&sums[lane]); });
    return RgbT<Floats>(columns[0], columns[1], columns[2]) * (Floats(1.0f) / probes.count);
}

} // namespace duet::raster
