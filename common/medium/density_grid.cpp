#include "common/medium/density_grid.h"

#include "common/vec/simd.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace duet {

namespace {

using Cell = std::array<int, 3>;

// A block has this many cells along each axis.
constexpr int kBlockSide = 8;

// Returns the cell of [low, high) that is nearest to a coordinate. NaN counts as the first.
int cell_of(float coordinate, int side, int low, int high) {
    const float index = std::floor(coordinate / static_cast<float>(side));
    return static_cast<int>(min(max(static_cast<float>(low), index), static_cast<float>(high - 1)));
}

// Visits the cells of [low, high) that the ray passes between s and s_end, in order. A cell has the given side. Calls
// visit(cell, s where the ray enters, s where it leaves), until that returns false; returns whether it never did
// (Amanatides and Woo 1987, "A Fast Voxel Traversal Algorithm for Ray Tracing"). The s where the ray leaves is computed
// from the cell's index, so that errors do not add up. The outermost cells extend without bound, so that they include
// points that rounding moves out of the grid.
template <typename Visit>
bool visit_cells(const GridRay& ray, float s, float s_end, int side, const Cell& low, const Cell& high, Visit visit) {
    Cell cell{}, step{}, last{};
    Vec3 inverse, leaves;
    const auto find_end = [&](std::size_t axis) {
        const float plane = static_cast<float>((cell[axis] + std::max(step[axis], 0)) * side);
        leaves[axis] = cell[axis] == last[axis] ? kInfinity : (plane - ray.origin[axis]) * inverse[axis];
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float d = ray.direction[axis];
        cell[axis] = cell_of(ray.origin[axis] + d * s, side, low[axis], high[axis]);
        inverse[axis] = 1 / d;
        step[axis] = d > 0 ? 1 : -1;
        const bool moves = std::abs(inverse[axis]) < kInfinity;
        last[axis] = !moves ? cell[axis] : d > 0 ? high[axis] - 1 : low[axis];
        find_end(axis);
    }
    for (;;) {
        const std::size_t axis = leaves.x < leaves.y ? (leaves.x < leaves.z ? 0 : 2) : (leaves.y < leaves.z ? 1 : 2);
        const float end = std::min(leaves[axis], s_end);
        if (end > s) {
            if (!visit(cell, s, end)) return false;
            s = end;
        }
        if (!(s < s_end)) return true;
        cell[axis] += step[axis];
        find_end(axis);
    }
}

/// Represents the density along a ray inside of one cell.
class CellOnRay {
public:
    CellOnRay(const DensityGrid& grid, const GridRay& ray, const Cell& cell) : ray_(ray) {
        const auto sx = static_cast<std::size_t>(grid.size()[0]), sy = static_cast<std::size_t>(grid.size()[1]);
        const auto index = [&](std::size_t axis) { return static_cast<std::size_t>(cell[axis]); };
        const float* at = grid.densities().data() + index(0) + sx * (index(1) + sy * index(2));
        for (std::size_t i = 0; i < 4; ++i) {
            const float* row = at + (i & 1u) * sx + (i >> 1) * sx * sy;
            low_[i] = row[0];
            high_[i] = row[1];
        }
        for (std::size_t axis = 0; axis < 3; ++axis) corner_[axis] = static_cast<float>(cell[axis]);
    }

    /// Returns the density at a distance. T is float or a batch of floats.
    template <typename T> T density(const T& s) const {
        const auto fraction = [&](std::size_t axis) { // clamped, because rounding may leave the cell
            const T p = T(ray_.origin[axis] - corner_[axis]) + T(ray_.direction[axis]) * s;
            return min(max(T(0), p), T(1));
        };
        const T x = fraction(0), y = fraction(1), z = fraction(2);
        const auto along_x = [&](std::size_t i) { return lerp(T(low_[i]), T(high_[i]), x); };
        return lerp(lerp(along_x(0), along_x(1), y), lerp(along_x(2), along_x(3), y), z);
    }

    /// Returns the column between two distances: the integral of the density.
    double column(float begin, float end) const {
        // Simpson's second rule is exact for polynomials of degree three.
        const std::array<float, 4> f = densities(begin, end);
        return static_cast<double>(end - begin) * static_cast<double>(f[0] + 3 * (f[1] + f[2]) + f[3]) * 0.125;
    }

