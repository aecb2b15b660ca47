// Which surfaces are plain: what most of many a scene is.
#pragma once

#include "common/geometry/hit.h"
#include "common/scene/scene.h"

#include <algorithm>
#include <optional>
#include <vector>

namespace duet::raytrace {

/// Surfaces without texture or emission, standing still, not placed by a transform, of a shape and of a material of which
/// paths scatter many alike.
class PlainSurfaces {
public:
    enum class Form : std::uint8_t {
        kFlat,
        kSmooth, ///< of a mesh with normals of its own
        kRound
    };
    enum class Scattering : std::uint8_t {
        kMatt,   ///< diffuse
        kMetal,  ///< rough
        kMirror, ///< smooth metal
        kGlass   ///< smooth, with an inside
    };
    static constexpr std::size_t kForms = 3, kScatterings = 4;
    struct Kind {
        Form form;
        Scattering scattering;

        static constexpr std::size_t kCount = kForms * kScatterings;
        std::size_t index() const { return static_cast<std::size_t>(form) * kScatterings + static_cast<std::size_t>(scattering); }
        static Kind of_index(std::size_t i) { return {static_cast<Form>(i / kScatterings), static_cast<Scattering>(i % kScatterings)}; }
    };

    /// None is, of so many objects.
    explicit PlainSurfaces(std::size_t objects) : classes_(objects + 1, kOther) { classes_.back() = kNothing; }
    /// Those of a scene. bsdfs: by material, where it is constant; they must stay.
    PlainSurfaces(const Scene& scene, const std::vector<std::optional<Bsdf>>& bsdfs);

    /// What a ray has found, as a number: a kind's index, or, of other surfaces, kOther, or kNothing.
    static constexpr std::size_t kOther = Kind::kCount, kNothing = kOther + 1, kClasses = kNothing + 1;
    std::size_t class_of(const Hit& hit) const {
        // Mostly without a branch: what random rays find cannot be foreseen.
        const std::size_t known = classes_[std::min<std::size_t>(hit.object, classes_.size() - 1)];
        return known == kAsMaterial ? class_by_material(hit) : known;
    }
    /// What a valid hit has found, if it is one.
    std::optional<Kind> kind(const Hit& hit) const {
        const std::size_t i = class_of(hit);
        return i < Kind::kCount ? std::optional(Kind::of_index(i)) : std::nullopt;
    }
    /// Of such a one.
    const Shape& shape(const Hit& hit) const { return *objects_[hit.object].shape; }
    const Bsdf& bsdf(const Hit& hit) const { return *material_at(hit, objects_[hit.object]).bsdf; }

private:
    struct PlainMaterial {
        const Bsdf* bsdf = nullptr; ///< null: it is not plain
        Scattering scattering = Scattering::kMatt;
    };
    struct PlainObject {
        std::optional<Form> form;
        const Shape* shape = nullptr;
        bool several = false; ///< materials
        PlainMaterial material; ///< the only one
    };

    static PlainMaterial plain(const Scene& scene, std::uint32_t material, const std::optional<Bsdf>& bsdf);

    const PlainMaterial& material_at(const Hit& hit, const PlainObject& object) const {
        return object.several ? materials_[material_index(*scene_, hit.object, hit.primitive)] : object.material;
    }

    std::size_t class_by_material(const Hit& hit) const;

    static constexpr std::uint8_t kAsMaterial = 255;

    const Scene* scene_ = nullptr;
    std::vector<std::uint8_t> classes_;  ///< by object, and last of none
    std::vector<PlainObject> objects_; ///< empty: none is
    std::vector<PlainMaterial> materials_;
};

} // namespace duet::raytrace
