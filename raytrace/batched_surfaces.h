// Declares BatchedSurfaces, which decides which surfaces are batched: paths at batched surfaces of one kind are
// scattered together with SIMD. Many scenes consist mostly of such surfaces.
#pragma once

#include "common/geometry/hit.h"
#include "common/scene/scene.h"

#include <algorithm>
#include <optional>
#include <vector>

namespace duet::raytrace {

/// Classifies surfaces. Batched surfaces have no texture and no emission, do not move, are not transformed, and have a
/// shape and a material with a batched implementation.
class BatchedSurfaces {
public:
    enum class Geometry : std::uint8_t {
        kFlat,
        kSmooth, ///< a mesh with vertex normals
        kSphere
    };
    enum class BsdfKind : std::uint8_t {
        kDiffuse, ///< Lambertian reflection
        kMetal,   ///< rough metal
        kMirror,  ///< smooth metal
        kGlass    ///< smooth dielectric that is not thin
    };
    static constexpr std::size_t kGeometries = 3, kBsdfKinds = 4;
    struct Kind {
        Geometry geometry;
        BsdfKind bsdf_kind;

        static constexpr std::size_t kCount = kGeometries * kBsdfKinds;
        std::size_t index() const {
            return static_cast<std::size_t>(geometry) * kBsdfKinds + static_cast<std::size_t>(bsdf_kind);
        }
        static Kind of_index(std::size_t i) {
            return {static_cast<Geometry>(i / kBsdfKinds), static_cast<BsdfKind>(i % kBsdfKinds)};
        }
    };

    /// Treats none of the surfaces of this many objects as batched.
    explicit BatchedSurfaces(std::size_t objects) : classes_(objects + 1, kOther) { classes_.back() = kMiss; }
    /// Classifies the surfaces of a scene. `bsdfs` holds the BSDF of each material where it is constant. The scene
    /// and `bsdfs` must outlive this object.
    BatchedSurfaces(const Scene& scene, const std::vector<std::optional<Bsdf>>& bsdfs);

    /// The class of a hit is the index of a Kind for a batched surface, kOther for any other surface, or kMiss for a
    /// miss.
    static constexpr std::size_t kOther = Kind::kCount, kMiss = kOther + 1, kClasses = kMiss + 1;
    std::size_t class_of(const Hit& hit) const {
        // This code has few branches, because the hits of incoherent rays are unpredictable.
        const std::size_t known = classes_[std::min<std::size_t>(hit.object, classes_.size() - 1)];
        return known == kByMaterial ? class_by_material(hit) : known;
    }
    /// Returns the kind of the surface at a valid hit, or nothing if it is not batched.
    std::optional<Kind> kind(const Hit& hit) const {
        const std::size_t i = class_of(hit);
        return i < Kind::kCount ? std::optional(Kind::of_index(i)) : std::nullopt;
    }
    /// shape() and bsdf() return the shape and the BSDF at a hit on a batched surface.
    const Shape& shape(const Hit& hit) const { return *objects_[hit.object].shape; }
    const Bsdf& bsdf(const Hit& hit) const { return *material_at(hit, objects_[hit.object]).bsdf; }

private:
    struct BatchedMaterial {
        const Bsdf* bsdf = nullptr; ///< null if the material is not batched
        BsdfKind bsdf_kind = BsdfKind::kDiffuse;
    };
    struct BatchedObject {
        std::optional<Geometry> geometry;
        const Shape* shape = nullptr;
        bool multi_material = false; ///< whether the primitives have different materials
        BatchedMaterial material;    ///< the only material, unless multi_material
    };

    static BatchedMaterial batched_material(const Scene& scene, std::uint32_t material,
                                            const std::optional<Bsdf>& bsdf);

    const BatchedMaterial& material_at(const Hit& hit, const BatchedObject& object) const {
        return object.multi_material ? materials_[material_index(*scene_, hit.object, hit.primitive)] : object.material;
    }

    std::size_t class_by_material(const Hit& hit) const;

    static constexpr std::uint8_t kByMaterial = 255;

    const Scene* scene_ = nullptr;
    std::vector<std::uint8_t> classes_;  ///< by object; the last element represents a miss
    std::vector<BatchedObject> objects_; ///< by object; empty if no surface is batched
    std::vector<BatchedMaterial> materials_;
};

} // namespace duet::raytrace
