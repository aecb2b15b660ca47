// Implements programmable shading: a vertex and a fragment function in C++, each written once for single points and
// SIMD batches.
//
//     struct Stripes {
//         template <typename T> struct Varyings { T height; };             // only T, and vectors and colors of T
//         template <typename T> Varyings<T> vertex(const VertexInput<T>& v) const { return {v.world_p().y}; }
//         template <typename T, typename F> RgbT<T> fragment(const F& f) const {
//             return select_each(f.at.height > T(0.5f), f.base_color(), RgbT<T>(T(1)));
//         }
//     };
//     Rendering image = draw(prepared, view, settings, Stripes{}, control);   // raster/draw.h
//
// Visibility is resolved first (an image of triangle ids). A fragment function therefore runs once for each packet
// of samples in which an object is visible; its results for other samples are discarded. A vertex function runs
// only for the corners of visible triangles and for each sample of a sphere. Both are inlined into the loop over
// packets. They can't change the position of a vertex in the image, which is computed exactly
// (raster/geometry/transform.h).
#pragma once

#include "common/image/rgb.h"
#include "common/vec/matrix.h"
#include "raster/geometry/packet.h"
#include "raster/raster_scene.h"

#include <bit>
#include <concepts>
#include <limits>
#include <optional>
#include <span>
#include <type_traits>

namespace duet::raster {

struct PassView;

/// Returns v / |v|. v must not be zero.
template <typename T> Vec3T<T> unit(Vec3T<T> v) { return v * inverse_sqrt(dot(v, v)); }
/// Represents a direction whose vector has any length. A cosine with it takes one multiplication by `scale`;
/// normalizing the vector would take three.
template <typename T> struct Direction {
    Vec3T<T> v;
    T scale; ///< 1/|v|, or −1/|v| if v points the opposite way

    /// Returns the direction of v. A zero vector, as interpolated between opposite normals, has cosine 0 with every
    /// direction.
    static Direction of(Vec3T<T> v) { return {v, inverse_sqrt(max(dot(v, v), T(std::numeric_limits<float>::min())))}; }
    Vec3T<T> unit() const { return v * scale; }
};
/// Returns `a` where the condition holds, else `b`.
template <typename T, typename Mask> RgbT<T> select_each(Mask condition, RgbT<T> a, RgbT<T> b) {
    return {select(condition, a.r, b.r), select(condition, a.g, b.g), select(condition, a.b, b.b)};
}

/// Holds the state that all vertices and samples of an object share in one view.
struct ObjectView {
    const RasterSceneData& data;
    const PassView& pass;
    std::uint32_t object;      ///< index into Scene::objects
    bool identity;             ///< whether object space equals world space
    bool smooth;               ///< whether it has vertex normals, or is a sphere
    bool has_normal_map;       ///< whether it has a material with a normal or bump map
    bool is_emissive;          ///< whether it has an emissive material
    Mat4 to_world, to_object;  ///< at the pass's time
    std::optional<Rgb> color;  ///< base color, if it is constant
    /// Returns true if the material is constant over the surface and does not emit light.
    bool is_uniform() const { return color && !has_normal_map && !is_emissive; }
    Vec3 eye, forward;         ///< viewer position, and unit view direction
    bool orthographic;

    ObjectView(const RasterSceneData& data, const PassView& pass, std::uint32_t object);

