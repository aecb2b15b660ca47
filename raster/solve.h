// Where on its triangle each of sixteen samples lies: barycentrics and depth, side by side.
#pragma once

#include "raster/geometry.h"
#include "raster/lanes.h"

#include <cstdint>

namespace duet::raster {

/// A strip of samples of one tile, and what they see. Walks from strip to strip: what two of them have in common is not
/// looked up again.
class StripSolver {
public:
    /// Pixels are counted from the tile's corner.
    StripSolver(const Triangles& triangles, const PassView& view, const PixelRect& tile)
        : triangles_(triangles), view_(view), origin_x_(tile.x0), origin_y_(tile.y0) {}

    /// Takes the numbers of what the sixteen samples see (DepthTile::ids).
    void load(const std::int32_t* ids);
    /// Finds barycentrics and depths at two rows of eight samples, from pixel (x, y) on.
    void solve(int x, int y, SampleOffset offset);
    /// The same, with those solutions mended that do not hold as they are: see inside().
    void solve_all(int x, int y, SampleOffset offset);

    /// A bit for each sample that sees something, and for each that sees a mesh's triangle: the others have no solution.
    std::uint32_t seen() const { return seen_; }
    std::uint32_t on_mesh() const { return on_mesh_; }
    /// After solve(): a bit for each sample that lies in the unsnapped triangle, where the solution holds as it is.
    std::uint32_t inside() const { return inside_; }

    std::uint32_t id(std::size_t i) const { return static_cast<std::uint32_t>(ids_[i]); }
    const Run& run(std::size_t i) const { return triangles_.run_of(id(i), *last_run_); }
    /// The only object that is seen of all meshes, or null.
    const TransformedObject* one_object() const { return one_object_; }
    const Mesh* one_mesh() const { return one_mesh_; }

    // Of each sample's triangle, by axis, in the object's space: the vertex normal n, which changes by n1 and n2 along
    // the barycentrics b1 and b2, and the geometric normal ng, of any length, on the side that is seen.
    std::array<StripOf<float>, 3> n, n1, n2, ng;
    StripOf<double> b1, b2; ///< barycentrics of the second and third corner
    StripOf<double> depth;  ///< camera-space −z

private:
    struct Corners;
    void load_one(const std::vector<PackedVertex>& vertices);
    void load_each(const std::vector<PackedVertex>& vertices);
    void set_up(const Corners& corners);
    std::size_t index(std::size_t i) const { return static_cast<std::size_t>(ids_[i]) - first_id_; }

    const Triangles& triangles_;
    const PassView& view_;
    StripOf<std::int32_t> ids_; ///< where nothing is seen: another's
    std::uint32_t one_id_ = kNoTriangle; ///< the only one, if all samples that see any see the same
    const Run* last_run_ = nullptr;
    const TransformedObject* one_object_ = nullptr;
    const Mesh* one_mesh_ = nullptr;
    std::size_t first_id_ = 0; ///< number of the object's first triangle
    std::uint32_t seen_ = 0, on_mesh_ = 0, inside_ = 0;
    int origin_x_, origin_y_;
    /// Coefficients of x, y and 1, all with the sign that is positive inside: Interpolation's e[1] and e[2], the sum of
    /// its three, and Σ(e·depth).
    std::array<StripOf<double>, 3> e1_, e2_, sum_, depth_sum_;
};

} // namespace duet::raster
