#include "common/scene/obj/add_obj_materials.h"

#include "common/scene/build_scene.h"
#include "common/system/error.h"

namespace duet {

std::vector<std::uint32_t> add_obj_materials(const std::filesystem::path& file, const ObjFile& obj, ImageCache& images,
                                             Scene& scene) {
    std::vector<std::int32_t> textures;
    for (const ObjTexture& texture : obj.textures) {
        textures.push_back(static_cast<std::int32_t>(scene.textures.textures.size()));
        try {
            scene.textures.textures.push_back(
                ImageTexture{images.load(texture.file, texture.selection), texture.scale});
        } catch (const Error& error) {
            throw Error(message(file.string(), ": an image of its MTL file: ", error.what()));
        }
    }
    std::vector<std::uint32_t> indices;
    for (const ObjMaterial& entry : obj.materials) {
        Material material = entry.material;
        SurfaceMaps maps = entry.maps;
        const auto map = [&](std::int32_t& texture) {
            if (texture >= 0) texture = textures[static_cast<std::size_t>(texture)];
        };
        for_each_texture(material, map);
        for_each_texture(maps, map);
        const std::string name = file.stem().string() + ":" + (entry.name.empty() ? "default" : entry.name);
        indices.push_back(add_material(scene, name, material, maps));
    }
    return indices;
}

} // namespace duet
