// Shadow maps with a slope-scaled bias and soft shadows of variable width, and rays to hold them to.
#include "compare/lessons/assignments/5-shadow-maps/lab.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace duet::lab {

namespace {

/// Two axes perpendicular to a direction.
struct Axes {
    Vec3 right, up;
};
Axes axes_of(Vec3 direction) {
    const Vec3 any = std::abs(direction.y) < 0.9f ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
    const Vec3 right = normalize(cross(direction, any));
    return {right, cross(right, direction)};
}

/// Returns a row of a matrix: scale * dot(axis, p - origin) + constant.
std::array<float, 4> row(Vec3 axis, Vec3 origin, float scale, float constant) {
    return {scale * axis.x, scale * axis.y, scale * axis.z, constant - scale * dot(axis, origin)};
}

/// The distance along the light that has a depth.
float distance_of(const LightView& view, const Light& light, float depth) {
    if (depth == kInfinity) return kInfinity; // nothing is there
    if (!light.spot) return view.near + depth * (view.far - view.near);
    return view.far * view.near / (view.far - depth * (view.far - view.near));
}

/// A point in the map: its column and row with fractions, and its distance along the light.
struct Place {
    float x, y, distance;
    float texel; // the side of a texel at this distance, in meters
};
Place place_of(const ShadowMap& map, const Light& light, Vec3 p) {
    const float side = static_cast<float>(map.depth.width());
    const Vec4 q = map.view.clip_from_world * Vec4(p, 1);
    const float distance = light.spot ? q.w : distance_of(map.view, light, q.z);
    const float texel = map.view.width / side * (light.spot ? distance : 1);
    return {(1 + q.x / q.w) / 2 * side, (1 - q.y / q.w) / 2 * side, distance, texel};
}

/// Whether the light shines on this side of the surface at p at all.
bool reaches(const Light& light, Vec3 p, Vec3 n) {
    const Vec3 to_light = light.spot ? normalize(light.position - p) : -light.direction;
    if (!(dot(n, to_light) > 0)) return false;
    return !light.spot || dot(-to_light, light.direction) >= std::cos(light.half_angle);
}

/// How much farther a flat surface through p is for each meter to the right and up in the map.
struct Slope {
    float right, up;
};
Slope slope_of(const ShadowMap& map, const Light& light, Vec3 p, Vec3 n) {
    const auto axis = [&](std::size_t i) {
        const auto& row = map.view.clip_from_world[i];
        return normalize(Vec3{row[0], row[1], row[2]});
    };
    const Vec3 ray = light.spot ? (p - light.position) / dot(p - light.position, light.direction) : light.direction;
    const float along = std::min(dot(n, ray), -0.05f); // light that grazes more than that would make it endless
    return {-dot(n, axis(0)) / along, -dot(n, axis(1)) / along};
}

/// Calls visit(surface, blocker, away) for the texels from -reach to +reach around the point: the distance of the flat
/// surface at the texel's center, a little nearer to the light, that of the map, and how far away from the point the
/// center is, in meters. Comparing the first two needs no large bias.
template <typename Visit>
void for_each_texel(const ShadowMap& map, const Light& light, Vec3 p, Vec3 n, const Place& place, int reach,
                    const Visit& visit) {
    const Slope slope = slope_of(map, light, p, n);
    const float bias = 0.3f * place.texel * (1 + std::abs(slope.right) + std::abs(slope.up)) + 1e-4f * place.distance;
    const int column = static_cast<int>(std::floor(place.x)), line = static_cast<int>(std::floor(place.y));
    const int side = map.depth.width();
    for (int y = line - reach; y <= line + reach; ++y) {
        for (int x = column - reach; x <= column + reach; ++x) {
            const float right = (static_cast<float>(x) + 0.5f - place.x) * place.texel;
            const float up = -(static_cast<float>(y) + 0.5f - place.y) * place.texel;
            const float more = slope.right * right + slope.up * up;
            const float surface =
                light.spot ? place.distance / std::max(1 - more / place.distance, 0.1f) : place.distance + more;
            const bool outside = x < 0 || y < 0 || x >= side || y >= side;
            visit(surface - bias, outside ? kInfinity : distance_of(map.view, light, map.depth(x, y)),
                  std::sqrt(right * right + up * up));
        }
    }
}

/// The fraction of the texels from -reach to +reach around the point that say it is lit.
float lit_fraction(const ShadowMap& map, const Light& light, Vec3 p, Vec3 n, int reach) {
    int lit = 0;
    for_each_texel(map, light, p, n, place_of(map, light, p), reach, [&](float surface, float blocker, float) {
        if (surface <= blocker) ++lit;
    });
    return static_cast<float>(lit) / static_cast<float>((2 * reach + 1) * (2 * reach + 1));
}

constexpr int kMostReach = 64;

/// What the texels in a disk around the point say.
struct Around {
    int lit = 0, blocked = 0;
    float blockers = 0; // the sum of their distances
};
Around look_around(const ShadowMap& map, const Light& light, Vec3 p, Vec3 n, float radius) {
    const Place place = place_of(map, light, p);
    radius = std::max(radius, 0.75f * place.texel);
    const int reach = std::min(static_cast<int>(radius / place.texel) + 1, kMostReach);
    Around around;
    for_each_texel(map, light, p, n, place, reach, [&](float surface, float blocker, float away) {
        if (away > radius) return;
        if (surface <= blocker) {
            ++around.lit;
        } else {
            ++around.blocked;
            around.blockers += blocker;
        }
    });
    return around;
}

bool blocked(const std::vector<Triangle>& triangles, Vec3 origin, Vec3 direction, float t_max) {
    for (const Triangle& tri : triangles) {
        const Vec3 u = tri.b - tri.a, v = tri.c - tri.a, o = origin - tri.a;
        const Vec3 normal = cross(direction, v), across = cross(o, u);
        const float determinant = dot(u, normal);
        const float alpha = dot(o, normal) / determinant, beta = dot(direction, across) / determinant;
        const float t = dot(v, across) / determinant;
        if (alpha >= 0 && beta >= 0 && alpha + beta <= 1 && t > 0 && t < t_max) return true;
    }
    return false;
}

template <typename Lit> ImageFloat each_lit_pixel(const Light& light, const GBuffer& gbuffer, const Lit& lit) {
    ImageFloat image(gbuffer.point.width(), gbuffer.point.height(), 0);
    for (std::size_t i = 0; i < image.size(); ++i)
        if (reaches(light, gbuffer.point[i], gbuffer.normal[i])) image[i] = lit(gbuffer.point[i], gbuffer.normal[i]);
    return image;
}

} // namespace

