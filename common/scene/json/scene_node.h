// This file defines the tree of objects as a scene file describes it, before groups and instances are flattened.
#pragma once

#include "common/scene/json/json_reader.h"
#include "common/scene/json/read_materials.h"
#include "common/scene/json/read_transform.h"
#include "common/scene/scene.h"

#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace duet {

/// Groups and instances may be nested at most this deep.
inline constexpr std::size_t kMaxGroupDepth = 64;

/// A SceneNode is one entry of "objects": a shape with its materials, a group of members, or an instance of a group.
struct SceneNode {
    std::string name;   ///< name in the file, or a generated one such as "sphere-3"
    bool named = false; ///< whether the file gives a name; instances can refer to named groups
    std::string path;   ///< JSON path, for messages
    MotionTransform motion;
    bool hidden = false;                  ///< whether the group only serves as a definition for instances
    std::optional<std::uint32_t> shape;   ///< index into Scene::shapes
    std::vector<std::uint32_t> materials; ///< materials of a shape, one per slot
    std::vector<SceneNode> members;       ///< members of a group
    std::string instance_of;              ///< name of the group that is instanced
};

/// A SceneNodeReader reads nodes, and adds their shapes and the materials of meshes to the scene. A mesh file is read
/// once for each value of "normals".
class SceneNodeReader {
public:
    SceneNodeReader(const NameIndex& materials, ImageCache& images, Scene& scene)
        : materials_(&materials), images_(&images), scene_(&scene) {}

    /// Returns the nodes of an "objects" array. `depth` is the number of groups around it.
    std::vector<SceneNode> read(const JsonValue& objects, std::size_t depth = 0);

private:
    struct LoadedMesh {
        std::uint32_t shape;
        std::vector<std::uint32_t> materials; ///< materials of its MTL file, one per slot
        std::size_t slots;
    };

    SceneNode read_node(const JsonValue& value, std::size_t depth);
    void read_mesh(const JsonValue& value, SceneNode& node);
    const LoadedMesh& load_mesh(const JsonValue& value, bool own_material);
    void set_shape(SceneNode& node, Shape shape, const JsonValue& value);

    const NameIndex* materials_;
    ImageCache* images_;
    Scene* scene_;
    std::map<std::tuple<std::string, int, bool>, LoadedMesh> meshes_;
};

} // namespace duet
