// Evaluates base colors and mapped normals of a packet's fragments. Base colors of objects with a single texture are
// evaluated with SIMD.
#pragma once

#include "raster/shader/texture_sampler.h"
#include "raster/visibility/packet_primitives.h"
#include "raster/visibility/shader.h"

namespace duet::raster {

/// Refers to the barycentrics of a packet's samples, as in InterpolatedPacket.
struct PacketBarycentrics {
    const PacketOf<float>*b1 = nullptr, *b2 = nullptr;
    const std::array<PacketOf<float>, 2>*b1_steps = nullptr, *b2_steps = nullptr;
};

/// Represents the surface visible in a packet: triangles of one object, or a sphere. One instance is reused for
/// successive packets.
class PacketSurface final : public ColorSource {
public:
    PacketSurface(const RasterSceneData& data, const Geometry& geometry, const PassView& view)
        : data_(data), geometry_(geometry), view_(view) {}

    /// Selects a packet. All three arguments must outlive the following calls. The barycentrics are not used for a
    /// sphere.
    void set_packet(const SamplePacket& packet, const PacketPrimitives& samples, const PacketBarycentrics& at) {
        packet_ = &packet;
        samples_ = &samples;
        at_ = at;
    }
    Rgb base_color(std::size_t sample) const override;
    RgbT<Floats> base_colors(std::size_t first) const override;
    Vec3 mapped_normal(std::size_t sample) const override;
    Rgb emitted(std::size_t sample) const override;

private:
    TextureCoordinates texture_coordinates(std::size_t first) const;
    float step_scale() const;

    const RasterSceneData& data_;
    const Geometry& geometry_;
    const PassView& view_;
    const SamplePacket* packet_ = nullptr;
    const PacketPrimitives* samples_ = nullptr;
    PacketBarycentrics at_;
};

} // namespace duet::raster
