// Stages 2 to 4 over a run of triangles: cull → clip → set up, and the smallest triangles all the way to their samples.
#pragma once

#include "raster/geometry/batch.h"
#include "raster/geometry/triangles.h"
#include "raster/lanes.h"
#include "raster/prepare.h"

#include <vector>

namespace duet::raster {

/// What assembling asks of a pass.
struct AssemblyPlan {
    Viewport viewport;
    TileGrid grid;
    std::vector<SampleOffset> samples;
    Skips skips;
    bool front_faces_only = false;
    bool patches = true; ///< small triangles of several samples in one piece each; else all of them as fragments
};

/// Takes runs of triangles to batches; one a thread. A triangle whose box holds at most 8 × 16 samples, where there
/// is one sample a pixel, is decided at once, many of them side by side: its covered samples become a patch or two, or
/// fragments where they are few. The others are set up. Each triangle of a mesh is one, each quad two (the diagonal is shared, so no
/// sample falls through or counts twice), a clipped one a fan.
class Assembler {
public:
    /// `culls_back_faces`: of this run's object. `batch` is empty.
    void assemble(const AssemblyPlan& plan, const Triangles& triangles, const Run& run, bool culls_back_faces,
                  Batch& batch);

private:
    /// Boxes of at most so many samples across and down are small: two of 8 × 8, one below the other. (Of a mesh of small triangles
    /// in rows most are a bit too tall for one; to look at every box's further columns, too, takes longer than it saves.)
    static constexpr std::int32_t kSmallSide = 8, kSmallRows = 2 * kSmallSide;

    struct Outlines;
    struct Small {            ///< a triangle whose samples in a box of 8 × 8 are known
        std::uint32_t index;  ///< of the run's object's triangles
        std::int32_t x, y;    ///< the first pixel of the box
        std::uint64_t covered, well_inside; ///< a bit for each sample, row by row
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
        std::array<StripOf<double>, 3> plane; ///< NearnessPlane's coefficients
        StripOf<double> least_depth;          ///< of the corners
    };
    template <typename IndexOf, typename OriginOf>
    void find_planes(std::size_t count, const IndexOf& index_of, const OriginOf& origin_of, PlaneStrip& planes) const;
    void add_patch(const Small& small, const NearnessPlane& plane);
    void add_fragments(const Small& small, std::uint64_t samples, const NearnessPlane& plane);

    const AssemblyPlan* plan_ = nullptr;
    const Triangles* triangles_ = nullptr;
    const TransformedObject* object_ = nullptr;
    const Mesh* mesh_ = nullptr; ///< null: quads
    Run run_;
    bool culls_back_faces_ = false;
    SampleOffset least_, most_; ///< of the plan's samples
    Batch* batch_ = nullptr;
    struct Candidates {          ///< small triangles whose samples are not known yet, up to sixteen
        std::size_t count = 0;
        std::array<std::uint32_t, kStrip> index{};
        std::array<StripOf<std::int32_t>, 3> x{}, y{}; ///< corners; where there is no triangle, of some
        StripOf<std::int32_t> sample_x{}, sample_y{};  ///< the first pixel of the box
    };
    Candidates candidates_;
    struct Outlined { ///< a triangle of the batch that still lacks its plane
        std::uint32_t index, number;
    };
    std::vector<Outlined> outlined_;
    std::vector<Small> small_;
    std::vector<TileSorter::Touch> touches_, patch_touches_;
    TileSorter sorter_;
};

} // namespace duet::raster
