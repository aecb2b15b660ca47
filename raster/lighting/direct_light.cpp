#include "raster/lighting/direct_light.h"

#include "raster/lighting/light_clusters.h"
#include "raster/lighting/lit_batch.h"

namespace duet::raster {
namespace {

/// Computes the direct light of one tile after another, on one thread.
class TileLighter {
public:
    TileLighter(const GBuffer& gbuffer, std::span<const FrameLight> lights, const LightClusters& clusters,
                const ShadowLookup* shadows, DirectLight& result)
        : gbuffer_(gbuffer), lights_(lights), clusters_(clusters), shadows_(shadows), result_(result) {}

    void light_tile(int x0, int y0) {
        clusters_.list(gbuffer_, x0, y0, reaching_);
        constexpr int kLanes = static_cast<int>(Floats::size), kSide = LightClusters::kTileSide;
        std::size_t batch = 0;
        for (int y = y0; y < y0 + kSide; ++y)
            for (int x = x0; x < x0 + kSide; x += kLanes, ++batch)
                if (x < gbuffer_.width() && y < gbuffer_.height()) light_batch(x, y, reaching_.batch_slices[batch]);
    }

private:
    void light_batch(int x, int y, std::uint32_t slices) {
        const LitBatch batch(gbuffer_, x, y, tables_);
        RgbT<Floats> unshadowed(Floats(0.0f)), shadowed(Floats(0.0f));
        for (const TileLights::Entry& entry : reaching_.entries) {
            if ((entry.slices & slices) == 0 || batch.empty()) continue;
            const FrameLight& light = lights_[entry.light];
            const RgbT<Floats> reflected = batch.reflected(light);
            unshadowed += reflected;
            if (shadows_ == nullptr) continue;
            const xsimd::batch_bool<float> lit = max_component(reflected) > Floats(0.0f);
            if (lane_bits(lit) == 0) continue;
            const Floats visible = shadows_->visibility(light.index, batch.p(), batch.n(), x, y, lit);
            shadowed += reflected * xsimd::select(lit, visible, Floats(0.0f));
        }
        result_.unshadowed.set(x, y, unshadowed);
        if (shadows_ != nullptr) result_.shadowed.set(x, y, shadowed);
    }

    const GBuffer& gbuffer_;
    std::span<const FrameLight> lights_;
    const LightClusters& clusters_;
    const ShadowLookup* shadows_;
    DirectLight& result_;
    TileLights reaching_;
    LitBatch::Tables tables_;
};

} // namespace

DirectLight direct_light(const PreparedData& data, const Settings& settings, const GBuffer& gbuffer,
                         const ShadowLookup* shadows) {
    const int width = gbuffer.width(), height = gbuffer.height();
    DirectLight result;
    result.unshadowed = Planes3(width, height);
    if (shadows != nullptr) result.shadowed = Planes3(width, height);
    if (!settings.parts.direct) return result;
    const std::vector<FrameLight> lights = frame_lights(data.scene.lights, gbuffer.projection);
    if (lights.empty()) return result;
    const LightClusters clusters(lights);
    constexpr int kSide = LightClusters::kTileSide;
    parallel_for(static_cast<std::size_t>((height + kSide - 1) / kSide), settings.threads, [&](std::size_t row) {
        TileLighter lighter(gbuffer, lights, clusters, shadows, result);
        for (int x = 0; x < width; x += kSide) lighter.light_tile(x, static_cast<int>(row) * kSide);
    });
    return result;
}

void add(const DirectLight& light, int threads, Planes3& radiance) {
    for_each_batch(radiance.x.width(), radiance.x.height(), threads, [&](int x, int y) {
        radiance.set(x, y, radiance.color(x, y) + light.arriving().color(x, y));
    });
}

} // namespace duet::raster
