// Turns a shader of raster/visibility/shader.h into a ShaderProgram, which shades packets of samples in SIMD batches,
// object by object, and single hits with the same functions.
#pragma once

#include "raster/shader/linear_in_tile.h"
#include "raster/shader/packet_shader.h"
#include "raster/shader/packet_surface.h"
#include "raster/shader/single_hit.h"
#include "raster/shader/sphere_interpolation.h"
#include "raster/visibility/hit_tile.h"

#include <cstring>
#include <optional>
#include <vector>

namespace duet::raster {

/// Stores one batch from the i-th sample on.
inline void store(ColorPacket& to, std::size_t i, const RgbT<Floats>& c) {
    store(to.r, i, c.r), store(to.g, i, c.g), store(to.b, i, c.b);
}
inline void store(PacketAttributes& to, std::size_t i, const SurfaceAttributes<Floats>& c) {
    store(to.normal.x, i, c.normal.x), store(to.normal.y, i, c.normal.y), store(to.normal.z, i, c.normal.z);
    store(to.bulge, i, c.bulge);
    store(to.color, i, c.color);
}
/// Copies the marked samples of a packet's components.
inline void copy_lanes(std::uint32_t lanes, const PacketOf<float>& from, PacketOf<float>& to) {
    for (std::size_t i = 0; i < kPacketSize; i += Floats::size)
        store(to, i, xsimd::select(lanes_from<float>(lanes >> i), load(from, i), load(to, i)));
}
inline void copy_lanes(std::uint32_t lanes, const ColorPacket& from, ColorPacket& to) {
    for (PacketOf<float> ColorPacket::*c : {&ColorPacket::r, &ColorPacket::g, &ColorPacket::b})
        copy_lanes(lanes, from.*c, to.*c);
}
inline void copy_lanes(std::uint32_t lanes, const PacketAttributes& from, PacketAttributes& to) {
    using Vector = Vec3T<PacketOf<float>>;
    for (PacketOf<float> Vector::*c : {&Vector::x, &Vector::y, &Vector::z})
        copy_lanes(lanes, from.normal.*c, to.normal.*c);
    copy_lanes(lanes, from.bulge, to.bulge);
    copy_lanes(lanes, from.color, to.color);
}

/// Returns the packet type of a shader's output.
template <Shader S>
using ColorsOf = std::conditional_t<std::same_as<decltype(std::declval<const S&>().template fragment<Floats>(
                                                     std::declval<const FragmentOf<S, Floats>&>())),
                                                 RgbT<Floats>>,
                                    ColorPacket, PacketAttributes>;

/// Shades the packets of one tile with shader S.
template <Shader S> class TileShader final : public PacketShaderOf<ColorsOf<S>> {
    using Colors = ColorsOf<S>;

public:
    TileShader(const RasterSceneData& data, const Geometry& geometry, const PassView& view, const PixelRect& tile,
               const S& shader)
        : data_(data), geometry_(geometry), view_(view), shader_(shader), surface_(data, geometry, view),
          interpolator_(geometry.triangles, view, tile, shader, data.scene.needs.footprints),
          ray_directions_(view.pinhole.direction, view.pinhole.direction_dx, view.pinhole.direction_dy, tile),
          eye_(view.pinhole.origin) {
        if (view.viewport.orthographic)
            ray_origins_.emplace(view.pinhole.origin, view.pinhole.origin_dx, view.pinhole.origin_dy, tile);
    }

    using PacketShaderOf<Colors>::shade;
    void shade(std::span<const SamplePacket> packets, Colors* colors, std::uint32_t* visible) override {
        sub_packets_.clear();
        shade_packets(packets, colors, visible);
        if (!sub_packets_.empty()) shade_sub_packets();
    }

private:
    using VaryingBatch = VaryingsOf<S, Floats>;
    using ResultPacket = InterpolatedPacket<S, float>;

    /// Holds the samples of a packet that see one of several objects.
    struct SubPacket {
        PacketOf<std::int32_t> ids;
        SamplePacket packet;
        Colors* colors = nullptr;
    };

    void shade_packets(std::span<const SamplePacket> packets, Colors* colors, std::uint32_t* visible) {
        interpolator_.interpolate_packets(packets, true, [&](std::size_t first, std::span<const ResultPacket> results) {
            for (std::size_t s = 0; s < results.size(); ++s) visible[first + s] = results[s].samples->visible;
            for (std::size_t s = 0; s < results.size(); ++s) {
                if (results[s].object_view != nullptr)
                    shade_solved(packets[first + s], results[s], colors[first + s]);
                else if (results[s].samples->visible != 0)
                    shade_objects(packets[first + s], *results[s].samples, colors[first + s]);
            }
        });
    }

    /// Shades a packet whose samples see one object. `colors` is __restrict, so that data shared by its batches is
    /// loaded once.
    void shade_solved(const SamplePacket& packet, const ResultPacket& result, Colors& __restrict colors) {
        const SampleOffset offset = packet.offsets != nullptr ? SampleOffset{0, 0} : packet.offset;
        ray_directions_.set_offset(offset);
        if (ray_origins_) ray_origins_->set_offset(offset);
        if (!result.object_view->is_uniform())
            surface_.set_packet(packet, *result.samples, {&result.b1, &result.b2, &result.b1_steps, &result.b2_steps});
        for (std::size_t i = 0; i < kPacketSize; i += Floats::size)
            store(colors, i, shader_.template fragment<Floats>(fragment(packet, result, i)));
    }

    /// Shades a packet that sees several objects: spheres immediately, triangles later by shade_sub_packets().
    void shade_objects(const SamplePacket& packet, const PacketPrimitives& samples, Colors& colors) {
        for (std::uint32_t left = samples.visible; left != 0;) {
            const Run& run = interpolator_.run_of(samples.id(static_cast<std::size_t>(std::countr_zero(left))));
            const Triangles::IdRange own = geometry_.triangles.ids_of_object(run);
            const Ints first(static_cast<std::int32_t>(own.first)), end(static_cast<std::int32_t>(own.end));
            std::uint32_t here = 0;
            for (std::size_t i = 0; i < kPacketSize; i += Ints::size)
                here |= lane_bits(load(samples.ids, i) >= first && load(samples.ids, i) < end) << i;
            here &= left;
            left &= ~here;
            if (run.sphere)
                shade_sphere(packet, here, samples, geometry_.spheres[run.object], colors);
            else
                add_sub_packet(packet, here, samples, colors);
        }
    }

    void add_sub_packet(const SamplePacket& packet, std::uint32_t lanes, const PacketPrimitives& all_samples,
                        Colors& colors) {
        SubPacket& sub_packet = sub_packets_.emplace_back();
        sub_packet.packet = packet;
        sub_packet.colors = &colors;
        const Ints none(static_cast<std::int32_t>(kNoTriangle));
        for (std::size_t i = 0; i < kPacketSize; i += Ints::size)
            store(sub_packet.ids, i,
                  xsimd::select(xsimd::bool_cast(lanes_from<float>(lanes >> i)), load(all_samples.ids, i), none));
    }

    void shade_sphere(const SamplePacket& packet, std::uint32_t lanes, const PacketPrimitives& all_samples,
                      const DrawSphere& sphere, Colors& colors) {
        PacketPrimitives samples{.ids = all_samples.ids, .visible = lanes};
        if (!sphere_view_ || sphere_view_->object != sphere.object) sphere_view_.emplace(data_, view_, sphere.object);
        ResultPacket result;
        result.samples = &samples;
        interpolate_sphere(SpherePacket(view_, packet, sphere, wants_derivatives<S>()), sphere.sphere, shader_,
                           *sphere_view_, result);
        Colors own;
        shade_solved(packet, result, own);
        copy_lanes(lanes, own, colors);
    }

    /// Shades the collected sub-packets. Each sees one object, so no further sub-packets result.
    void shade_sub_packets() {
        sub_packet_inputs_.clear();
        for (const SubPacket& sub_packet : sub_packets_) {
            sub_packet_inputs_.push_back(sub_packet.packet);
            sub_packet_inputs_.back().ids = sub_packet.ids.at(0);
        }
        sub_packet_colors_.resize(sub_packets_.size());
        sub_packet_visible_.resize(sub_packets_.size());
        shade_packets(sub_packet_inputs_, sub_packet_colors_.data(), sub_packet_visible_.data());
        for (std::size_t i = 0; i < sub_packets_.size(); ++i)
            copy_lanes(sub_packet_visible_[i], sub_packet_colors_[i], *sub_packets_[i].colors);
    }

    FragmentOf<S, Floats> fragment(const SamplePacket& packet, const ResultPacket& result, std::size_t i) const {
        const Floats near(static_cast<float>(view_.pinhole.near)), depth = load(result.depth, i);
        const Floats reversed_depth = packet.reversed_depth != nullptr
                                          ? Floats::load_aligned(packet.reversed_depth + i)
                                          : min(near / depth, Floats(1.0f));
        return {derivatives(result, i),
                packet_detail::vector(result.ng, 0, i),
                varyings_at(result.at, i),
                ray_origins_ ? vector(*ray_origins_, packet, i) : broadcast<Floats>(eye_),
                vector(ray_directions_, packet, i),
                depth,
                reversed_depth,
                *result.object_view,
                surface_,
                i};
    }

    static Vec3T<Floats> vector(const LinearInTile& of, const SamplePacket& packet, std::size_t i) {
        const Vec3T<Floats> here = of.at(packet.x, packet.y, i);
        if (packet.offsets == nullptr) return here;
        return here + of.displacement(in_pixel(*packet.offsets, i, &SampleOffset::x),
                                      in_pixel(*packet.offsets, i, &SampleOffset::y));
    }
    static Floats in_pixel(const std::array<SampleOffset, kPacketSize>& offsets, std::size_t first,
                           std::int32_t SampleOffset::*axis) {
        PacketOf<float> own;
        for (std::size_t i = 0; i < Floats::size; ++i)
            own[i] = static_cast<float>(offsets[first + i].*axis) / kSubpixels;
        return load(own, 0);
    }
    template <std::size_t N>
    static VaryingBatch varyings_at(const std::array<PacketOf<float>, N>& from, std::size_t i) {
        VaryingBatch result;
        for (std::size_t c = 0; c < N; ++c) { // one by one, so that compilers use registers
            const Floats number = load(from[c], i);
            std::memcpy(reinterpret_cast<char*>(&result) + c * sizeof(number), static_cast<const void*>(&number),
                        sizeof(number));
        }
        return result;
    }
    static auto derivatives(const ResultPacket& result, std::size_t i) {
        if constexpr (wants_derivatives<S>())
            return ScreenDerivatives<VaryingBatch, true>{varyings_at(result.dx, i), varyings_at(result.dy, i)};
        else
            return ScreenDerivatives<VaryingBatch, false>{};
    }

    const RasterSceneData& data_;
    const Geometry& geometry_;
    const PassView& view_;
    const S& shader_;
    PacketSurface surface_; ///< surface of the current packet
    PacketInterpolator<S, float> interpolator_;
    LinearInTile ray_directions_;             ///< directions of camera rays
    Vec3 eye_;                                ///< common origin of all camera rays
    std::optional<LinearInTile> ray_origins_; ///< origins per pixel in an orthographic view
    std::vector<SubPacket> sub_packets_;
    std::vector<SamplePacket> sub_packet_inputs_; ///< arguments of shade_packets() for the sub-packets
    std::vector<Colors> sub_packet_colors_;
    std::vector<std::uint32_t> sub_packet_visible_;
    std::optional<ObjectView> sphere_view_; ///< view of the last sphere shaded
};

/// Implements a ShaderProgram that owns a copy of its shader.
template <Shader S> class ShaderProgramOf final : public ShaderProgram {
public:
    explicit ShaderProgramOf(S shader) : shader_(std::move(shader)) {}
    std::unique_ptr<PacketShader> for_tile(const RasterSceneData& data, const Geometry& geometry, const PassView& view,
                                           const PixelRect& tile) const override {
        return std::make_unique<TileShader<S>>(data, geometry, view, tile, shader_);
    }
    Rgb shade_hit(const RasterSceneData& data, const PassView& view, const Hit& hit, Vec2d pixel) const override {
        return shade_single_hit(data, view, shader_, hit, pixel, view.samples_per_pixel);
    }

private:
    S shader_;
};

} // namespace duet::raster
