#include "compare/stress/drawing.h"

#include "raster/assemble.h"

namespace duet::compare {

using raster::PixelVertex, raster::SetupTriangle;

CoverageProbe::CoverageProbe(const Window& window)
    : tile_(window.rect, CameraModel({Camera{}, raster::kSubPixels, raster::kSubPixels}).through(), window.offset, 0) {}

void CoverageProbe::draw(GridTriangle t) {
    ++count_;
    const int turn = winding(t);
    if (turn == 0) return;
    if (turn < 0) std::swap(t[1], t[2]);
    // Parallel to the picture, so that its depth is the same everywhere; nearer than the one before by 1/count.
    const double depth = 1.0 / count_;
    const auto vertex = [&](raster::FixedPoint p) {
        const double x = static_cast<double>(p.x) / raster::kSubPixels,
                     y = static_cast<double>(p.y) / raster::kSubPixels;
        return PixelVertex{.xw = x * depth, .yw = y * depth, .w = depth, .depth = depth};
    };
    tile_.draw({.corners = t,
                .object = 0,
                .primitive = count_,
                .interpolation = raster::Interpolation(vertex(t[0]), vertex(t[1]), vertex(t[2]), t[0])});
}

bool CoverageProbe::covers(int x, int y) const {
    const Hit& hit = tile_.hit(x, y);
    return hit.valid() && hit.primitive == count_;
}

std::vector<SetupTriangle> set_up(const Mesh& mesh, const View& view, raster::SampleOffset offset) {
    Scene scene;
    scene.shapes = {mesh};
    scene.objects.resize(1);
    const raster::PreparedData data{.scene = scene,
                                    .objects = std::vector<raster::PreparedObject>(1),
                                    .polygonal = {0},
                                    .spheres = {},
                                    .irradiance = raster::Irradiance(scene.environment, 1)};
    const Pinhole pinhole = CameraModel(view).through();
    const raster::Viewport viewport{view.width, view.height, pinhole.near};
    const std::vector<raster::TransformedObject> objects = transform(scene, data.polygonal, pinhole, 0, viewport, 1);
    return assemble(data, objects, viewport, {offset}, {.frustum = false, .back_faces = false}, 1).triangles;
}

raster::HitTile draw(const std::vector<SetupTriangle>& triangles, const View& view, const Window& window) {
    raster::HitTile tile(window.rect, CameraModel(view).through(), window.offset, 0);
    for (const SetupTriangle& triangle : triangles) tile.draw(triangle);
    return tile;
}

} // namespace duet::compare
