// This fuzz target loads any bytes as OBJ and MTL files. They must load to a valid mesh or throw Error with one line.
// The text after the first "%" is the MTL file m.mtl.
#include "common/scene/obj/load_obj.h"
#include "tests/fuzz/require.h"
#include "tests/support/errors.h"
#include "tests/support/scratch.h"

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
    static const duet::test::ScratchFolder folder;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const std::size_t cut = std::min(text.find('%'), text.size());
    duet::write_file(folder / "mesh.obj", text.substr(0, cut));
    duet::write_file(folder / "m.mtl", text.substr(std::min(cut + 1, text.size())));
    const std::string error = duet::test::error_of([&] {
        check(duet::load_obj(folder / "mesh.obj"));
        check(duet::load_obj(folder / "mesh.obj", {duet::MeshNormals::kSmooth}));
    });
    require(duet::test::says(error, "")); // a single line
    return 0;
}
