#include "compare/stress/raster_stages.h"

namespace duet::compare {

using raster::PixelVertex;

namespace {

constexpr double kProbeNear = 1e-6; ///< first depth; each later one is nearer than the last

/// A WindowPass is a render pass over the window alone.
struct WindowPass {
    std::vector<raster::SampleOffset> samples;
    raster::PassView view;
    raster::TileGrid grid;

    WindowPass(const View& full_view, const Window& window)
        : WindowPass(full_view, window, CameraModel(full_view).pinhole()) {}
    WindowPass(const WindowPass&) = delete;
    WindowPass& operator=(const WindowPass&) = delete;

private:
    WindowPass(const View& full_view, const Window& window, const Pinhole& pinhole)
        : samples{window.offset}, view{pinhole, 0, raster::viewport_of(full_view, pinhole), samples},
          grid{window.rect} {}
};

/// A MeshScene is a scene of one mesh, with the rasterizer's prepared data.
struct MeshScene {
    Scene scene;
    raster::RasterSceneData data;

    explicit MeshScene(const Mesh& mesh)
        : scene(make(mesh)), data{.scene = scene,
                                  .objects = std::vector<raster::RasterObject>(1),
                                  .polygonal = {0},
                                  .spheres = {},
                                  .sky_irradiance = raster::environment_irradiance(scene.environment, nullptr, 1),
                                  .shapes = packed(scene.shapes[0])} {}
    MeshScene(const MeshScene&) = delete;
    MeshScene& operator=(const MeshScene&) = delete;

    static Scene make(const Mesh& mesh) {
        Scene scene;
        scene.shapes = {mesh};
        scene.objects.resize(1);
        return scene;
    }
    static SharedList<raster::PackedShape> packed(const Shape& shape) {
        SharedList<raster::PackedShape> list;
        list.push_back(raster::PackedShape(shape));
        return list;
    }
};

raster::RasterSettings without_culling() {
    raster::RasterSettings settings;
    settings.threads = 1;
    settings.skips.frustum = settings.skips.back_faces = false;
    return settings;
}

} // namespace

CoverageProbe::CoverageProbe(const Window& window) {
    plan_.viewport = {1 << 14, 1 << 14, kProbeNear, true};
    plan_.grid = {window.rect};
    plan_.samples = {window.offset};
    plan_.skips = without_culling().skips;
    Mesh mesh;
    mesh.positions.resize(3);
    mesh.triangles = {{0, 1, 2}};
    scene_ = MeshScene::make(mesh);
    triangles_.scene = &scene_;
    triangles_.objects.resize(1); // the object's transform is the identity: orthographic, (x, y, depth, 1)
    triangles_.objects[0].vertices.resize(3);
    triangles_.runs.resize(1);
    tile_.reset(window.rect, window.offset, plan_.viewport);
}

// Draws a triangle parallel to the image plane, so that its depth is constant. That depth, 1/count, is nearer than that
// of the previous triangle.
void CoverageProbe::draw(GridTriangle t) {
    ++count_;
    if (winding(t) == 0) return;
    for (std::size_t i = 0; i < 3; ++i) {
        triangles_.objects[0].vertices[i].p = t[i];
        std::get<Mesh>(scene_.shapes.edit(0)).positions[i] =
            Vec3(Vec3d(t[i].x, t[i].y, 0) * (1.0 / raster::kSubpixels) + Vec3d(0, 0, 1.0 / count_));
    }
    triangles_.runs[0] = {0, 0, 1, count_, false};
    raster::Batch batch;
    assembler_.assemble(plan_, triangles_, triangles_.runs[0], false, batch);
    for (const raster::DrawTriangle& setup_triangle : batch.triangles) tile_.draw(setup_triangle, triangles_);
    for (const raster::CoverageMask& patch : batch.coverage_masks) tile_.draw(patch);
    tile_.draw(batch.fragments);
}

bool CoverageProbe::covers(int x, int y) const { return tile_.id(x, y) == count_; }

void SetupTriangles::append(const SetupTriangles& other) {
    const auto first = static_cast<std::uint32_t>(source_triangles.size());
    source_triangles.insert(source_triangles.end(), other.source_triangles.begin(), other.source_triangles.end());
    for (raster::DrawTriangle setup_triangle : other.triangles) {
        setup_triangle.id += first;
        triangles.push_back(setup_triangle);
    }
}

SetupTriangles set_up_triangles(const Mesh& mesh, const View& view, raster::SampleOffset offset) {
    const MeshScene scene(mesh);
    const WindowPass pass(view, {{0, 0, view.width, view.height}, offset});
    raster::Geometry geometry;
    transform(scene.scene, {0}, pass.view.pinhole, 0, pass.view.viewport, 1, geometry.triangles.objects);
    geometry.triangles.scene = &scene.scene;
    // Two samples per pixel, at one offset, keep the assembly from resolving small triangles itself.
    const raster::AssemblyPlan plan{pass.view.viewport, pass.grid, {offset, offset}, without_culling().skips, false};
    geometry.triangles.runs = {{0, 0, static_cast<std::uint32_t>(mesh.triangles.size()), 0, false}};
    raster::Batch batch;
    raster::Assembler().assemble(plan, geometry.triangles, geometry.triangles.runs[0], false, batch);
    SetupTriangles setup;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
        setup.source_triangles.push_back(geometry.triangles.unclipped(i));
    setup.triangles = batch.triangles;
    return setup;
}

std::unique_ptr<raster::DepthTile> draw(const SetupTriangles& setup, const std::vector<raster::DrawTriangle>& triangles,
                                        const View& view, const Window& window) {
    auto tile = std::make_unique<raster::DepthTile>();
    tile->reset(window.rect, window.offset, raster::viewport_of(view, CameraModel(view).pinhole()));
    for (const raster::DrawTriangle& setup_triangle : triangles) tile->draw(setup_triangle, setup);
    return tile;
}

raster::HitTile draw(const Mesh& mesh, const View& view, const Window& window) {
    const MeshScene scene(mesh);
    const WindowPass pass(view, window);
    raster::Geometry geometry;
    process_geometry(scene.data, pass.grid, pass.view, without_culling(), geometry);
    raster::DepthTile tile;
    rasterize_tile(geometry, pass.view, window.offset, window.rect, 0, tile);
    return {tile, geometry, pass.view};
}

} // namespace duet::compare
