// Computes the light of froxels.
#include "raster/fog/fog_grid.h"

#include "common/medium/phase_function.h"
#include "raster/fog/pixel_rays.h"
#include "raster/lighting/light_set.h"
#include "raster/shadows/space_shadows.h"

#include <algorithm>
#include <cmath>

namespace duet::raster {
namespace {

using Vec3s = Vec3T<Floats>;
using Color = RgbT<Floats>;
using Lanes = xsimd::batch_bool<float>;
constexpr int kBatch = static_cast<int>(Floats::size);
const Floats kNone(0.0f), kOne(1.0f);

/// Returns the single-scattering albedo of a medium, scattering / (scattering + absorption), per channel.
Rgb albedo(const Medium& medium) {
    const Rgb& s = medium.scattering;
    const Rgb all = s + medium.absorption;
    return {s.r > 0 ? s.r / all.r : 0, s.g > 0 ? s.g / all.g : 0, s.b > 0 ? s.b / all.b : 0};
}

} // namespace

/// Represents the rays through the middles of a batch of columns of froxels.
struct FogGrid::Columns {
    Vec3s origin, direction;
    std::vector<IntervalT<Floats>> inside; ///< intervals of the rays inside each medium
    Floats surface;                        ///< distance of the farthest surface in the columns themselves
    float farthest = 0;                    ///< distance up to which light is needed
};

FogGrid::Columns FogGrid::columns(int x, int y) const {
    const auto pixel = [&](int i) { return static_cast<float>(i * side_); };
    const Vec3s p = projection_->point(lane_offsets(pixel(x), pixel(1)), Floats(pixel(y)), kOne);
    Columns result;
    result.direction = projection_->to_viewer(p) * Floats(-1.0f);
    result.origin = p - result.direction * projection_->distance(p);
    for (const Medium& medium : media_)
        result.inside.push_back(overlap(medium.box, result.origin, result.direction, Floats(kInfinity)));
    result.surface = load(farthest_, x, y);
    // Pixels interpolate between neighboring columns, so light is needed as far as the neighbors need it.
    for (int row = std::max(y - 1, 0); row <= std::min(y + 1, rows_ - 1); ++row)
        for (int i = std::max(x - 1, 0); i <= std::min(x + kBatch, columns_ - 1); ++i)
            result.farthest = std::max(result.farthest, farthest_(i, row));
    return result;
}

/// Finds the distances between which the view shows media, and divides them into slices. The slices are about equal up
/// to the distance of the camera's look-at point, and grow in proportion to the distance beyond.
void FogGrid::find_distances(const GBuffer& gbuffer, const FogOptions& options) {
    farthest_ = PlaneFloat(columns_, rows_);
    parallel_for(static_cast<std::size_t>(rows_), options.threads, [&](std::size_t i) {
        const int row = static_cast<int>(i), first = row * side_ - side_ / 2;
        for (int y = std::max(first, 0); y < std::min(first + side_, gbuffer.height()); ++y)
            for (int x = 0; x < gbuffer.width(); x += kBatch) {
                alignas(64) std::array<float, kBatch> distances;
                const Floats distance = PixelRays(gbuffer, x, y).distance;
                const Lanes counts = options.background ? Lanes(true) : gbuffer.visible(x, y);
                xsimd::select(counts, distance, kNone).store_aligned(distances.data());
                for (int lane = 0; lane < std::min(kBatch, gbuffer.width() - x); ++lane) {
                    float& most = farthest_((x + lane + side_ / 2) / side_, row);
                    most = std::max(most, distances[static_cast<std::size_t>(lane)]);
                }
            }
    });
    float begin = kInfinity, end = 0;
    for (int y = 0; y < rows_; ++y)
        for (int x = 0; x < columns_; x += kBatch) {
            const Columns some = columns(x, y);
            for (const IntervalT<Floats>& inside : some.inside) {
                const Lanes seen = (!inside.empty()) & (inside.begin < Floats(some.farthest));
                if (lane_bits(seen) == 0) continue;
                begin = std::min(begin, reduce_min(xsimd::select(seen, inside.begin, Floats(kInfinity))));
                end = std::max(end, reduce_max(xsimd::select(seen, min(inside.end, Floats(some.farthest)), kNone)));
            }
        }
    if (!(begin < end)) begin = end = 0;
    if (end == kInfinity) { // a medium has no bounds: cut it off where its transmittance is negligible
        constexpr float kDepths = 12; // optical depths, of which 6e-6 of the light pass
        float least = kInfinity;
        for (const Medium& medium : media_)
            for (std::size_t c = 0; c < 3; ++c)
                if (const float extinction = medium.scattering[c] + medium.absorption[c]; extinction > 0)
                    least = std::min(least, extinction);
        end = begin + kDepths / least;
    }
    end = std::min(end, 1e12f); // so that its square does not overflow a float
    nearest_ = begin;
    const float range = std::log1p((end - begin) / scale_);
    slices_per_log_ = range > 0 ? static_cast<float>(slices_) / range : 0;
    distances_.resize(static_cast<std::size_t>(slices_) + 1);
    for (std::size_t k = 0; k < distances_.size(); ++k)
        distances_[k] = begin + scale_ * std::expm1(range * static_cast<float>(k) / static_cast<float>(slices_));
}

/// Computes the light of the grid, one batch of columns after another. Each thread has its own.
class FogGrid::Lighter {
public:
    Lighter(const FogGrid& grid, std::span<const FrameLight> lights, const LightSet& light_set,
            const SpaceShadows* shadows, const AmbientLight& ambient)
        : grid_(grid), lights_(lights), light_set_(light_set), shadows_(shadows), ambient_(ambient),
          crossed_(grid.media_.size(), kNone) {}

