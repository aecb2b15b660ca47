// A medium is matter that fills a part of space, such as fog: light that passes through it is absorbed and scattered,
// and it may glow.
#pragma once

#include "common/image/rgb.h"
#include "common/vec/box.h"
#include "common/vec/interval.h"
#include "common/vec/ray.h"

#include <array>
#include <cmath>
#include <memory>
#include <span>

namespace duet {

class DensityGrid; // common/medium/density_grid.h

/// A scene may have at most this many media, because each ray is tested against each of them.
inline constexpr std::size_t kMaxMedia = 64;

/// A Medium fills an axis-aligned box; a box without bounds is all of space. Where several overlap, their coefficients
/// add up. Glass and other dielectrics displace it: it is not inside of them.
struct Medium {
    Box3 box = unbounded();
    Rgb scattering; ///< scattering coefficient σs where the density is 1, 1/m
    Rgb absorption; ///< absorption coefficient σa where the density is 1, 1/m
    /// This is the radiance that an infinitely thick layer without scattering emits, W/(m² sr). Over a short distance d
    /// the medium adds σa·d times that (Kirchhoff's law).
    Rgb radiance;
    float asymmetry = 0; ///< g, the mean cosine of the angle by which light is scattered, in (−1, 1)
    /// This is the density in the box; a medium with a density must have bounds. If it is null, the density is 1.
    std::shared_ptr<const DensityGrid> density{};

    static constexpr Box3 unbounded() {
        Box3 box;
        std::swap(box.low, box.high);
        return box;
    }
};

/// Returns the interval of [0, t_end] in which a ray is inside of the box (Kay and Kajiya 1986, "Ray Tracing Complex
/// Scenes"). t_end may be infinite. T is float or a batch of floats.
template <typename T>
IntervalT<T> overlap(const Box3& box, const Vec3T<T>& origin, const Vec3T<T>& direction, T t_end) {
    IntervalT<T> interval{T(0), t_end};
    const auto clip = [&](float Vec3::*axis, T o, T d) {
        const T low = T(box.low.*axis), high = T(box.high.*axis);
        const MaskOf<T> parallel = d == T(0), outside = (o < low) | (high < o);
        const T a = (low - o) / d, b = (high - o) / d; // both unused where the ray is parallel to the planes
        const T end = select(outside, interval.begin, interval.end);
        interval.begin = select(parallel, interval.begin, max(interval.begin, min(a, b)));
        interval.end = select(parallel, end, min(interval.end, max(a, b)));
    };
    clip(&Vec3::x, origin.x, direction.x);
    clip(&Vec3::y, origin.y, direction.y);
    clip(&Vec3::z, origin.z, direction.z);
    return interval;
}
inline Interval overlap(const Box3& box, const Ray& ray, float t_end) {
    return overlap(box, ray.origin, ray.direction, t_end);
}

/// Returns the density of a medium at a point of its box.
float density_at(const Medium& medium, Vec3 p);

/// A PassedColumn says how far a ray goes before it has passed a given column of a medium.
struct PassedColumn {
    float t = 0;      ///< where the column is passed; infinite if the interval ends before
    float column = 0; ///< the column up to t, or on the whole interval
};
/// Follows a ray through a part of its overlap with a medium until it has passed a column, > 0 or infinite. A column is
/// the integral of the density over the distance, in meters.
PassedColumn follow(const Medium& medium, const Ray& ray, Interval inside, float column);

/// Returns the column of a medium on a part of a ray's overlap with it, in meters. T is float or a batch of floats.
template <typename T>
T column_of(const Medium& medium, const Vec3T<T>& origin, const Vec3T<T>& direction, const IntervalT<T>& inside) {
    if (medium.density == nullptr) return select(inside.empty(), T(0), inside.end - inside.begin);
    if constexpr (std::is_same_v<T, float>) {
        return inside.empty() ? 0 : follow(medium, Ray{origin, direction}, inside, kInfinity).column;
    } else {
        const auto lanes = [](const T& batch) {
            std::array<float, T::size> values;
            batch.store_unaligned(values.data());
            return values;
        };
        const std::array o{lanes(origin.x), lanes(origin.y), lanes(origin.z)};
        const std::array d{lanes(direction.x), lanes(direction.y), lanes(direction.z)};
        const auto begin = lanes(inside.begin), end = lanes(inside.end);
        std::array<float, T::size> columns;
        for (std::size_t i = 0; i < T::size; ++i)
            columns[i] =
                column_of<float>(medium, {o[0][i], o[1][i], o[2][i]}, {d[0][i], d[1][i], d[2][i]}, {begin[i], end[i]});
        return T::load_unaligned(columns.data());
    }
}

/// Returns the optical depth of columns of a medium: the integral of σs + σa. T is float or a batch of floats.
template <typename T> RgbT<T> optical_depth(const Medium& medium, const T& column) {
    // The column may be infinite where the coefficient is 0, and their product would then be NaN.
    const auto channel = [&](float coefficient) { return coefficient > 0 ? T(coefficient) * column : T(0); };
    const Rgb extinction = medium.scattering + medium.absorption;
    return {channel(extinction.r), channel(extinction.g), channel(extinction.b)};
}
/// Returns the optical depth of all media over [0, t_end] of a ray. T is float or a batch of floats.
template <typename T>
RgbT<T> optical_depth(std::span<const Medium> media, const Vec3T<T>& origin, const Vec3T<T>& direction, T t_end) {
    RgbT<T> depth(T(0));
    for (const Medium& medium : media)
        depth +=
            optical_depth(medium, column_of(medium, origin, direction, overlap(medium.box, origin, direction, t_end)));
    return depth;
}

/// Returns the fraction of light that passes an optical depth: the law of Beer and Lambert.
template <typename T> RgbT<T> transmittance(const RgbT<T>& depth) {
    using std::exp;
    return {exp(-depth.r), exp(-depth.g), exp(-depth.b)};
}
/// Returns the fraction of light that the media let through on [0, t_end] of the ray.
inline Rgb transmittance(std::span<const Medium> media, const Ray& ray, float t_end) {
    return transmittance(optical_depth(media, ray.origin, ray.direction, t_end));
}

} // namespace duet
