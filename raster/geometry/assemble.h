// Implements stages 2 to 4 for a run of triangles: cull → clip → set up. The smallest triangles are rasterized
// here as well.
#pragma once

#include "raster/geometry/batch.h"
#include "raster/geometry/packet.h"
#include "raster/geometry/triangles.h"
#include "raster/raster_scene.h"

#include <vector>

namespace duet::raster {

/// Stores the parameters of a pass that triangle assembly needs.
struct AssemblyPlan {
    Viewport viewport;
    TileGrid grid;
    std::vector<SampleOffset> samples;
    SkipFlags skips;
    bool front_faces_only = false;
    /// With coverage masks, a small triangle's samples become one mask (CoverageMask); without, they become fragments.
    bool coverage_masks = true;
};

/// Culls, clips and sets up runs of triangles and appends the results to batches. Each thread uses its own
/// assembler. A triangle whose bounding box holds at most 8 × 16 samples, with one sample per pixel, is rasterized
/// at once with SIMD: its covered samples become one or two coverage masks (CoverageMask), or fragments if they are
/// few. Every other triangle gets a triangle setup. A mesh triangle yields one triangle, a quad two (they share the
/// diagonal, so no sample is missed or counted twice), a clipped triangle a fan.
class Assembler {
public:
    /// Processes `run` and appends its results to `batch`, which must be empty. `cull_back_faces` applies to the
    /// run's object.
    void assemble(const AssemblyPlan& plan, const Triangles& triangles, const Run& run, bool cull_back_faces,
                  Batch& batch);

private:
    /// A bounding box of at most this many samples across and down is small. It is covered by two boxes of 8 × 8,
    /// one below the other, because most triangles of a finely tessellated mesh in rows are slightly too tall for
    /// one. Testing further columns of every box as well costs more time than it saves.
    static constexpr std::int32_t kSmallSide = 8, kSmallRows = 2 * kSmallSide;

    struct TrianglePacket;
    struct SmallTriangle {    ///< a triangle with known coverage in a box of 8 × 8 samples
        std::uint32_t index;  ///< index into the triangles of the run's object
        std::int32_t x, y;    ///< first pixel of the box
        std::uint64_t covered, well_inside; ///< one bit per sample, row by row
    };

    void gather(std::uint32_t first, std::uint32_t count, TrianglePacket& triangle_packet) const;
    void dispatch(const TrianglePacket& triangle_packet);
    void classify(TrianglePacket& triangle_packet) const;
    void clip_and_set_up(std::uint32_t index);
    DrawTriangle* add_triangle(std::uint32_t index, std::array<FixedPoint, 3> corners);
    void set_up_pending();
    void add_candidate(const TrianglePacket& triangle_packet, std::uint32_t i);
    void cover_candidates();
    void add_small_triangle(std::size_t i, std::int32_t top, std::uint64_t covered, std::uint64_t well_inside);
    void compute_small_depths();
    struct PlanePacket {
        std::array<PacketOf<double>, 3> plane; ///< coefficients of DepthPlane
        PacketOf<double> min_depth;            ///< minimum over the corners
    };
    template <typename IndexOf, typename OriginOf>
    void compute_planes(std::size_t count, const IndexOf& index_of, const OriginOf& origin_of,
                        PlanePacket& planes) const;
    void add_mask(const SmallTriangle& small, const DepthPlane& plane);
    void add_fragments(const SmallTriangle& small, std::uint64_t samples, const DepthPlane& plane);

    const AssemblyPlan* plan_ = nullptr;
    const TransformedObject* object_ = nullptr;
    ShapeTriangles shape_;
    Run run_;
    bool cull_back_faces_ = false;
    SampleOffset min_offset_, max_offset_; ///< componentwise minimum and maximum of the plan's sample offsets
    Batch* batch_ = nullptr;
    struct Candidates {          ///< up to 16 small triangles whose coverage is not computed yet
        std::size_t count = 0;
        std::array<std::uint32_t, kPacketSize> index{};
        std::array<PacketOf<std::int32_t>, 3> x{}, y{}; ///< corners; lanes past `count` hold stale values
        PacketOf<std::int32_t> sample_x{}, sample_y{};  ///< first pixel of the box
    };
    Candidates candidates_;
    struct PendingTriangle { ///< a triangle of the batch whose depth plane is still missing
        std::uint32_t index, number;
    };
    std::vector<PendingTriangle> pending_;
    std::vector<SmallTriangle> small_triangles_;
    std::vector<TileSorter::TileOverlap> overlaps_, mask_overlaps_;
    TileSorter sorter_;
};

} // namespace duet::raster
