// Implements stages 2 to 4 for a run of triangles: cull → clip → set up. The smallest triangles are rasterized
// here as well.
#pragma once

#include "raster/geometry/batch.h"
#include "raster/geometry/triangles.h"
#include "raster/lanes.h"
#include "raster/prepare.h"

#include <vector>

namespace duet::raster {

/// Stores the parameters of a pass that triangle assembly needs.
struct AssemblyPlan {
    Viewport viewport;
    TileGrid grid;
    std::vector<SampleOffset> samples;
    Skips skips;
    bool front_faces_only = false;
    /// If it is true, a small triangle's samples become one coverage mask (Patch); else they become fragments.
    bool patches = true;
};

/// Culls, clips and sets up runs of triangles and appends the results to batches. Each thread uses its own
/// assembler. A triangle whose bounding box holds at most 8 × 16 samples, with one sample per pixel, is rasterized
/// at once with SIMD: its covered samples become one or two coverage masks (Patch), or fragments if they are few.
/// Every other triangle gets a triangle setup. A mesh triangle yields one triangle, a quad two (they share the
/// diagonal, so no sample is missed or counted twice), a clipped triangle a fan.
class Assembler {
public:
    /// Processes `run` and appends its results to `batch`, which must be empty. `culls_back_faces` applies to the
    /// run's object.
    void assemble(const AssemblyPlan& plan, const Triangles& triangles, const Run& run, bool culls_back_faces,
                  Batch& batch);

private:
    /// A bounding box of at most this many samples across and down is small. It is covered by two boxes of 8 × 8,
    /// one below the other, because most triangles of a finely tessellated mesh in rows are slightly too tall for
    /// one. Testing further columns of every box as well costs more time than it saves.
    static constexpr std::int32_t kSmallSide = 8, kSmallRows = 2 * kSmallSide;

    struct Outlines;
    struct Small {            ///< a triangle with known coverage in a box of 8 × 8 samples
        std::uint32_t index;  ///< index into the triangles of the run's object
        std::int32_t x, y;    ///< first pixel of the box
        std::uint64_t covered, well_inside; ///< one bit per sample, row by row
    };

    void gather(const Shape& shape, std::uint32_t first, std::uint32_t count, Outlines& outlines) const;
    void sort_out(const Outlines& outlines);
    void judge(Outlines& outlines) const;
    WholeTriangle whole_triangle(std::uint32_t index) const;
    void clip_and_set_up(std::uint32_t index);
    DrawTriangle* add_outline(std::uint32_t index, std::array<FixedPoint, 3> corners);
    void set_up_outlines();
    void add_candidate(const Outlines& outlines, std::uint32_t i);
    void cover_candidates();
    void add_small(std::size_t i, std::int32_t top, std::uint64_t covered, std::uint64_t well_inside);
    void find_nearness();
    struct PlaneStrip {
        std::array<StripOf<double>, 3> plane; ///< coefficients of NearnessPlane
        StripOf<double> least_depth;          ///< minimum over the corners
    };
    template <typename IndexOf, typename OriginOf>
    void find_planes(std::size_t count, const IndexOf& index_of, const OriginOf& origin_of, PlaneStrip& planes) const;
    void add_patch(const Small& small, const NearnessPlane& plane);
    void add_fragments(const Small& small, std::uint64_t samples, const NearnessPlane& plane);

    const AssemblyPlan* plan_ = nullptr;
    const Triangles* triangles_ = nullptr;
    const TransformedObject* object_ = nullptr;
    const Mesh* mesh_ = nullptr; ///< null for quads
    Run run_;
    bool culls_back_faces_ = false;
    SampleOffset least_, most_; ///< componentwise minimum and maximum of the plan's sample offsets
    Batch* batch_ = nullptr;
    struct Candidates {          ///< up to 16 small triangles whose coverage is not computed yet
        std::size_t count = 0;
        std::array<std::uint32_t, kStrip> index{};
        std::array<StripOf<std::int32_t>, 3> x{}, y{}; ///< corners; lanes past `count` hold stale values
        StripOf<std::int32_t> sample_x{}, sample_y{};  ///< first pixel of the box
    };
    Candidates candidates_;
    struct Outlined { ///< a triangle of the batch whose depth plane is still missing
        std::uint32_t index, number;
    };
    std::vector<Outlined> outlined_;
    std::vector<Small> small_;
    std::vector<TileSorter::Touch> touches_, patch_touches_;
    TileSorter sorter_;
};

} // namespace duet::raster