    /// Returns the distance at which the column from `begin` on equals `wanted`; at `end` the column must exceed it.
    /// The search uses Newton's method, with bisection to stay within the bounds. The density is a polynomial in u,
    /// which runs from 0 to 1.
    float find(float begin, float end, double wanted) const {
        const std::array<float, 4> at = densities(begin, end);
        std::array<double, 4> f{};
        for (std::size_t i = 0; i < 4; ++i) f[i] = static_cast<double>(at[i]);
        const double c1 = -5.5 * f[0] + 9 * f[1] - 4.5 * f[2] + f[3];
        const double c2 = 9 * f[0] - 22.5 * f[1] + 18 * f[2] - 4.5 * f[3];
        const double c3 = 4.5 * (f[3] - f[0] + 3 * (f[1] - f[2]));
        const double length = static_cast<double>(end - begin), part = wanted / length;
        constexpr int kMostSteps = 30;
        double low = 0, high = 1, u = 0.5;
        for (int i = 0; i < kMostSteps; ++i) {
            const double excess = u * (f[0] + u * (c1 / 2 + u * (c2 / 3 + u * (c3 / 4)))) - part;
            (excess > 0 ? high : low) = u;
            double next = u - excess / (f[0] + u * (c1 + u * (c2 + u * c3)));
            if (!(next > low && next < high)) next = (low + high) / 2;
            const bool found = std::abs(next - u) <= 1e-7;
            u = next;
            if (found) break;
        }
        return begin + static_cast<float>(u * length);
    }

private:
    /// Returns the densities at `begin` and `end`, and at one third and two thirds of the distance between them.
    std::array<float, 4> densities(float begin, float end) const {
        using Floats = FloatBatch<4>;
        const float third = (end - begin) / 3;
        alignas(sizeof(Floats)) std::array<float, 4> at{begin, begin + third, end - third, end};
        density(Floats::load_aligned(at.data())).store_aligned(at.data());
        return at;
    }

    const GridRay& ray_;
    Vec3 corner_;
    std::array<float, 4> low_{}, high_{}; ///< densities at the corners with the lower and the higher x
};

} // namespace

DensityGrid::DensityGrid(std::array<int, 3> size, std::vector<float> densities)
    : size_(size), densities_(std::move(densities)) {
    std::size_t blocks = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        assert(size_[axis] >= 2);
        blocks_[axis] = (size_[axis] - 2) / kBlockSide + 1;
        blocks *= static_cast<std::size_t>(blocks_[axis]);
    }
    assert(densities_.size() == static_cast<std::size_t>(size_[0]) * static_cast<std::size_t>(size_[1]) *
                                    static_cast<std::size_t>(size_[2]));
    empty_.assign(blocks, 1);
    std::size_t i = 0;
    // A point at the border between two blocks belongs to both.
    const auto first = [](int point) { return std::max(point - 1, 0) / kBlockSide; };
    for (int z = 0; z < size_[2]; ++z)
        for (int y = 0; y < size_[1]; ++y)
            for (int x = 0; x < size_[0]; ++x, ++i) {
                if (!(densities_[i] > 0)) continue;
                largest_ = std::max(largest_, densities_[i]);
                for (int bz = first(z); bz <= std::min(z / kBlockSide, blocks_[2] - 1); ++bz)
                    for (int by = first(y); by <= std::min(y / kBlockSide, blocks_[1] - 1); ++by)
                        for (int bx = first(x); bx <= std::min(x / kBlockSide, blocks_[0] - 1); ++bx)
                            empty_[block_index(bx, by, bz)] = 0;
            }
}

namespace {

// Returns the ray in the coordinates of a grid, from t = begin on.
GridRay grid_ray(const std::array<int, 3>& size, const Box3& box, const Ray& ray, float begin) {
    GridRay result;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double low = static_cast<double>(box.low[axis]), d = static_cast<double>(ray.direction[axis]);
        const double scale = (size[axis] - 1) / (static_cast<double>(box.high[axis]) - low);
        const double p = static_cast<double>(ray.origin[axis]) + static_cast<double>(begin) * d - low;
        result.origin[axis] = static_cast<float>(p * scale);
        result.direction[axis] = static_cast<float>(d * scale);
    }
    return result;
}

} // namespace