LightView light_view(const Light& light, const std::vector<Triangle>& triangles) {
    const Axes axes = axes_of(light.direction);
    LightView view;
    Vec3 low = triangles[0].a, high = triangles[0].a;
    float nearest = kInfinity, farthest = 0;
    for (const Triangle& t : triangles) {
        for (const Vec3 p : {t.a, t.b, t.c}) {
            low = min(low, p), high = max(high, p);
            nearest = std::min(nearest, dot(p - light.position, light.direction));
            farthest = std::max(farthest, dot(p - light.position, light.direction));
        }
    }
    Mat4& m = view.clip_from_world;
    if (light.spot) {
        view.near = nearest < 0.05f ? 0.05f : 0.95f * nearest;
        view.far = 1.02f * farthest;
        view.width = 2 * std::tan(light.half_angle);
        const Vec3 eye = light.position;
        const float a = view.far / (view.far - view.near);
        m[0] = row(axes.right, eye, 2 / view.width, 0);
        m[1] = row(axes.up, eye, 2 / view.width, 0);
        m[2] = row(light.direction, eye, a, -a * view.near);
        m[3] = row(light.direction, eye, 1, 0);
    } else {
        const Vec3 center = (low + high) * 0.5f;
        const float diameter = 1.02f * length(high - low);
        view.near = 0;
        view.far = view.width = diameter;
        m[0] = row(axes.right, center, 2 / diameter, 0);
        m[1] = row(axes.up, center, 2 / diameter, 0);
        m[2] = row(light.direction, center, 1 / diameter, 0.5f);
    }
    return view;
}

