// This fuzz target loads any bytes as a scene file. It must load or throw Error with one line, without a crash, hang
// or leak.
#include "common/scene/scene.h"
#include "tests/fuzz/require.h"
#include "tests/support/errors.h"
#include "tests/support/scratch.h"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
    static const duet::test::ScratchFolder folder;
    // Scenes may refer to this mesh and this image.
    static const std::filesystem::path mesh = folder.write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
                                       image = folder.write("m.ppm", "P3 2 1 255 255 0 0 0 0 255\n");
    duet::write_file(folder / "scene.json", {reinterpret_cast<const char*>(data), size});
    const std::string error = duet::test::error_of([&] { duet::load_scene(folder / "scene.json"); });
    duet::require(duet::test::says(error, "")); // a single line
    return 0;
}
