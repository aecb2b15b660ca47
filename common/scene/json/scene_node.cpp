#include "common/scene/json/scene_node.h"

#include "common/scene/file_cache.h"
#include "common/scene/json/read_media.h"
#include "common/scene/json/scene_keys.h"
#include "common/scene/obj/add_obj_materials.h"
#include "common/system/error.h"

namespace duet {

namespace {

const std::vector<std::string_view>& node_types() {
    static const std::vector<std::string_view> types{"quad", "sphere", "box", "mesh", "group", "instance"};
    return types;
}

Shape read_quad(const JsonValue& value) {
    const Quad quad{Vec3(value.at("corner").vec3()), Vec3(value.at("u").vec3()), Vec3(value.at("v").vec3())};
    const Vec3d u(quad.u), v(quad.v);
    const double lengths = length(u) * length(v);
    if (!(lengths > 0) || !(length(cross(u, v)) > 1e-6 * lengths))
        value.fail("the quad's \"u\" and \"v\" span no area");
    return QuadList{{quad}};
}

Shape read_box(const JsonValue& value) {
    const Box3 box{Vec3(value.at("low").vec3()), Vec3(value.at("high").vec3())};
    check_corners(value, box);
    return box_quads(box.low, box.high);
}

/// Holds a mesh file. Its mesh is a shape, which scenes share.
struct MeshFile {
    ObjFile obj; ///< without the mesh
    std::shared_ptr<const Shape> shape;
};

MeshFile with_shape(ObjFile obj) {
    auto shape = std::make_shared<Shape>(std::exchange(obj.mesh, {}));
    return {std::move(obj), std::move(shape)};
}

MeshFile read_mesh_file(const std::filesystem::path& file, const ObjOptions& options, FileCache* cache) {
    if (!cache) return with_shape(load_obj(file, options));
    const std::string key = message("mesh ", canonical_key(file), '\n', static_cast<int>(options.normals), ' ',
                                    options.materials);
    return *cache->get<MeshFile>(key, [&] {
        ObjFile obj = load_obj(file, options);
        obj.mesh.closed = is_closed_outwards(obj.mesh); // here, because a scene cannot change a shape that others share
        std::vector<std::filesystem::path> files = obj.files;
        return FileCache::Read<MeshFile>{with_shape(std::move(obj)), std::move(files)};
    });
}

} // namespace

std::vector<SceneNode> SceneNodeReader::read(const JsonValue& objects, std::size_t depth) {
    if (depth > kMaxGroupDepth) objects.fail(message("groups are nested more than ", kMaxGroupDepth, " deep"));
    std::vector<SceneNode> nodes;
    for (const JsonValue& value : objects.elements()) {
        nodes.push_back(read_node(value, depth));
        if (nodes.back().name.empty()) nodes.back().name = message(value.at("type").string(), "-", nodes.size() - 1);
    }
    return nodes;
}

SceneNode SceneNodeReader::read_node(const JsonValue& value, std::size_t depth) {
    const std::size_t type = value.at("type").one_of(node_types());
    value.check_keys(scene_keys(node_types()[type]));
    SceneNode node;
    node.path = value.path();
    node.named = value.has("name");
    if (node.named) node.name = value.at("name").string();
    node.motion = read_motion(value);
    switch (type) {
    case 0:
        set_shape(node, read_quad(value), value);
        break;
    case 1:
        set_shape(node,
                  Sphere{Vec3(value.at("center").vec3()), static_cast<float>(value.at("radius").number(kPositive))},
                  value);
        break;
    case 2:
        set_shape(node, read_box(value), value);
        break;
    case 3:
        read_mesh(value, node);
        break;
    case 4:
        node.hidden = value.boolean_or("hidden", false);
        if (node.hidden && !node.named) value.fail("a hidden group needs a \"name\", or no instance can show it");
        node.members = read(value.at("objects"), depth + 1);
        break;
    default:
        node.instance_of = value.at("of").string();
        if (node.name.empty()) node.name = node.instance_of;
    }
    return node;
}

void SceneNodeReader::set_shape(SceneNode& node, Shape shape, const JsonValue& value) {
    node.shape = static_cast<std::uint32_t>(scene_->shapes.size());
    node.materials = {look_up(value.at("material"), *materials_, "material")};
    scene_->shapes.push_back(std::move(shape));
}

void SceneNodeReader::read_mesh(const JsonValue& value, SceneNode& node) {
    const bool own_material = value.has("material");
    const LoadedMesh& mesh = load_mesh(value, own_material);
    node.shape = mesh.shape;
    node.materials = mesh.materials;
    if (own_material) node.materials.assign(mesh.slots, look_up(value.at("material"), *materials_, "material"));
}

const SceneNodeReader::LoadedMesh& SceneNodeReader::load_mesh(const JsonValue& value, bool own_material) {
    constexpr const char* kHowToGenerate =
        "; the build targets \"models\" and \"gallery-models\" generate this folder's files";
    constexpr MeshNormals kKinds[] = {MeshNormals::kFile, MeshNormals::kFlat, MeshNormals::kSmooth};
    const std::size_t kind = value.has("normals") ? value.at("normals").one_of({"file", "flat", "smooth"}) : 0;
    const std::filesystem::path file = resolve_path(value.file(), value.at("file").string());
    const auto key = std::tuple(canonical_key(file), static_cast<int>(kind), own_material);
    const auto found = meshes_.find(key);
    if (found != meshes_.end()) return found->second;
    try {
        const auto [obj, shape] = read_mesh_file(file, {kKinds[kind], !own_material}, images_->files());
        scene_->files.insert(scene_->files.end(), obj.files.begin(), obj.files.end());
        LoadedMesh mesh{static_cast<std::uint32_t>(scene_->shapes.size()), {}, obj.materials.size()};
        if (!own_material) mesh.materials = add_obj_materials(file, obj, *images_, *scene_);
        scene_->shapes.push_back(shape);
        return meshes_.emplace(key, std::move(mesh)).first->second;
    } catch (const Error& error) {
        // The meshes of models/generated/ are not part of the repository.
        const bool generated = file.parent_path().filename() == "generated" && !std::filesystem::exists(file);
        value.at("file").fail(error.what() + std::string(generated ? kHowToGenerate : ""));
    }
}

} // namespace duet
