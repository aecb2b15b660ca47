// These tests check which of two surfaces is nearer: surfaces a few ulp apart, and surfaces at equal depth.
#include "common/vec/robust.h"
#include "compare/stress/projection_runs.h"
#include "compare/stress/projection_scenes.h"
#include "compare/stress/textbook_rasterizer.h"

#include <algorithm>
#include <cmath>

namespace duet::compare {

namespace {

constexpr int kSide = 8; // pixels per side of a trial's window

// Depth order --------------------------------------------------------------------------------------------------------

constexpr float kNear = 1e-3f, kFar = 1e5f;

/// Returns a quadrilateral over the window as two triangles, perpendicular to the view or tilted, at `depth` in the
/// window's center.
Mesh random_layer(TrialRandom& random, const TrialView& v, double depth) {
    const raster::PixelRect& r = v.window.rect;
    const double margin = static_cast<double>(random.log_uniform(1, 100));
    const double tilt_x = 0.9 * static_cast<double>(random.uniform(-1, 1)) * random.coin(),
                 tilt_y = 0.9 * static_cast<double>(random.uniform(-1, 1)) * random.coin();
    const auto corner = [&](double x, double y) { // 1/depth is linear in screen space on a plane
        return point_at(v.pinhole, {lerp(r.x0 - margin, r.x1 + margin, x), lerp(r.y0 - margin, r.y1 + margin, y)},
                        depth / (1 + tilt_x * (x - 0.5) + tilt_y * (y - 0.5)));
    };
    Mesh layer;
    layer.positions = {corner(0, 0), corner(0, 1), corner(1, 1), corner(1, 0)};
    layer.triangles = {{0, 1, 2}, {0, 2, 3}};
    return layer;
}

/// Returns the layer with each corner moved `steps` floats nearer along the view.
Mesh moved_nearer(Mesh layer, int steps) {
    for (Vec3& p : layer.positions)
        for (int i = 0; i < steps; ++i) p.z = next_up(p.z);
    return layer;
}

/// Returns the layer's depth at a pixel, or none close to its diagonal.
std::optional<double> depth_at(const Mesh& layer, const Pinhole& pinhole, Vec2d pixel) {
    for (const auto& t : layer.triangles) {
        const ProjectedTriangle half(pinhole, {layer.positions[t[0]], layer.positions[t[1]], layer.positions[t[2]]});
        if (half.inside(pixel) > 1.0 / 64) return half.at(pixel).depth;
    }
    return std::nullopt;
}

// Draw order ---------------------------------------------------------------------------------------------------------

/// Returns triangles over the window, some duplicated and some at equal depth.
SetupTriangles random_setup(TrialRandom& random, const TrialView& v) {
    Mesh mesh;
    const auto add = [&](const std::array<Vec3, 3>& corners) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), corners.begin(), corners.end());
        mesh.triangles.push_back({first, first + 1, first + 2});
    };
    const std::uint32_t count = 2 + random.below(10);
    for (std::uint32_t i = 0; i < count; ++i) {
        const double depth = v.pinhole.near * static_cast<double>(2 + random.below(3));
        const auto corner = [&] {
            return point_at(v.pinhole,
                            pixel_in(random, v.window) + Vec2d(Vec2(random.uniform(-9, 9), random.uniform(-9, 9))),
                            depth);
        };
        const Vec3 a = corner(), b = corner(), c = corner();
        add({a, b, c});
        if (random.coin()) add({a, b, c});
    }
    return set_up_triangles(mesh, v.view, v.window.offset);
}

template <typename T> void shuffle(std::vector<T>& items, TrialRandom& random) {
    for (std::size_t i = items.size(); i > 1; --i)
        std::swap(items[i - 1], items[random.below(static_cast<std::uint32_t>(i))]);
}

/// Stores the visible primitive of a sample by two rules for equal depth. `reversed_depth` is 0 where nothing is
/// visible.
struct VisiblePrimitive {
    float reversed_depth = 0;
    std::uint32_t lowest = kNoObject; ///< Duet's rule: the lowest ID wins
    std::uint32_t first = kNoObject;  ///< the textbook rule: the first drawn wins
};

