#include "raster/solve.h"

#include <algorithm>
#include <cstring>

namespace duet::raster {

void StripSolver::load(const std::int32_t* ids) {
    if (generation_ > 0 && std::memcmp(ids, ids_.at(0), sizeof(ids_.v)) == 0) return;
    ++generation_;
    std::memcpy(ids_.at(0), ids, sizeof(ids_.v));
    seen_ = on_mesh_ = 0;
    one_object_ = nullptr;
    one_mesh_ = nullptr;
    bool several = false;
    const TransformedObject* object = nullptr;
    const Run* hint = last_run_ != nullptr ? last_run_ : &triangles_.runs.front();
    std::size_t last = kStrip; // lane looked up last
    for (std::size_t i = 0; i < kStrip; ++i) {
        if (id(i) == kNoTriangle) continue;
        seen_ |= 1u << i;
        if (last < kStrip && ids_[i] == ids_[last]) { // a copy is cheaper than to look it up again
            runs_[i] = runs_[last];
            if (!(on_mesh_ >> last & 1)) continue;
            for (std::size_t k = 0; k < 3; ++k) {
                corner[k][i] = corner[k][last];
                for (std::size_t axis = 0; axis < 3; ++axis) position[k][axis][i] = position[k][axis][last];
            }
            on_mesh_ |= 1u << i;
            continue;
        }
        last = i;
        runs_[i] = hint = last_run_ = &triangles_.run_of(id(i), *hint);
        if (runs_[i]->sphere) continue;
        const auto* mesh = std::get_if<Mesh>(&triangles_.shape(*runs_[i]));
        if (mesh == nullptr) continue;
        const TransformedObject* of = &triangles_.objects[runs_[i]->object];
        several = several || (object != nullptr && object != of);
        object = of;
        one_mesh_ = mesh;
        on_mesh_ |= 1u << i;
        load_lane(i);
    }
    if (several) on_mesh_ = 0; // a border of two objects: too few samples to be worth a second way
    if (on_mesh_ == 0) {
        one_mesh_ = nullptr;
        return;
    }
    one_object_ = object;
    project();
}

void StripSolver::load_lane(std::size_t i) {
    const auto& corners = one_mesh_->triangles[Triangles::index(*runs_[i], id(i))];
    for (std::size_t k = 0; k < 3; ++k) {
        corner[k][i] = corners[k];
        const Vec3 p = one_mesh_->positions[corners[k]];
        position[k][0][i] = p.x;
        position[k][1][i] = p.y;
        position[k][2][i] = p.z;
    }
}

void StripSolver::project() {
    const Mat4d& m = one_object_->to_pixel;
    for (std::size_t k = 0; k < 3; ++k) {
        StripOf<double> px, py, pz;
        for (std::size_t i = 0; i < kStrip; ++i) {
            px[i] = static_cast<double>(position[k][0][i]);
            py[i] = static_cast<double>(position[k][1][i]);
            pz[i] = static_cast<double>(position[k][2][i]);
        }
        for (std::size_t i = 0; i < kStrip; i += Doubles::size) {
            const Doubles x = raster::load(px, i), y = raster::load(py, i), z = raster::load(pz, i);
            const auto row = [&](std::size_t r) {
                return Doubles(m[r][0]) * x + Doubles(m[r][1]) * y + Doubles(m[r][2]) * z + Doubles(m[r][3]);
            };
            store(x_[k], i, row(0));
            store(y_[k], i, row(1));
            store(depth_[k], i, row(2));
        }
    }
}

// With the vertices moved so that the sample is the origin, the edge functions of Interpolation are plain 2 × 2
// determinants: b_i = e_i / Σe, whatever the triangle's winding, and depth = Σ(e·depth) / Σe.
void StripSolver::solve(int x, int y, SampleOffset offset) {
    inside_ = counter_clockwise_ = 0;
    if (on_mesh_ == 0) return;
    const Vec2d first = offset.position(x, y);
    StripOf<double> sample_x, sample_y, least, orientation;
    for (std::size_t i = 0; i < kStrip; ++i) {
        sample_x[i] = first.x + static_cast<double>(i % kStripWidth);
        sample_y[i] = first.y + static_cast<double>(i / kStripWidth);
    }
    const bool orthographic = view_.viewport.orthographic;
    for (std::size_t i = 0; i < kStrip; i += Doubles::size) {
        const Doubles sx = raster::load(sample_x, i), sy = raster::load(sample_y, i), one(1.0);
        std::array<Doubles, 3> vx, vy, d, w;
        for (std::size_t k = 0; k < 3; ++k) {
            d[k] = raster::load(depth_[k], i);
            w[k] = orthographic ? one : d[k];
            vx[k] = raster::load(x_[k], i) - sx * w[k];
            vy[k] = raster::load(y_[k], i) - sy * w[k];
        }
        const Doubles e0 = vx[1] * vy[2] - vy[1] * vx[2], e1 = vx[2] * vy[0] - vy[2] * vx[0],
                      e2 = vx[0] * vy[1] - vy[0] * vx[1];
        const Doubles determinant = e0 * w[0] + e1 * w[1] + e2 * w[2];
        const Doubles sum = e0 + e1 + e2, depth_sum = e0 * d[0] + e1 * d[1] + e2 * d[2];
        const Doubles inverse = one / sum;
        store(b1, i, e1 * inverse);
        store(b2, i, e2 * inverse);
        store(depth, i, depth_sum * inverse);
        store(orientation, i, determinant);
        const auto positive = determinant > Doubles(0.0);
        store(least, i, xsimd::select(positive, min(min(e0, e1), e2), Doubles(0.0) - max(max(e0, e1), e2)));
    }
    for (std::size_t i = 0; i < kStrip; ++i) {
        inside_ |= std::uint32_t{least[i] >= 0 && orientation[i] != 0} << i;
        counter_clockwise_ |= std::uint32_t{orientation[i] < 0} << i;
    }
    inside_ &= sabotaged(Guard::kPerspective) ? 0 : on_mesh_;
}

} // namespace duet::raster
