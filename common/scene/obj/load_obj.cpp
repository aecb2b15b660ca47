#include "common/scene/obj/load_obj.h"

#include "common/scene/json/read_materials.h"
#include "common/scene/obj/load_mtl.h"
#include "common/scene/obj/obj_check.h"
#include "common/scene/obj/obj_mesh.h"
#include "common/scene/obj/obj_text.h"
#include "common/scene/obj/smooth_normals.h"
#include "common/system/error.h"
#include "common/system/escape.h"
#include "common/system/suggestion.h"

#include <tiny_obj_loader.h>

#include <istream>

namespace duet {

namespace {

/// MaterialSlots assigns the material slots of a mesh in the order in which usemtl lines use them.
class MaterialSlots {
public:
    MaterialSlots(const std::filesystem::path& path, const ObjCounts& counts, bool wanted)
        : path_(&path), wanted_(wanted), files_{path} {
        if (!wanted) return;
        for (const std::string& line : counts.material_files) load_library(line);
    }

    void use(const char* name) {
        current_ = wanted_ ? trimmed(name) : "";
        slot_ = kUnknown;
    }

    /// Returns the slot of the next face. The material is only looked up here, so that a material may be missing
    /// where no face uses it.
    std::uint16_t slot() {
        if (slot_ == kUnknown) slot_ = find_slot();
        return static_cast<std::uint16_t>(slot_);
    }

    void finish(ObjFile& file) {
        file.files = std::move(files_);
        file.materials = std::move(materials_);
        file.textures = std::move(textures_);
    }

private:
    static constexpr std::uint32_t kUnknown = ~0u;

    /// Loads the files of an mtllib line. The line is a list such as "mtllib a.mtl b.mtl", or a single name that
    /// contains blanks.
    void load_library(const std::string& line) {
        const auto file_exists = [&](const std::string& name) {
            std::error_code error;
            return std::filesystem::is_regular_file(resolve_path(*path_, name), error);
        };
        const std::string whole = trimmed(line);
        if (whole.empty()) return;
        if (file_exists(whole)) return load(resolve_path(*path_, whole));
        for (std::size_t at = 0; at < whole.size();) {
            const std::size_t end = std::min(whole.find_first_of(" \t", at), whole.size());
            const std::string name = whole.substr(at, end - at);
            at = end + 1;
            if (name.empty()) continue;
            if (file_exists(name))
                load(resolve_path(*path_, name));
            else
                missing_.push_back(resolve_path(*path_, name).string());
        }
    }

    void load(const std::filesystem::path& file) {
        load_mtl(file, library_);
        files_.push_back(file);
    }

    std::uint32_t find_slot() {
        const auto [entry, added] = slots_.try_emplace(current_, static_cast<std::uint32_t>(slots_.size()));
        if (!added) return entry->second;
        if (slots_.size() > 65536) throw Error(path_->string() + ": more than 65536 materials are used");
        ObjMaterial material{current_, default_obj_material(), {}};
        const auto found = library_.find(current_);
        if (found != library_.end()) {
            add_material(found->second, material);
        } else if (!current_.empty() && !missing_.empty()) {
            throw Error(message(path_->string(), ": the material ", quoted_text(current_), " is used, but its file ",
                                missing_.front(), " is missing"));
        } else if (!current_.empty() && !library_.empty()) {
            throw Error(message(path_->string(), ": the material ", quoted_text(current_),
                                " is used, but no MTL file has it", suggest()));
        }
        materials_.push_back(std::move(material));
        return entry->second;
    }

    std::string suggest() const {
        std::vector<std::string_view> known;
        for (const auto& entry : library_) known.push_back(entry.first);
        return suggestion(current_, known);
    }

    void add_material(const MtlMaterial& from, ObjMaterial& to) {
        to.material = from.material;
        to.maps = from.maps;
        const auto offset_texture = [this](std::int32_t& texture) {
            if (texture >= 0) texture += static_cast<std::int32_t>(textures_.size());
        };
        for_each_texture(to.material, offset_texture);
        for_each_texture(to.maps, offset_texture);
        textures_.insert(textures_.end(), from.textures.begin(), from.textures.end());
    }

    const std::filesystem::path* path_;
    bool wanted_;
    std::vector<std::filesystem::path> files_;
    std::map<std::string, MtlMaterial> library_;
    std::vector<std::string> missing_;
    std::string current_;
    std::uint32_t slot_ = kUnknown;
    std::map<std::string, std::uint32_t> slots_;
    std::vector<ObjMaterial> materials_;
    std::vector<ObjTexture> textures_;
};

/// An ObjReader is the state that tinyobjloader's callbacks receive.
struct ObjReader {
    ObjMeshBuilder mesh;
    MaterialSlots slots;
};

tinyobj::callback_t callbacks() {
    tinyobj::callback_t c;
    c.vertex_cb = [](void* reader, float x, float y, float z, float) {
        static_cast<ObjReader*>(reader)->mesh.add_position({x, y, z});
    };
    c.normal_cb = [](void* reader, float x, float y, float z) {
        static_cast<ObjReader*>(reader)->mesh.add_normal({x, y, z});
    };
    c.texcoord_cb = [](void* reader, float u, float v, float) { static_cast<ObjReader*>(reader)->mesh.add_uv({u, v}); };
    c.usemtl_cb = [](void* reader, const char* name, int) { static_cast<ObjReader*>(reader)->slots.use(name); };
    c.index_cb = [](void* user, tinyobj::index_t* indices, int count) {
        auto* reader = static_cast<ObjReader*>(user);
        reader->mesh.begin_face(reader->slots.slot());
        for (int i = 0; i < count; ++i)
            reader->mesh.add_corner(indices[i].vertex_index, indices[i].texcoord_index, indices[i].normal_index);
        reader->mesh.end_face();
    };
    return c;
}

} // namespace

Material default_obj_material() { return Diffuse{{Rgb(0.62f, 0.5f, 0.42f)}}; }

ObjFile load_obj(const std::filesystem::path& path, const ObjOptions& options) {
    ObjText text(path);
    std::istream stream(&text);
    stream.exceptions(std::ios::badbit);
    const ObjCounts counts = check_obj(path, stream);
    stream.clear();
    text.rewind();
    const bool file_normals =
        options.normals == MeshNormals::kFile || (options.normals == MeshNormals::kAuto && counts.normals > 0);
    ObjReader reader{ObjMeshBuilder(path, counts, file_normals), MaterialSlots(path, counts, options.materials)};
    std::string warnings, errors;
    if (!tinyobj::LoadObjWithCallback(stream, callbacks(), &reader, nullptr, &warnings, &errors))
        throw Error(message(path.string(), ": ", quoted_text(errors)));
    ObjFile file;
    reader.slots.finish(file);
    file.mesh = reader.mesh.finish(file.degenerate_faces);
    if (file.materials.size() == 1) file.mesh.material_slots.clear();
    if (options.normals == MeshNormals::kSmooth || (options.normals == MeshNormals::kAuto && !file_normals))
        add_smooth_normals(file.mesh);
    return file;
}

} // namespace duet
