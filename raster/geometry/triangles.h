// Gives access to the triangles of a pass by id. A tile stores for each sample the id of the visible triangle.
#pragma once

#include "raster/geometry/setup.h"
#include "raster/raster_scene.h"

#include "common/scene/scene.h"

#include <vector>

namespace duet::raster {

/// This id stands for no triangle.
inline constexpr std::uint32_t kNoTriangle = 0x7fffffff;

/// Represents a range of an object's triangles with consecutive ids, the unit of parallel work. A quad's two halves
/// are two triangles. A sphere is a run of one.
struct Run {
    std::uint32_t object = 0; ///< index into Triangles::objects; of a sphere: index into the list of spheres
    std::uint32_t first = 0;  ///< index of the first triangle in the object
    std::uint32_t count = 0;
    std::uint32_t first_id = 0; ///< id of the first triangle
    bool sphere = false;
};

/// Gives access to the corners of a shape's triangles. The halves of a quad are (corner, +u, +u+v) and
/// (corner, +u+v, +v).
class ShapeTriangles {
public:
    ShapeTriangles() = default;
    explicit ShapeTriangles(const Shape& shape) : shape_(&shape), mesh_(std::get_if<Mesh>(&shape)) {}

    const Mesh* mesh() const { return mesh_; } ///< null for quads
    /// Returns the corners as indices into TransformedObject::vertices.
    std::array<std::uint32_t, 3> vertices(std::uint32_t triangle) const {
        if (mesh_ != nullptr) return mesh_->triangles[triangle];
        const std::uint32_t quad = triangle / 2 * 4, half = triangle % 2;
        return {quad, quad + 1 + half, quad + 2 + half};
    }
    /// Returns the corners in object space.
    std::array<Vec3, 3> corners(std::uint32_t triangle) const {
        if (mesh_ != nullptr) {
            const auto& corner = mesh_->triangles[triangle];
            return {mesh_->positions[corner[0]], mesh_->positions[corner[1]], mesh_->positions[corner[2]]};
        }
        const PrimitiveVertices four = primitive_vertices(*shape_, triangle / 2);
        const std::size_t half = triangle % 2;
        return {four.p[0], four.p[1 + half], four.p[2 + half]};
    }
    UnclippedTriangle unclipped(const TransformedObject& object, std::uint32_t triangle) const {
        const std::array<Vec3, 3> p = corners(triangle);
        const TriangleKind half = triangle % 2 == 0 ? TriangleKind::kQuadFirst : TriangleKind::kQuadSecond;
        return {pixel_vertex(object, p[0]), pixel_vertex(object, p[1]), pixel_vertex(object, p[2]),
                mesh_ != nullptr ? TriangleKind::kTriangle : half};
    }

private:
    const Shape* shape_ = nullptr;
    const Mesh* mesh_ = nullptr;
};

/// Gives access to the unclipped, unsnapped triangles by id.
class UnclippedTriangles {
public:
    virtual ~UnclippedTriangles() = default;
    /// Returns the triangle of an id.
    virtual UnclippedTriangle unclipped(std::uint32_t id) const = 0;
};

/// Gives access to the triangles of a pass. Ids are in the order of (object, primitive), so that the lower id wins a
/// depth tie.
struct Triangles : UnclippedTriangles {
    const RasterSceneData* prepared = nullptr;
    const Scene* scene = nullptr;           ///< RasterSceneData::scene
    std::vector<TransformedObject> objects; ///< meshes and quads
    std::vector<Run> runs;

    /// Returns the run that contains `id`. `hint` is tested first.
    const Run& run_of(std::uint32_t id, const Run& hint) const;
    const Run& run_of(std::uint32_t id) const { return run_of(id, runs.front()); }
    const Shape& shape(const Run& run) const { return scene->shapes[scene->objects[objects[run.object].object].shape]; }
    const PackedShape& packed(const Run& run) const {
        return prepared->shapes[scene->objects[objects[run.object].object].shape];
    }

    /// Returns the triangle with this index in the run's object. Indices count the object's triangles, like Run::first.
    UnclippedTriangle unclipped(const Run& run, std::uint32_t index) const {
        return ShapeTriangles(shape(run)).unclipped(objects[run.object], index);
    }
    UnclippedTriangle unclipped(std::uint32_t id) const override {
        const Run& run = run_of(id);
        return unclipped(run, index(run, id));
    }
    /// Stores the half-open range of the ids of an object's triangles.
    struct IdRange {
        std::uint32_t first, end;
    };
    IdRange ids_of_object(const Run& run) const {
        const std::uint32_t first = run.first_id - run.first;
        return {first, first + (run.sphere ? 1 : static_cast<std::uint32_t>(packed(run).triangles.size()))};
    }
    static std::uint32_t index(const Run& run, std::uint32_t id) { return run.first + id - run.first_id; }
};

} // namespace duet::raster
