#include "raster/shader/texels.h"

#include "common/system/error.h"
#include "common/texture/probe_line.h"
#include "common/texture/texel_place.h"

namespace duet::raster {

Texels::Texels(const ImageRgb& image, const std::vector<ImageRgb>& smaller) {
    if (smaller.size() >= kStrip)
        throw Error(message(smaller.size() + 1, " sizes of an image: expected at most ", kStrip));
    const auto add = [&](const ImageRgb& one) {
        const auto level = static_cast<std::size_t>(levels_++);
        numbers_[level] = &one.pixels().data()->r;
        widths_[level] = static_cast<float>(one.width()); // integers below 2^24
        heights_[level] = static_cast<float>(one.height());
    };
    add(image);
    for (const ImageRgb& one : smaller) add(one);
}

std::vector<Texels> texels_of(const TextureSet& textures) {
    std::vector<Texels> result(textures.images.size());
    for (std::size_t i = 0; i < textures.smaller.size(); ++i)
        if (!textures.smaller[i].empty()) result[i] = Texels(textures.images[i], textures.smaller[i]);
    return result;
}

/// Loads the 2 × 2 texels around each lane's position. Their addresses are computed with SIMD. Because the texels of
/// different lanes are far apart, each is loaded separately, with its three channels in one register.
class Texels::Quartets {
public:
    /// Selects a mipmap level per lane. Level 0 is the largest; levels beyond the last are clamped.
    Quartets(const Texels& of, const Ints& level) {
        const Ints known = min(level, Ints(of.levels_ - 1));
        width_ = raster::look_up(of.widths_, known);
        height_ = raster::look_up(of.heights_, known);
        raster::look_up(of.numbers_, known, numbers_);
    }
    /// Sets the positions, in [0, 1). (v points up, but rows are stored from the top.)
    void move_to(const Vec2T<Floats>& place) {
        const TexelPair<Floats> x(place.x, width_), y(place.y, height_);
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
        const auto texel = [&](const Places& places) { return load_three(at(lane, places)); };
        return bilinear(texel(lower_left_), texel(lower_right_), texel(upper_left_), texel(upper_right_),
                        Quads(weight_x_[lane]), Quads(weight_y_[lane]));
    }

private:
    using Places = std::array<std::int32_t, Floats::size>;
    const float* at(std::size_t lane, const Places& places) const {
        return numbers_[lane] + static_cast<std::uint32_t>(places[lane]);
    }

    Floats width_, height_;
    alignas(64) Places lower_left_, lower_right_, upper_left_, upper_right_; ///< offsets in floats, below 2^32
    alignas(64) std::array<float, Floats::size> weight_x_, weight_y_;
    alignas(64) std::array<const float*, Floats::size> numbers_;
};

RgbT<Floats> Texels::look_up(const ImageTexture& texture, const TexturePlaces& places) const {
    const auto scaled = [](const Vec2T<Floats>& v, float x, float y) {
        return Vec2T<Floats>(v.x * Floats(x), v.y * Floats(y));
    };
    const auto in_period = [](const Vec2T<Floats>& v) { return Vec2T<Floats>(fraction(v.x), fraction(v.y)); };
    const float width = widths_[0], height = heights_[0], scale_x = texture.scale.x, scale_y = texture.scale.y;
    const auto in_texels = [&](const Vec2T<Floats>& duv) { return scaled(duv, scale_x * width, scale_y * height); };
    const ProbeLineT<Floats> probes =
        probe_line(in_texels(places.duv_dx), in_texels(places.duv_dy), max_probes(texture.filter));
    const Vec2T<Floats> middle = in_period(scaled(places.uv, scale_x, scale_y)),
                        step = scaled(probes.step, 1 / width, 1 / height);

    const Ints level = truncated(probes.level);
    Quartets fine(*this, level), coarse(*this, level + Ints(1));
    const std::uint32_t between = lane_bits(probes.blend > Floats(0.0f)) & places.lanes; // lanes that blend two levels
    const Lanes<Floats> blend(probes.blend);

    std::array<Quads, Floats::size> sums;
    sums.fill(Quads(0.0f));
    for (float i = 0;; ++i) {
        std::uint32_t left = lane_bits(Floats(i) < probes.count) & places.lanes;
        if (left == 0) break;
        const Vec2T<Floats> place =
            in_period(middle + step * Floats(Floats(i) - Floats(0.5f) * (probes.count - Floats(1.0f))));
        fine.move_to(place);
        if ((left & between) != 0) coarse.move_to(place);
        for (; left != 0; left &= left - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(left));
            Quads color = fine.color(lane);
            if ((between >> lane & 1) != 0) color = duet::between(color, coarse.color(lane), Quads(blend[lane]));
            sums[lane] = sums[lane] + color;
        }
    }
    const auto columns =
        load_columns<Floats::size>([&](std::size_t lane) { return reinterpret_cast<const float*>(&sums[lane]); });
    return RgbT<Floats>(columns[0], columns[1], columns[2]) * (Floats(1.0f) / probes.count);
}

} // namespace duet::raster