ImageFloat depth_map(const std::vector<Triangle>& triangles, const LightView& view, int side) {
    ImageFloat depth(side, side, kInfinity);
    const double half = side / 2.0;
    for (const Triangle& t : triangles) {
        // Clip at depth 0, which is z = 0 in clip space.
        const std::array<Vec4, 3> corners{view.clip_from_world * Vec4(t.a, 1), view.clip_from_world * Vec4(t.b, 1),
                                          view.clip_from_world * Vec4(t.c, 1)};
        std::vector<Vec4> outline;
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec4 a = corners[i], b = corners[(i + 1) % 3];
            if (a.z >= 0) outline.push_back(a);
            const float s = a.z / (a.z - b.z);
            if ((a.z >= 0) != (b.z >= 0)) outline.push_back(a * (1 - s) + b * s);
        }
        std::vector<Vec3d> p;
        for (const Vec4& c : outline) {
            const double w = c.w;
            p.push_back({half + half * c.x / w, half - half * c.y / w, c.z / w});
        }
        for (std::size_t k = 2; k < p.size(); ++k) {
            const Vec3d a = p[0], b = p[k - 1], c = p[k];
            const auto edge = [](Vec3d from, Vec3d to, double x, double y) {
                return (to.x - from.x) * (y - from.y) - (to.y - from.y) * (x - from.x);
            };
            const double area = edge(a, b, c.x, c.y);
            if (area == 0) continue;
            const auto bound = [side](double x) {
                return static_cast<int>(std::clamp(x, 0.0, static_cast<double>(side)));
            };
            const int left = bound(std::floor(std::min({a.x, b.x, c.x}))),
                      right = bound(std::ceil(std::max({a.x, b.x, c.x})));
            const int top = bound(std::floor(std::min({a.y, b.y, c.y}))),
                      bottom = bound(std::ceil(std::max({a.y, b.y, c.y})));
            for (int y = top; y < bottom; ++y) {
                for (int x = left; x < right; ++x) {
                    const double wa = edge(b, c, x + 0.5, y + 0.5) / area, wb = edge(c, a, x + 0.5, y + 0.5) / area;
                    const double wc = 1 - wa - wb;
                    if (wa < 0 || wb < 0 || wc < 0) continue;
                    const float z = static_cast<float>(wa * a.z + wb * b.z + wc * c.z);
                    depth(x, y) = std::min(depth(x, y), z);
                }
            }
        }
    }
    return depth;
}

ImageFloat shadows(const ShadowMap& map, const Light& light, const GBuffer& gbuffer, int reach) {
    return each_lit_pixel(light, gbuffer, [&](Vec3 p, Vec3 n) { return lit_fraction(map, light, p, n, reach); });
}

float penumbra_width(const Light& light, float blocker, float receiver) {
    if (!(blocker > 0 && blocker < receiver)) return 0;
    const float width = 2 * light.radius * (receiver - blocker);
    return light.spot ? width / blocker : width;
}

ImageFloat soft_shadows(const ShadowMap& map, const Light& light, const GBuffer& gbuffer) {
    return each_lit_pixel(light, gbuffer, [&](Vec3 p, Vec3 n) {
        const float distance = place_of(map, light, p).distance;
        // The widest penumbra here is that of something at the near plane.
        const float nearest = std::max(map.view.near, 0.001f);
        const Around search = look_around(map, light, p, n, penumbra_width(light, nearest, distance) / 2);
        if (search.blocked == 0) return 1.0f;
        const float blocker = search.blockers / static_cast<float>(search.blocked);
        const Around filter = look_around(map, light, p, n, penumbra_width(light, blocker, distance) / 2);
        return static_cast<float>(filter.lit) / static_cast<float>(filter.lit + filter.blocked);
    });
}

ImageFloat traced_shadows(const std::vector<Triangle>& triangles, const Light& light, const GBuffer& gbuffer,
                          int samples) {
    const Axes axes = axes_of(light.direction);
    return each_lit_pixel(light, gbuffer, [&](Vec3 p, Vec3 n) {
        const Vec3 origin = p + n * (1e-4f * (1 + length(p)));
        int lit = 0;
        for (int k = 0; k < samples; ++k) {
            // A spiral with equal areas between its turns.
            const float angle = 2.3999632f * static_cast<float>(k);
            const float r = samples == 1 ? 0 : std::sqrt((static_cast<float>(k) + 0.5f) / static_cast<float>(samples));
            const Vec3 offset = (axes.right * std::cos(angle) + axes.up * std::sin(angle)) * (r * light.radius);
            if (light.spot) {
                if (!blocked(triangles, origin, light.position + offset - origin, 1)) ++lit;
            } else {
                if (!blocked(triangles, origin, offset - light.direction, kInfinity)) ++lit;
            }
        }
        return static_cast<float>(lit) / static_cast<float>(samples);
    });
}

} // namespace duet::lab