    /// Stores, for each slice's end, the in-scattered and emitted radiance between the eye and that distance and,
    /// unless `stopped` is empty, the opacity of the media.
    void light_columns(int x, int y, Planes3& result, Planes3& stopped) {
        const Columns columns = grid_.columns(x, y);
        Color sum(kNone), through(kOne);
        const auto store = [&](int ends) {
            result.set(x, grid_.row(y, ends), sum);
            if (!stopped.empty()) stopped.set(x, grid_.row(y, ends), Color(kOne) - through);
        };
        store(0);
        for (int k = 0; k < grid_.slices_; ++k) {
            const auto slice = static_cast<std::size_t>(k);
            const float begin = grid_.distances_[slice], end = grid_.distances_[slice + 1];
            if (begin >= columns.farthest) break;
            if (k % kClusterSlices == 0) find_lights(columns, k);
            add_slice(columns, {begin, end}, sum, through);
            store(k + 1);
        }
    }

private:
    static constexpr int kClusterSlices = 4; ///< slices in a row that share a list of lights

    /// Finds the lights that reach the slices from the k-th on. The bounds admit all normals, because points in a
    /// volume have none.
    void find_lights(const Columns& columns, int k) {
        const auto first = static_cast<std::size_t>(k),
                   last = std::min(first + kClusterSlices, static_cast<std::size_t>(grid_.slices_));
        SurfaceBounds bounds{Vec3(kInfinity, kInfinity, kInfinity), {}, Vec3(-1, -1, -1), Vec3(1, 1, 1)};
        bounds.p_high = -bounds.p_low;
        for (const float distance : {grid_.distances_[first], grid_.distances_[last]}) {
            const Vec3s p = columns.origin + columns.direction * Floats(distance);
            bounds.p_low = min(bounds.p_low, Vec3(reduce_min(p.x), reduce_min(p.y), reduce_min(p.z)));
            bounds.p_high = max(bounds.p_high, Vec3(reduce_max(p.x), reduce_max(p.y), reduce_max(p.z)));
        }
        light_set_.reach(bounds, 0, found_);
        constexpr float kGoldenRatio = 0.618034f; // its multiples modulo 1 are evenly spread
        random_ += kGoldenRatio - (random_ + kGoldenRatio < 1 ? 0.0f : 1.0f);
        light_set_.choose(found_, kMostLights, random_, near_);
    }

    /// Adds the light of a slice to the sum, and multiplies the transmittance before it by its own. Light that is
    /// scattered evenly along the slice is attenuated in closed form (Hillaire 2015, "Physically Based and Unified
    /// Volumetric Rendering in Frostbite", §5).
    void add_slice(const Columns& columns, Interval slice, Color& sum, Color& through) {
        const Floats begin(slice.begin), end(slice.end);
        IntervalT<Floats> piece{end, begin}; // interval that contains media; empty at first
        Color depth(kNone), scattering(kNone), light(kNone);
        for (std::size_t i = 0; i < crossed_.size(); ++i) {
            const Medium& medium = grid_.media_[i];
            const IntervalT<Floats> inside{max(columns.inside[i].begin, begin), min(columns.inside[i].end, end)};
            const Floats length = crossed_[i] = column_of(medium, columns.origin, columns.direction, inside);
            const Lanes in = length > kNone;
            if (lane_bits(in) == 0) continue;
            piece.begin = xsimd::select(in, min(piece.begin, inside.begin), piece.begin);
            piece.end = xsimd::select(in, max(piece.end, inside.end), piece.end);
            depth += broadcast<Floats>(medium.scattering + medium.absorption) * length;
            scattering += broadcast<Floats>(medium.scattering) * length;
            light += broadcast<Floats>(medium.absorption * medium.radiance) * length;
        }
        const Lanes any = piece.begin < piece.end;
        if (lane_bits(any) == 0) return;
        if (lane_bits(max_component(scattering) > kNone) != 0) {
            const Floats width = grid_.projection_->pixel_size(begin) * Floats(static_cast<float>(grid_.side_));
            // Froxels behind a surface get the light at the surface, because pixels in front of it interpolate with
            // them.
            piece = {min(xsimd::select(any, piece.begin, begin), columns.surface),
                     min(xsimd::select(any, piece.end, end), columns.surface)};
            const RayPieces rays{columns.origin, columns.direction, piece, width};
            for (const WeightedLight& near : near_) add_light(lights_[near.index], near.weight, rays, light);
            if (ambient_) light += scattering * ambient_(rays.p());
        }
        sum += through * light * mean_transmittance(depth);
        through *= transmittance(depth);
    }

