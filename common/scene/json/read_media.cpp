#include "common/scene/json/read_media.h"

#include "common/medium/cloud.h"
#include "common/scene/file_cache.h"
#include "common/scene/json/read_textures.h"
#include "common/scene/json/scene_keys.h"
#include "common/system/error.h"
#include "common/system/file.h"

#include <algorithm>
#include <memory>

namespace duet {

namespace {

/// All grids of a scene together may have at most this many points, each of four bytes in memory.
constexpr long long kMaxGridPoints = 257 * 257 * 257;

/// Throws Error if another grid of this size would be too many points.
void check_points(const JsonValue& value, const Scene& scene, const std::array<int, 3>& size) {
    long long points = static_cast<long long>(size[0]) * size[1] * size[2];
    for (const Medium& medium : scene.media)
        if (medium.density) points += static_cast<long long>(medium.density->densities().size());
    if (points > kMaxGridPoints)
        value.fail(message("found ", points, " points in the grids of all media up to here, expected at most ",
                           kMaxGridPoints));
}

std::shared_ptr<const DensityGrid> read_cloud(const JsonValue& value, const Box3& box, const Scene& scene,
                                              FileCache* cache) {
    Cloud cloud;
    cloud.scale = static_cast<float>(value.number_or("scale", 1, kPositive));
    if (value.has("octaves")) cloud.octaves = value.at("octaves").integer(1, 16);
    cloud.coverage = static_cast<float>(value.number_or("coverage", 0.5, kUnit));
    cloud.softness = static_cast<float>(value.number_or("softness", 0.3, {1e-3, 1e3, false}));
    if (value.has("resolution")) cloud.resolution = value.at("resolution").integer(1, 256);
    check_points(value, scene, grid_size(box, cloud.resolution));
    if (cache == nullptr) return std::make_shared<const DensityGrid>(make_cloud(cloud, box));
    const Vec3 size = box.diagonal();
    const std::array numbers{size.x,
                             size.y,
                             size.z,
                             cloud.scale,
                             cloud.coverage,
                             cloud.softness,
                             static_cast<float>(cloud.octaves),
                             static_cast<float>(cloud.resolution)};
    const std::string key(reinterpret_cast<const char*>(numbers.data()), sizeof(numbers));
    return cache->reuse<DensityGrid>(key, [&] { return make_cloud(cloud, box); });
}

/// Reads a file that holds a byte for each point of a grid: 255 is a density of 1.
DensityGrid read_grid(const JsonValue& value, const std::filesystem::path& file, const std::array<int, 3>& size) {
    const std::size_t points =
        static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) * static_cast<std::size_t>(size[2]);
    const std::string bytes = read_file(file);
    if (bytes.size() != points)
        value.at("file").fail(message(file.string(), ": found ", bytes.size(), " bytes, expected ", points,
                                      ": one for each point that \"resolution\" asks for"));
    std::vector<float> densities(points);
    std::transform(bytes.begin(), bytes.end(), densities.begin(),
                   [](char byte) { return static_cast<float>(static_cast<unsigned char>(byte)) / 255; });
    return {size, std::move(densities)};
}

std::shared_ptr<const DensityGrid> read_smoke(const JsonValue& value, Scene& scene, FileCache* cache) {
    std::array<int, 3> size{};
    const std::vector<JsonValue> resolution = value.at("resolution").elements();
    if (resolution.size() != 3) value.at("resolution").expected("three numbers of points");
    for (std::size_t axis = 0; axis < 3; ++axis) size[axis] = resolution[axis].integer(2, 4096);
    check_points(value, scene, size);
    const std::filesystem::path file = resolve_path(value.file(), value.at("file").string());
    if (std::find(scene.files.begin(), scene.files.end(), file) == scene.files.end()) scene.files.push_back(file);
    if (cache == nullptr) return std::make_shared<const DensityGrid>(read_grid(value, file, size));
    const std::string key = message("smoke ", size[0], ' ', size[1], ' ', size[2], ' ', canonical_key(file));
    return cache->get<DensityGrid>(key, [&] {
        return FileCache::Read<DensityGrid>{read_grid(value, file, size), {file}};
    });
}

Medium read_medium(const JsonValue& value, Scene& scene, FileCache* cache) {
    const std::vector<std::string_view> types{"fog", "cloud", "smoke"};
    const std::string_view type = types[value.at("type").one_of(types)];
    value.check_keys(scene_keys(type));
    Medium medium;
    if (value.has("low")) medium.box.low = Vec3(value.at("low").vec3());
    if (value.has("high")) medium.box.high = Vec3(value.at("high").vec3());
    check_corners(value, medium.box);
    medium.scattering = value.rgb_or("scattering", medium.scattering, kLightRange);
    medium.absorption = value.rgb_or("absorption", medium.absorption, kLightRange);
    medium.radiance = value.rgb_or("radiance", medium.radiance, kLightRange);
    medium.asymmetry = static_cast<float>(value.number_or("asymmetry", medium.asymmetry, {-0.99, 0.99, false}));
    if (type == "cloud") medium.density = read_cloud(value, medium.box, scene, cache);
    if (type == "smoke") medium.density = read_smoke(value, scene, cache);
    return medium;
}

} // namespace

void check_corners(const JsonValue& value, const Box3& box) {
    if (!(box.low.x < box.high.x && box.low.y < box.high.y && box.low.z < box.high.z))
        value.fail("\"low\" must be below \"high\" on each axis");
}

void read_media(const JsonValue& value, Scene& scene, FileCache* cache) {
    const std::vector<JsonValue> elements = value.elements();
    if (elements.size() > kMaxMedia) value.expected(message("at most ", kMaxMedia));
    for (const JsonValue& element : elements) scene.media.push_back(read_medium(element, scene, cache));
}

} // namespace duet
