// Which surfaces are plain and matt: what most of many a scene is.
#pragma once

#include "common/geometry/hit.h"
#include "common/scene/scene.h"

#include <optional>
#include <vector>

namespace duet::raytrace {

/// Surfaces that are lit and scatter all alike: diffuse without texture, emission or normals of their own, standing
/// still, not placed by a transform.
class MattSurfaces {
public:
    enum class Kind : std::uint8_t { kNone, kFlat, kRound };

    MattSurfaces() = default; ///< none is
    /// Those of a scene. bsdfs: by material, where it is constant; they must stay.
    MattSurfaces(const Scene& scene, const std::vector<std::optional<Bsdf>>& bsdfs);

    /// What a valid hit has found.
    Kind kind(const Hit& hit) const {
        if (kinds_.empty() || kinds_[hit.object] == Kind::kNone || bsdf(hit) == nullptr) return Kind::kNone;
        return kinds_[hit.object];
    }
    /// Of such a one.
    Rgb albedo(const Hit& hit) const { return bsdf(hit)->albedo; }

private:
    const DiffuseBsdf* bsdf(const Hit& hit) const {
        return bsdfs_[material_index(*scene_, hit.object, hit.primitive)];
    }

    const Scene* scene_ = nullptr;
    std::vector<Kind> kinds_;               ///< by object; empty: none is
    std::vector<const DiffuseBsdf*> bsdfs_; ///< by material; null: it is not matt
};

} // namespace duet::raytrace
