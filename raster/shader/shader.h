// Programmable shading: a vertex and a fragment function in C++, written once for one point and for a SIMD batch of them.
//
//     struct Stripes {
//         template <typename T> struct Varyings { T height; };             // nothing but T, and vectors and colours of it
//         template <typename T> Varyings<T> vertex(const VertexInput<T>& v) const { return {v.world_p().y}; }
//         template <typename T, typename F> RgbT<T> fragment(const F& f) const {
//             return select_each(f.at.height > T(0.5f), f.base_color(), RgbT<T>(T(1)));
//         }
//     };
//     Rendering picture = draw(prepared, view, settings, Stripes{}, control);   // raster/draw.h
//
// Visibility comes first (an image of triangle numbers), so a fragment function runs once for each strip of samples that sees an
// object (what it makes of samples that do not is thrown away), and a vertex function only for the corners of triangles that are
// seen, and for each sample of a sphere. Both inline into the loop over strips.
// Where a vertex lies in the picture is not theirs to say: that is exact (raster/geometry/transform.h).
#pragma once

#include "common/image/rgb.h"
#include "common/vec/matrix.h"
#include "raster/lanes.h"
#include "raster/prepare.h"

#include <bit>
#include <concepts>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <type_traits>

namespace duet::raster {

struct PassView;

/// One value to all lanes.
template <typename T> RgbT<T> spread(Rgb c) { return {T(c.r), T(c.g), T(c.b)}; }
/// v / |v| of what is not zero.
template <typename T> Vec3T<T> unit(Vec3T<T> v) { return v * inverse_sqrt(dot(v, v)); }
/// A direction, of any length: who asks for a cosine with it multiplies once, where a unit vector takes three multiplications.
template <typename T> struct Direction {
    Vec3T<T> v;
    T scale; ///< 1/|v|, or −1/|v| where v points the other way

    /// Of nothing, as between normals that point away from each other: no direction at all, which no light meets.
    static Direction of(Vec3T<T> v) { return {v, inverse_sqrt(max(dot(v, v), T(std::numeric_limits<float>::min())))}; }
    Vec3T<T> unit() const { return v * scale; }
};
/// a where the condition holds, else b.
template <typename T, typename Mask> RgbT<T> select_each(Mask condition, RgbT<T> a, RgbT<T> b) {
    return {select(condition, a.r, b.r), select(condition, a.g, b.g), select(condition, a.b, b.b)};
}

/// What all vertices and samples of an object have in common in one view.
struct ObjectView {
    const PreparedData& data;
    const PassView& pass;
    std::uint32_t object;      ///< index into Scene::objects
    bool identity;             ///< its space is the world's
    bool smooth;               ///< it has normals at its vertices
    bool bent;                 ///< a material of it has a normal or bump map
    bool emits;                ///< a material of it is a lamp's
    Mat4 to_world, to_object;  ///< at the pass's moment
    std::optional<Rgb> color;  ///< its base colour, if it has but one
    /// Where on a triangle a sample lies makes no difference to its material, and it has no light of its own.
    bool even() const { return color && !bent && !emits; }
    Vec3 eye, forward;         ///< the viewer, and unit, the way the camera looks
    bool orthographic;

    ObjectView(const PreparedData& data, const PassView& pass, std::uint32_t object);

