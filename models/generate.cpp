#include "models/generate.h"

#include "models/octopus.h"

namespace duet::models {

std::span<const Model> all_models() {
    using enum Model::Kind;
    static const std::vector<Model> models{
        {"amphora", kCommitted, {"meshes/amphora.obj", "textures/amphora.png"}, write_amphora},
        {"bowl", kCommitted, {"meshes/bowl.obj"}, write_bowl},
        {"pear", kCommitted, {"meshes/pear.obj", "meshes/pear.mtl", "textures/pear.png"}, write_pear},
        {"plinth", kCommitted, {"meshes/plinth.obj"}, write_plinth},
        {"sky", kCommitted, {"textures/sky.hdr"}, write_sky},
        {"spheres", kCommitted, {"spheres.json"}, write_spheres},
        {"hall", kBuilt, {kHallFile}, write_hall},
        {"octopus", kBuilt, {kOctopusFile}, write_octopus},
        {"octopus-hundred-thousand", kOnRequest, {kOctopusSmallFile}, write_octopus_hundred_thousand},
        {"octopus-million", kOnRequest, {kOctopusMillionFile}, write_octopus_million},
    };
    return models;
}

void make(const Model& model, const std::filesystem::path& folder) {
    for (const std::string& file : model.files) std::filesystem::create_directories((folder / file).parent_path());
    model.write(folder);
}

} // namespace duet::models
