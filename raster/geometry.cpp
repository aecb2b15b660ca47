#include "raster/geometry.h"

#include "common/system/stopwatch.h"

namespace duet::raster {
namespace {

/// The objects whose bounds touch the frustum; the others' primitives are counted.
std::vector<std::uint32_t> in_frustum(const PreparedData& data, const std::vector<std::uint32_t>& objects,
                                      const PassView& view, CullCounts& culled) {
    std::vector<std::uint32_t> result;
    for (const std::uint32_t object : objects) {
        if (outside_frustum(data.objects[object].bounds, view.pinhole, view.viewport))
            culled.outside += primitive_count(data.scene.shapes[data.scene.objects[object].shape]);
        else
            result.push_back(object);
    }
    return result;
}

std::size_t memory_of(const std::vector<TransformedObject>& objects) {
    std::size_t vertices = 0;
    for (const TransformedObject& object : objects) vertices += object.vertices.size();
    return vertices * (sizeof(PixelVertex) + sizeof(FixedPoint) + sizeof(std::uint8_t));
}

} // namespace

Geometry process_geometry(const PreparedData& data, const TileGrid& grid, const PassView& view,
                          const Settings& settings) {
    Stopwatch watch;
    CullCounts culled;
    const auto visible = [&](const std::vector<std::uint32_t>& objects) {
        return settings.skips.frustum ? in_frustum(data, objects, view, culled) : objects;
    };
    const std::vector<TransformedObject> objects =
        transform(data.scene, visible(data.polygonal), view.pinhole, view.time, view.viewport, settings.threads);
    const double transform_seconds = watch.lap();

    DrawList list = assemble(data, objects, view.viewport, view.samples, settings.skips, settings.threads);
    std::vector<DrawSphere> spheres =
        set_up_spheres(data.scene, visible(data.spheres), view.pinhole, view.time, view.viewport);
    list.culled += culled;
    const double setup_seconds = watch.lap();

    Bins triangle_bins = bin(grid, list.triangles, view.samples), sphere_bins = bin(grid, spheres);
    const std::size_t bytes = memory_of(objects) + list.triangles.size() * sizeof(SetupTriangle) +
                              spheres.size() * sizeof(DrawSphere) + triangle_bins.memory_bytes() +
                              sphere_bins.memory_bytes();
    return {.list = std::move(list),
            .spheres = std::move(spheres),
            .triangle_bins = std::move(triangle_bins),
            .sphere_bins = std::move(sphere_bins),
            .transform_seconds = transform_seconds,
            .setup_seconds = setup_seconds,
            .bin_seconds = watch.lap(),
            .memory_bytes = bytes};
}

} // namespace duet::raster
