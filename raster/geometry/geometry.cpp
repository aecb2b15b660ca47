#include "raster/geometry/geometry.h"

#include "common/system/error.h"
#include "common/system/parallel.h"
#include "common/system/stopwatch.h"

#include <algorithm>

namespace duet::raster {
namespace {

/// The first two constants bound the number of triangles per run; the third is the target number of runs. There must
/// be enough runs to balance the load between threads, and enough triangles per run to make its overhead negligible.
constexpr std::uint32_t kMaxRun = 8192, kMinRun = 512, kTargetRuns = 16;

/// Returns the runs of the objects' triangles and of the spheres, in the order of objects, and assigns the spheres'
/// ids.
std::vector<Run> assign_ids(const Scene& scene, const std::vector<std::uint32_t>& polygonal,
                            std::vector<DrawSphere>& spheres) {
    const auto triangles = [&](std::uint32_t object) {
        const Shape& shape = scene.shapes[scene.objects[object].shape];
        return primitive_count(shape) * (std::holds_alternative<Mesh>(shape) ? 1 : 2);
    };
    std::uint64_t all = 0;
    for (const std::uint32_t object : polygonal) all += triangles(object);
    const auto run = static_cast<std::uint32_t>(std::clamp<std::uint64_t>(all / kTargetRuns, kMinRun, kMaxRun));
    std::vector<Run> runs;
    std::uint64_t id = 0;
    std::size_t sphere = 0;
    const auto add_spheres = [&](std::uint32_t before) {
        for (; sphere < spheres.size() && spheres[sphere].object < before; ++sphere) {
            spheres[sphere].id = static_cast<std::uint32_t>(id);
            runs.push_back({static_cast<std::uint32_t>(sphere), 0, 1, static_cast<std::uint32_t>(id++), true});
        }
    };
    for (std::uint32_t slot = 0; slot < polygonal.size(); ++slot) {
        add_spheres(polygonal[slot]);
        const std::uint32_t count = triangles(polygonal[slot]);
        for (std::uint32_t first = 0; first < count; first += run) {
            runs.push_back({slot, first, std::min(run, count - first), static_cast<std::uint32_t>(id), false});
            id += runs.back().count;
        }
        if (id >= kNoTriangle) throw Error("more than 2^31 triangles in view");
    }
    add_spheres(kNoObject);
    return runs;
}

void assemble(const RasterSceneData& data, const AssemblyPlan& plan, int threads, Geometry& geometry) {
    const Triangles& triangles = geometry.triangles;
    geometry.batches.resize(triangles.runs.size());
    parallel_for(triangles.runs.size(), threads, [&](std::size_t i) {
        const Run& run = triangles.runs[i];
        geometry.batches[i].clear();
        if (run.sphere) return;
        const TransformedObject& object = triangles.objects[run.object];
        const bool cull = plan.front_faces_only ||
                          (plan.skips.back_faces && may_cull_backfaces(object, data.objects[object.object].solid));
        geometry.assemblers.take()->assemble(plan, triangles, run, cull, geometry.batches[i]);
    });
    for (const Batch& batch : geometry.batches) geometry.culled += batch.culled;
}

} // namespace

PassView center_view(const View& view) {
    static const std::vector<SampleOffset> samples{SampleOffset{}};
    const Pinhole pinhole = CameraModel(view).pinhole();
    return {.pinhole = pinhole,
            .time = static_cast<float>(view.camera.shutter_open),
            .viewport = viewport_of(view, pinhole),
            .samples = samples};
}

Geometry::Primitive Geometry::primitive(const Run& run, std::uint32_t id) const {
    if (run.sphere) return {spheres[run.object].object, 0};
    const std::uint32_t index = Triangles::index(run, id);
    const bool quads = std::holds_alternative<QuadList>(triangles.shape(run));
    return {triangles.objects[run.object].object, quads ? index / 2 : index};
}

std::size_t Geometry::memory_bytes() const {
    std::size_t bytes = spheres.size() * sizeof(DrawSphere) + sphere_bins.memory_bytes() +
                        triangle_lists.memory_bytes() + mask_lists.memory_bytes() + fragment_lists.memory_bytes() +
                        triangles.runs.size() * sizeof(Run);
    for (const TransformedObject& object : triangles.objects)
        bytes += object.vertices.size() * sizeof(SnappedVertex);
    for (const Batch& batch : batches) bytes += batch.memory_bytes();
    return bytes;
}

namespace {

using Objects = std::vector<std::uint32_t>;

void process(const RasterSceneData& data, const Objects& all_polygonal, const Objects& all_spheres,
             const TileGrid& grid, const PassView& view, const RasterSettings& settings, bool coverage_masks,
             const ObjectFilter& includes, Geometry& result) {
    Stopwatch watch;
    result.culled = {};
    const auto visible = [&](const Objects& objects) {
        Objects found;
        for (const std::uint32_t object : objects) {
            if (includes && !includes(object)) continue;
            if (settings.skips.frustum && outside_frustum(data.objects[object].bounds, view.pinhole, view.viewport))
                result.culled.outside += primitive_count(data.scene.shapes[data.scene.objects[object].shape]);
            else
                found.push_back(object);
        }
        return found;
    };
    const Objects polygonal = visible(all_polygonal);
    result.triangles.prepared = &data;
    result.triangles.scene = &data.scene;
    transform(data.scene, polygonal, view.pinhole, view.time, view.viewport, settings.threads,
              result.triangles.objects);
    result.transform_seconds = watch.lap();

    result.spheres = set_up_spheres(data.scene, visible(all_spheres), view.pinhole, view.time, view.viewport);
    result.triangles.runs = assign_ids(data.scene, polygonal, result.spheres);
    assemble(data,
             {view.viewport, grid, view.samples, settings.skips, settings.front_faces_only, coverage_masks},
             settings.threads, result);
    result.setup_seconds = watch.lap();

    result.triangle_lists.gather(result.batches, &Batch::triangle_segments, grid.size());
    result.mask_lists.gather(result.batches, &Batch::mask_segments, grid.size());
    result.fragment_lists.gather(result.batches, &Batch::fragment_segments, grid.size());
    result.sphere_bins.assign(grid.size(), [&](const auto& put) {
        for (std::uint32_t i = 0; i < result.spheres.size(); ++i)
            grid.for_each(result.spheres[i].bounds, [&](std::size_t tile) { put(tile, i); });
    });
    result.bin_seconds = watch.lap();
}

} // namespace

void process_geometry(const RasterSceneData& data, const TileGrid& grid, const PassView& view,
                      const RasterSettings& settings, Geometry& result, const ObjectFilter& includes) {
    process(data, data.polygonal, data.spheres, grid, view, settings, true, includes, result);
}

void process_layers(const RasterSceneData& data, const TileGrid& grid, const PassView& view,
                    const RasterSettings& settings, Geometry& result, const ObjectFilter& includes) {
    process(data, data.alpha_polygonal, data.alpha_spheres, grid, view, settings, false, includes, result);
}

} // namespace duet::raster
