// This fuzz target loads any bytes as a scene file. It must load or throw Error with one line, without a crash, hang
// or leak.
#include "common/scene/scene.h"
#include "common/system/error.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>

namespace {

std::filesystem::path fuzz_folder() {
    const std::filesystem::path base =
        std::filesystem::is_directory("/dev/shm") ? "/dev/shm" : std::filesystem::temp_directory_path();
    const std::filesystem::path folder = base / ("duet-fuzz-" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    // Scenes may reference this mesh.
    std::ofstream(folder / "m.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    return folder;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
    static const std::filesystem::path folder = fuzz_folder();
    const std::filesystem::path file = folder / "scene.json";
    std::ofstream(file, std::ios::binary | std::ios::trunc)
        .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
    try {
        duet::load_scene(file);
    } catch (const duet::Error& error) {
        if (std::string(error.what()).find('\n') != std::string::npos) std::abort(); // a single line
    }
    return 0;
}
