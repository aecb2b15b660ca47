// The library's clipping (raster/geometry/clip.h). Its vertices have no attributes, so the corners are clipped once
// with x and y, and once with u and v in their place.
#include "raster/geometry/clip.h"
#include "raster/lessons/05-clipping/lab.h"

namespace duet::lab {

namespace {

std::vector<Vertex> clipped(const Vertex& a, const Vertex& b, const Vertex& c) {
    const raster::Viewport viewport{.width = 64, .height = 64, .near = 0}; // z takes the place of the depth
    const auto vertex = [](float x, float y, const Vertex& v) {
        return raster::PixelVertex{static_cast<double>(x), static_cast<double>(y), static_cast<double>(v.clip.w),
                                   static_cast<double>(v.clip.z)};
    };
    const auto places = raster::clip(vertex(a.clip.x, a.clip.y, a), vertex(b.clip.x, b.clip.y, b),
                                     vertex(c.clip.x, c.clip.y, c), viewport);
    const auto attributes =
        raster::clip(vertex(a.uv.x, a.uv.y, a), vertex(b.uv.x, b.uv.y, b), vertex(c.uv.x, c.uv.y, c), viewport);
    std::vector<Vertex> outline;
    for (std::size_t i = 0; i < static_cast<std::size_t>(places.count); ++i) {
        const raster::PixelVertex &p = places.vertices[i], &q = attributes.vertices[i];
        outline.push_back(
            {{static_cast<float>(p.xw), static_cast<float>(p.yw), static_cast<float>(p.depth), static_cast<float>(p.w)},
             {static_cast<float>(q.xw), static_cast<float>(q.yw)}});
    }
    return outline;
}

} // namespace

Vertex crossing(const Vertex& a, const Vertex& b) {
    const bool turned = a.clip.z < 0; // a triangle whose first two corners are the end in front
    return clipped(turned ? b : a, turned ? b : a, turned ? a : b)[2];
}

float crossing_fraction(float front_z, float behind_z) {
    return crossing({{0, 0, front_z, 1}, {0, 0}}, {{1, 0, behind_z, 1}, {0, 0}}).clip.x;
}

std::vector<Triangle> clip_near(const Triangle& triangle) {
    const std::vector<Vertex> outline = clipped(triangle[0], triangle[1], triangle[2]);
    std::vector<Triangle> parts;
    for (std::size_t i = 2; i < outline.size(); ++i) parts.push_back({outline[0], outline[i - 1], outline[i]});
    return parts;
}

} // namespace duet::lab