    /// Adds the radiance of a light that the slice scatters to the viewer. Multiple scattering in clouds is estimated
    /// by octaves, as if the light came through thinner media that scatter more evenly (Wrenninge et al. 2013, "Oz: The
    /// Great and Volumetric"). Each octave is weighted by the fraction of light that the media stop. Multiple
    /// scattering in uniform fog is left to the probes.
    void add_light(const FrameLight& light, float weight, const RayPieces& rays, Color& sum) const {
        const Vec3s p = rays.p();
        const LightDirection to = direction_to(light, p);
        Color arriving = light_in_space(light, to, rays) * Floats(weight);
        if (lane_bits(max_component(arriving) > kNone) == 0) return;
        if (shadows_ != nullptr) arriving *= shadows_->visibility(light.index, p);
        if (lane_bits(max_component(arriving) > kNone) == 0) return;
        const Color depth = optical_depth<Floats>(grid_.media_, p, to.wi, to.distance), through = transmittance(depth);
        sum += arriving * through * scattered(rays.direction, to.wi, 0);
        for (int octave = 1; octave < kOctaves && !grid_.stopped_.empty(); ++octave) {
            arriving *= Color(kOne) - through;
            if (lane_bits(max_component(arriving) > kNone) == 0) break;
            const float thinness = std::ldexp(1.0f, -octave);
            sum += arriving * transmittance(depth * Floats(thinness)) * scattered(rays.direction, to.wi, octave);
        }
    }

    /// Returns the fraction of the light from direction wi that the slice scatters toward the viewer in an octave,
    /// 1/sr.
    Color scattered(const Vec3s& direction, const Vec3s& wi, int octave) const {
        Color sum(kNone);
        for (std::size_t i = 0; i < crossed_.size(); ++i) {
            const Medium& medium = grid_.media_[i];
            if (is_black(medium.scattering) || (octave > 0 && !medium.density)) continue;
            Rgb scattering = medium.scattering;
            for (int k = 0; k < octave; ++k) scattering *= albedo(medium);
            const float asymmetry = std::ldexp(medium.asymmetry, -octave);
            sum += broadcast<Floats>(scattering) * (crossed_[i] * phase(direction, wi, asymmetry));
        }
        return sum;
    }

    static constexpr int kOctaves = 4; ///< of scattering in clouds; the last has an eighth of the optical depth

    const FogGrid& grid_;
    std::span<const FrameLight> lights_;
    const LightSet& light_set_;
    const SpaceShadows* shadows_;
    const AmbientLight& ambient_;
    std::vector<Floats, xsimd::aligned_allocator<Floats>> crossed_; ///< column_of() of each medium in the slice
    LightsOfCluster found_;
    std::vector<WeightedLight> near_;
    float random_ = 0;
};

void FogGrid::compute(const RasterSceneData& data, const RasterSettings& settings, const GBuffer& gbuffer,
                      const AmbientLight& ambient, const FogOptions& options) {
    projection_ = gbuffer.projection;
    media_ = frame_media(data.scene.media, settings, *projection_);
    if (media_.empty()) return;
    side_ = options.side, slices_ = options.slices;
    const auto count = [&](int pixels) { return (pixels + side_ - 2) / side_ + 1; }; // each pixel lies between two
    columns_ = count(gbuffer.width()), rows_ = count(gbuffer.height());
    const Camera& camera = data.scene.camera;
    scale_ = static_cast<float>(std::max(length(camera.look_at - camera.eye), 1e-6));
    find_distances(gbuffer, options);
    light_.set_size(columns_, rows_ * (slices_ + 1));
    const bool varies = std::ranges::any_of(media_, [](const Medium& medium) { return medium.density != nullptr; });
    if (varies)
        stopped_.set_size(columns_, rows_ * (slices_ + 1));
    else
        stopped_ = {};
    std::vector<FrameLight> lights = scene_lights(data, settings, *projection_);
    for (const FrameLight& sun : sun_lights(data, settings, *projection_)) lights.push_back(sun);
    const LightSet light_set(lights, nullptr);
    std::optional<SpaceShadows> shadows;
    if (settings.shadows && data.shadows) shadows.emplace(data, projection_->eye(), options.time);
    parallel_for(static_cast<std::size_t>(rows_), options.threads, [&](std::size_t y) {
        Lighter lighter(*this, lights, light_set, shadows ? &*shadows : nullptr, ambient);
        for (int x = 0; x < columns_; x += kBatch) lighter.light_columns(x, static_cast<int>(y), light_, stopped_);
    });
}

} // namespace duet::raster