    /// To the world.
    template <typename T> Vec3T<T> point(Vec3T<T> p) const {
        if (identity) return p;
        const auto row = [&](std::size_t r) {
            const auto& m = to_world[r];
            return T(m[0]) * p.x + T(m[1]) * p.y + T(m[2]) * p.z + T(m[3]);
        };
        return {row(0), row(1), row(2)};
    }
    /// A normal to the world, of any length.
    template <typename T> Vec3T<T> normal(Vec3T<T> n) const {
        if (identity) return n;
        const auto column = [&](std::size_t c) {
            return T(to_object[0][c]) * n.x + T(to_object[1][c]) * n.y + T(to_object[2][c]) * n.z;
        };
        return {column(0), column(1), column(2)};
    }
    /// From an interpolated normal n and the geometric one ng on the side that is seen, both in the object's space and
    /// of any length: the shading normal in the world, in the hemisphere of ng. ng's where the object has no other.
    template <typename T> Direction<T> shading_normal(Vec3T<T> n, Vec3T<T> ng) const {
        const Vec3T<T> g = normal(ng);
        if (!smooth) return Direction<T>::of(g);
        const Direction<T> s = Direction<T>::of(normal(n));
        return {s.v, s.scale * select(dot(s.v, g) < T(0), T(-1), T(1))};
    }
    /// Unit, from a point of the world.
    template <typename T> Vec3T<T> to_viewer(Vec3T<T> p) const {
        return orthographic ? -spread<T>(forward) : unit(spread<T>(eye) - p);
    }
};

/// What a vertex function is given: a corner of a triangle that is seen, or a point of a sphere. In the object's space, but for world_….
template <typename T> struct VertexInput {
    Vec3T<T> p;
    Vec3T<T> n; ///< as the mesh has it, or (0, 0, 0)
    Vec2T<T> uv;
    Vec3T<T> ng;     ///< the triangle's geometric normal on the side that is seen, of any length
    Vec3T<T> middle; ///< the triangle's or the whole quad's centroid; of a sphere p itself
    /// One number an edge: 1 at the corner opposite to it, 0 on it. Where no edge is (a quad's diagonal; a sphere): 1.
    Vec3T<T> edges;
    const ObjectView& object;

    Vec3T<T> world_p() const { return object.point(p); }
    Vec3T<T> world_middle() const { return object.point(middle); }
    /// The shading normal: unit, on the side that is seen.
    Vec3T<T> world_n() const { return object.shading_normal(n, ng).unit(); }
    Vec3T<T> world_ng() const { return unit(object.normal(ng)); }
};

/// What is asked of samples one by one, side by side: three numbers each.
template <typename Ask> std::array<Floats, 3> one_by_one(std::size_t first, const Ask& ask) {
    std::array<StripOf<float>, 3> found;
    for (std::size_t lane = 0; lane < Floats::size; ++lane) {
        const auto answer = ask(first + lane);
        for (std::size_t axis = 0; axis < 3; ++axis) found[axis][lane] = answer[axis];
    }
    return {load(found[0], 0), load(found[1], 0), load(found[2], 0)};
}

/// Looks up what has no batches: base colours of the samples of a strip, and normals by their materials' maps.
class ColorSource {
public:
    virtual ~ColorSource() = default;
    virtual Rgb base_color(std::size_t sample) const = 0;
    /// Of as many samples from `first` on as a batch has lanes.
    virtual RgbT<Floats> base_colors(std::size_t first) const {
        const auto [r, g, b] = one_by_one(first, [&](std::size_t sample) { return base_color(sample); });
        return {r, g, b};
    }
    virtual Vec3 bent_normal(std::size_t sample) const = 0; ///< in the world, unit, on the side that is seen
    virtual Rgb emitted(std::size_t sample) const = 0; ///< radiance of its own towards the viewer
};

template <typename V, bool kDerivatives> struct ScreenDerivatives {};
template <typename V> struct ScreenDerivatives<V, true> {
    V dx, dy; ///< exact derivatives of the varyings by the sample's place, along the row and down the column, per pixel
};

template <typename T, bool kFacing> struct SeenSide {
    Vec3T<T> ng; ///< geometric normal on the side that is seen, in the object's space, of any length
};
template <typename T> struct SeenSide<T, true> {};

/// A scene's lights. kSuns: they are suns, all of them.
template <bool kSuns> struct Lights {
    std::span<const Light> all;
};

/// What a fragment function is given: a sample that sees something. dx and dy are there where the shader says so. kPlain: the
/// object has one colour, no map bends its normals, and suns are all the lights: then nothing is called, and batches stay in
/// registers. kFacing: all interpolated normals are on the side that is seen, and ng is not there (wants_directions).
template <typename T, typename V, bool kDerivatives, bool kPlain, bool kFacing>
struct FragmentInput : ScreenDerivatives<V, kDerivatives>, SeenSide<T, kFacing> {
    V at;                  ///< the varyings, interpolated as perspective shows them
    Vec3T<T> origin, way;  ///< the camera ray in the world: way's camera-space −z is 1
    T depth;               ///< camera-space −z, metres
    T nearness;            ///< near / depth, in (0, 1]
    const ObjectView& object;
    const ColorSource& colors;
    std::size_t first; ///< sample of the strip that lane 0 is

