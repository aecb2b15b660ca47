#include "raster/shading/blended_layers.h"

#include "raster/visibility/hit_lists.h"

#include "common/system/parallel.h"

namespace duet::raster {

BlendedLayers::BlendedLayers(const SampleView& sample, GBuffer& gbuffer, Planes3& emission) {
    struct TileLayers {
        std::vector<std::vector<Surface>> layers;
        std::vector<Attenuation> attenuations;
    };
    std::vector<TileLayers> tiles(sample.grid.size());
    fill_gbuffer(sample, gbuffer, emission, [&](std::size_t i, HitTile& tile, HitLists& lists) {
        const PixelRect& rect = tile.rect();
        struct Pixel {
            float transmittance = 1;
            std::uint32_t count = 0;
        };
        Image<Pixel> pixels(rect.width(), rect.height());
        TileLayers& found = tiles[i];
        lists.for_each([&](int x, int y, const Hit& hit) {
            const float alpha = opacity(sample.data.scene, tile.ray(x, y), hit);
            if (alpha == 0) return false;
            const Hit behind = tile.exchange(x, y, hit);
            const float reversed_depth = tile.reversed_depth(x, y);
            if (alpha == 1) {
                store_hit(sample, x, y, hit, reversed_depth, gbuffer, emission);
                return true;
            }
            tile.exchange(x, y, behind);
            Pixel& pixel = pixels(x - rect.x0, y - rect.y0);
            if (found.layers.size() <= pixel.count) found.layers.emplace_back();
            found.layers[pixel.count++].push_back({x, y, hit, reversed_depth, pixel.transmittance * alpha});
            pixel.transmittance *= 1 - alpha;
            return pixel.transmittance < kLeastTransmittance;
        });
        for (int y = rect.y0; y < rect.y1; ++y)
            for (int x = rect.x0; x < rect.x1; ++x)
                if (const Pixel& pixel = pixels(x - rect.x0, y - rect.y0); pixel.count > 0)
                    found.attenuations.push_back({x, y, pixel.transmittance});
    });
    for (const TileLayers& tile : tiles) {
        if (layers_.size() < tile.layers.size()) layers_.resize(tile.layers.size());
        for (std::size_t k = 0; k < tile.layers.size(); ++k)
            layers_[k].insert(layers_[k].end(), tile.layers[k].begin(), tile.layers[k].end());
        attenuations_.insert(attenuations_.end(), tile.attenuations.begin(), tile.attenuations.end());
    }
}

void BlendedLayers::fill(const SampleView& sample, std::size_t k, GBuffer& gbuffer, Planes3& emission) const {
    clear(gbuffer, emission);
    const std::vector<Surface>& surfaces = layers_[k];
    parallel_for(surfaces.size(), sample.settings.threads, [&](std::size_t i) {
        const Surface& s = surfaces[i];
        store_hit(sample, s.x, s.y, s.hit, s.reversed_depth, gbuffer, emission);
    });
}

void BlendedLayers::add(std::size_t k, const Planes3& layer, Planes3& radiance) const {
    for (const Surface& s : layers_[k])
        radiance.set_at(s.x, s.y, radiance.color_at(s.x, s.y) + layer.color_at(s.x, s.y) * s.weight);
}

void BlendedLayers::attenuate(Planes3& radiance) const {
    for (const Attenuation& a : attenuations_)
        radiance.set_at(a.x, a.y, radiance.color_at(a.x, a.y) * a.transmittance);
}

} // namespace duet::raster
