#include "raster/texels.h"

#include "common/texture/probe_line.h"
#include "common/texture/texel_place.h"

#include <algorithm>
#include <utility>

namespace duet::raster {

Texels::Level::Level(const ImageRgb& image) : width(image.width()), height(image.height()), texels(image.size()) {
    for (std::size_t i = 0; i < texels.size(); ++i) texels[i] = {image[i].r, image[i].g, image[i].b};
}

Texels::Texels(const ImageRgb& image, const std::vector<ImageRgb>& smaller) {
    levels_.reserve(smaller.size() + 1);
    levels_.emplace_back(image);
    for (const ImageRgb& one : smaller) levels_.emplace_back(one);
}

std::size_t Texels::memory_bytes() const {
    std::size_t bytes = 0;
    for (const Level& level : levels_) bytes += level.texels.size() * sizeof(Texel);
    return bytes;
}

std::vector<Texels> pack_texels(const TextureSet& textures) {
    std::vector<Texels> result(textures.images.size());
    for (std::size_t i = 0; i < textures.smaller.size(); ++i)
        if (!textures.smaller[i].empty()) result[i] = Texels(textures.images[i], textures.smaller[i]);
    return result;
}

/// The size of the image that each lane looks at.
struct Texels::LevelLanes {
    std::array<const Texel*, kStrip> texels{};
    StripOf<double> width, height;
    std::array<StripOf<std::int32_t>, 4> corners; ///< numbers of the texels around a place
    StripOf<float> weight_x, weight_y;

    void set(std::size_t lane, const Level& level) {
        texels[lane] = level.texels.data();
        width[lane] = level.width, height[lane] = level.height;
    }
    /// Some lanes' corners; rows are stored from the top, v rises from the bottom.
    void move_to(std::size_t k, const Doubles& s, const Doubles& t) {
        const Doubles columns = load(width, k), rows = load(height, k);
        const TexelPair<Doubles> x(s, columns), y(t, rows);
        const Doubles first = (rows - Doubles(1.0) - y.first) * columns, second = (rows - Doubles(1.0) - y.second) * columns;
        store_ints(first + x.first, corners[0].at(k));
        store_ints(first + x.second, corners[1].at(k));
        store_ints(second + x.first, corners[2].at(k));
        store_ints(second + x.second, corners[3].at(k));
        store_floats(x.weight, weight_x.at(k));
        store_floats(y.weight, weight_y.at(k));
    }
    RgbT<Floats> colors() const {
        const auto corner = [&](std::size_t c) -> RgbT<Floats> {
            const auto columns = load_columns<Floats::size>(
                [&](std::size_t lane) { return &texels[lane][corners[c][lane]].r; });
            return {columns[0], columns[1], columns[2]};
        };
        return bilinear(corner(0), corner(1), corner(2), corner(3), load(weight_x, 0), load(weight_y, 0));
    }
};

struct Texels::Probes {
    StripOf<double> s, t;             ///< place of the middle
    StripOf<double> count, step_x, step_y;
    StripOf<double> level;
    StripOf<float> blend;
};

void Texels::find(const ImageTexture& texture, const TexturePlaces& places, Probes& probes) const {
    const Doubles scale_x(static_cast<double>(texture.scale.x)), scale_y(static_cast<double>(texture.scale.y));
    const Doubles width(static_cast<double>(levels_.front().width)), height(static_cast<double>(levels_.front().height));
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
        store(probes.level, k, line.level);
        store_floats(line.blend, probes.blend.at(k));
    }
}

RgbT<Floats> Texels::look_up(const ImageTexture& texture, const TexturePlaces& places) const {
    Probes probes;
    find(texture, places, probes);
    LevelLanes fine, coarse;
    double most = 1;
    for (std::size_t i = 0; i < Floats::size; ++i) {
        const auto level = static_cast<std::size_t>(probes.level[i]), last = levels_.size() - 1;
        fine.set(i, levels_[std::min(level, last)]);
        coarse.set(i, levels_[std::min(level + 1, last)]);
        most = std::max(most, probes.count[i]);
    }
    const Doubles width(static_cast<double>(levels_.front().width)), height(static_cast<double>(levels_.front().height));
    const Floats blend = load(probes.blend, 0), zero(0.0f);
    const bool blends = xsimd::any(blend > zero);
    StripOf<float> weights; // of probes: 1, or 0 beyond the last
    RgbT<Floats> sum(zero);
    for (int i = 0; i < static_cast<int>(most); ++i) {
        for (std::size_t k = 0; k < Floats::size; k += Doubles::size) {
            const Doubles number(static_cast<double>(i)), count = load(probes.count, k);
            const Doubles along = number - Doubles(0.5) * (count - Doubles(1.0));
            const Doubles s = fraction(Doubles(load(probes.s, k) + along * load(probes.step_x, k) / width)),
                          t = fraction(Doubles(load(probes.t, k) + along * load(probes.step_y, k) / height));
            fine.move_to(k, s, t);
            if (blends) coarse.move_to(k, s, t);
            store_floats(xsimd::select(number < count, Doubles(1.0), Doubles(0.0)), weights.at(k));
        }
        RgbT<Floats> color = fine.colors();
        if (blends) color = lerp(color, coarse.colors(), blend);
        sum += color * load(weights, 0);
    }
    Floats count;
    {
        StripOf<float> counts;
        for (std::size_t k = 0; k < Floats::size; k += Doubles::size) store_floats(load(probes.count, k), counts.at(k));
        count = load(counts, 0);
    }
    return sum * (Floats(1.0f) / count);
}

} // namespace duet::raster
