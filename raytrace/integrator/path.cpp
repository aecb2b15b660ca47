// Unidirectional path tracing with next event estimation: at each vertex a light sample and a BSDF sample, combined by
// multiple importance sampling (Kajiya 1986; Veach 1997, §9 and §10). Without light samples (plan.lights is null)
// it is the naive path tracer, in which only chance finds the lights.
#include "raytrace/integrator/insides.h"
#include "raytrace/integrator/integrator.h"
#include "raytrace/integrator/light_sampling.h"
#include "raytrace/integrator/plain_vertices.h"
#include "raytrace/integrator/path_footprint.h"
#include "raytrace/integrator/path_gains.h"
#include "raytrace/integrator/path_log.h"

#include <array>
#include <type_traits>
#include <utility>
#include <vector>

namespace duet::raytrace {

namespace {

// What becomes of the light that a path finds: in a picture it is added up, whatever way it came.
class Sum {
public:
    static constexpr bool kTold = false; // whether it has a log that is told of all
    void start(const Bsdf&) {}
    void add(Rgb light, LightSource, int) { total_ += light; }
    void add_shadowed(Rgb, LightSource, int) {}
    Rgb result() const { return total_; }

private:
    Rgb total_;
};

// Or it goes to the part it belongs to. `bounces` is the number of scatterings between the light and the camera.
class Split {
public:
    static constexpr bool kTold = false;
    void start(const Bsdf& first) {
        diffuse_ = is_diffuse(first);
        specular_ = is_specular(first);
    }
    void add(Rgb light, LightSource source, int bounces) { part(source, bounces) += light; }
    void add_shadowed(Rgb light, LightSource source, int bounces) {
        if (bounces == 1 && source == LightSource::kLight) parts_.shadowed += light;
    }
    const LightParts& result() const { return parts_; }

private:
    Rgb& part(LightSource source, int bounces) {
        if (bounces == 0) return parts_.emission;
        if (bounces == 1 && source == LightSource::kLight && !specular_) return parts_.direct;
        if (!diffuse_) return parts_.reflection;
        return bounces == 1 && source == LightSource::kEnvironment ? parts_.environment : parts_.indirect;
    }

