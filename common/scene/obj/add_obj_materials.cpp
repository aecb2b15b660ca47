#include "common/scene/obj/add_obj_materials.h"

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
        indices.push_back(static_cast<std::uint32_t>(scene.materials.size()));
        scene.materials.push_back(material);
        scene.maps.resize(scene.materials.size() - 1);
        scene.maps.push_back(maps);
        scene.material_names.push_back(file.stem().string() + ":" + (entry.name.empty() ? "default" : entry.name));
    }
    return indices;
}

} // namespace duet
