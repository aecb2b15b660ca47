// The whole scene behind two questions: what does a ray hit first, and is anything in its way?
#pragma once

#include "common/film/rendering.h"
#include "common/scene/scene.h"
#include "raytrace/acceleration/bvh.h"
#include "raytrace/acceleration/bvh_quality.h"

#include <span>

namespace duet::raytrace {

/// Two levels: one hierarchy over everything that stands in the world as it is, and over the bounds of instances;
/// and one of its own, in its own space, for each shape that instances show. Refers to the scene.
class Accelerator {
public:
    /// threads: for building, 0 = all. The result does not depend on it; no hit depends on the quality.
    Accelerator(const Scene& scene, int threads, BvhQuality quality = BvhQuality::kDefault);

    /// The first hit with t in (t_min, t_max], t_min not negative; invalid where there is none, or where the ray's
    /// numbers are out of range (`traceable`) or it has no direction. At equal t the lower (object, primitive). Holes of
    /// the surfaces' opacity maps are no hits; what stops a part of the light is one for that part of all rays (holes.h).
    Hit closest(const Ray& ray) const;
    /// The same of many rays at once: faster where neighbours in the list run close by each other, as those of
    /// neighbouring pixels do. As many hits as rays.
    void closest(std::span<const Ray> rays, std::span<Hit> hits) const;
    /// The same of some rays, those with these indices, which may run anywhere, in a scene that gathers_scattered(). Other
    /// hits stay.
    void closest_of_scattered(std::span<const Ray> rays, std::span<const std::uint32_t> which, std::span<Hit> hits) const;
    /// Whether many rays that run anywhere are sooner there together than one by one.
    bool gathers_scattered() const { return few_primitives_ || streams_; }
    /// Whether there are few, and nothing but primitives: then the nearest hit of many rays costs less than a look for any
    /// hit of each.
    bool few_primitives() const { return few_primitives_; }
    /// Whether anything is hit before `end`, other than end's own primitive: where a light is the end of a shadow
    /// ray, it does not shade itself. An end without object is a mere distance.
    bool occluded(const Ray& ray, const Hit& end) const;

    std::int64_t primitives() const { return primitives_; } ///< of the flattened scene
    std::int64_t memory_bytes() const;
    HierarchyStatistics statistics() const;
    const Bvh& world() const { return world_; }

private:
    Hit first(const Ray& ray) const;
    void closest_by_class(std::span<const Ray> rays, std::span<const std::uint32_t> which, std::span<Hit> hits) const;
    void closest_in_list(std::span<const Ray> rays, std::span<const std::uint32_t> which, std::span<Hit> hits) const;
    Hit beyond_holes(const Ray& ray, Hit hit) const;
    bool occluded_beyond_holes(Ray ray, const Hit& end) const;
    struct PacketInstances;
    Ray inside(const BvhInstance& instance, const Ray& ray) const;
    template <bool kAny> auto instance_test(const Ray& ray) const;

    const Scene& scene_;
    BvhQuality quality_;
    Bvh world_;
    std::vector<Bvh> shapes_; ///< by shape; empty for those that no instance shows
    std::int64_t primitives_ = 0;
    bool holes_; ///< some material has
    bool few_primitives_ = false;
    bool streams_ = false; ///< rays may go through the world side by side
};

} // namespace duet::raytrace
