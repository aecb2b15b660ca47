// This fuzz target loads any bytes as OBJ and MTL files. They must load to a valid mesh or throw Error.
// The text after the first "%" is the MTL file m.mtl.
#include "common/scene/obj/load_obj.h"
#include "tests/fuzz/fuzz_files.h"

#include <algorithm>

namespace {

using duet::require;

void check(const duet::ObjFile& file) {
    const duet::Mesh& mesh = file.mesh;
    require(!mesh.triangles.empty() && !file.materials.empty());
    require(mesh.uvs.empty() || mesh.uvs.size() == mesh.positions.size());
    require(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size());
    require(mesh.material_slots.empty() || mesh.material_slots.size() == mesh.triangles.size());
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t i : triangle) require(i < mesh.positions.size());
    for (const std::uint16_t slot : mesh.material_slots) require(slot < file.materials.size());
    for (const duet::Vec3 p : mesh.positions)
        require(duet::is_finite(p) && duet::max_component(duet::abs(p)) <= 1.0001e18f);
    for (const duet::Vec3 n : mesh.normals) require(std::abs(duet::length(n) - 1) < 1e-5f);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
    static const std::filesystem::path folder = duet::fuzz_folder();
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const std::size_t cut = std::min(text.find('%'), text.size());
    duet::write_bytes(folder / "mesh.obj", text.substr(0, cut));
    duet::write_bytes(folder / "m.mtl", text.substr(std::min(cut + 1, text.size())));
    duet::returns_or_throws_error([&] {
        check(duet::load_obj(folder / "mesh.obj"));
        check(duet::load_obj(folder / "mesh.obj", {duet::MeshNormals::kSmooth}));
    });
    return 0;
}
