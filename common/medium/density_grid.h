// A DensityGrid is a density that varies in space, as that of a cloud does: numbers at the points of a regular grid,
// with trilinear interpolation in between.
#pragma once

#include "common/vec/box.h"
#include "common/vec/interval.h"
#include "common/vec/ray.h"

#include <array>
#include <cstddef>
#include <vector>

namespace duet {

/// The grid fills a box, which each function takes as an argument: its first and last points lie on the sides of the
/// box. The density has no unit.
class DensityGrid {
public:
    /// Takes the number of points along each axis, at least 2, and the densities there, finite and ≥ 0. The index of a
    /// point is x + size[0] · (y + size[1] · z).
    DensityGrid(std::array<int, 3> size, std::vector<float> densities);

    const std::array<int, 3>& size() const { return size_; }
    const std::vector<float>& densities() const { return densities_; }
    float largest() const { return largest_; }

    /// Returns the density at a point of the box.
    float density(const Box3& box, Vec3 p) const;

    /// Where a ray has passed a given column, and the column up to there.
    struct Reached {
        float t = 0;       ///< infinite if the ray leaves before
        double column = 0; ///< at most the one that was given
    };
    /// Follows a ray through an interval on which it is inside of the box, until the integral of the density over the
    /// distance, which is called the column, has the given value, > 0 or infinite. In meters. It is as exact as floats
    /// are: inside of a cell the density along a ray is a cubic polynomial, which Simpson's rule integrates exactly.
    /// Blocks of cells without density are skipped.
    Reached follow(const Box3& box, const Ray& ray, Interval inside, double column) const;

private:
    class OnRay;
    std::size_t block_index(int x, int y, int z) const {
        return static_cast<std::size_t>(x + blocks_[0] * (y + blocks_[1] * z));
    }

    std::array<int, 3> size_;
    std::vector<float> densities_;
    std::array<int, 3> blocks_{};      ///< number of blocks along each axis
    std::vector<unsigned char> empty_; ///< for each block, whether it has no density
    float largest_ = 0;
};

} // namespace duet
