#include "raster/shader/octahedral_map.h"

namespace duet::raster {

Vec3 octahedral_direction(Vec2 p) {
    Vec3 w(p.x, p.y, 1 - std::abs(p.x) - std::abs(p.y));
    if (w.z < 0) {
        const auto sign = [](float v) { return v < 0 ? -1.0f : 1.0f; };
        w.x = (1 - std::abs(p.y)) * sign(p.x), w.y = (1 - std::abs(p.x)) * sign(p.y);
    }
    return normalize(w);
}

OctahedralMap::OctahedralMap(int side)
    : side_(side), texels_(static_cast<std::size_t>(side + 2) * static_cast<std::size_t>(side + 2)) {}

Vec3 OctahedralMap::direction(int x, int y) const {
    const auto center = [&](int i) { return (2 * static_cast<float>(i) + 1) / static_cast<float>(side_) - 1; };
    return octahedral_direction({center(x), center(y)});
}

void OctahedralMap::finish() {
    const int last = side_ - 1;
    for (int i = 0; i < side_; ++i) { // a border row mirrors the edge row next to it
        texel(i, -1) = texel(last - i, 0), texel(i, side_) = texel(last - i, last);
        texel(-1, i) = texel(0, last - i), texel(side_, i) = texel(last, last - i);
    }
    texel(-1, -1) = texel(last, last), texel(side_, side_) = texel(0, 0);
    texel(-1, side_) = texel(last, 0), texel(side_, -1) = texel(0, last);
}

} // namespace duet::raster
