// A shader of raster/shader/shader.h becomes a Program: whole strips of one mesh in batches, all else sample by sample, by the
// same functions.
#pragma once

#include "raster/shader/linear_in_tile.h"
#include "raster/shader/one_sample.h"
#include "raster/shader/solve.h"
#include "raster/shader/strip_surface.h"
#include "raster/visibility/cover.h"

#include <algorithm>
#include <cassert>
#include <optional>

namespace duet::raster {

template <Shader S> class ShadedStrips final : public StripShader {
public:
    ShadedStrips(const PreparedData& data, const Geometry& geometry, const PassView& view, const PixelRect& tile, const S& shader)
        : data_(data), geometry_(geometry), view_(view), shader_(shader), surface_(data, geometry, view),
          solver_(geometry.triangles, view, tile, shader, data.scene.needs.footprints),
          ways_(view.pinhole.direction, view.pinhole.direction_dx, view.pinhole.direction_dy, tile), eye_(view.pinhole.origin),
          only_suns_(std::ranges::all_of(data.scene.lights, [](const Light& light) { return std::holds_alternative<SunLight>(light); })) {
        if (view.viewport.orthographic) eyes_.emplace(view.pinhole.origin, view.pinhole.origin_dx, view.pinhole.origin_dy, tile);
    }

    using StripShader::shade;
    void shade(std::span<const StripPlace> places, StripColors* colors, std::uint32_t* seen) override {
        solver_.solve(places, true, [&](std::size_t s, const Solved& strip) {
            const StripSamples& samples = *strip.samples;
            seen[s] = samples.seen;
            const StripPlace& place = places[s];
            surface_.move_to(place, samples, {&strip.b1, &strip.b2, &strip.b1_steps, &strip.b2_steps});
            if (samples.seen == 0) return;
            if (samples.on_mesh != samples.seen)
                return shade_one_by_one(place, samples, colors[s]);
            const SampleOffset offset = place.offsets != nullptr ? SampleOffset{0, 0} : place.offset;
            ways_.use(offset);
            if (eyes_) eyes_->use(offset);
            if (only_suns_ && strip.object_view->even())
                shade_as<true>(place, strip, colors[s]);
            else
                shade_as<false>(place, strip, colors[s]);
        });
    }

private:
    using Many = VaryingsOf<S, Floats>;
    using Solved = SolvedStrip<S, float>;

    void shade_one_by_one(const StripPlace& place, const StripSamples& strip, StripColors& colors) const {
        for (std::uint32_t left = strip.seen; left != 0; left &= left - 1) {
            const auto i = static_cast<std::size_t>(std::countr_zero(left));
            const Vec2d pixel = place.position(i);
            const Rgb c = shade_one(data_, view_, shader_, find_hit(geometry_, view_, strip.id(i), pixel), pixel,
                                    samples_per_pixel(place, view_),
                                    place.nearness != nullptr ? place.nearness + i : nullptr);
            colors.r[i] = c.r, colors.g[i] = c.g, colors.b[i] = c.b;
        }
    }

    template <bool kPlain> void shade_as(const StripPlace& place, const Solved& strip, StripColors& colors) const {
        if constexpr (wants_directions<S>())
            if (strip.directions) return shade_together<kPlain, true>(place, strip, colors);
        shade_together<kPlain, false>(place, strip, colors);
    }

    template <bool kPlain, bool kFacing>
    void shade_together(const StripPlace& place, const Solved& strip, StripColors& colors) const {
        for (std::size_t i = 0; i < kStrip; i += Floats::size) {
            const Floats near(static_cast<float>(view_.pinhole.near));
            const Floats nearness = place.nearness != nullptr ? Floats::load_aligned(place.nearness + i)
                                                              : min(near / load(strip.depth, i), Floats(1.0f));
            assert(!kFacing || place.nearness != nullptr);
            // A strip of directions has no depths. (Where nothing is seen nearness is 0.)
            const Floats depth = kFacing ? near / xsimd::select(nearness > Floats(0.0f), nearness, Floats(1.0f)) : load(strip.depth, i);
            const FragmentOf<S, Floats, kPlain, kFacing> fragment{derivatives(strip, i),
                                                 seen_side<kFacing>(strip, i),
                                                 varyings_at(strip.at, i),
                                                 eyes_ ? vector(*eyes_, place, i) : spread<Floats>(eye_),
                                                 vector(ways_, place, i),
                                                 depth,
                                                 nearness,
                                                 *strip.object_view,
                                                 surface_,
                                                 i};
            const RgbT<Floats> c = shader_.template fragment<Floats>(fragment);
            store(colors.r, i, c.r);
            store(colors.g, i, c.g);
            store(colors.b, i, c.b);
        }
    }

    static Vec3T<Floats> vector(const LinearInTile& of, const StripPlace& place, std::size_t i) {
        const Vec3T<Floats> here = of.at(place.x, place.y, i);
        if (place.offsets == nullptr) return here;
        return here + of.moved(in_pixel(*place.offsets, i, &SampleOffset::x), in_pixel(*place.offsets, i, &SampleOffset::y));
    }
    static Floats in_pixel(const std::array<SampleOffset, kStrip>& offsets, std::size_t first, std::int32_t SampleOffset::*axis) {
        StripOf<float> own;
        for (std::size_t i = 0; i < Floats::size; ++i) own[i] = static_cast<float>(offsets[first + i].*axis) / kSubPixels;
        return load(own, 0);
    }
    template <std::size_t N> static Many varyings_at(const std::array<StripOf<float>, N>& from, std::size_t i) {
        Many result;
        for (std::size_t c = 0; c < N; ++c) { // one by one, as compilers keep them in registers
            const Floats number = load(from[c], i);
            std::memcpy(reinterpret_cast<char*>(&result) + c * sizeof(number), static_cast<const void*>(&number), sizeof(number));
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
    StripSurface surface_; ///< of the strip at hand
    StripSolver<S, float> solver_;
    LinearInTile ways_;                ///< of camera rays
    Vec3 eye_;                         ///< and where they begin: all of them there,
    std::optional<LinearInTile> eyes_; ///< or each at a place of its own
    bool only_suns_;                   ///< are the scene's lights
};

/// A shader, kept by value.
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
