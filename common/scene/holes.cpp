#include "common/scene/holes.h"

#include "common/sampling/hash.h"

#include <bit>

namespace duet {

bool passes_through(const Scene& scene, const Ray& ray, const Hit& hit) {
    const float stopped = opacity(scene, ray, hit);
    if (stopped >= 1) return false;
    if (stopped <= 0) return true;
    std::uint64_t state = hash_combine(hit.object, hit.primitive);
    for (const Vec3 v : {ray.origin, ray.direction})
        for (std::size_t axis = 0; axis < 3; ++axis) state = hash_combine(state, std::bit_cast<std::uint32_t>(v[axis]));
    return unit_float(high_bits(state)) >= stopped;
}

} // namespace duet
