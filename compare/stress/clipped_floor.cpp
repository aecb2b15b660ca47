// This test renders a floor of many triangles that extends below and behind the eye. After clipping at the near plane
// and the guard band it must have no gap and no overlap.
#include "compare/stress/projection_runs.h"
#include "compare/stress/projection_scenes.h"
#include "compare/stress/textbook_rasterizer.h"

namespace duet::compare {

namespace {

constexpr int kSide = 12; // pixels per side of a trial's window
constexpr std::uint32_t kCells = 5;

/// Returns a square mesh in the plane y = −height about the y axis. Its border is straight and its inner vertices are
/// random, so most meshes fold over themselves.
Mesh random_floor(TrialRandom& random, float height, float extent) {
    Mesh floor;
    for (std::uint32_t row = 0; row <= kCells; ++row)
        for (std::uint32_t column = 0; column <= kCells; ++column) {
            const auto along = [&](std::uint32_t i) { // the ends are exactly ±extent
                return i == 0 ? -extent : i == kCells ? extent : extent * (2.0f * static_cast<float>(i) / kCells - 1);
            };
            const bool inner = row % kCells != 0 && column % kCells != 0;
            const float reach = random.log_uniform(height, extent);
            const float x = inner ? reach * random.uniform(-1, 1) : along(column);
            floor.positions.emplace_back(x, -height, inner ? reach * random.uniform(-1, 1) : along(row));
        }
    for (std::uint32_t row = 0; row < kCells; ++row)
        for (std::uint32_t column = 0; column < kCells; ++column) {
            const std::uint32_t a = row * (kCells + 1) + column, b = a + 1, d = a + kCells + 1, c = d + 1;
            floor.triangles.push_back({a, b, c});
            floor.triangles.push_back({a, c, d});
        }
    return floor;
}

/// Computes whether the whole square covers a sample. The result is empty where the sample is so close to the border
/// or the diagonal that vertex snapping can decide.
class Square {
public:
    Square(const Pinhole& pinhole, float height, float extent)
        : halves_{ProjectedTriangle(pinhole, {Vec3(-extent, -height, -extent), Vec3(extent, -height, -extent),
                                              Vec3(extent, -height, extent)}),
                  ProjectedTriangle(pinhole, {Vec3(-extent, -height, -extent), Vec3(extent, -height, extent),
                                              Vec3(-extent, -height, extent)})} {}

    std::optional<bool> sees(Vec2d pixel) const {
        constexpr double kSnapping = 1.0 / 256;
        const double nearest = max(halves_[0].inside(pixel), halves_[1].inside(pixel));
        return std::abs(nearest) < kSnapping ? std::nullopt : std::optional(nearest > 0);
    }

private:
    std::array<ProjectedTriangle, 2> halves_;
};

/// Returns how many of the triangles cover each sample.
Image<int> count_library(const Mesh& floor, const TrialView& v) {
    Image<int> count(kSide, kSide, 0);
    CoverageProbe probe(v.window);
    for (const raster::DrawTriangle& triangle : set_up_triangles(floor, v.view, v.window.offset).triangles) {
        probe.draw(triangle.corners);
        v.window.for_each(
            [&](int x, int y) { count(x - v.window.rect.x0, y - v.window.rect.y0) += probe.covers(x, y); });
    }
    return count;
}
Image<int> count_naive(const Mesh& floor, const TrialView& v) {
    Image<int> count(kSide, kSide, 0);
    const Mat4 matrix(v.pinhole.world_to_pixel);
    for (const auto& t : floor.triangles) {
        const auto vertex = [&](std::size_t i) { return textbook_project(matrix, floor.positions[t[i]]); };
        const TextbookTriangle triangle{vertex(0), vertex(1), vertex(2)};
        v.window.for_each([&](int x, int y) {
            count(x - v.window.rect.x0, y - v.window.rect.y0) +=
                textbook_covers(triangle, Vec2(v.window.offset.position(x, y)));
        });
    }
    return count;
}

} // namespace

void clipped_floor(Trial& trial) {
    TrialRandom& random = trial.random;
    TrialView v = random_view(random, kSide);
    v.view.camera.look_at = v.view.camera.look_at - v.view.camera.eye;
    v.view.camera.eye = {0, 0, 0};
    v.pinhole = CameraModel(v.view).pinhole();
    const float height = static_cast<float>(v.pinhole.near) * random.log_uniform(0.1f, 1000);
    const float extent = height * random.log_uniform(10, 1e5f);
    const Mesh floor = random_floor(random, height, extent);
    const Square square(v.pinhole, height, extent);
    const Image<int> count = count_library(floor, v), naive = count_naive(floor, v);
    int wrong = 0, naive_wrong = 0;
    v.window.for_each([&](int x, int y) {
        const std::optional<bool> seen = square.sees(v.window.offset.position(x, y));
        const int column = x - v.window.rect.x0, row = y - v.window.rect.y0;
        if (!seen) return;
        // Each fold adds two covering triangles, so the count is odd where the square is visible.
        wrong += (count(column, row) % 2 != 0) != *seen;
        naive_wrong += (naive(column, row) % 2 != 0) != *seen;
    });
    trial.note("floor ", exact(height), " below the eye, to ", exact(extent), " on all sides; looking along ",
               exact(Vec3(v.pinhole.forward)), ", near ", v.pinhole.near, ", ", v.view.width, "x", v.view.height,
               " pixels from (", v.window.rect.x0, ", ", v.window.rect.y0, ")");
    trial.record(wrong);
    trial.record_naive(naive_wrong);
}

} // namespace duet::compare
