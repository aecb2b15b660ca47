#include "raster/texels.h"

#include "common/system/error.h"
#include "common/system/parallel.h"
#include "common/texture/probe_line.h"
#include "common/texture/texel_place.h"
#include "raster/shader.h"

namespace duet::raster {

// Rows are stored from the top.
void Texels::add(const ImageRgb& image) {
    const auto level = static_cast<std::size_t>(levels_++);
    widths_[level] = static_cast<float>(image.width()); // whole numbers below 2^24
    heights_[level] = static_cast<float>(image.height());
    firsts_[level] = static_cast<std::int32_t>(texels_.size());
    const auto add_row = [&](int y) {
        for (int x = 0; x <= image.width(); ++x) {
            const Rgb c = image(x % image.width(), y);
            texels_.push_back({c.r, c.g, c.b});
        }
    };
    add_row(image.height() - 1);
    for (int y = 0; y < image.height(); ++y) add_row(y);
}

Texels::Texels(const ImageRgb& image, const std::vector<ImageRgb>& smaller) {
    if (smaller.size() >= kStrip) throw Error(message(smaller.size() + 1, " sizes of an image: expected at most ", kStrip));
    const auto room = [](const ImageRgb& one) { return static_cast<std::size_t>(one.width() + 1) * static_cast<std::size_t>(one.height() + 1); };
    std::size_t count = room(image);
    for (const ImageRgb& one : smaller) count += room(one);
    texels_.reserve(count);
    add(image);
    for (const ImageRgb& one : smaller) add(one);
}

std::vector<Texels> pack_texels(const TextureSet& textures, const std::vector<std::uint8_t>& wanted, int threads) {
    std::vector<Texels> result(textures.images.size());
    parallel_for(textures.smaller.size(), threads, [&](std::size_t i) {
        if (wanted[i] != 0 && !textures.smaller[i].empty()) result[i] = Texels(textures.images[i], textures.smaller[i]);
    });
    return result;
}

/// The size of the image that each lane looks at, and where.
struct Texels::LevelLanes {
    const Texel* texels;
    StripOf<float> width, height;
    StripOf<std::int32_t> first;
    StripOf<std::int32_t> at, above; ///< numbers of the left ones of the texels around a place
    StripOf<float> weight_x, weight_y;

    LevelLanes(const Texels& of, const Ints& level) : texels(of.texels_.data()) {
        store(width, 0, raster::look_up(of.widths_, level));
        store(height, 0, raster::look_up(of.heights_, level));
        store(first, 0, raster::look_up(of.firsts_, level));
    }
    /// Some lanes' places. v rises from the bottom, and the top row is stored second.
    void move_to(std::size_t k, const Doubles& s, const Doubles& t) {
        const Doubles columns = load_doubles(width.at(k)), rows = load_doubles(height.at(k)), stride = columns + Doubles(1.0);
        const TexelPair<Doubles> x(s, columns), y(t, rows);
        const Doubles place = (rows - y.first) * stride + x.first;
        store_ints(place, at.at(k));
        store_ints(place - stride, above.at(k));
        store_floats(x.weight, weight_x.at(k));
        store_floats(y.weight, weight_y.at(k));
    }
    RgbT<Floats> colors() const {
        std::array<const Texel*, Floats::size> lower, upper;
        for (std::size_t lane = 0; lane < Floats::size; ++lane) {
            lower[lane] = texels + first[lane] + at[lane];
            upper[lane] = texels + first[lane] + above[lane];
        }
        const auto corner = [](const std::array<const Texel*, Floats::size>& row, std::size_t column) -> RgbT<Floats> {
            const auto columns = load_columns<Floats::size>([&](std::size_t lane) { return &row[lane][column].r; });
            return {columns[0], columns[1], columns[2]};
        };
        return bilinear(corner(lower, 0), corner(lower, 1), corner(upper, 0), corner(upper, 1), load(weight_x, 0), load(weight_y, 0));
    }
};

struct Texels::Probes {
    StripOf<double> s, t;             ///< place of the middle
    StripOf<double> count, step_x, step_y;
    StripOf<float> counts, level, blend;
};

void Texels::find(const ImageTexture& texture, const TexturePlaces& places, Probes& probes) const {
    const Doubles scale_x(static_cast<double>(texture.scale.x)), scale_y(static_cast<double>(texture.scale.y));
    const Doubles width(static_cast<double>(widths_[0])), height(static_cast<double>(heights_[0]));
    for (std::size_t k = 0; k < Floats::size; k += Doubles::size) {
        const auto in_texels = [&](const std::array<StripOf<float>, 2>& duv) {
            return Vec2T<Doubles>(load_doubles(duv[0].at(k)) * scale_x * width, load_doubles(duv[1].at(k)) * scale_y * height);
        };
        const ProbeLineT<Doubles> line =
            probe_line(in_texels(places.duv_dx), in_texels(places.duv_dy), max_probes(texture.filter));
        store(probes.s, k, fraction(Doubles(load_doubles(places.uv[0].at(k)) * scale_x)));
        store(probes.t, k, fraction(Doubles(load_doubles(places.uv[1].at(k)) * scale_y)));
        store(probes.count, k, line.count);
        store(probes.step_x, k, line.step.x);
        store(probes.step_y, k, line.step.y);
        store_floats(line.count, probes.counts.at(k));
        store_floats(line.level, probes.level.at(k));
        store_floats(line.blend, probes.blend.at(k));
    }
}

RgbT<Floats> Texels::look_up(const ImageTexture& texture, const TexturePlaces& places) const {
    Probes probes;
    find(texture, places, probes);
    const Ints level = truncated(load(probes.level, 0)), last(levels_ - 1);
    LevelLanes fine(*this, min(level, last)), coarse(*this, min(level + Ints(1), last));
    const Doubles width(static_cast<double>(widths_[0])), height(static_cast<double>(heights_[0]));
    const Floats blend = load(probes.blend, 0), counts = load(probes.counts, 0), zero(0.0f);
    const auto between = blend > zero; // two sizes
    const bool any_between = xsimd::any(between);
    RgbT<Floats> sum(zero);
    const int most = static_cast<int>(highest(counts));
    for (int i = 0; i < most; ++i) {
        for (std::size_t k = 0; k < Floats::size; k += Doubles::size) {
            const Doubles along = Doubles(static_cast<double>(i)) - Doubles(0.5) * (load(probes.count, k) - Doubles(1.0));
            const Doubles s = fraction(Doubles(load(probes.s, k) + along * load(probes.step_x, k) / width)),
                          t = fraction(Doubles(load(probes.t, k) + along * load(probes.step_y, k) / height));
            fine.move_to(k, s, t);
            if (any_between) coarse.move_to(k, s, t);
        }
        RgbT<Floats> color = fine.colors();
        // What a lane does not ask for is left out, not weighed by 0: it may be infinite.
        if (any_between) color = select_each(between, lerp(color, coarse.colors(), blend), color);
        sum += select_each(Floats(static_cast<float>(i)) < counts, color, RgbT<Floats>(zero));
    }
    return sum * (Floats(1.0f) / counts);
}

} // namespace duet::raster
