// This file finds the blockers between a receiver and a light: an upper bound of their distance from the receiver,
// and their mean.
#include "raster/shadows/light_cone.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

namespace duet::raster {
namespace {

/// Returns the unit direction through the center of cell (x, y) of n × n on a cube face.
Vec3 cell_direction(std::size_t face, int x, int y, int n) {
    const float step = 2.0f / static_cast<float>(n);
    return normalize(from_face(face,
            {-1 + (static_cast<float>(x) + 0.5f) * step, 1 - (static_cast<float>(y) + 0.5f) * step, 1}));
}

} // namespace

/// For each cell of directions, stores the least distance of any surface that may lie in the cone of a receiver in
/// that cell. Every point of a cone is within the light's radius r of the line from the light's center to the
/// receiver. So a surface at distance d and angle ψ from the receiver's direction can lie in the cone only if d sin ψ
/// ≤ r.
void AreaLightShadow::compute_closest() {
    constexpr int kOccluderCells = 2 * kDirectionCells;
    struct Occluder {
        Vec3 direction;
        float distance; ///< lower bound
    };
    std::vector<Occluder> occluders;
    const int side = 2 * static_cast<int>(cube_.middle);
    for (std::size_t face = 0; face < 6; ++face) {
        if (nearest_[face] == nullptr) continue;
        for (int y = 0; y < kOccluderCells; ++y)
            for (int x = 0; x < kOccluderCells; ++x) {
                const Vec3 direction = cell_direction(face, x, y, kOccluderCells);
                const auto texel = [&](int cell) { return std::min(cell * side / kOccluderCells, side - 1); };
                const float reversed_depth = nearest_[face]->max_over(texel(x), texel(y), texel(x + 1), texel(y + 1));
                if (reversed_depth > 0) occluders.push_back({direction, cube_.near / reversed_depth * 0.9999f});
            }
    }
    // The angular slack is at most half the diagonal of a cell of each kind, plus the guard texels that a cell may
    // overlap.
    const float slack = std::sqrt(2.0f) / kDirectionCells + std::sqrt(2.0f) / kOccluderCells + 0.1f;
    const float cosine = std::cos(slack), sine = std::sin(slack);
    for (std::size_t face = 0; face < 6; ++face)
        for (int y = 0; y < kDirectionCells; ++y)
            for (int x = 0; x < kDirectionCells; ++x) {
                const Vec3 direction = cell_direction(face, x, y, kDirectionCells);
                float closest = kInfinity;
                for (const Occluder& s : occluders) {
                    if (s.distance >= closest) continue;
                    const float c = dot(direction, s.direction);
                    const float beside = c >= cosine  ? 0.0f
                                         : c < -sine ? 1.0f // behind the light: only as close as the light's own radius
                                                     : std::sqrt(1 - c * c) * cosine - c * sine; // sin(ψ − slack)
                    if (s.distance * beside <= radius_) closest = s.distance;
                }
                closest_[(face * kDirectionCells + static_cast<std::size_t>(y)) * kDirectionCells +
                         static_cast<std::size_t>(x)] = closest;
            }
}

/// Returns the bound of bound(), taken from the precomputed cells around the receiver's direction.
float AreaLightShadow::initial_reach(Vec3 p, std::size_t face, float farthest) const {
    const Vec3 along = to_face(face, p);
    const auto cell = [&](float at) {
        return static_cast<std::size_t>(
            std::clamp(static_cast<int>((at / along.z + 1) * (0.5f * kDirectionCells)), 0, kDirectionCells - 1));
    };
    const float distance = length(p),
                closest = closest_[(face * kDirectionCells + cell(-along.y)) * kDirectionCells + cell(along.x)];
    if (closest >= std::max(distance, farthest)) return 0;
    return distance > farthest ? std::min((distance - closest) / (distance - farthest), 1.0f) : 1.0f;
}

/// Returns an upper bound of the distance from the receiver at which a blocker in these windows can stand, as a
/// fraction of the way to the light.
float AreaLightShadow::bound(const Faces& faces, float farthest) const {
    float bound = 0;
    for (std::size_t i = 0; i < faces.count; ++i) {
        const auto& [face, cone, window] = *faces.windows[i];
        const float reversed_depth = nearest_[face]->max_over(window.x0, window.y0, window.x1, window.y1);
        if (!(reversed_depth > 0)) continue;
        const float depth = cube_.near / reversed_depth * 0.9999f, distance = length(cone.p);
        // A point at the fraction f of the way is at most |p| (1 − f) + r f away from the center. If one face covers
        // the whole cone, its depth is also at most p.z (1 − f) + z f.
        if (distance > farthest) bound = std::max(bound, (distance - depth) / (distance - farthest));
        else bound = 1;
        if (faces.count > 1) continue;
        const float deepest = reduce_max(cone.corners_z);
        if (cone.p.z > deepest) bound = std::min(bound, (cone.p.z - depth) / (cone.p.z - deepest));
    }
    return bound;
}

/// For a row of texels, or of the nearest depths of texel blocks, stores which of them block the light and at which
/// fraction of the way.
struct AreaLightShadow::BlockerBatch {
    Floats::batch_bool_type blocks;
    Floats fraction; ///< of the way from receiver to light
    Floats margin; ///< half a texel or block at that depth, in units of the light's edges
};

AreaLightShadow::Blockers AreaLightShadow::search(const Faces& faces) const {
    Blockers blockers;
    for (std::size_t i = 0; i < faces.count; ++i)
        add_blockers(faces.windows[i]->cone, faces.windows[i]->face, faces.windows[i]->window, blockers);
    return blockers;
}

/// Searches the texel blocks that may contain a blocker, instead of a sparse subset of each window's texels.
AreaLightShadow::Blockers AreaLightShadow::search_blocks(const Faces& faces) const {
    Blockers blockers;
    for (std::size_t i = 0; i < faces.count; ++i)
        add_blocks(faces.windows[i]->cone, faces.windows[i]->face, faces.windows[i]->window, blockers);
    return blockers;
}

/// Accumulates the fraction of the way at which the blockers in a window stand. Each blocker is weighted by its size
/// as occluders from the receiver, which is how much of the light it hides.
void AreaLightShadow::add_blockers(const Cone& cone, std::size_t face, const Window& window, Blockers& blockers) const {
    const int rows = std::min(window.rows(), kSearchedRows);
    const float down = static_cast<float>(window.rows()) / static_cast<float>(rows),
                across = static_cast<float>(window.columns()) / kSearchedSide;
    // A texel's point is above the receiver's plane where height + over · reversed_depth > 0, as in count_dark_taps.
    // `reversed_depth` is reversed depth.
    const float per_texel = cube_.near / cube_.scale;
    const Floats over(-dot(cone.n, cone.p) - cone.slack), n_x(cone.n.x * per_texel);
    const int width = 2 * static_cast<int>(cube_.middle);
    // In a narrow window whole rows are loaded, at any alignment.
    const bool narrow = window.columns() <= kSearchedSide;
    const int left = narrow ? std::min(window.x0, width - kSearchedSide) : window.x0;
    for (int first = 0; first < kSearchedSide; first += static_cast<int>(Floats::size)) {
        const Floats column = load(kLanesAsFloats, 0) + Floats(static_cast<float>(first));
        const Floats x = Floats(static_cast<float>(left)) + (narrow ? column : xsimd::floor(column * Floats(across)));
        const auto inside = (x >= Floats(static_cast<float>(window.x0))) & (x <= Floats(static_cast<float>(window.x1)));
        const Ints indices = truncated(x);
        const Floats from_middle = x + Floats(0.5f - cube_.middle), height_x = n_x * from_middle;
        for (int row = 0; row < rows; ++row) {
            const int y = window.y0 + static_cast<int>(static_cast<float>(row) * down);
            const float up = cube_.middle - 0.5f - static_cast<float>(y);
            const float* row_depths = cube_.faces[face]->reversed_depth().pixels().data() + y * width;
            const Floats reversed_depth =
                narrow ? Floats::load_unaligned(row_depths + left + first) : gather(row_depths, indices);
            const Floats height = height_x + Floats(cone.n.y * per_texel * up + cone.n.z * cube_.near);
            const auto above = inside & (height + over * reversed_depth > Floats(0.0f));
            if (!xsimd::any(above)) continue;
            const BlockerBatch found = this->evaluate_blockers(cone, above, reversed_depth, from_middle, up, 1);
            if (!xsimd::any(found.blocks)) continue;
            const Floats none(0.0f), about = found.fraction + found.margin, weight = Floats(1.0f) / (about * about);
            blockers.weights += xsimd::hadd(xsimd::select(found.blocks, weight, none));
            blockers.sum += xsimd::hadd(xsimd::select(found.blocks, weight * found.fraction, none));
        }
    }
}

/// Finds the blocks of texels whose nearest depth may hide a part of the light, and searches those for blockers.
void AreaLightShadow::add_blocks(const Cone& cone, std::size_t face, const Window& window, Blockers& blockers) const {
    int level = 0;
    Window blocks = window;
    while (blocks.columns() > kSearchedSide || blocks.rows() > kSearchedRows) {
        ++level;
        blocks = {window.x0 >> level, window.y0 >> level, window.x1 >> level, window.y1 >> level};
    }
    const ImageFloat& image = nearest_[face]->level(level);
    const int texels = 1 << level;
    const float block = static_cast<float>(texels), per_texel = cube_.near / cube_.scale;
    // The test must not miss a block whose nearest surface is above the plane anywhere in the block.
    const float rim = 0.5f * (block - 1) * (std::abs(cone.n.x) + std::abs(cone.n.y)) * per_texel;
    const Floats over(-dot(cone.n, cone.p) - cone.slack), n_x(cone.n.x * per_texel);
    const bool rows = image.width() >= kSearchedSide; // whole rows are loaded then, at any alignment
    const int start = rows ? std::min(blocks.x0, image.width() - kSearchedSide) : 0;
    for (int first = start; first <= blocks.x1; first += static_cast<int>(Floats::size)) {
        const Floats x = min(load(kLanesAsFloats, 0) + Floats(static_cast<float>(first)),
                             Floats(static_cast<float>(image.width() - 1)));
        const Floats from_middle = (x + Floats(0.5f)) * Floats(block) - Floats(cube_.middle), height_x = n_x *
            from_middle;
        const Ints indices = truncated(x);
        for (int y = blocks.y0; y <= blocks.y1; ++y) {
            const float up = cube_.middle - (static_cast<float>(y) + 0.5f) * block;
            const float* row_depths = image.pixels().data() + y * image.width();
            const Floats reversed_depth =
                rows ? Floats::load_unaligned(row_depths + first) : gather(row_depths, indices);
            const Floats height = height_x + Floats(cone.n.y * per_texel * up + cone.n.z * cube_.near - rim);
            const auto above = height + over * reversed_depth > Floats(0.0f);
            if (!xsimd::any(above)) continue;
            const auto found = this->evaluate_blockers(cone, above, reversed_depth, from_middle, up, block).blocks;
            for (std::uint32_t left = lane_bits(found); left != 0; left &= left - 1) {
                const int i = first + std::countr_zero(left);
                if (i < blocks.x0 || i > blocks.x1) continue;
                const int x0 = i * texels, y0 = y * texels;
                add_blockers(cone, face,
                             {std::max(x0, window.x0), std::max(y0, window.y0), std::min(x0 + texels - 1, window.x1),
                                          std::min(y0 + texels - 1, window.y1)}, blockers);
            }
        }
    }
}

AreaLightShadow::BlockerBatch AreaLightShadow::evaluate_blockers(const Cone& cone, const Floats::batch_bool_type& above,
                                                                 const Floats& reversed_depth, const Floats& right,
                                                                 float up, float block) const {
    const Floats depth = Floats(cube_.near) / reversed_depth, per_scale = depth * Floats(1 / cube_.scale);
    const Vec3T<Floats> to{right * per_scale - Floats(cone.p.x), Floats(up) * per_scale - Floats(cone.p.y),
                           depth - Floats(cone.p.z)};
    const Floats fraction = dot(broadcast<Floats>(cone.o.axis), to) * Floats(cone.per_height);
    // Where the cone is narrower than a texel, half a texel on each side still belongs to the filter's footprint. The
    // next facet of a concave surface is excluded (kConcave).
    const Floats none(0.0f), margin = per_scale * Floats(0.5f * block * cone.per_meter);
    const auto steps_up =
        block > 1 ? above : dot(broadcast<Floats>(cone.n), to) > per_scale * Floats(static_cast<float>(kConcave));
    return {above & (fraction > none) & (fraction < Floats(1.0f)) &
            cone.meets(to, fraction, xsimd::select(steps_up, margin, none)),
            fraction, margin};
}

} // namespace duet::raster