float DensityGrid::density(const Box3& box, Vec3 p) const {
    const GridRay at = grid_ray(size_, box, Ray{p, {0, 0, 0}}, 0);
    Cell cell{};
    for (std::size_t axis = 0; axis < 3; ++axis) cell[axis] = cell_of(at.origin[axis], 1, 0, size_[axis] - 1);
    return CellOnRay(*this, at, cell).density(0.0f);
}

template <typename Visit>
bool DensityGrid::visit_filled_cells(const GridRay& ray, float s, float s_end, Visit visit) const {
    return visit_cells(ray, s, s_end, kBlockSide, {}, blocks_, [&](const Cell& block, float begin, float end) {
        if (empty_[block_index(block[0], block[1], block[2])]) return true;
        Cell low{}, high{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            low[axis] = block[axis] * kBlockSide;
            high[axis] = std::min(low[axis] + kBlockSide, size_[axis] - 1);
        }
        return visit_cells(ray, begin, end, 1, low, high, visit);
    });
}

// This stores no steps, as DensityOnRay does for rays that are asked more than once: storing them for shadow rays, too,
// makes clouds take a tenth longer.
DensityGrid::Reached DensityGrid::follow(const Box3& box, const Ray& ray, Interval inside, double column) const {
    const GridRay local = grid_ray(size_, box, ray, inside.begin);
    Reached reached{kInfinity, 0};
    if (!local.is_finite()) return reached;
    visit_filled_cells(local, 0, inside.end - inside.begin, [&](const Cell& cell, float begin, float end) {
        const CellOnRay densities(*this, local, cell);
        const double more = densities.column(begin, end);
        if (reached.column + more <= column) {
            reached.column += more;
            return true;
        }
        reached.t = inside.begin + densities.find(begin, end, column - reached.column);
        reached.column = column;
        return false;
    });
    return reached;
}

DensityOnRay::DensityOnRay(const DensityGrid& grid, const Box3& box, const Ray& ray, Interval inside)
    : grid_(&grid), ray_(grid_ray(grid.size(), box, ray, inside.begin)), inside_(inside) {
    if (!ray_.is_finite()) followed_ = inside.end - inside.begin;
}

// Follows the ray until the column is above the given one, or up to the distance s_end if that is nearer.
void DensityOnRay::extend(double column, float s_end) {
    const float s_last = inside_.end - inside_.begin;
    if (column_ > column || followed_ >= std::min(s_end, s_last)) return;
    const bool to_the_end =
        grid_->visit_filled_cells(ray_, followed_, s_last, [&](const Cell& cell, float begin, float end) {
            const double before = column_;
            column_ += CellOnRay(*grid_, ray_, cell).column(begin, end);
            steps_.push_back({cell, begin, end, before, column_});
            followed_ = end;
            return column_ <= column && end < s_end;
        });
    if (to_the_end) followed_ = s_last;
}

std::vector<DensityOnRay::Step>::const_iterator DensityOnRay::step_that_passes(double column) {
    extend(column, kInfinity);
    return std::ranges::upper_bound(steps_, column, {}, &Step::column_after);
}

float DensityOnRay::passed_by(double column) {
    const auto step = step_that_passes(column);
    return step == steps_.end() ? kInfinity : inside_.begin + step->end;
}

DensityGrid::Reached DensityOnRay::follow(double column) {
    const auto step = step_that_passes(column);
    if (step == steps_.end()) return {kInfinity, column_};
    const float s = CellOnRay(*grid_, ray_, step->cell).find(step->begin, step->end, column - step->column_before);
    return {inside_.begin + s, column};
}

double DensityOnRay::column(float t) {
    const float s = t - inside_.begin;
    extend(std::numeric_limits<double>::infinity(), s);
    const auto next = std::ranges::lower_bound(steps_, s, {}, &Step::begin); // first step that begins at or after s
    if (next == steps_.begin()) return 0;
    const Step& step = *std::prev(next);
    if (s >= step.end) return step.column_after;
    return step.column_before + CellOnRay(*grid_, ray_, step.cell).column(step.begin, s);
}

} // namespace duet
