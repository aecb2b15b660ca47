#include "common/scene/alpha_mask.h"

#include "common/sampling/hash.h"

#include <algorithm>
#include <bit>

namespace duet {

bool passes_alpha_mask(const Scene& scene, const Ray& ray, const Hit& hit) {
    const float alpha = opacity(scene, ray, hit);
    if (alpha >= 1) return false;
    if (alpha <= 0) return true;
    std::uint64_t state = hash_combine(hit.object, hit.primitive);
    for (const Vec3 v : {ray.origin, ray.direction})
        for (std::size_t axis = 0; axis < 3; ++axis) state = hash_combine(state, std::bit_cast<std::uint32_t>(v[axis]));
    return unit_float(high_bits(state)) >= alpha;
}

bool can_be_seen_through(const Scene& scene, const Object& object) {
    return std::any_of(object.materials.begin(), object.materials.end(),
                       [&](std::uint32_t material) { return scene.maps[material].has_transparency(); });
}

} // namespace duet
