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

// A ray in the coordinates of the grid, in which a cell has side 1. The parameter is the distance in meters.
struct GridRay {
    Vec3 origin, direction;
};

// Returns the cell of [low, high) that is nearest to a coordinate. NaN counts as the first.
int cell_of(float coordinate, int side, int low, int high) {
    const float index = std::floor(coordinate / static_cast<float>(side));
    return static_cast<int>(min(max(static_cast<float>(low), index), static_cast<float>(high - 1)));
}

// Visits the cells of [low, high) that the ray passes between s and s_end, in order. A cell has the given side. Calls
// visit(cell, s where the ray enters, s where it leaves), until that returns false; returns whether it never did
// (Amanatides and Woo 1987, "A Fast Voxel Traversal Algorithm for Ray Tracing"). Where the ray leaves is computed from
// the cell's index, so that errors do not add up. The outermost cells have no end: what rounding leaves over is theirs.
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

} // namespace

/// Represents the density along a ray inside of one cell.
class DensityGrid::OnRay {
public:
    OnRay(const DensityGrid& grid, const GridRay& ray, const Cell& cell) : ray_(ray) {
        const auto sx = static_cast<std::size_t>(grid.size_[0]), sy = static_cast<std::size_t>(grid.size_[1]);
        const auto index = [&](std::size_t axis) { return static_cast<std::size_t>(cell[axis]); };
        const float* at = grid.densities_.data() + index(0) + sx * (index(1) + sy * index(2));
        for (std::size_t i = 0; i < 4; ++i) {
            const float* row = at + (i & 1u) * sx + (i >> 1) * sx * sy;
            low_[i] = row[0];
            high_[i] = row[1];
        }
        for (std::size_t axis = 0; axis < 3; ++axis) corner_[axis] = static_cast<float>(cell[axis]);
    }

    /// Returns the density at a distance. T is float or a batch of floats.
    template <typename T> T density(const T& s) const {
        const auto fraction = [&](std::size_t axis) { // rounding may leave the cell
            const T p = T(ray_.origin[axis] - corner_[axis]) + T(ray_.direction[axis]) * s;
            return min(max(T(0), p), T(1));
        };
        const T x = fraction(0), y = fraction(1), z = fraction(2);
        const auto along_x = [&](std::size_t i) { return lerp(T(low_[i]), T(high_[i]), x); };
        return lerp(lerp(along_x(0), along_x(1), y), lerp(along_x(2), along_x(3), y), z);
    }

    /// Returns the column between both distances, by Simpson's rule.
    double column(float begin, float end) const {
        using Floats = FloatBatch<4>;
        alignas(sizeof(Floats)) std::array<float, 4> at{begin, (begin + end) / 2, end, end};
        density(Floats::load_aligned(at.data())).store_aligned(at.data());
        return static_cast<double>(end - begin) * static_cast<double>(at[0] + 4 * at[1] + at[2]) * (1.0 / 6);
    }

    /// Returns where the column from `begin` on, which is more than `wanted` at `end`, equals it: by Newton's method,
    /// kept inside of the bounds by bisection.
    float find(float begin, float end, double wanted) const {
        constexpr int kMostSteps = 30;
        float low = begin, high = end, s = (begin + end) / 2;
        for (int i = 0; i < kMostSteps; ++i) {
            const double excess = column(begin, s) - wanted;
            (excess > 0 ? high : low) = s;
            float next = s - static_cast<float>(excess / static_cast<double>(density(s)));
            if (!(next > low && next < high)) next = low + (high - low) / 2;
            const bool found = std::abs(next - s) <= 1e-6f * (end - begin);
            s = next;
            if (found) break;
        }
        return s;
    }

private:
    const GridRay& ray_;
    Vec3 corner_;
    std::array<float, 4> low_{}, high_{}; ///< densities at the corners with the lower and the higher x
};

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
    // A point at the border of blocks belongs to both.
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
    return OnRay(*this, at, cell).density(0.0f);
}

DensityGrid::Reached DensityGrid::follow(const Box3& box, const Ray& ray, Interval inside, double column) const {
    const GridRay local = grid_ray(size_, box, ray, inside.begin);
    Reached reached{kInfinity, 0};
    if (!is_finite(local.origin) || !is_finite(local.direction)) return reached; // the box is thinner than floats are
    visit_cells(local, 0, inside.end - inside.begin, kBlockSide, {}, blocks_,
                [&](const Cell& block, float s, float s_end) {
                    if (empty_[block_index(block[0], block[1], block[2])]) return true;
                    Cell low{}, high{};
                    for (std::size_t axis = 0; axis < 3; ++axis) {
                        low[axis] = block[axis] * kBlockSide;
                        high[axis] = std::min(low[axis] + kBlockSide, size_[axis] - 1);
                    }
                    return visit_cells(local, s, s_end, 1, low, high, [&](const Cell& cell, float begin, float end) {
                        const OnRay densities(*this, local, cell);
                        const double more = densities.column(begin, end);
                        if (reached.column + more <= column) {
                            reached.column += more;
                            return true;
                        }
                        reached.t = inside.begin + densities.find(begin, end, column - reached.column);
                        reached.column = column;
                        return false;
                    });
                });
    return reached;
}

} // namespace duet
