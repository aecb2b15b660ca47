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

    /// After solve(), by axis, in the object's space and of any length: the vertex normals interpolated, and the
    /// geometric normal on the side that is seen.
    std::array<StripOf<float>, 3> normal, ng;
    StripOf<double> b1, b2; ///< barycentrics of the second and third corner
    StripOf<double> depth;  ///< camera-space −z

private:
    /// What follows from one triangle, for all its samples; T is a number, or a strip of them, a triangle each. Planes
    /// are the coefficients of x, y and 1, all with the sign that is positive inside: Interpolation's e[1] and e[2], the
    /// sum of its three, and Σ(e·depth).
    template <typename D, typename F> struct SetUp {
        std::array<D, 3> e1, e2, sum, depth_sum;
        std::array<F, 3> n, n1, n2, ng; ///< the first corner's normal, and its changes along the barycentrics
    };
    struct CachedSetUp : SetUp<double, float> {
        std::uint32_t id = kNoTriangle;
    };

    const CachedSetUp& set_up_of(std::size_t i);
    void set_up_each();
    template <typename Planes> void solve_lanes(const Planes& planes, Vec2d first, std::uint32_t lanes, bool only);
    std::size_t index(std::size_t i) const { return static_cast<std::size_t>(ids_[i]) - first_id_; }

    const Triangles& triangles_;
    const PassView& view_;
    StripOf<std::int32_t> ids_; ///< where nothing is seen: another's
    const Run* last_run_ = nullptr;
    const TransformedObject* one_object_ = nullptr;
    const Mesh* one_mesh_ = nullptr;
    std::size_t first_id_ = 0; ///< number of the object's first triangle
    std::uint32_t seen_ = 0, on_mesh_ = 0, inside_ = 0;
    int origin_x_, origin_y_;
    bool each_ = false;                   ///< so many triangles that each sample's is set up by itself, side by side
    SetUp<StripOf<double>, StripOf<float>> lanes_; ///< then
    static constexpr std::size_t kFew = 5, kCached = 64;
    std::size_t few_ = 0; ///< else: how many there are
    std::array<std::uint32_t, kFew> few_lanes_{}; ///< and a bit for each of their samples
    std::array<CachedSetUp, kCached> cache_; ///< by id; the next strip sees much the same triangles
};

} // namespace duet::raster
