#include "raster/lighting/direct_light.h"

#include "raster/gbuffer/facet_normal.h"
#include "raster/lighting/light_set.h"
#include "raster/lighting/lit_batch.h"

#include <optional>
#include <utility>

namespace duet::raster {
namespace {

constexpr int kTileSide = 16, kBatch = static_cast<int>(Floats::size);

/// Computes the direct light of rows or tiles of the image. Each thread has its own.
class PixelLighter {
public:
    PixelLighter(const GBuffer& gbuffer, std::span<const FrameLight> lights, const LightSet& light_set,
                 std::span<const Medium> media, const LightVisibility* shadows, const ChosenLights& chosen,
                 DirectLight& result)
        : gbuffer_(gbuffer), lights_(lights), light_set_(light_set), media_(media), shadows_(shadows), chosen_(chosen),
          result_(result) {}

    /// Lights a row of pixels by the given lights.
    void light_row(int y, std::span<const WeightedLight> lights) {
        for (int x = 0; x < gbuffer_.width(); x += kBatch) {
            const auto lanes = gbuffer_.visible(x, y);
            store(x, y, lane_bits(lanes) != 0 ? light_batch(x, y, lanes, lights) : Sum());
        }
    }

    /// Lights the tile that starts at column x of row y by the lights that reach it.
    void light_tile(int x, int y) {
        const Cluster tile{.x = x, .y = y, .columns = kTileSide, .rows = kTileSide};
        std::array<Cluster, kDepthSlices> slices;
        const std::size_t count = slices_of_depth(gbuffer_, tile, slices);
        sums_.fill({});
        for (std::size_t k = 0; k < count; ++k) light_cluster(slices[k], light_set_, 0);
        for_each_batch_of(gbuffer_, tile, [&](int column, int row) { store(column, row, sum_at(column, row)); });
    }

private:
    struct Sum {
        RgbT<Floats> exact{Floats(0.0f)}, unshadowed{Floats(0.0f)}, shadowed{Floats(0.0f)};

        void add(const Sum& other) {
            exact += other.exact, unshadowed += other.unshadowed, shadowed += other.shadowed;
        }
        /// Returns the visible fraction of each channel of the light, as DirectLight stores it. A channel that the
        /// surface does not reflect gets the fraction of all channels together, because a filter averages it with its
        /// neighbors.
        RgbT<Floats> lit() const {
            const Floats zero(0.0f), all = unshadowed.r + unshadowed.g + unshadowed.b;
            const Floats of_all = xsimd::select(all > zero, (shadowed.r + shadowed.g + shadowed.b) / all,
                                                Floats(DirectLight::kNoLight));
            const auto fraction = [&](const Floats& whole, const Floats& part) {
                return xsimd::select(whole > zero, part / whole, of_all);
            };
            return {fraction(unshadowed.r, shadowed.r), fraction(unshadowed.g, shadowed.g),
                    fraction(unshadowed.b, shadowed.b)};
        }
    };

    /// Holds the light that the lights of one source send to the viewer if nothing shades them.
    struct SourceLight {
        std::size_t source = LightVisibility::kUnshadowed;
        RgbT<Floats> reflected{Floats(0.0f)};
        Vec3T<Floats> direction{Floats(0.0f), Floats(0.0f), Floats(0.0f)}; ///< sum of unit vectors to the lights

        void add(const RgbT<Floats>& light, const Vec3T<Floats>& wi) {
            reflected += light;
            direction += wi * xsimd::select(max_component(light) > Floats(0.0f), Floats(1.0f), Floats(0.0f));
        }
    };

    /// Clusters of 16 rows are divided into clusters of 4 rows, these into single rows, and each at most twice by
    /// normals.
    static constexpr std::size_t kLevels = 5;
    static constexpr int kDivision = 4;

