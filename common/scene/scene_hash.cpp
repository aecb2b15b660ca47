#include "common/scene/scene_hash.h"

#include "common/sampling/digest.h"
#include "common/sampling/hash.h"
#include "common/system/file.h"

namespace duet {

std::string hash_scene_files(const Scene& scene) {
    std::uint64_t state = hash_combine(0, scene.files.size());
    for (const std::filesystem::path& file : scene.files) state = hash_bytes(state, read_file(file));
    return to_hex(state);
}

} // namespace duet