/// Renders each triangle alone and then selects the nearest one at each sample.
Image<VisiblePrimitive> resolve_by_hand(const SetupTriangles& setup, const TrialView& v) {
    Image<VisiblePrimitive> seen(kSide, kSide);
    for (const raster::DrawTriangle& setup_triangle : setup.triangles) {
        const auto alone = draw(setup, {setup_triangle}, v.view, v.window);
        v.window.for_each([&](int x, int y) {
            VisiblePrimitive& here = seen(x - v.window.rect.x0, y - v.window.rect.y0);
            const float reversed_depth = alone->reversed_depth(x, y);
            if (reversed_depth > here.reversed_depth)
                here = {reversed_depth, setup_triangle.id, setup_triangle.id};
            else if (reversed_depth > 0 && reversed_depth == here.reversed_depth)
                here.lowest = min(here.lowest, setup_triangle.id);
        });
    }
    return seen;
}

} // namespace

void depth_order(Trial& trial) {
    TrialRandom& random = trial.random;
    TrialView v = random_view(random, kSide, static_cast<double>(kNear));
    v.view.camera.eye = {0, 0, 0}; // the view is along −z from the origin, so a corner's z is its depth
    v.view.camera.look_at = {0, 0, -1};
    v.view.camera.up = {0, 1, 0};
    v.pinhole = CameraModel(v.view).pinhole();
    const double depth = static_cast<double>(random.log_uniform(4 * kNear, kFar / 4));
    const int steps = static_cast<int>(random.log_uniform(1, 64));
    // The layer behind has the lower ID and would win a tie.
    const Mesh behind = random_layer(random, v, depth), before = moved_nearer(behind, steps);
    SetupTriangles setup = set_up_triangles(behind, v.view, v.window.offset);
    const auto first_before = static_cast<std::uint32_t>(setup.source_triangles.size());
    setup.append(set_up_triangles(before, v.view, v.window.offset));
    if (random.coin()) std::reverse(setup.triangles.begin(), setup.triangles.end());
    const auto tile = draw(setup, v.view, v.window);

    trial.note("corners ", exact(behind.positions[0]), ", ", exact(behind.positions[1]), ", ",
               exact(behind.positions[2]), "; others ", steps, " floats nearer");
    v.window.for_each([&](int x, int y) {
        const Vec2d pixel = v.window.offset.position(x, y);
        const std::optional<double> far = depth_at(behind, v.pinhole, pixel), near = depth_at(before, v.pinhole, pixel);
        constexpr double kResolved = 0x1p-23 * (1 + 1e-6);
        if (!far || !near || *far / *near - 1 < kResolved) return;
        const std::uint32_t seen = tile->id(x, y);
        trial.record_failure_if(seen < first_before || seen == raster::kNoTriangle);
        const auto z = [](double d) { return textbook_z(static_cast<float>(d), kNear, kFar); };
        trial.record_naive_failure_if(!(z(*near) < z(*far)));
    });
}

void draw_order(Trial& trial) {
    const TrialView v = random_view(trial.random, kSide);
    SetupTriangles setup = random_setup(trial.random, v);
    shuffle(setup.triangles, trial.random);
    const auto tile = draw(setup, v.view, v.window);
    const Image<VisiblePrimitive> seen = resolve_by_hand(setup, v);
    int wrong = 0, naive_wrong = 0;
    v.window.for_each([&](int x, int y) {
        const VisiblePrimitive& here = seen(x - v.window.rect.x0, y - v.window.rect.y0);
        const std::uint32_t id = tile->id(x, y);
        wrong += (id == raster::kNoTriangle ? kNoObject : id) != here.lowest;
        naive_wrong += here.first != here.lowest;
    });
    trial.note(setup.triangles.size(), " triangles in ", v.view.width, "x", v.view.height, " pixels from (",
               v.window.rect.x0, ", ", v.window.rect.y0, ')');
    trial.record(wrong);
    trial.record_naive(naive_wrong);
}

} // namespace duet::compare
