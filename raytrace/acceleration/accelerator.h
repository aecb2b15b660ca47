// Declares the accelerator, which answers ray queries against the whole scene: closest hit and occlusion.
#pragma once

#include "common/rendering.h"
#include "common/scene/scene.h"
#include "raytrace/acceleration/bvh.h"

#include <memory>
#include <span>

namespace duet::raytrace {

struct AlphaFilter;

/// Builds and queries a two-level acceleration structure. The top-level BVH holds the primitives of all static,
/// untransformed objects and the bounds of instances. Each instanced shape has a bottom-level BVH in its object
/// space. The accelerator refers to the scene, which must outlive it.
class Accelerator {
public:
    /// Builds all hierarchies. `threads` is the number of build threads (0 = all); the result does not depend on it.
    Accelerator(const Scene& scene, int threads) : Accelerator(scene, threads, nullptr) {}
    /// Builds the hierarchies of an edited scene. Each mesh has a bottom-level BVH, so that it can be used again after
    /// the next edit. BVHs of meshes that `before` has, too, are reused (see Transforms::kKept). Rays are
    /// a little slower than with the other constructor.
    Accelerator(const Scene& scene, int threads, const Accelerator& before) : Accelerator(scene, threads, &before) {}

    /// Returns the closest hit with t in (t_min, t_max]; t_min must not be negative. The hit is invalid if the ray
    /// misses, or if it is not `traceable`: its components are out of range or it has no direction. At equal t the
    /// lower (object, primitive) wins. A point where the material's alpha is 0 is no hit. At an alpha between 0 and
    /// 1 that fraction of rays hits, chosen by a hash of the ray and the primitive (alpha_mask.h).
    Hit closest(const Ray& ray) const;
    /// Finds the closest hit of each ray; `hits` must be as long as `rays`. The rays are traced in packets, which is
    /// faster if neighbors in the list are coherent, as the camera rays of neighboring pixels are.
    void closest(std::span<const Ray> rays, std::span<Hit> hits) const;
    /// Finds the closest hits of the rays with the indices `indices`, which may be incoherent. Other elements of
    /// `hits` stay unchanged.
    void closest_of_incoherent(std::span<const Ray> rays, std::span<const std::uint32_t> indices,
                               std::span<Hit> hits) const;
    /// Returns whether the scene is a short list of primitives without instances and alpha masks. For such a scene,
    /// the closest hits of a batch of rays cost less than a separate any-hit query for each ray.
    bool few_primitives() const { return few_primitives_; }
    /// Returns whether any primitive is hit before `end`. The primitive of `end` itself is ignored, so that a light
    /// at the end of a shadow ray does not occlude itself. An `end` without an object is only a distance.
    bool occluded(const Ray& ray, const Hit& end) const;

    std::int64_t primitives() const { return primitives_; } ///< primitives of the scene, counted for each instance
    std::int64_t memory_bytes() const;
    BvhStatistics statistics() const;
    const Bvh& world() const { return world_; }
    /// Returns the bottom-level BVH of a shape; null if it has none.
    std::shared_ptr<const Bvh> hierarchy(std::uint32_t shape) const { return shapes_[shape]; }

private:
    Accelerator(const Scene& scene, int threads, const Accelerator* before);
    std::shared_ptr<const Bvh> hierarchy_for(const Scene& scene, std::uint32_t shape, bool seen_through) const;
    void closest_sorted_by_class(std::span<const Ray> rays, std::span<const std::uint32_t> indices,
                                 std::span<Hit> hits) const;
    void closest_in_list(std::span<const Ray> rays, std::span<const std::uint32_t> indices, std::span<Hit> hits) const;
    struct PacketInstances;
    template <bool kAny> bool trace(const Ray& ray, Hit& best) const;
    Ray to_instance_space(const BvhInstance& instance, const Ray& ray) const;
    template <bool kAny> auto instance_test(const Ray& ray, const AlphaFilter* alpha) const;

    const Scene& scene_;
    Bvh world_;
    std::vector<bool> seen_through_; ///< by shape: whether rays may pass through some object of the shape
    std::vector<std::shared_ptr<const Bvh>> shapes_; ///< by shape; null if no instance uses the shape
    std::int64_t primitives_ = 0;
    bool has_alpha_masks_; ///< whether any material has an alpha mask
    bool few_primitives_ = false;
};

} // namespace duet::raytrace
