// This fuzz target loads any bytes as a scene file. It must load or throw Error, without a crash, hang
// or leak.
#include "common/scene/scene.h"
#include "tests/fuzz/fuzz_files.h"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
    static const std::filesystem::path folder = [] {
        const std::filesystem::path made = duet::fuzz_folder();
        // Scenes may refer to this mesh and this image.
        duet::write_bytes(made / "m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
        duet::write_bytes(made / "m.ppm", "P3 2 1 255 255 0 0 0 0 255\n");
        return made;
    }();
    duet::write_bytes(folder / "scene.json", {reinterpret_cast<const char*>(data), size});
    duet::returns_or_throws_error([] { duet::load_scene(folder / "scene.json"); });
    return 0;
}
