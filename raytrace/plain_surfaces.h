// PlainSurfaces decides which surfaces are batched: paths at those of one kind can be scattered together with SIMD.
// Many scenes consist mostly of such surfaces.
#pragma once

#include "common/geometry/hit.h"
#include "common/scene/scene.h"

#include <algorithm>
#include <optional>
#include <vector>

namespace duet::raytrace {

/// Batched surfaces have no texture and no emission, do not move, are not transformed, and have a shape and a
/// material for which there is a batched implementation.
class PlainSurfaces {
public:
    enum class Form : std::uint8_t {
        kFlat,
        kSmooth, ///< a mesh with vertex normals
        kRound
    };
    enum class Scattering : std::uint8_t {
        kMatt,   ///< diffuse
        kMetal,  ///< rough metal
        kMirror, ///< smooth metal
        kGlass   ///< smooth dielectric that is not thin
    };
    static constexpr std::size_t kForms = 3, kScatterings = 4;
    struct Kind {
        Form form;
        Scattering scattering;

        static constexpr std::size_t kCount = kForms * kScatterings;
        std::size_t index() const {
            return static_cast<std::size_t>(form) * kScatterings + static_cast<std::size_t>(scattering);
        }
        static Kind of_index(std::size_t i) {
            return {static_cast<Form>(i / kScatterings), static_cast<Scattering>(i % kScatterings)};
        }
    };

    /// Classifies none of the surfaces of this many objects as batched.
    explicit PlainSurfaces(std::size_t objects) : classes_(objects + 1, kOther) { classes_.back() = kNothing; }
    /// Classifies the surfaces of a scene. `bsdfs` holds the BSDF of each material where it is constant. The scene
    /// and `bsdfs` must outlive this object.
    PlainSurfaces(const Scene& scene, const std::vector<std::optional<Bsdf>>& bsdfs);

    /// The class of a hit is the index of a Kind for a batched surface, kOther for any other surface, or kNothing for a
    /// miss.
    static constexpr std::size_t kOther = Kind::kCount, kNothing = kOther + 1, kClasses = kNothing + 1;
    std::size_t class_of(const Hit& hit) const {
        // This is mostly without a branch, because the hits of incoherent rays are unpredictable.
        const std::size_t known = classes_[std::min<std::size_t>(hit.object, classes_.size() - 1)];
        return known == kAsMaterial ? class_by_material(hit) : known;
    }
    /// Returns the kind of the surface at a valid hit, or nothing if it is not batched.
    std::optional<Kind> kind(const Hit& hit) const {
        const std::size_t i = class_of(hit);
        return i < Kind::kCount ? std::optional(Kind::of_index(i)) : std::nullopt;
    }
    /// These functions return the shape and the BSDF at a hit on a batched surface.
    const Shape& shape(const Hit& hit) const { return *objects_[hit.object].shape; }
    const Bsdf& bsdf(const Hit& hit) const { return *material_at(hit, objects_[hit.object]).bsdf; }

private:
    struct PlainMaterial {
        const Bsdf* bsdf = nullptr; ///< null if the material is not batched
        Scattering scattering = Scattering::kMatt;
    };
    struct PlainObject {
        std::optional<Form> form;
        const Shape* shape = nullptr;
        bool several = false; ///< whether there are several
        PlainMaterial material; ///< the only material, if there are not several
    };

    static PlainMaterial plain(const Scene& scene, std::uint32_t material, const std::optional<Bsdf>& bsdf);

    const PlainMaterial& material_at(const Hit& hit, const PlainObject& object) const {
        return object.several ? materials_[material_index(*scene_, hit.object, hit.primitive)] : object.material;
    }

    std::size_t class_by_material(const Hit& hit) const;

    static constexpr std::uint8_t kAsMaterial = 255;

    const Scene* scene_ = nullptr;
    std::vector<std::uint8_t> classes_;  ///< by object; the last element is for a miss
    std::vector<PlainObject> objects_; ///< by object; empty if no surface is batched
    std::vector<PlainMaterial> materials_;
};

} // namespace duet::raytrace
