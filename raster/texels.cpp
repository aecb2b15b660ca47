#include "raster/texels.h"

#include "common/system/error.h"
#include "common/texture/probe_line.h"
#include "common/texture/texel_place.h"
#include "raster/shader.h"

namespace duet::raster {

Texels::Texels(const ImageRgb& image, const std::vector<ImageRgb>& smaller) {
    if (smaller.size() >= kStrip) throw Error(message(smaller.size() + 1, " sizes of an image: expected at most ", kStrip));
    const auto add = [&](const ImageRgb& one) {
        const auto level = static_cast<std::size_t>(levels_++);
        pixels_[level] = one.pixels().data();
        widths_[level] = static_cast<float>(one.width()); // whole numbers below 2^24
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

/// The size of the image that each lane looks at, and where. A lane's texels are far from any other's: what they are is worked
/// out side by side, and the three channels of each, in one register, lane after lane.
class Texels::LevelLanes {
public:
    LevelLanes(const Texels& of, const Ints& level)
        : width_(raster::look_up(of.widths_, level)), height_(raster::look_up(of.heights_, level)) {
        alignas(64) std::array<std::int32_t, Ints::size> levels;
        level.store_aligned(levels.data());
        for (std::size_t lane = 0; lane < Ints::size; ++lane) numbers_[lane] = &of.pixels_[static_cast<std::size_t>(levels[lane])]->r;
    }
    /// Places in [0, 1). (v rises from the bottom, rows are stored from the top.)
    void move_to(const Floats& s, const Floats& t) {
        const TexelPair<Floats> x(s, width_), y(t, height_);
        const Ints left = truncated(x.first) * Ints(3), right = truncated(x.second) * Ints(3);
        const Ints stride = truncated(width_) * Ints(3), top = truncated(height_) - Ints(1);
        const Ints lower = (top - truncated(y.first)) * stride, upper = (top - truncated(y.second)) * stride;
        store(lower_left_, 0, lower + left);
        store(lower_right_, 0, lower + right);
        store(upper_left_, 0, upper + left);
        store(upper_right_, 0, upper + right);
        store(weight_x_, 0, x.weight);
        store(weight_y_, 0, y.weight);
    }
    Quads color(std::size_t lane) const {
        const auto texel = [&](const StripOf<std::int32_t>& places) { return load_three(numbers_[lane] + static_cast<std::uint32_t>(places[lane])); };
        return bilinear(texel(lower_left_), texel(lower_right_), texel(upper_left_), texel(upper_right_), Quads(weight_x_[lane]),
                        Quads(weight_y_[lane]));
    }

private:
    std::array<const float*, Floats::size> numbers_; ///< three a texel
    Floats width_, height_;
    StripOf<std::int32_t> lower_left_, lower_right_, upper_left_, upper_right_; ///< among them, below 2^32
    StripOf<float> weight_x_, weight_y_;
};

RgbT<Floats> Texels::look_up(const ImageTexture& texture, const TexturePlaces& places) const {
    const Floats scale_x(texture.scale.x * widths_[0]), scale_y(texture.scale.y * heights_[0]);
    const auto in_texels = [&](const Vec2T<Floats>& duv) { return Vec2T<Floats>(duv.x * scale_x, duv.y * scale_y); };
    const ProbeLineT<Floats> probes = probe_line(in_texels(places.duv_dx), in_texels(places.duv_dy), max_probes(texture.filter));
    const Floats s = fraction(Floats(places.uv.x * Floats(texture.scale.x))), t = fraction(Floats(places.uv.y * Floats(texture.scale.y)));
    const Floats step_x = probes.step.x * Floats(1 / widths_[0]), step_y = probes.step.y * Floats(1 / heights_[0]);
    const Floats middle = Floats(0.5f) * (probes.count - Floats(1.0f));

    const Ints level = truncated(probes.level), last(levels_ - 1);
    LevelLanes fine(*this, min(level, last)), coarse(*this, min(level + Ints(1), last));
    const std::uint32_t between = lane_bits(probes.blend > Floats(0.0f)) & places.lanes; // two sizes
    StripOf<float> blend;
    store(blend, 0, probes.blend);

    std::array<Quads, Floats::size> sums;
    sums.fill(Quads(0.0f));
    for (float i = 0;; ++i) {
        std::uint32_t left = lane_bits(Floats(i) < probes.count) & places.lanes;
        if (left == 0) break;
        const Floats along = Floats(i) - middle;
        const Floats ps = fraction(Floats(s + along * step_x)), pt = fraction(Floats(t + along * step_y));
        fine.move_to(ps, pt);
        if ((left & between) != 0) coarse.move_to(ps, pt);
        for (; left != 0; left &= left - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(left));
            Quads color = fine.color(lane);
            if ((between >> lane & 1) != 0) color = duet::between(color, coarse.color(lane), Quads(blend[lane]));
            sums[lane] = sums[lane] + color;
        }
    }
    const auto columns = load_columns<Floats::size>([&](std::size_t lane) { return reinterpret_cast<const float*>(&sums[lane]); });
    return RgbT<Floats>(columns[0], columns[1], columns[2]) * (Floats(1.0f) / probes.count);
}

} // namespace duet::raster
