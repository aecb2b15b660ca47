#include "common/scene/build_scene.h"

#include "common/system/error.h"
#include "common/system/escape.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace duet {

namespace {

/// Checks the parts of one scene.
class SceneCheck {
public:
    explicit SceneCheck(const Scene& scene) : scene_(scene) {}

    void check() const {
        if (scene_.materials.size() != scene_.material_names.size())
            fail("found ", scene_.material_names.size(), " material names, expected ", scene_.materials.size());
        if (scene_.media.size() > kMaxMedia)
            fail("found ", scene_.media.size(), " media, expected at most ", kMaxMedia);
        for (std::size_t i = 0; i < scene_.materials.size(); ++i) check_material(i);
        for (const Texture& texture : scene_.textures.textures)
            if (const auto* image = std::get_if<ImageTexture>(&texture))
                check_index(image->image, scene_.textures.images.size(), "a texture's image");
        check_objects();
        for (const Light& light : scene_.lights) check_light(light);
        const Camera& camera = scene_.camera;
        if (!(length(camera.look_at - camera.eye) > 0)) fail("the camera's look_at must not be where its eye is");
    }

private:
    template <typename... Parts> [[noreturn]] void fail(const Parts&... parts) const {
        throw Error(message(scene_.path.string(), scene_.path.empty() ? "" : ": ", parts...));
    }
    template <typename... Parts> [[noreturn]] void fail_at(const Object& object, const Parts&... parts) const {
        fail("the object ", quoted_text(object.name), ": ", parts...);
    }
    template <typename Index, typename... What>
    void check_index(Index index, std::size_t count, const What&... what) const {
        if (static_cast<std::size_t>(index) >= count)
            fail(what..., ": found the index ", index, ", expected one below ", count);
    }

    void check_material(std::size_t i) const {
        const auto check = [&](std::int32_t texture) {
            if (texture >= 0)
                check_index(texture, scene_.textures.textures.size(), "a texture of the material ",
                            quoted_text(scene_.material_names[i]));
        };
        for_each_texture(scene_.materials[i], check);
        if (i < scene_.maps.size()) for_each_texture(scene_.maps[i], check);
    }

    /// A shape may have many objects, so it is checked once.
    void check_objects() const {
        std::vector<std::optional<std::size_t>> slots(scene_.shapes.size()); // material slots that each shape needs
        for (const Object& object : scene_.objects) {
            check_index(object.shape, scene_.shapes.size(), "the shape of the object ", object.name);
            auto& needed = slots[object.shape];
            if (!needed) needed = checked_slots(object, scene_.shapes[object.shape]);
            if (object.materials.size() < *needed)
                fail_at(object, "found ", object.materials.size(), " materials, expected at least ", *needed);
            for (const std::uint32_t material : object.materials)
                check_index(material, scene_.materials.size(), "a material of the object ", object.name);
            const bool at_rest = object.to_world == Mat4() && object.to_world_end == Mat4();
            if ((object.identity && !at_rest) || object.moving != !(object.to_world == object.to_world_end))
                fail_at(object, "Object::place() was not called to set its transform");
        }
    }

    /// Checks an object's shape and returns how many material slots it needs, at least 1.
    std::size_t checked_slots(const Object& object, const Shape& shape) const {
        if (const auto* sphere = std::get_if<Sphere>(&shape); sphere != nullptr && !(sphere->radius > 0))
            fail_at(object, "found the radius ", sphere->radius, ", expected one above 0");
        const auto* mesh = std::get_if<Mesh>(&shape);
        if (mesh == nullptr) return 1;
        const std::size_t count = mesh->positions.size();
        const auto check_size = [&](const char* what, std::size_t size, std::size_t expected) {
            if (size != 0 && size != expected) fail_at(object, "found ", size, ' ', what, ", expected 0 or ", expected);
        };
        check_size("normals", mesh->normals.size(), count);
        check_size("texture coordinates", mesh->uvs.size(), count);
        check_size("material slots", mesh->material_slots.size(), mesh->triangles.size());
        const auto finite = [](Vec3 v) { return is_finite(v); };
        if (const auto bad = std::ranges::find_if_not(mesh->positions, finite); bad != mesh->positions.end())
            fail_at(object, "the vertex ", bad - mesh->positions.begin(), " is not finite");
        for (std::size_t i = 0; i < mesh->triangles.size(); ++i)
            for (const std::uint32_t vertex : mesh->triangles[i])
                if (vertex >= count)
                    fail_at(object, "found the vertex ", vertex, " in triangle ", i, ", expected one below ", count);
        const auto& slots = mesh->material_slots;
        return slots.empty() ? 1 : *std::ranges::max_element(slots) + std::size_t{1};
    }

    void check_light(const Light& light) const {
        const auto check_direction = [&](const char* what, Vec3 direction) {
            if (!(abs(length(direction) - 1) < 1e-3f))
                fail(what, "'s direction has the length ", length(direction), ", expected 1");
        };
        if (const auto* sun = std::get_if<SunLight>(&light)) check_direction("a sun", sun->direction);
        const auto* spot = std::get_if<SpotLight>(&light);
        if (spot == nullptr) return;
        check_direction("a spot light", spot->direction);
        if (!(spot->cos_inner > spot->cos_outer)) fail("a spot light's cos_inner must be above its cos_outer");
    }

    const Scene& scene_;
};

} // namespace

std::uint32_t add_material(Scene& scene, std::string name, Material material, SurfaceMaps maps) {
    scene.maps.resize(scene.materials.size());
    scene.materials.push_back(std::move(material));
    scene.material_names.push_back(std::move(name));
    scene.maps.push_back(std::move(maps));
    return static_cast<std::uint32_t>(scene.materials.size() - 1);
}

Object& add_object(Scene& scene, std::string name, Shape shape, std::uint32_t material, const Mat4& to_world) {
    scene.shapes.push_back(std::move(shape));
    Object& object = scene.objects.emplace_back();
    object.name = std::move(name);
    object.shape = static_cast<std::uint32_t>(scene.shapes.size() - 1);
    object.materials = {material};
    object.place(to_world);
    return object;
}

void check_scene(const Scene& scene) { SceneCheck(scene).check(); }

} // namespace duet
