#include "common/scene/read_objects.h"

#include "common/scene/load_obj.h"
#include "common/scene/scene_node.h"
#include "common/system/error.h"

#include <algorithm>
#include <unordered_map>

namespace duet {

namespace {

using GroupIndex = std::unordered_map<std::string, const SceneNode*>;

[[noreturn]] void fail_at(const Scene& scene, const SceneNode& node, const std::string& what) {
    throw Error(message(scene.path.string(), ": ", node.path, ": ", what));
}

void index_groups(const Scene& scene, const std::vector<SceneNode>& nodes, GroupIndex& groups) {
    for (const SceneNode& node : nodes) {
        if (node.shape || !node.instance_of.empty()) continue;
        if (node.named) {
            const auto [entry, added] = groups.try_emplace(node.name, &node);
            if (!added)
                fail_at(scene, node,
                        "a second group of the name " + in_quotes(node.name) + "; the first is " + entry->second->path);
        }
        index_groups(scene, node.members, groups);
    }
}

const SceneNode& group_of(const Scene& scene, const SceneNode& instance, const GroupIndex& groups) {
    const auto found = groups.find(instance.instance_of);
    if (found != groups.end()) return *found->second;
    std::vector<std::string_view> known;
    for (const auto& entry : groups) known.push_back(entry.first);
    std::sort(known.begin(), known.end());
    fail_at(scene, instance,
            "an instance of the unknown group " + in_quotes(instance.instance_of) +
                suggestion(instance.instance_of, known));
}

/// Checks that no group holds itself and that nothing is nested too deep, over all groups, shown or not.
class NestingCheck {
public:
    NestingCheck(const Scene& scene, const GroupIndex& groups) : scene_(&scene), groups_(&groups) {}

    /// The height of the tree under a node; `depth` nodes are above it.
    std::size_t height(const SceneNode& node, std::size_t depth) {
        if (node.shape) return 0;
        if (depth > kMaxGroupDepth) fail_depth(node);
        const auto [entry, added] = height_.try_emplace(&node, kOpen);
        if (!added && entry->second == kOpen)
            fail_at(*scene_, node, "the group " + in_quotes(node.name) + " is part of itself");
        if (!added) {
            if (depth + entry->second > kMaxGroupDepth) fail_depth(node);
            return entry->second;
        }
        std::size_t result = 0;
        if (!node.instance_of.empty()) result = 1 + height(group_of(*scene_, node, *groups_), depth + 1);
        for (const SceneNode& member : node.members) result = std::max(result, 1 + height(member, depth + 1));
        return height_[&node] = result;
    }

private:
    [[noreturn]] void fail_depth(const SceneNode& node) const {
        fail_at(*scene_, node, message("groups and instances are nested more than ", kMaxGroupDepth, " deep"));
    }

    static constexpr std::size_t kOpen = ~std::size_t{0};
    const Scene* scene_;
    const GroupIndex* groups_;
    std::unordered_map<const SceneNode*, std::size_t> height_;
};

/// Walks the tree and appends an Object for each shape it comes by.
class Flattener {
public:
    Flattener(const GroupIndex& groups, Scene& scene) : groups_(&groups), scene_(&scene) {}

    void visit(const SceneNode& node, const MotionTransform& parent, const std::string& prefix, bool definition) {
        // Counts groups, too: sixty nested groups of two empty instances each would otherwise take forever and yield
        // nothing.
        if (++visited_ > kMaxObjects)
            fail_at(*scene_, node, message("groups and instances expand to more than ", kMaxObjects, " objects"));
        if (node.hidden && !definition) return;
        const MotionTransform motion = parent * node.motion;
        const std::string name = prefix + node.name;
        if (node.shape) {
            place(node, motion, name);
        } else if (!node.instance_of.empty()) {
            show_group(group_of(*scene_, node, *groups_), motion, name);
        } else {
            for (const SceneNode& member : node.members) visit(member, motion, name + "/", false);
        }
    }

private:
    /// An instance stands for the group with the group's own transform; its members carry the instance's name.
    void show_group(const SceneNode& group, const MotionTransform& motion, const std::string& name) {
        for (const SceneNode& member : group.members) visit(member, motion * group.motion, name + "/", false);
    }

    void place(const SceneNode& node, const MotionTransform& motion, const std::string& name) {
        if (const char* fault = placement_fault(motion))
            fail_at(*scene_, node, std::string("together with the transforms around it, ") + fault);
        Object object;
        object.name = name;
        object.shape = *node.shape;
        object.materials = node.materials;
        object.to_world = Mat4(motion.start);
        object.to_world_end = Mat4(motion.end);
        // The inverse of the rounded matrix: of what the pipelines apply.
        object.to_object = Mat4(inverse_affine(Mat4d(object.to_world)));
        object.moving = !(object.to_world == object.to_world_end);
        object.identity = !object.moving && object.to_world == Mat4();
        scene_->objects.push_back(std::move(object));
    }

    const GroupIndex* groups_;
    Scene* scene_;
    std::size_t visited_ = 0;
};

} // namespace

void read_objects(const JsonValue& objects, const NameIndex& materials, ImageCache& images, Scene& scene) {
    const std::vector<SceneNode> nodes = SceneNodeReader(materials, images, scene).read(objects);
    GroupIndex groups;
    index_groups(scene, nodes, groups);
    NestingCheck nesting(scene, groups);
    for (const SceneNode& node : nodes) nesting.height(node, 0);
    Flattener flattener(groups, scene);
    for (const SceneNode& node : nodes) flattener.visit(node, {}, "", false);
}

std::vector<std::uint32_t> add_obj_materials(const std::filesystem::path& file, const ObjFile& obj, ImageCache& images,
                                             Scene& scene) {
    std::vector<std::int32_t> textures;
    for (const ObjTexture& texture : obj.textures) {
        textures.push_back(static_cast<std::int32_t>(scene.textures.textures.size()));
        scene.textures.textures.push_back(ImageTexture{images.load(texture.file), texture.scale, true});
    }
    const auto map_slot = [&](RgbSlot& slot) {
        if (slot.texture >= 0) slot.texture = textures[static_cast<std::size_t>(slot.texture)];
    };
    std::vector<std::uint32_t> indices;
    for (const ObjMaterial& entry : obj.materials) {
        Material material = entry.material;
        if (auto* diffuse = std::get_if<Diffuse>(&material)) map_slot(diffuse->albedo);
        if (auto* metal = std::get_if<Metal>(&material)) map_slot(metal->reflectance);
        if (auto* glass = std::get_if<Dielectric>(&material)) map_slot(glass->tint);
        if (auto* lamp = std::get_if<Emissive>(&material)) map_slot(lamp->albedo);
        indices.push_back(static_cast<std::uint32_t>(scene.materials.size()));
        scene.materials.push_back(material);
        scene.material_names.push_back(file.stem().string() + ":" + (entry.name.empty() ? "default" : entry.name));
    }
    return indices;
}

} // namespace duet
