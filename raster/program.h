// A shader of raster/shader.h becomes a Program: whole strips of one mesh in batches, all else sample by sample, by the
// same functions.
#pragma once

#include "raster/cover.h"
#include "raster/one_sample.h"
#include "raster/solve.h"

#include "common/vec/robust.h"

#include <algorithm>

namespace duet::raster {

template <Shader S> class ShadedStrips final : public StripShader, private ColorSource {
public:
    ShadedStrips(const PreparedData& data, const Geometry& geometry, const PassView& view, const PixelRect& tile, const S& shader)
        : data_(data), geometry_(geometry), view_(view), shader_(shader), solver_(geometry.triangles, view, tile, shader, data.scene.needs.footprints),
          ways_(view.pinhole.direction, view.pinhole.direction_dx, view.pinhole.direction_dy, tile),
          eyes_(view.pinhole.origin, view.pinhole.origin_dx, view.pinhole.origin_dy, tile),
          only_suns_(std::ranges::all_of(data.scene.lights, [](const Light& light) { return std::holds_alternative<SunLight>(light); })) {}

    using StripShader::shade;
    void shade(std::span<const StripPlace> places, StripColors* colors, std::uint32_t* seen) override {
        solver_.solve(places, true, [&](std::size_t s, const Solved& strip) {
            const StripSamples& samples = *strip.samples;
            seen[s] = samples.seen;
            place_ = &places[s];
            strip_ = &strip;
            if (samples.seen == 0) return;
            if (samples.on_mesh != samples.seen)
                shade_one_by_one(*place_, samples, colors[s]);
            else if (only_suns_ && strip.object_view->even())
                shade_as<true>(*place_, strip, colors[s]);
            else
                shade_as<false>(*place_, strip, colors[s]);
        });
    }

private:
    using Many = VaryingsOf<S, Floats>;
    using Solved = SolvedStrip<S, float>;

    /// A vector that is linear in the pixel, counted from the tile's corner: rounded once a tile, to floats whose errors
    /// are of their last place.
    struct Linear {
        Vec3 start, step_x, step_y;
        int x0, y0;

        Linear(Vec3d start_, Vec3d dx, Vec3d dy, const PixelRect& tile)
            : start(start_ + dx * static_cast<double>(tile.x0) + dy * static_cast<double>(tile.y0)), step_x(dx), step_y(dy),
              x0(tile.x0), y0(tile.y0) {}
        Vec3T<Floats> at(const Floats& x, const Floats& y) const {
            const auto along = [&](std::size_t axis) {
                return fused(Floats(step_x[axis]), x, fused(Floats(step_y[axis]), y, Floats(start[axis])));
            };
            return {along(0), along(1), along(2)};
        }
    };

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
        const SampleOffset offset = place.offsets != nullptr ? SampleOffset{0, 0} : place.offset;
        const Floats left(static_cast<float>(place.x - ways_.x0) + static_cast<float>(offset.x) / kSubPixels),
            top(static_cast<float>(place.y - ways_.y0) + static_cast<float>(offset.y) / kSubPixels);
        for (std::size_t i = 0; i < kStrip; i += Floats::size) {
            Floats x = left + load(kColumns<float>, i), y = top + load(kRows<float>, i);
            if (place.offsets != nullptr) {
                x += in_pixel(*place.offsets, i, &SampleOffset::x);
                y += in_pixel(*place.offsets, i, &SampleOffset::y);
            }
            const Floats near(static_cast<float>(view_.pinhole.near));
            const Floats nearness = place.nearness != nullptr ? Floats::load_aligned(place.nearness + i)
                                                              : min(near / load(strip.depth, i), Floats(1.0f));
            const Floats depth = kFacing ? near / nearness : load(strip.depth, i); // a strip of directions has none
            const FragmentOf<S, Floats, kPlain, kFacing> fragment{derivatives(strip, i),
                                                 varyings_at(strip.at, i),
                                                 strips::vector(strip.ng, 0, i),
                                                 view_.viewport.orthographic ? eyes_.at(x, y) : spread<Floats>(eyes_.start),
                                                 ways_.at(x, y),
                                                 depth,
                                                 nearness,
                                                 *strip.object_view,
                                                 *this,
                                                 i};
            const RgbT<Floats> c = shader_.template fragment<Floats>(fragment);
            store(colors.r, i, c.r);
            store(colors.g, i, c.g);
            store(colors.b, i, c.b);
        }
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
    static auto derivatives(const Solved& strip, std::size_t i) {
        if constexpr (wants_derivatives<S>())
            return ScreenDerivatives<Many, true>{varyings_at(strip.dx, i), varyings_at(strip.dy, i)};
        else
            return ScreenDerivatives<Many, false>{};
    }

    Vec3 bent_normal(std::size_t sample) const override {
        if (!(strip_->samples->seen >> sample & 1)) return {0, 0, 1};
        const Vec2d pixel = place_->position(sample);
        return hit_normal(data_.scene, view_, find_hit(geometry_, view_, strip_->samples->id(sample), pixel), pixel,
                          samples_per_pixel(*place_, view_));
    }

    /// As surface_point() and set_footprint() have it, but for what base colours don't depend on. (The steps of texture
    /// coordinates follow from those of the barycentrics, which have been found for all samples side by side.)
    Rgb base_color(std::size_t sample) const override {
        const StripSamples& samples = *strip_->samples;
        if (!(samples.seen >> sample & 1)) return {};
        const Mesh& mesh = *samples.mesh;
        const bool filtered = data_.scene.needs.footprints;
        const double u = static_cast<double>(strip_->b1[sample]), v = static_cast<double>(strip_->b2[sample]);
        const auto& corners = mesh.triangles[samples.index(sample)];
        SurfacePoint point;
        point.object = samples.object->object;
        point.primitive = static_cast<std::uint32_t>(samples.index(sample));
        point.material = material_index(data_.scene, point.object, point.primitive);
        point.time = view_.time;
        const Vec3d a(mesh.positions[corners[0]]), b(mesh.positions[corners[1]]), c(mesh.positions[corners[2]]);
        point.p_object = Vec3(a + (b - a) * u + (c - a) * v);
        point.uv = Vec2(static_cast<float>(u), static_cast<float>(v));
        Vec2d along_u(1, 0), along_v(0, 1); // changes of the texture coordinates
        if (!mesh.uvs.empty()) {
            const auto uv = [&](std::size_t k) { return Vec2d(mesh.uvs[corners[k]]); };
            point.uv = Vec2(uv(0) * (1 - u - v) + uv(1) * u + uv(2) * v);
            along_u = uv(1) - uv(0);
            along_v = uv(2) - uv(0);
        }
        if (filtered && difference_of_products(along_u.x, along_v.y, along_u.y, along_v.x) != 0) {
            const double scale = 1 / std::sqrt(samples_per_pixel(*place_, view_)); // as PixelFootprint's
            const auto step = [&](std::size_t axis) {
                return Vec2((along_u * static_cast<double>(strip_->b1_steps[axis][sample]) +
                             along_v * static_cast<double>(strip_->b2_steps[axis][sample])) * scale);
            };
            point.duv_dx = step(0);
            point.duv_dy = step(1);
        }
        return duet::base_color(data_.scene.materials[point.material], data_.scene.textures, point);
    }

    /// The same side by side, of an object that one texture colours.
    RgbT<Floats> base_colors(std::size_t first) const override {
        const std::optional<RgbSlot>& slot = data_.objects[strip_->samples->object->object].one_texture;
        if (!slot) return ColorSource::base_colors(first);
        const auto& texture = std::get<ImageTexture>(data_.scene.textures.textures[static_cast<std::size_t>(slot->texture)]);
        TexturePlaces places;
        find_places(first, places);
        const RgbT<Floats> c = spread<Floats>(slot->value) * data_.texels[texture.image].look_up(texture, places);
        const Floats zero(0.0f), one(1.0f); // as evaluate_reflectance()
        return {clamp(c.r, zero, one), clamp(c.g, zero, one), clamp(c.b, zero, one)};
    }

    void find_places(std::size_t first, TexturePlaces& places) const {
        std::array<std::array<StripOf<float>, 2>, 3> corners; // axis
        const std::uint32_t with_area = gather_uvs(first, corners);
        const Doubles scale(1 / std::sqrt(samples_per_pixel(*place_, view_))), one(1.0), zero(0.0); // as PixelFootprint's
        for (std::size_t k = 0; k < Floats::size; k += Doubles::size) {
            const Doubles u = load_doubles(strip_->b1.at(first + k)), v = load_doubles(strip_->b2.at(first + k));
            const auto has_area = lanes_from<double>(with_area >> k);
            for (std::size_t axis = 0; axis < 2; ++axis) {
                const auto uv = [&](std::size_t corner) { return load_doubles(corners[corner][axis].at(k)); };
                store_floats(uv(0) * (one - u - v) + uv(1) * u + uv(2) * v, places.uv[axis].at(k));
                const auto step = [&](std::size_t way) -> Doubles {
                    const Doubles steps = (uv(1) - uv(0)) * load_doubles(strip_->b1_steps[way].at(first + k)) +
                                          (uv(2) - uv(0)) * load_doubles(strip_->b2_steps[way].at(first + k));
                    return xsimd::select(has_area, steps * scale, zero);
                };
                store_floats(step(0), places.duv_dx[axis].at(k));
                store_floats(step(1), places.duv_dy[axis].at(k));
            }
        }
    }
    /// Texture coordinates at the corners of each sample's triangle; where nothing is seen any. A bit for each triangle that has
    /// an area in the texture. Triangle by triangle: samples side by side mostly see the same.
    std::uint32_t gather_uvs(std::size_t first, std::array<std::array<StripOf<float>, 2>, 3>& corners) const {
        constexpr std::uint32_t kAll = (1u << Floats::size) - 1;
        const StripSamples& samples = *strip_->samples;
        const Mesh& mesh = *samples.mesh;
        std::uint32_t with_area = 0;
        for (std::uint32_t left = samples.seen >> first & kAll; left != 0;) {
            const std::size_t sample = first + static_cast<std::size_t>(std::countr_zero(left));
            const std::uint32_t lanes = lanes_of_number(samples.ids, samples.ids[sample]) >> first & kAll;
            left &= ~lanes;
            std::array<Vec2, 3> uv{Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)};
            if (!mesh.uvs.empty())
                for (std::size_t k = 0; k < 3; ++k) uv[k] = mesh.uvs[mesh.triangles[samples.index(sample)][k]];
            const Vec2d along_u = Vec2d(uv[1]) - Vec2d(uv[0]), along_v = Vec2d(uv[2]) - Vec2d(uv[0]);
            if (difference_of_products(along_u.x, along_v.y, along_u.y, along_v.x) != 0) with_area |= lanes;
            const auto here = lanes_from<float>(lanes);
            for (std::size_t k = 0; k < 3; ++k)
                for (std::size_t axis = 0; axis < 2; ++axis)
                    store(corners[k][axis], 0, xsimd::select(here, Floats(axis == 0 ? uv[k].x : uv[k].y), load(corners[k][axis], 0)));
        }
        return with_area;
    }

    const PreparedData& data_;
    const Geometry& geometry_;
    const PassView& view_;
    const S& shader_;
    StripSolver<S, float> solver_;
    Linear ways_, eyes_; ///< camera rays
    bool only_suns_;     ///< are the scene's lights
    const StripPlace* place_ = nullptr; ///< of the strip at hand
    const Solved* strip_ = nullptr;
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
