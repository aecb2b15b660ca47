// Turns a shader of raster/shader/shader.h into a Program, which shades packets of samples in SIMD batches, object
// by object, and single hits with the same functions.
#pragma once

#include "raster/shader/linear_in_tile.h"
#include "raster/shader/one_sample.h"
#include "raster/shader/solve_sphere.h"
#include "raster/shader/strip_surface.h"
#include "raster/visibility/cover.h"

#include <algorithm>
#include <cassert>
#include <optional>
#include <vector>

namespace duet::raster {

inline void store(StripColors& to, std::size_t i, const RgbT<Floats>& c) {
    store(to.r, i, c.r), store(to.g, i, c.g), store(to.b, i, c.b);
}
inline void store(StripNormalsAndColors& to, std::size_t i, const NormalAndColor<Floats>& c) {
    store(to.normal.x, i, c.normal.x), store(to.normal.y, i, c.normal.y), store(to.normal.z, i, c.normal.z);
    store(to.color, i, c.color);
}
/// Copies the marked samples of a packet's components.
inline void copy_lanes(std::uint32_t lanes, const StripOf<float>& from, StripOf<float>& to) {
    for (std::size_t i = 0; i < kStrip; i += Floats::size)
        store(to, i, xsimd::select(lanes_from<float>(lanes >> i), load(from, i), load(to, i)));
}
inline void copy_lanes(std::uint32_t lanes, const StripColors& from, StripColors& to) {
    for (StripOf<float> StripColors::*c : {&StripColors::r, &StripColors::g, &StripColors::b})
        copy_lanes(lanes, from.*c, to.*c);
}
inline void copy_lanes(std::uint32_t lanes, const StripNormalsAndColors& from, StripNormalsAndColors& to) {
    using Vector = Vec3T<StripOf<float>>;
    for (StripOf<float> Vector::*c : {&Vector::x, &Vector::y, &Vector::z})
        copy_lanes(lanes, from.normal.*c, to.normal.*c);
    copy_lanes(lanes, from.color, to.color);
}

/// Returns the packet type of a shader's output.
template <Shader S>
using ColorsOf = std::conditional_t<
    std::same_as<decltype(std::declval<const S&>().template fragment<Floats>(
                     std::declval<const FragmentOf<S, Floats>&>())), RgbT<Floats>>,
    StripColors, StripNormalsAndColors>;

/// Shades the packets of one tile with shader S.
template <Shader S> class ShadedStrips final : public StripShaderOf<ColorsOf<S>> {
    using Colors = ColorsOf<S>;

public:
    ShadedStrips(const PreparedData& data, const Geometry& geometry, const PassView& view, const PixelRect& tile,
                 const S& shader)
        : data_(data), geometry_(geometry), view_(view), shader_(shader), surface_(data, geometry, view),
          solver_(geometry.triangles, view, tile, shader, data.scene.needs.footprints),
          ways_(view.pinhole.direction, view.pinhole.direction_dx, view.pinhole.direction_dy, tile),
          eye_(view.pinhole.origin), only_suns_(std::ranges::all_of(data.scene.lights, [](const Light& light) {
              return std::holds_alternative<SunLight>(light);
          })) {
        if (view.viewport.orthographic)
            eyes_.emplace(view.pinhole.origin, view.pinhole.origin_dx, view.pinhole.origin_dy, tile);
    }

    using StripShaderOf<Colors>::shade;
    void shade(std::span<const StripPlace> places, Colors* colors, std::uint32_t* seen) override {
        parts_.clear();
        shade_strips(places, colors, seen);
        if (!parts_.empty()) shade_parts();
    }

private:
    using Many = VaryingsOf<S, Floats>;
    using Solved = SolvedStrip<S, float>;

    /// Holds those samples of a packet that see one of several objects.
    struct Part {
        StripOf<std::int32_t> ids;
        StripPlace place;
        Colors* colors = nullptr;
    };

    void shade_strips(std::span<const StripPlace> places, Colors* colors, std::uint32_t* seen) {
        solver_.solve(places, true, [&](std::size_t first, std::span<const Solved> strips) {
            for (std::size_t s = 0; s < strips.size(); ++s) seen[first + s] = strips[s].samples->seen;
            for (std::size_t s = 0, end; s < strips.size(); s = end) {
                end = s + 1;
                if (strips[s].object_view != nullptr) {
                    if (plain(*strips[s].object_view))
                        while (end < strips.size() && alike(&places[first], strips, s, end)) ++end;
                    shade_solved(&places[first + s], strips.subspan(s, end - s), &colors[first + s]);
                } else if (strips[s].samples->seen != 0) {
                    shade_objects(places[first + s], *strips[s].samples, colors[first + s]);
                }
            }
        });
    }

    /// Returns true if the specialization for one color, unperturbed normals and suns only (kPlain) applies.
    bool plain(const ObjectView& object) const { return only_suns_ && object.even(); }
    /// Returns true if two packets can be shaded by the same loop, because their samples share the object and the
    /// offset.
    static bool alike(const StripPlace* places, std::span<const Solved> strips, std::size_t a, std::size_t b) {
        return strips[a].object_view == strips[b].object_view && strips[a].directions == strips[b].directions &&
               places[a].offsets == nullptr && places[b].offsets == nullptr && places[a].offset == places[b].offset;
    }

    /// Shades one packet, or several for which alike() holds.
    void shade_solved(const StripPlace* places, std::span<const Solved> strips, Colors* colors) {
        const Solved& strip = strips.front();
        const SampleOffset offset = places->offsets != nullptr ? SampleOffset{0, 0} : places->offset;
        ways_.use(offset);
        if (eyes_) eyes_->use(offset);
        if (plain(*strip.object_view)) return shade_as<true>(places, strips, colors);
        surface_.move_to(*places, *strip.samples, {&strip.b1, &strip.b2, &strip.b1_steps, &strip.b2_steps});
        shade_as<false>(places, strips, colors);
    }

    /// Shades a packet that sees several objects: spheres immediately, triangles later by shade_parts().
    void shade_objects(const StripPlace& place, const StripSamples& samples, Colors& colors) {
        for (std::uint32_t left = samples.seen; left != 0;) {
            const Run& run = solver_.run_of(samples.id(static_cast<std::size_t>(std::countr_zero(left))));
            const Triangles::Numbers own = geometry_.triangles.of_object(run);
            const Ints first(static_cast<std::int32_t>(own.first)), end(static_cast<std::int32_t>(own.end));
            std::uint32_t here = 0;
            for (std::size_t i = 0; i < kStrip; i += Ints::size)
                here |= lane_bits(load(samples.ids, i) >= first && load(samples.ids, i) < end) << i;
            here &= left;
            left &= ~here;
            if (run.sphere)
                shade_sphere(place, here, samples, geometry_.spheres[run.object], colors);
            else
                add_part(place, here, samples, colors);
        }
    }

    void add_part(const StripPlace& place, std::uint32_t lanes, const StripSamples& among, Colors& colors) {
        Part& part = parts_.emplace_back();
        part.place = place;
        part.colors = &colors;
        const Ints none(static_cast<std::int32_t>(kNoTriangle));
        for (std::size_t i = 0; i < kStrip; i += Ints::size)
            store(part.ids, i,
                  xsimd::select(xsimd::bool_cast(lanes_from<float>(lanes >> i)), load(among.ids, i), none));
    }

    void shade_sphere(const StripPlace& place, std::uint32_t lanes, const StripSamples& among, const DrawSphere& sphere,
                      Colors& colors) {
        StripSamples samples{.ids = among.ids, .seen = lanes};
        if (!sphere_view_ || sphere_view_->object != sphere.object) sphere_view_.emplace(data_, view_, sphere.object);
        Solved strip;
        strip.samples = &samples;
        solve_sphere(SphereStrip(view_, place, sphere, wants_derivatives<S>()), sphere.sphere, shader_, *sphere_view_,
                     strip);
        Colors own;
        shade_solved(&place, std::span(&strip, 1), &own);
        copy_lanes(lanes, own, colors);
    }

    /// Shades the collected parts. Each sees one object, so no further parts result.
    void shade_parts() {
        places_of_parts_.clear();
        for (const Part& part : parts_) {
            places_of_parts_.push_back(part.place);
            places_of_parts_.back().ids = part.ids.at(0);
        }
        colors_of_parts_.resize(parts_.size());
        seen_of_parts_.resize(parts_.size());
        shade_strips(places_of_parts_, colors_of_parts_.data(), seen_of_parts_.data());
        for (std::size_t i = 0; i < parts_.size(); ++i) copy_lanes(seen_of_parts_[i], colors_of_parts_[i], *parts_[i].colors);
    }

    template <bool kPlain>
    void shade_as(const StripPlace* places, std::span<const Solved> strips, Colors* colors) const {
        if constexpr (wants_directions<S>())
            if (strips.front().directions) return shade_together<kPlain, true>(places, strips, colors);
        shade_together<kPlain, false>(places, strips, colors);
    }

    /// `colors` is __restrict, so what packets share is loaded only once.
    template <bool kPlain, bool kFacing>
    void shade_together(const StripPlace* places, std::span<const Solved> strips,
                        Colors* __restrict colors) const {
        const ObjectView& object = *strips.front().object_view;
        for (std::size_t s = 0; s < strips.size(); ++s)
            for (std::size_t i = 0; i < kStrip; i += Floats::size)
                store(colors[s], i,
                      shader_.template fragment<Floats>(fragment<kPlain, kFacing>(places[s], strips[s], object, i)));
    }

    template <bool kPlain, bool kFacing>
    FragmentOf<S, Floats, kPlain, kFacing> fragment(const StripPlace& place, const Solved& strip,
                                                    const ObjectView& object, std::size_t i) const {
        const Floats near(static_cast<float>(view_.pinhole.near));
        const Floats nearness = place.nearness != nullptr ? Floats::load_aligned(place.nearness + i)
                                                          : min(near / load(strip.depth, i), Floats(1.0f));
        assert(!kFacing || place.nearness != nullptr);
        // A packet solved for directions has no depths. (The reversed depth is 0 where nothing is visible.)
        const Floats depth =
            kFacing ? near / xsimd::select(nearness > Floats(0.0f), nearness, Floats(1.0f)) : load(strip.depth, i);
        return {derivatives(strip, i),
                seen_side<kFacing>(strip, i),
                varyings_at(strip.at, i),
                eyes_ ? vector(*eyes_, place, i) : spread<Floats>(eye_),
                vector(ways_, place, i),
                depth,
                nearness,
                object,
                surface_,
                i};
    }

    static Vec3T<Floats> vector(const LinearInTile& of, const StripPlace& place, std::size_t i) {
        const Vec3T<Floats> here = of.at(place.x, place.y, i);
        if (place.offsets == nullptr) return here;
        return here +
               of.moved(in_pixel(*place.offsets, i, &SampleOffset::x), in_pixel(*place.offsets, i, &SampleOffset::y));
    }
    static Floats in_pixel(const std::array<SampleOffset, kStrip>& offsets, std::size_t first,
                           std::int32_t SampleOffset::*axis) {
        StripOf<float> own;
        for (std::size_t i = 0; i < Floats::size; ++i)
            own[i] = static_cast<float>(offsets[first + i].*axis) / kSubPixels;
        return load(own, 0);
    }
    template <std::size_t N> static Many varyings_at(const std::array<StripOf<float>, N>& from, std::size_t i) {
        Many result;
        for (std::size_t c = 0; c < N; ++c) { // one by one, so that compilers keep them in registers
            const Floats number = load(from[c], i);
            std::memcpy(reinterpret_cast<char*>(&result) + c * sizeof(number), static_cast<const void*>(&number),
                        sizeof(number));
        }
        return result;
    }
    template <bool kFacing> static SeenSide<Floats, kFacing> seen_side(const Solved& strip, std::size_t i) {
        if constexpr (kFacing)
            return {};
        else
            return {strips::vector(strip.ng, 0, i)};
    }
    static auto derivatives(const Solved& strip, std::size_t i) {
        if constexpr (wants_derivatives<S>())
            return ScreenDerivatives<Many, true>{varyings_at(strip.dx, i), varyings_at(strip.dy, i)};
        else
            return ScreenDerivatives<Many, false>{};
    }

    const PreparedData& data_;
    const Geometry& geometry_;
    const PassView& view_;
    const S& shader_;
    StripSurface surface_; ///< of the current packet
    StripSolver<S, float> solver_;
    LinearInTile ways_;                ///< directions of camera rays
    Vec3 eye_;                         ///< common origin of all camera rays
    std::optional<LinearInTile> eyes_; ///< or an origin per pixel in an orthographic view
    std::vector<Part> parts_;
    std::vector<StripPlace> places_of_parts_; ///< arguments of shade_strips() for the parts
    std::vector<Colors> colors_of_parts_;
    std::vector<std::uint32_t> seen_of_parts_;
    std::optional<ObjectView> sphere_view_; ///< view of the last sphere shaded
    bool only_suns_;                   ///< true if all lights of the scene are suns
};

/// Implements a Program that owns a copy of its shader.
template <Shader S> class ProgramOf final : public Program {
public:
    explicit ProgramOf(S shader) : shader_(std::move(shader)) {}
    std::unique_ptr<StripShader> for_tile(const PreparedData& data, const Geometry& geometry, const PassView& view,
                                          const PixelRect& tile) const override {
        return std::make_unique<ShadedStrips<S>>(data, geometry, view, tile, shader_);
    }
    Rgb shade_hit(const PreparedData& data, const PassView& view, const Hit& hit, Vec2d pixel) const override {
        return shade_one(data, view, shader_, hit, pixel, static_cast<int>(view.samples.size()));
    }

private:
    S shader_;
};

} // namespace duet::raster
