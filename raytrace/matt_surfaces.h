// Which surfaces are plain and matt: what most of many a scene is.
#pragma once

#include "common/geometry/hit.h"
#include "common/scene/scene.h"

#include <array>
#include <optional>
#include <vector>

namespace duet::raytrace {

/// Surfaces that are lit and scatter all alike: diffuse without texture or emission, standing still, not placed by a
/// transform.
class MattSurfaces {
public:
    enum class Kind : std::uint8_t {
        kNone,
        kFlat,
        kSmooth, ///< of a mesh with normals of its own
        kRound
    };
    static constexpr std::array kKinds{Kind::kFlat, Kind::kSmooth, Kind::kRound};

    MattSurfaces() = default; ///< none is
    /// Those of a scene. bsdfs: by material, where it is constant; they must stay.
    MattSurfaces(const Scene& scene, const std::vector<std::optional<Bsdf>>& bsdfs);

    /// What a valid hit has found.
    Kind kind(const Hit& hit) const {
        if (objects_.empty()) return Kind::kNone;
        const MattObject& object = objects_[hit.object];
        return object.several && bsdf(hit) == nullptr ? Kind::kNone : object.kind;
    }
    /// Of such a one.
    Rgb albedo(const Hit& hit) const { return bsdf(hit)->albedo; }

private:
    struct MattObject {
        Kind kind = Kind::kNone;
        bool several = false;              ///< materials
        const DiffuseBsdf* bsdf = nullptr; ///< of the only one
    };

    const DiffuseBsdf* bsdf(const Hit& hit) const {
        const MattObject& object = objects_[hit.object];
        return object.several ? bsdfs_[material_index(*scene_, hit.object, hit.primitive)] : object.bsdf;
    }

    const Scene* scene_ = nullptr;
    std::vector<MattObject> objects_;       ///< empty: none is
    std::vector<const DiffuseBsdf*> bsdfs_; ///< by material; null: it is not matt
};

} // namespace duet::raytrace
