// The triangles of a pass by number: what a tile keeps of the one that a sample sees.
#pragma once

#include "raster/geometry/setup.h"
#include "raster/prepare.h"

#include "common/scene/scene.h"

#include <vector>

namespace duet::raster {

/// No triangle.
inline constexpr std::uint32_t kNoTriangle = 0x7fffffff;

/// Some of an object's triangles, with numbers one after the other: the unit of parallel work. A quad's two halves are
/// triangles; a sphere is a run of one.
struct Run {
    std::uint32_t object = 0; ///< index into Triangles::objects; of a sphere: into its list
    std::uint32_t first = 0;  ///< triangle of the object
    std::uint32_t count = 0;
    std::uint32_t first_id = 0; ///< number of that triangle
    bool sphere = false;
};

/// The triangles of which outlines are drawn.
class WholeTriangles {
public:
    virtual ~WholeTriangles() = default;
    virtual WholeTriangle whole(std::uint32_t id) const = 0;
};

/// Numbers are in the order of (object, primitive), so that the lower number is the one that wins a tie.
struct Triangles : WholeTriangles {
    const PreparedData* prepared = nullptr;
    const Scene* scene = nullptr; ///< PreparedData::scene
    std::vector<TransformedObject> objects; ///< of triangles and quads
    std::vector<Run> runs;

    /// The run that holds a number; `hint` is one to try first.
    const Run& run_of(std::uint32_t id, const Run& hint) const;
    const Run& run_of(std::uint32_t id) const { return run_of(id, runs.front()); }
    const Shape& shape(const Run& run) const { return scene->shapes[scene->objects[objects[run.object].object].shape]; }
    const PackedShape& packed(const Run& run) const { return prepared->shapes[scene->objects[objects[run.object].object].shape]; }

    /// `index`: of the object's triangles, as Run::first counts them.
    WholeTriangle whole(const Run& run, std::uint32_t index) const;
    WholeTriangle whole(std::uint32_t id) const override {
        const Run& run = run_of(id);
        return whole(run, run.first + id - run.first_id);
    }
    /// Numbers of all that a run's object is of.
    struct Numbers {
        std::uint32_t first, end;
    };
    Numbers of_object(const Run& run) const {
        const std::uint32_t first = run.first_id - run.first;
        return {first, first + (run.sphere ? 1 : static_cast<std::uint32_t>(packed(run).triangles.size()))};
    }
    static std::uint32_t index(const Run& run, std::uint32_t id) { return run.first + id - run.first_id; }
};

} // namespace duet::raster
