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

/// A GridRay is a ray in the coordinates of a grid, in which a cell has side 1. Its parameter is the distance in
/// meters.
struct GridRay {
    Vec3 origin, direction;

    /// Returns false where the box is thinner than floats are.
    bool is_finite() const { return duet::is_finite(origin) && duet::is_finite(direction); }
};

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

    /// Holds the distance at which a ray has passed a given column, and the column up to there.
    struct Reached {
        float t = 0;       ///< infinite if the ray leaves the grid before
        double column = 0; ///< at most the given column
    };
    /// Follows a ray through an interval on which it is inside of the box, until its column has the given value, in
    /// meters, > 0 or infinite. The column is the integral of the density over the distance. It is exact up to
    /// rounding: within a cell, the density along a ray is a cubic polynomial, which Simpson's second rule integrates
    /// exactly. Blocks of cells without density are skipped.
    Reached follow(const Box3& box, const Ray& ray, Interval inside, double column) const;

private:
    friend class DensityOnRay;
    template <typename Visit> bool visit_filled_cells(const GridRay& ray, float s, float s_end, Visit visit) const;
    std::size_t block_index(int x, int y, int z) const {
        return static_cast<std::size_t>(x + blocks_[0] * (y + blocks_[1] * z));
    }

    std::array<int, 3> size_;
    std::vector<float> densities_;
    std::array<int, 3> blocks_{};      ///< number of blocks along each axis
    std::vector<unsigned char> empty_; ///< for each block, whether it has no density
    float largest_ = 0;
};

/// A DensityOnRay is the density of a grid along a ray. It follows the ray once, only as far as the calls need, and
/// stores the columns of the cells.
class DensityOnRay {
public:
    /// Stores a reference to the grid. The ray must be inside of the box on the whole interval.
    DensityOnRay(const DensityGrid& grid, const Box3& box, const Ray& ray, Interval inside);
    /// Returns the same as DensityGrid::follow, for the interval of the constructor.
    DensityGrid::Reached follow(double column);
    /// Returns a distance at which the column has been passed, too large by at most one cell; infinite if the ray never
    /// passes it.
    float passed_by(double column);
    /// Returns the column from the beginning of the interval up to a t in it, in meters.
    double column(float t);

private:
    struct Step { // a step through one cell
        std::array<int, 3> cell;
        float begin, end; // distances from the beginning of the interval
        double column_before, column_after;
    };
    void extend(double column, float s_end);
    std::vector<Step>::const_iterator step_that_passes(double column);

    const DensityGrid* grid_;
    GridRay ray_;
    Interval inside_;
    std::vector<Step> steps_; // steps through cells of blocks that are not empty
    float followed_ = 0;      // the distance up to which steps_ go
    double column_ = 0;       // column up to followed_
};

} // namespace duet
