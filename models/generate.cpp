#include "models/generate.h"

#include "models/nave.h"
#include "models/octopus.h"
#include "models/test_ball.h"

namespace duet::models {

namespace {

std::vector<std::string> ball_files() {
    std::vector<std::string> files{"meshes/test-ball.obj"};
    for (const BallScene& ball : ball_scenes()) files.push_back("balls/" + ball.name + ".json");
    return files;
}

} // namespace

std::span<const Model> all_models() {
    using enum Model::Kind;
    static const std::vector<Model> models{
        {"amphora", kCommitted, {"meshes/amphora.obj", "textures/amphora.png"}, write_amphora},
        {"bowl", kCommitted, {"meshes/bowl.obj"}, write_bowl},
        {"candle", kCommitted, {"meshes/candle.obj", "meshes/flame.obj", "meshes/wick.obj"}, write_candle},
        {"lanterns", kCommitted, {"lanterns.json"}, write_lanterns},
        {"pear", kCommitted, {"meshes/pear.obj", "meshes/pear.mtl", "textures/pear.png"}, write_pear},
        {"plinth", kCommitted, {"meshes/plinth.obj"}, write_plinth},
        {"ring", kCommitted, {"meshes/ring.obj"}, write_ring},
        {"sky", kCommitted, {"textures/sky.hdr"}, write_sky},
        {"smoke", kCommitted, {"textures/smoke.raw"}, write_smoke},
        {"spheres", kCommitted, {"spheres.json"}, write_spheres},
        {"test-ball", kCommitted, ball_files(), write_test_ball},
        {"hall", kBuilt, {kHallFile}, write_hall},
        {"octopus", kBuilt, {kOctopusFile}, write_octopus},
        {"water", kBuilt, {kWaterFile}, write_water},
        {"octopus-hundred-thousand", kOnRequest, {kOctopusSmallFile}, write_octopus_hundred_thousand},
        {"octopus-million", kOnRequest, {kOctopusMillionFile}, write_octopus_million},
        {"octopus-fine", kOnRequest, {kOctopusFineFile}, write_octopus_fine},
        {"gyroid", kOnRequest, {kGyroidFile}, write_gyroid},
        {"menger", kOnRequest, {kMengerFile}, write_menger},
        {"nave", kOnRequest, {kNaveFile}, write_nave},
        {"tracery", kOnRequest, {kTraceryFile}, write_tracery},
    };
    return models;
}

void generate_model(const Model& model, const std::filesystem::path& folder) {
    for (const std::string& file : model.files) std::filesystem::create_directories((folder / file).parent_path());
    model.write(folder);
}

} // namespace duet::models