    Vec3T<T> p() const { return origin + way * depth; } ///< in the world
    Lights<kPlain> lights() const { return {object.data.scene.lights}; }
    Direction<T> wo() const { return {way, -inverse_sqrt(dot(way, way))}; } ///< to the viewer
    /// The shading normal of an interpolated n of the object's space: in the world, on the side that is seen. Where a map bends
    /// normals: as that has it.
    Direction<T> normal(Vec3T<T> n) const { return !kPlain && object.bent ? Direction<T>{bent_normal(), T(1)} : smooth_normal(n); }
    /// The same, whatever maps say.
    Direction<T> smooth_normal(Vec3T<T> n) const {
        if constexpr (kFacing)
            return Direction<T>::of(object.normal(n));
        else
            return object.shading_normal(n, this->ng);
    }
    RgbT<T> base_color() const;
    /// And the light of its own, where it is a lamp.
    RgbT<T> with_emitted(RgbT<T> reflected) const { return !kPlain && object.emits ? reflected + emitted() : reflected; }

private:
    Vec3T<T> bent_normal() const;
    RgbT<T> emitted() const;
};

/// A strip's base colours from sample `first` on. Never inlined: so a fragment whose object has one colour need not lie in
/// memory.
[[gnu::noinline]] inline RgbT<Floats> sampled_colors(const ColorSource& colors, std::size_t first) {
    return colors.base_colors(first);
}

template <typename T, typename V, bool kDerivatives, bool kPlain, bool kFacing>
RgbT<T> FragmentInput<T, V, kDerivatives, kPlain, kFacing>::base_color() const {
    if (kPlain || object.color) return spread<T>(*object.color);
    if constexpr (std::same_as<T, float>)
        return colors.base_color(first);
    else
        return sampled_colors(colors, first);
}

/// And its normals, likewise.
[[gnu::noinline]] inline Vec3T<Floats> sampled_normals(const ColorSource& colors, std::size_t first) {
    const auto [x, y, z] = one_by_one(first, [&](std::size_t sample) { return colors.bent_normal(sample); });
    return {x, y, z};
}

template <typename T, typename V, bool kDerivatives, bool kPlain, bool kFacing>
Vec3T<T> FragmentInput<T, V, kDerivatives, kPlain, kFacing>::bent_normal() const {
    if constexpr (std::same_as<T, float>)
        return colors.bent_normal(first);
    else
        return sampled_normals(colors, first);
}

/// And the light of their own.
[[gnu::noinline]] inline RgbT<Floats> sampled_emission(const ColorSource& colors, std::size_t first) {
    const auto [r, g, b] = one_by_one(first, [&](std::size_t sample) { return colors.emitted(sample); });
    return {r, g, b};
}

template <typename T, typename V, bool kDerivatives, bool kPlain, bool kFacing>
RgbT<T> FragmentInput<T, V, kDerivatives, kPlain, kFacing>::emitted() const {
    if constexpr (std::same_as<T, float>)
        return colors.emitted(first);
    else
        return sampled_emission(colors, first);
}

/// Whether a shader asks for derivatives: `static constexpr bool kDerivatives = true;`
template <typename S> constexpr bool wants_derivatives() {
    if constexpr (requires { S::kDerivatives; })
        return S::kDerivatives;
    else
        return false;
}
/// Whether a shader's vertex function reads texture coordinates; `static constexpr bool kTextureCoordinates = false;`
/// promises that it does not, and saves gathering them.
template <typename S> constexpr bool wants_texture_coordinates() {
    if constexpr (requires { S::kTextureCoordinates; })
        return S::kTextureCoordinates;
    else
        return true;
}
/// Whether a shader's varyings matter by their directions alone: `static constexpr bool kDirections = true;` promises that its
/// fragment function returns the same for any positive multiple of all of them and does not read ng, and saves the division by
/// depth.
template <typename S> constexpr bool wants_directions() {
    if constexpr (requires { S::kDirections; })
        return S::kDirections && !wants_derivatives<S>();
    else
        return false;
}
template <typename S, typename T> using VaryingsOf = typename S::template Varyings<T>;
template <typename S, typename T, bool kPlain = false, bool kFacing = false>
using FragmentOf = FragmentInput<T, VaryingsOf<S, T>, wants_derivatives<S>(), kPlain, kFacing>;

/// Varyings are numbers in a row, to be interpolated one by one.
template <typename S> inline constexpr std::size_t kVaryings =
    std::is_empty_v<VaryingsOf<S, float>> ? 0 : sizeof(VaryingsOf<S, float>) / sizeof(float);
template <typename S, typename T> std::array<T, kVaryings<S>> numbers(const VaryingsOf<S, T>& varyings) {
    if constexpr (kVaryings<S> == 0)
        return {};
    else
        return std::bit_cast<std::array<T, kVaryings<S>>>(varyings);
}
template <typename S, typename T> VaryingsOf<S, T> varyings(const std::array<T, kVaryings<S>>& numbers) {
    if constexpr (kVaryings<S> == 0)
        return {};
    else
        return std::bit_cast<VaryingsOf<S, T>>(numbers);
}

/// What has varyings, and a vertex function for one point and for a batch.
template <typename S>
concept VertexShader = requires(const S& s, const VertexInput<float>& one, const VertexInput<Floats>& many) {
    { s.vertex(one) } -> std::same_as<VaryingsOf<S, float>>;
    { s.vertex(many) } -> std::same_as<VaryingsOf<S, Floats>>;
};
/// And a fragment function: linear radiance, in W/(m² sr) where it is meant to compare with light.
template <typename S>
concept Shader = VertexShader<S> && requires(const S& s, const FragmentOf<S, float>& one, const FragmentOf<S, Floats>& many,
                                             const FragmentOf<S, Floats, true>& plain,
                                             const FragmentOf<S, Floats, true, wants_directions<S>()>& facing) {
    { s.template fragment<float>(one) } -> std::same_as<Rgb>;
    { s.template fragment<Floats>(many) } -> std::same_as<RgbT<Floats>>;
    { s.template fragment<Floats>(plain) } -> std::same_as<RgbT<Floats>>;
    { s.template fragment<Floats>(facing) } -> std::same_as<RgbT<Floats>>;
};

} // namespace duet::raster
