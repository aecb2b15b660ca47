// This fuzz target loads any bytes as OBJ and MTL files. They must load to a valid mesh or throw Error with one line.
// The text after the first "%" is the MTL file m.mtl.
#include "common/scene/obj/load_obj.h"
#include "common/scene/obj/smooth_normals.h"
#include "common/system/error.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <unistd.h>

namespace {

std::filesystem::path fuzz_folder() {
    const std::filesystem::path base =
        std::filesystem::is_directory("/dev/shm") ? "/dev/shm" : std::filesystem::temp_directory_path();
    const std::filesystem::path folder = base / ("duet-fuzz-" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    return folder;
}

void require(bool condition) {
    if (!condition) std::abort();
}

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
    static const std::filesystem::path folder = fuzz_folder();
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const std::size_t cut = std::min(text.find('%'), text.size());
    const auto write = [&](const char* name, std::string_view part) {
        std::ofstream(folder / name, std::ios::binary | std::ios::trunc)
            .write(part.data(), static_cast<std::streamsize>(part.size()));
    };
    write("mesh.obj", text.substr(0, cut));
    write("m.mtl", text.substr(std::min(cut + 1, text.size())));
    try {
        check(duet::load_obj(folder / "mesh.obj"));
        check(duet::load_obj(folder / "mesh.obj", {duet::MeshNormals::kSmooth}));
    } catch (const duet::Error& error) {
        require(std::string_view(error.what()).find('\n') == std::string_view::npos);
    }
    return 0;
}
