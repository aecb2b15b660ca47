#include "models/generate.h"

namespace duet::models {

std::span<const Model> all_models() {
    using enum Model::Kind;
    static const std::vector<Model> models{
        {"spheres", kCommitted, {"spheres.json"}, write_spheres},
    };
    return models;
}

} // namespace duet::models