    /// Transforms a point to world space.
    template <typename T> Vec3T<T> point(Vec3T<T> p) const {
        if (identity) return p;
        const auto row = [&](std::size_t r) {
            const auto& m = to_world[r];
            return T(m[0]) * p.x + T(m[1]) * p.y + T(m[2]) * p.z + T(m[3]);
        };
        return {row(0), row(1), row(2)};
    }
    /// Transforms a normal to world space, without normalization.
    template <typename T> Vec3T<T> normal(Vec3T<T> n) const {
        if (identity) return n;
        const auto column = [&](std::size_t c) {
            return T(to_object[0][c]) * n.x + T(to_object[1][c]) * n.y + T(to_object[2][c]) * n.z;
        };
        return {column(0), column(1), column(2)};
    }
    /// Returns the world-space shading normal, in the hemisphere of ng. `n` is the interpolated and `ng` the
    /// geometric normal on the visible side, both in object space and of any length. ng is used if the object has
    /// no vertex normals.
    template <typename T> Direction<T> shading_normal(Vec3T<T> n, Vec3T<T> ng) const {
        const Vec3T<T> g = normal(ng);
        if (!smooth) return Direction<T>::of(g);
        const Direction<T> s = Direction<T>::of(normal(n));
        return {s.v, s.scale * select(dot(s.v, g) < T(0), T(-1), T(1))};
    }
    /// Returns the unit vector from a world-space point to the viewer.
    template <typename T> Vec3T<T> to_viewer(Vec3T<T> p) const {
        return orthographic ? -broadcast<T>(forward) : unit(broadcast<T>(eye) - p);
    }
};

/// Holds the input of a vertex function, which is a corner of a visible triangle or a point on a sphere. All vectors
/// are in object space, except those returned by functions named world_….
template <typename T> struct VertexInput {
    Vec3T<T> p;
    Vec3T<T> n; ///< vertex normal of the mesh, or (0, 0, 0)
    Vec2T<T> uv;
    Vec3T<T> ng;     ///< geometric normal of the triangle on the visible side, of any length
    Vec3T<T> middle; ///< centroid of the triangle or of the whole quad; p for a sphere
    /// Each edge has one value: 1 at the opposite corner, 0 on the edge. It is 1 everywhere for a quad's diagonal,
    /// which is not an edge, and on spheres.
    Vec3T<T> edges;
    const ObjectView& object;

    Vec3T<T> world_p() const { return object.point(p); }
    Vec3T<T> world_middle() const { return object.point(middle); }
    /// Returns the shading normal; unit, on the visible side.
    Vec3T<T> world_n() const { return object.shading_normal(n, ng).unit(); }
    Vec3T<T> world_ng() const { return unit(object.normal(ng)); }
};

/// Evaluates a scalar function for each lane and returns its three results as batches.
template <typename Evaluate> std::array<Floats, 3> evaluate_per_lane(std::size_t first, const Evaluate& evaluate) {
    std::array<PacketOf<float>, 3> found;
    for (std::size_t lane = 0; lane < Floats::size; ++lane) {
        const auto value = evaluate(first + lane);
        for (std::size_t axis = 0; axis < 3; ++axis) found[axis][lane] = value[axis];
    }
    return {load(found[0], 0), load(found[1], 0), load(found[2], 0)};
}

/// Evaluates per sample what SIMD code does not cover: base colors and normals that depend on textures, and emission.
class ColorSource {
public:
    virtual ~ColorSource() = default;
    /// Returns the base color of a sample.
    virtual Rgb base_color(std::size_t sample) const = 0;
    /// Returns the base colors of one batch of samples from `first` on.
    virtual RgbT<Floats> base_colors(std::size_t first) const {
        const auto [r, g, b] = evaluate_per_lane(first, [&](std::size_t sample) { return base_color(sample); });
        return {r, g, b};
    }
    virtual Vec3 mapped_normal(std::size_t sample) const = 0; ///< in world space, unit, on the visible side
    virtual Rgb emitted(std::size_t sample) const = 0; ///< emitted radiance toward the viewer
};

/// Is empty unless a shader requests derivatives.
template <typename V, bool kDerivatives> struct ScreenDerivatives {};
/// Holds the derivatives that a shader requests.
template <typename V> struct ScreenDerivatives<V, true> {
    /// These are exact screen-space derivatives of the varyings along the row and down the column, per pixel.
    V dx, dy;
};

/// Holds the input of a fragment function, which is a sample with a visible surface. dx and dy exist if the shader
/// requests derivatives.
template <typename T, typename V, bool kDerivatives> struct FragmentInput : ScreenDerivatives<V, kDerivatives> {
    Vec3T<T> ng;                ///< geometric normal on the visible side, in object space, of any length
    V at;                       ///< perspective-correct interpolated varyings
    Vec3T<T> origin, direction; ///< world-space camera ray; `direction` has camera-space −z = 1
    T depth;                    ///< camera-space −z, meters
    T reversed_depth;           ///< near / depth, in (0, 1]
    const ObjectView& object;
    const ColorSource& colors; ///< used only by base_color(), normal() and with_emitted()
    std::size_t first; ///< index in the packet of lane 0's sample

    Vec3T<T> p() const { return origin + direction * depth; } ///< in world space
    std::span<const Light> lights() const { return object.data.scene.lights; }
    Direction<T> wo() const { return {direction, -inverse_sqrt(dot(direction, direction))}; } ///< toward the viewer
    /// Returns the world-space shading normal on the visible side from an interpolated object-space normal n. A
    /// normal or bump map overrides n.
    Direction<T> normal(Vec3T<T> n) const {
        return object.has_normal_map ? Direction<T>{mapped_normal(), T(1)} : smooth_normal(n);
    }
    /// Returns the shading normal without normal and bump maps.
    Direction<T> smooth_normal(Vec3T<T> n) const { return object.shading_normal(n, ng); }
    /// Returns the base color, with filtered textures.
    RgbT<T> base_color() const;
    /// Adds the emitted radiance of an emissive material.
    RgbT<T> with_emitted(RgbT<T> reflected) const {
        return object.is_emissive ? reflected + emitted() : reflected;
    }

private:
    Vec3T<T> mapped_normal() const;
    RgbT<T> emitted() const;
};

/// Returns a packet's base colors from sample `first` on. It is never inlined, so that fragments of objects with
/// one color do not have to be stored in memory.
[[gnu::noinline]] inline RgbT<Floats> sampled_colors(const ColorSource& colors, std::size_t first) {
    return colors.base_colors(first);
}

template <typename T, typename V, bool kDerivatives>
RgbT<T> FragmentInput<T, V, kDerivatives>::base_color() const {
    if (object.color) return broadcast<T>(*object.color);
    if constexpr (std::same_as<T, float>)
        return colors.base_color(first);
    else
        return sampled_colors(colors, first);
}

/// Returns the packet's mapped normals from sample `first` on; see sampled_colors().
[[gnu::noinline]] inline Vec3T<Floats> sampled_normals(const ColorSource& colors, std::size_t first) {
    const auto [x, y, z] = evaluate_per_lane(first, [&](std::size_t sample) { return colors.mapped_normal(sample); });
    return {x, y, z};
}

template <typename T, typename V, bool kDerivatives>
Vec3T<T> FragmentInput<T, V, kDerivatives>::mapped_normal() const {
    if constexpr (std::same_as<T, float>)
        return colors.mapped_normal(first);
    else
        return sampled_normals(colors, first);
}

/// Returns the packet's emitted radiance from sample `first` on; see sampled_colors().
[[gnu::noinline]] inline RgbT<Floats> sampled_emission(const ColorSource& colors, std::size_t first) {
    const auto [r, g, b] = evaluate_per_lane(first, [&](std::size_t sample) { return colors.emitted(sample); });
    return {r, g, b};
}

template <typename T, typename V, bool kDerivatives>
RgbT<T> FragmentInput<T, V, kDerivatives>::emitted() const {
    if constexpr (std::same_as<T, float>)
        return colors.emitted(first);
    else
        return sampled_emission(colors, first);
}

/// Returns true if a shader requests derivatives, which `static constexpr bool kDerivatives = true;` does.
template <typename S> constexpr bool wants_derivatives() {
    if constexpr (requires { S::kDerivatives; })
        return S::kDerivatives;
    else
        return false;
}
/// Returns true if a shader's vertex function may read texture coordinates. `static constexpr bool
/// kTextureCoordinates = false;` declares that it does not, which saves gathering them.
template <typename S> constexpr bool wants_texture_coordinates() {
    if constexpr (requires { S::kTextureCoordinates; })
        return S::kTextureCoordinates;
    else
        return true;
}
template <typename S, typename T> using VaryingsOf = typename S::template Varyings<T>;
template <typename S, typename T> using FragmentOf = FragmentInput<T, VaryingsOf<S, T>, wants_derivatives<S>()>;

/// This is the number of floats in a shader's varyings, which are interpolated one by one.
template <typename S> inline constexpr std::size_t kVaryings =
    std::is_empty_v<VaryingsOf<S, float>> ? 0 : sizeof(VaryingsOf<S, float>) / sizeof(float);
/// Returns a shader's varyings as an array, in the order of their declaration.
template <typename S, typename T> std::array<T, kVaryings<S>> varying_floats(const VaryingsOf<S, T>& varyings) {
    if constexpr (kVaryings<S> == 0)
        return {};
    else
        return std::bit_cast<std::array<T, kVaryings<S>>>(varyings);
}
/// Returns the varyings that an array from varying_floats() stores.
template <typename S, typename T> VaryingsOf<S, T> varyings(const std::array<T, kVaryings<S>>& floats) {
    if constexpr (kVaryings<S> == 0)
        return {};
    else
        return std::bit_cast<VaryingsOf<S, T>>(floats);
}

/// Holds the result of the G-buffer's shader for a sample.
template <typename T> struct SurfaceAttributes {
    Vec3T<T> normal; ///< unit shading normal
    T bulge;         ///< GBuffer::bulge
    RgbT<T> color;   ///< base color
};

/// A VertexShader has varyings and a vertex function, for single points and SIMD batches.
template <typename S>
concept VertexShader = requires(const S& s, const VertexInput<float>& one, const VertexInput<Floats>& many) {
    { s.vertex(one) } -> std::same_as<VaryingsOf<S, float>>;
    { s.vertex(many) } -> std::same_as<VaryingsOf<S, Floats>>;
};
template <typename O, typename T>
concept FragmentOutput = std::same_as<O, RgbT<T>> || std::same_as<O, SurfaceAttributes<T>>;
/// A Shader is a vertex shader with a fragment function. It returns linear radiance, in W/(m² sr) if it is to be
/// compared with light.
template <typename S>
concept Shader = VertexShader<S> &&
    requires(const S& s, const FragmentOf<S, float>& one, const FragmentOf<S, Floats>& many) {
    { s.template fragment<float>(one) } -> FragmentOutput<float>;
    { s.template fragment<Floats>(many) } -> FragmentOutput<Floats>;
};

} // namespace duet::raster