    LightParts parts_;
    bool diffuse_ = false, specular_ = false; // the first hit
};

// Or each step is told, too.
template <typename Log> class Told : public Sum {
public:
    static constexpr bool kTold = true;
    explicit Told(Log& log) : log_(log) {}
    Log& log() { return log_; }

private:
    Log& log_;
};

// What a path keeps where no dielectric knows of others: nothing.
struct NoInsides {
    explicit NoInsides(const RenderPlan&) {}
    static constexpr float relative_index() { return 0; }
};

// The numbers of the vertex that a ray has found, if it is one that uses any.
VertexNumbers numbers_at(const RenderPlan& plan, Sampler& sampler, const Hit& hit, int depth) {
    return hit.valid() && depth < plan.max_depth ? vertex_numbers(sampler, depth) : VertexNumbers{};
}

template <typename Sink, bool kInsides> class Path {
public:
    Path(const RenderPlan& plan, const Sampler& sampler, RayCounts& counts, Sink sink = {})
        : plan_(plan), counts_(counts), sink_(sink), insides_(plan), footprint_(plan, sampler.sample()) {}

    /// The light along a camera ray, as the sink keeps it.
    auto trace(Sampler& sampler, Ray ray, Hit hit) {
        for (int depth = 0; advance(ray, hit, depth, numbers_at(plan_, sampler, hit, depth)); ++depth)
            hit = plan_.prepared.accelerator.closest(ray);
        return result();
    }

    /// What the ray has found after `depth` scatterings: adds the light, and turns the ray into the one that goes on from
    /// there. False where the path ends.
    bool advance(Ray& ray, const Hit& found, int depth, const VertexNumbers& u) {
        Hit reached;
        if constexpr (kInsides) reached = arrive(ray, found);
        const Hit& hit = kInsides ? std::as_const(reached) : found;
        if (!hit.valid()) {
            if constexpr (Sink::kTold) sink_.log().escape(ray, depth);
            add_environment(ray.direction, depth);
            return false;
        }
        const Vertex vertex(plan_, ray, hit, footprint_.arrive(ray, hit.t), insides_.relative_index());
        if constexpr (Sink::kTold) sink_.log().vertex(vertex, hit, depth);
        if (depth == 0) sink_.start(vertex.bsdf);
        add_emission(vertex, ray.direction, depth);
        if (depth == plan_.max_depth) return tell_end("it is as long as it may be (--depth)");
        const bool specular = is_specular(vertex.bsdf) && !plan_.mirror_light;
        if (plan_.lights != nullptr && !specular) add_light_sample(vertex, u, depth);
        if (depth + 1 == plan_.max_depth && !plan_.hits_find_light) return tell_end("nothing is left to find");
        if (!scatter(vertex, u, ray)) return false;
        if (plan_.russian_roulette && depth > 0 && !survives(u.roulette)) return false;
        ++counts_.indirect;
        return true;
    }
    auto result() const { return sink_.result(); }

    /// What a vertex that others scatter it at changes.
    PathState& state() { return state_; }
    void add(Rgb light) { sink_.add(light, LightSource::kLight, 0); }

private:
    void add_environment(Vec3 w, int bounces) {
        if (plan_.environment == nullptr) return;
        float weight = 1;
        if (!state_.departure.certain)
            weight = mis_weight(state_.departure.pdf,
                                arrival_pdf(*plan_.environment, *plan_.lights, state_.departure.receiver, w));
        const Rgb emission = radiance(*plan_.environment, w);
        if constexpr (Sink::kTold) sink_.log().found(emission, weight, state_.throughput * emission * weight);
        sink_.add(state_.throughput * emission * weight, LightSource::kEnvironment, bounces);
    }

    void add_emission(const Vertex& vertex, Vec3 direction, int bounces) {
        if (!plan_.emission) return;
        const Rgb emission = emitted(vertex.material, plan_.scene.textures, vertex.point, -direction);
        if (is_black(emission)) return;
        float weight = 1;
        if (!state_.departure.certain)
            weight = mis_weight(state_.departure.pdf,
                                arrival_pdf(plan_.scene, *plan_.lights, state_.departure.receiver, vertex.point));
        if constexpr (Sink::kTold) sink_.log().found(emission, weight, state_.throughput * emission * weight);
        sink_.add(state_.throughput * emission * weight, source_of(vertex.point), bounces);
    }

    void add_light_sample(const Vertex& vertex, const VertexNumbers& u, int bounces) {
        const auto arrival = sample_arrival(plan_.scene, *plan_.lights, vertex.receiver(), u.light_choice, u.light);
        if (!arrival) return tell_no_light_sample("the chosen light does not shine here");
        Rgb scattered = vertex.scattered(arrival->wi) * arrival->radiance;
        if constexpr (kInsides) scattered *= left_on_the_way(vertex, *arrival);
        if (is_black(scattered) && !plan_.black_shadow_rays)
            return tell_no_light_sample("the surface does not scatter the chosen light towards here");
        const LightSource source = arrival->light < 0 ? LightSource::kEnvironment : LightSource::kLight;
        ++counts_.shadow;
        if (!reaches(plan_, vertex, *arrival)) {
            if constexpr (Sink::kTold) sink_.log().light_sample(*arrival, scattered, false, 0, Rgb());
            sink_.add_shadowed(state_.throughput * scattered / arrival->pdf, source, bounces + 1);
            return;
        }
        // The environment and all still emitters are found by BSDF samples, too.
        const float bsdf_pdf = arrival->delta ? 0 : pdf(vertex.bsdf, vertex.wo, vertex.frame.to_local(arrival->wi));
        const float weight = mis_weight(arrival->pdf, bsdf_pdf);
        const Rgb light = state_.throughput * scattered * (weight / arrival->pdf);
        if constexpr (Sink::kTold) sink_.log().light_sample(*arrival, scattered, true, weight, light);
        sink_.add(light, source, bounces + 1);
    }

    // Asked for the sink that splits alone: a sum need not know.
    LightSource source_of(const SurfacePoint& point) const {
        if constexpr (std::is_same_v<Sink, Sum>) return LightSource::kLight;
        const bool sampled = surface_light_index(plan_.scene, point.object, point.primitive) >= 0;
        return sampled ? LightSource::kLight : LightSource::kOther;
    }

    // Chooses the next direction by the BSDF; false where the path ends.
    bool scatter(const Vertex& vertex, const VertexNumbers& u, Ray& ray) {
        const auto s = sample(vertex.bsdf, vertex.wo, u.lobe, u.bsdf);
        if (!s || is_black(s->weight)) return tell_end("the surface absorbs it");
        const Vec3 wi = normalize(vertex.frame.to_world(s->wi));
        if (!vertex.consistent(wi, s->wi)) return tell_end("its direction lies between the horizons of both normals");
        state_.throughput *= s->weight;
        if (s->transmitted) note_refraction(vertex);
        if constexpr (Sink::kTold) sink_.log().scattered(vertex, *s, wi, state_);
        footprint_.scatter(s->pdf, s->specular);
        // Each number is written where it is read from next: a whole ray copied right after it was put together would
        // wait for its parts.
        state_.departure.certain = s->specular || plan_.lights == nullptr;
        if (!state_.departure.certain) {
            state_.departure.receiver = vertex.receiver();
            state_.departure.pdf = s->pdf;
        }
        ray.origin = offset_origin(vertex.point, wi);
        ray.direction = wi;
        ray.t_min = 0;
        return true;
    }

    // Entering glass scales the throughput by 1/η², leaving it by η²: no reason to end or to favour a path.
    void note_refraction(const Vertex& vertex) {
        const float eta = refraction_index(vertex.bsdf);
        state_.refraction *= vertex.wo.z > 0 ? 1 / sqr(eta) : sqr(eta);
        if constexpr (kInsides)
            if (crosses(vertex)) insides_.cross(vertex.point.material, vertex.wo.z > 0);
    }

    // Goes on to where the ray meets something that is there, in scenes with dielectrics that know of each other.
    Hit arrive(Ray& ray, const Hit& found) {
        int passed = 0;
        const Hit hit = insides_.arrive(ray, found, state_.throughput, passed);
        counts_.indirect += passed;
        if (passed > 0) state_.departure.certain = true; // shadow rays end at any boundary
        return hit;
    }

    static bool crosses(const Vertex& vertex) {
        const auto* glass = std::get_if<Dielectric>(&vertex.material);
        return glass != nullptr && !glass->thin;
    }

    // Of a light sample's light, what is not absorbed by what the vertex, or its other side, is inside of.
    Rgb left_on_the_way(const Vertex& vertex, const Arrival& arrival) const {
        if (same_hemisphere(vertex.wo, vertex.frame.to_local(arrival.wi)) || !crosses(vertex))
            return insides_.transmittance(arrival.distance);
        Insides beyond = insides_;
        beyond.cross(vertex.point.material, vertex.wo.z > 0);
        return beyond.transmittance(arrival.distance);
    }

    bool survives(float u) {
        const float probability = survival(state_.throughput, state_.refraction, plan_.worth);
        if (!(probability < 1)) return true; // nor is what is no number dropped: it is to be counted
        if constexpr (Sink::kTold) sink_.log().roulette(probability, u < probability);
        if (!(u < probability)) {
            ++counts_.ended;
            return false;
        }
        state_.throughput *= 1 / probability;
        return true;
    }

    bool tell_end([[maybe_unused]] const char* why) {
        if constexpr (Sink::kTold) sink_.log().end(why);
        return false;
    }
    void tell_no_light_sample([[maybe_unused]] const char* why) {
        if constexpr (Sink::kTold) sink_.log().no_light_sample(why);
    }

    const RenderPlan& plan_;
    RayCounts& counts_;
    Sink sink_;
    PathState state_;
    std::conditional_t<kInsides, Insides, NoInsides> insides_;
    PathFootprint footprint_;
};

// The numbers of the vertices of some paths, by path; two at a time.
void draw_numbers(std::span<Sampler> samplers, std::span<const std::uint32_t> which, int depth,
                  std::vector<VertexNumbers>& numbers) {
    std::size_t k = 0;
    for (const std::uint32_t i : which) go_to_vertex(samplers[i], depth);
    for (; k + 1 < which.size(); k += 2) {
        const auto [first, second] = Sampler::get_blocks(samplers[which[k]], samplers[which[k + 1]]);
        numbers[which[k]] = vertex_numbers(first);
        numbers[which[k + 1]] = vertex_numbers(second);
    }
    if (k < which.size()) numbers[which[k]] = vertex_numbers(samplers[which[k]].get_block());
}

// Paths side by side. Those that stand at plain surfaces of one kind advance several at once.
template <bool kInsides> class Paths {
public:
    Paths(const RenderPlan& plan, std::span<Ray> rays, std::span<Hit> hits, std::span<Sampler> samplers, RayCounts& counts)
        : plan_(plan), rays_(rays), hits_(hits), samplers_(samplers), counts_(counts), found_(rays.size()), sorted_(rays.size()),
          numbers_(rays.size()), shadows_(plan) {
        paths_.reserve(rays.size());
        going_.reserve(rays.size());
        for (std::uint32_t i = 0; i < rays.size(); ++i) {
            paths_.emplace_back(plan, samplers[i], counts);
            going_.push_back(i);
        }
    }

    void trace(std::span<Rgb> radiances) {
        for (int depth = 0; !going_.empty(); ++depth) {
            advance(depth);
            shadows_.send([&](std::uint32_t i, Rgb light) { paths_[i].add(light); });
            find_hits();
        }
        for (std::size_t i = 0; i < paths_.size(); ++i) radiances[i] = paths_[i].result();
    }

private:
    using Kind = PlainSurfaces::Kind;
    using Scattering = PlainSurfaces::Scattering;
    static constexpr std::size_t kFewest = 3; // to go side by side

    void find_hits() {
        const Accelerator& accelerator = plan_.prepared.accelerator;
        if (accelerator.gathers_scattered()) return accelerator.closest_of_scattered(rays_, going_, hits_);
        for (const std::uint32_t i : going_) hits_[i] = accelerator.closest(rays_[i]);
    }

    void advance(int depth) {
        sort_by_found(depth);
        for (const std::uint32_t i : found(PlainSurfaces::kNothing)) paths_[i].advance(rays_[i], hits_[i], depth, VertexNumbers());
        const auto others = found(PlainSurfaces::kOther);
        draw_numbers(samplers_, others, depth, numbers_);
        for (const std::uint32_t i : others) advance_alone(i, depth);
        for (std::size_t k = 0; k < Kind::kCount; ++k)
            if (!found(k).empty()) scatter(Kind::of_index(k), found(k), depth);
    }

    // The paths by what they have found; those that end there like those that have found nothing.
    void sort_by_found(int depth) {
        const auto size = static_cast<std::uint32_t>(going_.size());
        ends_.fill(0);
        for (std::uint32_t k = 0; k < size; ++k) {
            const std::size_t what = depth == plan_.max_depth ? PlainSurfaces::kNothing : plan_.plain.found(hits_[going_[k]]);
            found_[k] = static_cast<std::uint8_t>(what);
            ++ends_[what];
        }
        std::uint32_t begin = 0;
        for (std::uint32_t& end : ends_) begin += std::exchange(end, begin);
        for (std::uint32_t k = 0; k < size; ++k) sorted_[ends_[found_[k]]++] = going_[k];
        going_.clear();
    }
    std::span<const std::uint32_t> found(std::size_t what) const {
        const std::uint32_t begin = what == 0 ? 0 : ends_[what - 1];
        return std::span(sorted_).subspan(begin, ends_[what] - begin);
    }
    void advance_alone(std::uint32_t i, int depth) {
        if (paths_[i].advance(rays_[i], hits_[i], depth, numbers_[i])) going_.push_back(i);
    }

    // What vertices at plain surfaces use of their numbers.
    void draw_plain_numbers(Scattering scattering, std::span<const std::uint32_t> which, int depth) {
        const std::uint32_t first = vertex_dimension(depth);
        pairs_.resize(which.size());
        const auto draw = [&](std::uint32_t dimension, const auto& set) {
            Sampler::pairs(samplers_, which, first + dimension, pairs_);
            for (std::size_t k = 0; k < which.size(); ++k) set(numbers_[which[k]], pairs_[k]);
        };
        const bool lit = scattering == Scattering::kMatt || scattering == Scattering::kMetal; // and spread by two numbers
        const bool lights = lit && plan_.lights != nullptr, lobes = scattering == Scattering::kMetal || scattering == Scattering::kGlass;
        if (lit) draw(0, [](VertexNumbers& u, Vec2 pair) { u.bsdf = pair; });
        if (lights) draw(2, [](VertexNumbers& u, Vec2 pair) { u.light = pair; });
        if (lights || lobes) draw(4, [](VertexNumbers& u, Vec2 pair) { u.light_choice = pair.x, u.lobe = pair.y; });
        if (plan_.russian_roulette && depth > 0) draw(6, [](VertexNumbers& u, Vec2 pair) { u.roulette = pair.x; });
    }

    PlainPath plain_path(std::uint32_t i) {
        const Hit& hit = hits_[i];
        return {i, &rays_[i], &hit, &plan_.plain.shape(hit), &plan_.plain.bsdf(hit), &numbers_[i], &paths_[i].state()};
    }
    void scatter(Kind kind, std::span<const std::uint32_t> which, int depth) {
        draw_plain_numbers(kind.scattering, which, depth);
        for (; which.size() >= kFewest; which = which.subspan(std::min(which.size(), kPathLanes))) {
            std::array<PlainPath, kPathLanes> some;
            const std::size_t size = std::min(which.size(), kPathLanes);
            for (std::size_t k = 0; k < size; ++k) some[k] = plain_path(which[k]);
            scatter_plain(plan_, kind, std::span(some).first(size), depth, shadows_, counts_);
            for (std::size_t k = 0; k < size; ++k)
                if (some[k].goes_on) going_.push_back(which[k]);
        }
        for (const std::uint32_t i : which) advance_alone(i, depth);
    }

    const RenderPlan& plan_;
    const std::span<Ray> rays_;
    const std::span<Hit> hits_;
    const std::span<Sampler> samplers_;
    RayCounts& counts_;
    std::vector<Path<Sum, kInsides>> paths_;
    std::vector<std::uint32_t> going_;
    std::vector<std::uint8_t> found_;                         // by each of these
    std::vector<std::uint32_t> sorted_;                       // they, by that
    std::array<std::uint32_t, PlainSurfaces::kFound> ends_{}; // in it
    std::vector<VertexNumbers> numbers_;
    std::vector<Vec2> pairs_;
    ShadowRays shadows_;
};

template <typename Sink>
auto traced(const RenderPlan& plan, const Ray& ray, const Hit& hit, Sampler& sampler, RayCounts& counts, Sink sink = {}) {
    if (plan.insides) return Path<Sink, true>(plan, sampler, counts, sink).trace(sampler, ray, hit);
    return Path<Sink, false>(plan, sampler, counts, sink).trace(sampler, ray, hit);
}

} // namespace

void path_radiances(const RenderPlan& plan, std::span<Ray> rays, std::span<Hit> hits, std::span<Sampler> samplers,
                    std::span<Rgb> radiances, RayCounts& counts) {
    if (plan.insides) return Paths<true>(plan, rays, hits, samplers, counts).trace(radiances);
    Paths<false>(plan, rays, hits, samplers, counts).trace(radiances);
}

Rgb path_radiance(const RenderPlan& plan, const Ray& ray, const Hit& hit, Sampler& sampler, RayCounts& counts) {
    return traced<Sum>(plan, ray, hit, sampler, counts);
}

Rgb logged_path_radiance(const RenderPlan& plan, const Ray& ray, const Hit& hit, Sampler& sampler, PathLog& log) {
    RayCounts counts;
    return traced(plan, ray, hit, sampler, counts, Told(log));
}

void follow_path(const RenderPlan& plan, const Ray& ray, const Hit& hit, Sampler& sampler, PathGains& gains) {
    RayCounts counts;
    traced(plan, ray, hit, sampler, counts, Told(gains));
}

LightParts path_parts(const RenderPlan& plan, const Ray& ray, const Hit& hit, Sampler& sampler, RayCounts& counts) {
    return traced<Split>(plan, ray, hit, sampler, counts);
}

} // namespace duet::raytrace
