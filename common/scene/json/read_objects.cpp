#include "common/scene/json/read_objects.h"

#include "common/scene/json/scene_node.h"
#include "common/system/error.h"
#include "common/system/suggestion.h"

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
                        "a second group of the name " + quoted_text(node.name) + "; the first is " +
                            entry->second->path);
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
            "an instance of the unknown group " + quoted_text(instance.instance_of) +
                suggestion(instance.instance_of, known));
}

/// An ExtentCheck checks that no group contains itself, and that no group, visible or not, is nested too deep or
/// expands to too many objects. Each node is visited only once: thirty groups of two instances of the next group are
/// a billion objects, but take few steps here.
class ExtentCheck {
public:
    ExtentCheck(const Scene& scene, const GroupIndex& groups) : scene_(&scene), groups_(&groups) {}

    /// An Extent is the size of the tree under a node, including the node. `depth` in check is the number of nodes
    /// above it.
    struct Extent {
        std::size_t height = 0, nodes = 1;
        bool in_progress = false; ///< whether the extent is still being computed
    };
    Extent check(const SceneNode& node, std::size_t depth) {
        if (node.shape) return {};
        if (depth > kMaxGroupDepth) fail_depth(node);
        const auto [entry, added] = extents_.try_emplace(&node, Extent{0, 1, true});
        if (!added && entry->second.in_progress)
            fail_at(*scene_, node, "the group " + quoted_text(node.name) + " is part of itself");
        if (!added) {
            if (depth + entry->second.height > kMaxGroupDepth) fail_depth(node);
            return entry->second;
        }
        Extent extent;
        const auto add = [&](const Extent& child) {
            extent.height = std::max(extent.height, 1 + child.height);
            extent.nodes += child.nodes;
            if (extent.nodes > kMaxObjects)
                fail_at(*scene_, node, message("groups and instances expand to more than ", kMaxObjects, " objects"));
        };
        if (!node.instance_of.empty()) add(check(group_of(*scene_, node, *groups_), depth + 1));
        for (const SceneNode& member : node.members) add(check(member, depth + 1));
        return extents_[&node] = extent;
    }

private:
    [[noreturn]] void fail_depth(const SceneNode& node) const {
        fail_at(*scene_, node, message("groups and instances are nested more than ", kMaxGroupDepth, " deep"));
    }

    const Scene* scene_;
    const GroupIndex* groups_;
    std::unordered_map<const SceneNode*, Extent> extents_;
};

/// A Flattener traverses the tree and appends an Object for each shape.
class Flattener {
public:
    Flattener(const GroupIndex& groups, Scene& scene) : groups_(&groups), scene_(&scene) {}

    /// Appends the objects of an element of the file's "objects".
    void visit_entry(const SceneNode& node, std::size_t entry) {
        entry_ = static_cast<std::uint32_t>(entry);
        visit(node, {}, "");
    }

private:
    void visit(const SceneNode& node, const MotionTransform& parent, const std::string& prefix) {
        if (node.hidden) return;
        const MotionTransform motion = parent * node.motion;
        const std::string name = prefix + node.name;
        if (node.shape) {
            add_object(node, motion, name);
        } else if (!node.instance_of.empty()) {
            add_instance_members(group_of(*scene_, node, *groups_), motion, name);
        } else {
            for (const SceneNode& member : node.members) visit(member, motion, name + "/");
        }
    }

    /// Adds the members of an instanced group. The group's own transform applies, and the names of the members start
    /// with the instance's name.
    void add_instance_members(const SceneNode& group, const MotionTransform& motion, const std::string& name) {
        for (const SceneNode& member : group.members) visit(member, motion * group.motion, name + "/");
    }

    void add_object(const SceneNode& node, const MotionTransform& motion, const std::string& name) {
        if (const char* error = transform_error(motion))
            fail_at(*scene_, node, std::string("together with the transforms around it, ") + error);
        Object object;
        object.name = name;
        object.shape = *node.shape;
        object.entry = entry_;
        object.materials = node.materials;
        object.place(Mat4(motion.start), Mat4(motion.end));
        scene_->objects.push_back(std::move(object));
    }

    const GroupIndex* groups_;
    Scene* scene_;
    std::uint32_t entry_ = 0;
};

} // namespace

void read_objects(const JsonValue& objects, const NameIndex& materials, ImageCache& images, Scene& scene) {
    const std::vector<SceneNode> nodes = SceneNodeReader(materials, images, scene).read(objects);
    GroupIndex groups;
    index_groups(scene, nodes, groups);
    ExtentCheck extents(scene, groups);
    std::size_t total = 0;
    for (const SceneNode& node : nodes) {
        total += extents.check(node, 0).nodes;
        if (total > kMaxObjects)
            fail_at(scene, node, message("from here on there are more than ", kMaxObjects, " objects"));
    }
    Flattener flattener(groups, scene);
    for (std::size_t i = 0; i < nodes.size(); ++i) flattener.visit_entry(nodes[i], i);
}

} // namespace duet
