// Evaluates vectors that are linear in the pixel, such as camera rays, by addition for the packets of a tile.
#pragma once

#include "raster/geometry/sample_positions.h"
#include "raster/geometry/tiles.h"
#include "raster/visibility/packet_primitives.h"

#include <array>

namespace duet::raster {

/// Holds the vector at packet positions of a tile as the sum of a term per column of blocks and a term per row of
/// packets. The latter includes the samples' offset in the pixel. Terms are rounded to float once per tile. No packet
/// needs to convert its position to float, which would be on the critical path.
class LinearInTile {
public:
    /// Represents start + dx·x + dy·y for the pixels (x, y) of a tile, at most TileGrid::kTileSize in each
    /// direction.
    LinearInTile(Vec3d start, Vec3d dx, Vec3d dy, const PixelRect& tile)
        : step_x_(dx), step_y_(dy), x0_(tile.x0), y0_(tile.y0) {
        const Vec3 first(start + dx * static_cast<double>(tile.x0) + dy * static_cast<double>(tile.y0));
        for (std::size_t k = 0; k < columns_.size(); ++k)
            for (std::size_t i = 0; i < kPacketSize; i += Floats::size) {
                const Floats x = Floats(static_cast<float>(k * kPacketWidth)) + load(kColumns<float>, i);
                const Vec3T<Floats> here = broadcast<Floats>(first) + displacement(x, load(kRows<float>, i));
                for (std::size_t axis = 0; axis < 3; ++axis) store(columns_[k][axis], i, here[axis]);
            }
        set_rows();
    }

    /// Sets the samples' offset in their pixels for the following calls of at().
    void set_offset(SampleOffset offset) {
        if (offset == offset_) return;
        offset_ = offset;
        set_rows();
    }
    /// Returns the vectors of the packet that starts at pixel (x, y), one batch of samples from the i-th on.
    Vec3T<Floats> at(int x, int y, std::size_t i) const {
        const auto& column = columns_[static_cast<std::size_t>(x - x0_) / kPacketWidth];
        const Vec3& row = rows_[static_cast<std::size_t>(y - y0_) / kPacketHeight];
        return {load(column[0], i) + Floats(row.x), load(column[1], i) + Floats(row.y),
                load(column[2], i) + Floats(row.z)};
    }
    /// Returns the increment for the given number of pixels to the right and down.
    template <typename T> Vec3T<T> displacement(T x, T y) const {
        const auto along = [&](std::size_t axis) { return multiply_add(T(step_x_[axis]), x, T(step_y_[axis]) * y); };
        return {along(0), along(1), along(2)};
    }

private:
    void set_rows() {
        const Vec3 shift =
            displacement(static_cast<float>(offset_.x) / kSubpixels, static_cast<float>(offset_.y) / kSubpixels);
        for (std::size_t k = 0; k < rows_.size(); ++k)
            rows_[k] = step_y_ * static_cast<float>(k * kPacketHeight) + shift;
    }

    static constexpr std::size_t kPacketHeight = DepthTile::kPacketRows;
    Vec3 step_x_, step_y_;
    int x0_, y0_;
    std::array<std::array<PacketOf<float>, 3>, TileGrid::kTileSize / kPacketWidth> columns_;
    std::array<Vec3, TileGrid::kTileSize / kPacketHeight> rows_; ///< includes the samples' offset in the pixel
    SampleOffset offset_{0, 0};
};

} // namespace duet::raster
