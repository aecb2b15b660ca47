#include "common/scene/json/read_media.h"

#include "common/scene/json/scene_keys.h"
#include "common/system/error.h"

namespace duet {

namespace {

/// Each ray looks at each medium, so a scene may not have more than this many.
constexpr std::size_t kMaxMedia = 64;

Medium read_medium(const JsonValue& value) {
    value.at("type").one_of({"fog"});
    value.check_keys(scene_keys("fog"));
    Medium medium;
    if (value.has("low")) medium.box.low = Vec3(value.at("low").vec3());
    if (value.has("high")) medium.box.high = Vec3(value.at("high").vec3());
    check_corners(value, medium.box);
    medium.scattering = value.rgb_or("scattering", medium.scattering, kLightRange);
    medium.absorption = value.rgb_or("absorption", medium.absorption, kLightRange);
    medium.radiance = value.rgb_or("radiance", medium.radiance, kLightRange);
    medium.asymmetry = static_cast<float>(value.number_or("asymmetry", medium.asymmetry, {-0.99, 0.99, false}));
    return medium;
}

} // namespace

void check_corners(const JsonValue& value, const Box3& box) {
    if (!(box.low.x < box.high.x && box.low.y < box.high.y && box.low.z < box.high.z))
        value.fail("\"low\" must be below \"high\" on each axis");
}

std::vector<Medium> read_media(const JsonValue& value) {
    const std::vector<JsonValue> elements = value.elements();
    if (elements.size() > kMaxMedia) value.expected(message("at most ", kMaxMedia));
    std::vector<Medium> media;
    for (const JsonValue& element : elements) media.push_back(read_medium(element));
    return media;
}

} // namespace duet