    /// Finds the lights of a cluster among those of the enclosing cluster, and divides the cluster as long as it has
    /// many.
    void light_cluster(const Cluster& cluster, const LightSet& around, std::size_t level) {
        const std::optional<SurfaceBounds> surfaces = surface_bounds(gbuffer_, cluster);
        if (!surfaces) return;
        float other = 0;
        for (const LightField& field : std::span(fields_).first(field_count_))
            other += average(field.irradiance(surfaces->center(), surfaces->mean_normal()));
        Level& own = levels_[level];
        around.reach(*surfaces, other, own.found);
        const std::size_t distant_before = distant_.size(), fields_before = field_count_;
        for (const std::uint32_t column : own.found.far) distant_.push_back(around.lights()[column]);
        if (!own.found.far.empty()) fields_[field_count_++] = own.found.field;
        const bool divides = chosen_.most == ChosenLights::kAll && level + 1 < kLevels,
                   many = divides && own.found.near.size() > LightSet::kFewLights;
        const auto edge = many ? split_at_edge(gbuffer_, cluster, *surfaces) : std::nullopt;
        if (!edge && (!many || cluster.rows == 1)) {
            constexpr float kGoldenRatio = 0.618034f; // its multiples modulo 1 are evenly spread
            chosen_.random += kGoldenRatio - (chosen_.random + kGoldenRatio < 1 ? 0.0f : 1.0f);
            around.choose(own.found, chosen_.most, chosen_.random, own.lights);
            light_pixels(cluster, own.lights);
        } else {
            own.near.assign(around, own.found.near);
            if (edge)
                for (const Cluster& part : *edge) light_cluster(part, own.near, level + 1);
            else
                light_rows(cluster, own.near, level + 1);
        }
        distant_.resize(distant_before), field_count_ = fields_before;
    }

    void light_rows(Cluster cluster, const LightSet& around, std::size_t level) {
        cluster.rows /= kDivision;
        for (int i = 0; i < kDivision; ++i, cluster.y += cluster.rows) light_cluster(cluster, around, level);
    }

    void light_pixels(const Cluster& cluster, std::span<const WeightedLight> near) {
        for_each_batch_of(gbuffer_, cluster, [&](int x, int y) {
            const xsimd::batch_bool<float> lanes = cluster.lanes(gbuffer_, x, y);
            if (lane_bits(lanes) == 0) return;
            sum_at(x, y).add(light_batch(x, y, lanes, near)); // the batch may be in several clusters
        });
    }

    Sum light_batch(int x, int y, const xsimd::batch_bool<float>& lanes, std::span<const WeightedLight> near) {
        const LitBatch batch(gbuffer_, x, y, lanes, tables_);
        const Vec3T<Floats> facet =
            shadows_ == nullptr ? batch.n() : facet_normals(gbuffer_, batch.p(), batch.n(), x, y);
        Sum sum;
        SourceLight one_source;
        for (const WeightedLight& light : near) {
            const std::size_t source =
                shadows_ == nullptr ? LightVisibility::kUnshadowed : shadows_->source(lights_[light.index].index);
            if (source != one_source.source) add_shadowed(batch, std::exchange(one_source, {source}), facet, x, y, sum);
            const FrameLight& its = lights_[light.index];
            const RgbT<Floats> all = reflected(batch, its, light.weight, LitBatch::Lobes::kAll);
            if (source == LightVisibility::kUnshadowed)
                sum.exact += all;
            else
                one_source.add(all, direction_to(its, batch.p()).wi);
        }
        add_shadowed(batch, one_source, facet, x, y, sum);
        for (const LightField& field : std::span(fields_).first(field_count_))
            sum.exact += batch.diffuse(field.irradiance(batch.p(), batch.n()));
        if (batch.specular())
            for (const std::uint32_t i : distant_)
                sum.exact += reflected(batch, lights_[i], 1, LitBatch::Lobes::kSpecular);
        return sum;
    }

    RgbT<Floats> reflected(const LitBatch& batch, const FrameLight& light, float weight, LitBatch::Lobes lobes) const {
        const RgbT<Floats> all = batch.reflected(light, lobes) * Floats(weight);
        if (media_.empty() || lane_bits(max_component(all) > Floats(0.0f)) == 0) return all;
        const LightDirection to = direction_to(light, batch.p());
        return all * transmittance(optical_depth(media_, batch.p(), to.wi, to.distance));
    }

    /// Adds the light of one shadow source. Its lights share one shadow lookup.
    void add_shadowed(const LitBatch& batch, const SourceLight& light, const Vec3T<Floats>& facet, int x, int y,
                      Sum& sum) const {
        const xsimd::batch_bool<float> lit = max_component(light.reflected) > Floats(0.0f);
        if (light.source == LightVisibility::kUnshadowed || lane_bits(lit) == 0) return;
        const Vec3T<Floats>& to = light.direction;
        const Vec3T<Floats> wi = to * inverse_sqrt(max(dot(to, to), Floats(1e-20f)));
        const Floats visible = shadows_->visibility(light.source, receiver(batch, wi, x, y),
                                                    receiving_normal(batch, wi, facet), x, y, lit);
        const RgbT<Floats> seen = light.reflected * xsimd::select(lit, visible, Floats(0.0f));
        if (shadows_->noisy(light.source))
            sum.unshadowed += light.reflected, sum.shadowed += seen;
        else
            sum.exact += seen;
    }

