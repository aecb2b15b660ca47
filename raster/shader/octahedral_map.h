// Maps the sphere of directions to a square without poles or seams (Engelhardt and Dachsbacher 2008, "Octahedron
// Environment Maps"; Cigolle et al. 2014, "A Survey of Efficient Representations for Independent Unit Vectors").
#pragma once

#include "raster/geometry/packet.h"

#include <algorithm>
#include <vector>

namespace duet::raster {

/// Returns the position of a direction of any length in the square [−1, 1]².
template <typename T> Vec2T<T> octahedral(const Vec3T<T>& w) {
    const T one(1.0f), zero(0.0f);
    const T over = one / max(abs(w.x) + abs(w.y) + abs(w.z), T(1e-30f));
    const T x = w.x * over, y = w.y * over;
    const auto sign = [&](const T& v) { return select(v < zero, -one, one); };
    const auto below = w.z < zero;
    return {select(below, (one - abs(y)) * sign(x), x), select(below, (one - abs(x)) * sign(y), y)};
}
/// Divides [−1, 1] into `side` cells, and returns the index of the cell that contains v, or the nearest one.
inline int cell_of(float v, int side) {
    return std::clamp(static_cast<int>((v + 1) * 0.5f * static_cast<float>(side)), 0, side - 1);
}
/// Returns the unit direction of a position in the square; the inverse of octahedral().
Vec3 octahedral_direction(Vec2 p);

/// Holds values of up to four channels for all directions. It has side × side texels in the octahedral square, and a
/// border of one texel that continues across the square's edges, so that bilinear lookups need no special cases.
class OctahedralMap {
public:
    static constexpr std::size_t kChannels = 4; ///< interleaved, so that a lookup touches few cache lines
    using Texel = std::array<float, kChannels>;

    OctahedralMap() = default;
    explicit OctahedralMap(int side);

    int side() const { return side_; }
    bool empty() const { return side_ == 0; }
    Texel& texel(int x, int y) { return texels_[index(x, y)]; }
    const Texel& texel(int x, int y) const { return texels_[index(x, y)]; }
    /// Returns the direction at a texel's center.
    Vec3 direction(int x, int y) const;
    /// Copies the border from the opposite texels. It must be called after the texels have changed.
    void finish();

    /// Returns kCount channels, from index `first` on, in directions of any length, interpolated bilinearly.
    template <std::size_t kCount> std::array<Floats, kCount> at(const Vec3T<Floats>& w, std::size_t first = 0) const;
    /// Returns kCount channels, from index `first` on, of the texels nearest to directions of any length.
    template <std::size_t kCount>
    std::array<Floats, kCount> nearest(const Vec3T<Floats>& w, std::size_t first = 0) const;
    std::size_t memory_bytes() const { return texels_.size() * sizeof(Texel); }

private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y + 1) * static_cast<std::size_t>(side_ + 2) + static_cast<std::size_t>(x + 1);
    }
    int side_ = 0;
    std::vector<Texel> texels_;
};

template <std::size_t kCount>
std::array<Floats, kCount> OctahedralMap::at(const Vec3T<Floats>& w, std::size_t first) const {
    const Vec2T<Floats> p = octahedral(w);
    const Floats half(0.5f * static_cast<float>(side_)), middle(half + Floats(0.5f));
    const Floats x = p.x * half + middle, y = p.y * half + middle; // relative to the border's first texel center
    // Unused lanes may hold NaN. They read an arbitrary texel.
    const auto cell = [&](const Floats& v) { return xsimd::max(xsimd::min(truncated(v), Ints(side_)), Ints(0)); };
    const Ints x0 = cell(x), y0 = cell(y);
    const Floats fx = x - xsimd::batch_cast<float>(x0), fy = y - xsimd::batch_cast<float>(y0);
    const Ints texel = (y0 * Ints(side_ + 2) + x0) * Ints(static_cast<std::int32_t>(kChannels));
    const int row = (side_ + 2) * static_cast<int>(kChannels);
    std::array<Floats, kCount> result;
    for (std::size_t c = 0; c < kCount; ++c) {
        const float* from = texels_.data()->data() + first + c;
        const auto corner = [&](int offset) { return gather(from + offset, texel); };
        const Floats low = lerp(corner(0), corner(static_cast<int>(kChannels)), fx);
        result[c] = lerp(low, lerp(corner(row), corner(row + static_cast<int>(kChannels)), fx), fy);
    }
    return result;
}

template <std::size_t kCount>
std::array<Floats, kCount> OctahedralMap::nearest(const Vec3T<Floats>& w, std::size_t first) const {
    const Vec2T<Floats> p = octahedral(w);
    const Floats half(0.5f * static_cast<float>(side_)), last(static_cast<float>(side_ - 1));
    const auto cell = [&](const Floats& v) {
        const Ints i = truncated(clamp(v * half + half, Floats(0.0f), last));
        return xsimd::max(xsimd::min(i, Ints(side_ - 1)), Ints(0)) + Ints(1); // skips the border
    };
    const Ints at = (cell(p.y) * Ints(side_ + 2) + cell(p.x)) * Ints(static_cast<std::int32_t>(kChannels));
    std::array<Floats, kCount> result;
    for (std::size_t c = 0; c < kCount; ++c) result[c] = gather(texels_.data()->data() + first + c, at);
    return result;
}

} // namespace duet::raster