    /// Returns the points at which a light's shadows are sampled. If the light is low, they lie on the smooth surface
    /// that the facets approximate, because coarse facets would shade themselves. Otherwise they lie on the facets,
    /// which preserves contact shadows.
    Vec3T<Floats> receiver(const LitBatch& batch, const Vec3T<Floats>& wi, int x, int y) const {
        constexpr float kLow = 0.4f, kHigh = 0.8f; // the height falls to 0 between these cosines
        const Vec3T<Floats> n = batch.n(), p = batch.p();
        const Floats low = clamp((Floats(kHigh) - dot(n, wi)) * Floats(1 / (kHigh - kLow)), Floats(0.0f), Floats(1.0f));
        return p + n * (load(gbuffer_.bulge, x, y) * low);
    }

    /// Returns the normals of the receiver planes, which must not shade themselves. A facet that faces the light is its
    /// own receiver plane. A facet that only its shading normal turns toward the light has the shading normal instead.
    static Vec3T<Floats> receiving_normal(const LitBatch& batch, const Vec3T<Floats>& wi, const Vec3T<Floats>& facet) {
        constexpr float kLeastCosine = 0.05f; // the facet turns from the light at 87 degrees
        return select(dot(facet, wi) > Floats(kLeastCosine), facet, batch.n());
    }

    Sum& sum_at(int x, int y) {
        return sums_[static_cast<std::size_t>((y % kTileSide * kTileSide + x % kTileSide) / kBatch)];
    }
    void store(int x, int y, const Sum& sum) {
        result_.exact.set(x, y, sum.exact);
        if (result_.lit.empty()) return;
        result_.unshadowed.set(x, y, sum.unshadowed), result_.lit.set(x, y, sum.lit());
    }

    const GBuffer& gbuffer_;
    std::span<const FrameLight> lights_;
    const LightSet& light_set_;
    std::span<const Medium> media_; ///< relative to the eye
    const LightVisibility* shadows_;
    ChosenLights chosen_; ///< its random number is new for each cluster
    DirectLight& result_;
    LitBatch::Tables tables_;
    struct Level {
        LightsOfCluster found;
        LightSet near;                     ///< the near lights of `found`, for the parts of the cluster
        std::vector<WeightedLight> lights; ///< the chosen lights, with their weights
    };
    std::array<Level, kLevels> levels_;
    std::array<LightField, kLevels> fields_; ///< distant lights of the enclosing clusters
    std::size_t field_count_ = 0;
    std::vector<std::uint32_t> distant_;
    std::array<Sum, kTileSide * kTileSide / Floats::size> sums_; ///< one per batch of the tile
};

} // namespace

void compute_direct_light(const RasterSceneData& data, const RasterSettings& settings, const GBuffer& gbuffer,
                          std::span<const FrameLight> lights, const LightVisibility* shadows, DirectLight& light,
                          const ChosenLights& chosen) {
    const int width = gbuffer.width(), height = gbuffer.height();
    const bool noisy = shadows != nullptr && std::ranges::any_of(lights, [&](const FrameLight& its) {
        const std::size_t source = shadows->source(its.index);
        return source != LightVisibility::kUnshadowed && shadows->noisy(source);
    });
    light.exact.set_size(width, height);
    for (Planes3* image : {&light.unshadowed, &light.lit}) {
        if (noisy)
            image->set_size(width, height);
        else
            *image = {};
    }
    const std::vector<Medium> media = frame_media(data.scene.media, settings, gbuffer.projection);
    const LightSet light_set(lights, shadows, media.empty());
    const bool few = lights.size() <= LightSet::kFewLights; // then lists of lights would save nothing
    std::vector<WeightedLight> all_of_few;
    if (few)
        for (const std::uint32_t i : light_set.lights()) all_of_few.push_back({i, 1});
    parallel_for(static_cast<std::size_t>((height + kTileSide - 1) / kTileSide), settings.threads, [&](std::size_t i) {
        PixelLighter lighter(gbuffer, lights, light_set, media, shadows, chosen, light);
        const int first = static_cast<int>(i) * kTileSide;
        if (few)
            for (int y = first; y < std::min(first + kTileSide, height); ++y) lighter.light_row(y, all_of_few);
        else
            for (int x = 0; x < width; x += kTileSide) lighter.light_tile(x, first);
    });
}

} // namespace duet::raster
