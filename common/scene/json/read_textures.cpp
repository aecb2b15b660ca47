#include "common/scene/json/read_textures.h"

#include "common/scene/file_cache.h"
#include "common/scene/json/scene_keys.h"
#include "common/system/error.h"
#include "common/system/suggestion.h"

#include <algorithm>

namespace duet {

namespace fs = std::filesystem;

fs::path resolve_path(const fs::path& owner, const std::string& name) {
    return (owner.parent_path() / name).lexically_normal();
}

std::string canonical_key(const fs::path& path) {
    std::error_code error;
    const fs::path canonical = fs::weakly_canonical(path, error);
    return (error ? path : canonical).string();
}

namespace {

ImageRgb read_reflectances(const fs::path& file, ChannelSelection selection) {
    ImageRgb image = select_channels(read_stored_image(file), selection);
    for (Rgb& pixel : image.pixels()) {
        if (!is_finite(pixel))
            throw Error(message(file.string(), ": holds a value that is not finite, which no texture may"));
        pixel = {clamp(pixel.r, 0.0f, 1.0f), clamp(pixel.g, 0.0f, 1.0f), clamp(pixel.b, 0.0f, 1.0f)};
    }
    return image;
}

} // namespace

std::uint32_t ImageCache::load(const fs::path& file, ChannelSelection selection) {
    SharedList<ImageRgb>& images = scene_->textures.images;
    const std::string key = message(canonical_key(file), '\n', static_cast<int>(selection.values), ' ',
                                    static_cast<int>(selection.channel));
    const auto [entry, added] = index_.try_emplace(key, static_cast<std::uint32_t>(images.size()));
    if (!added) return entry->second;
    const auto read = [&] { return FileCache::Read<ImageRgb>{read_reflectances(file, selection), {file}}; };
    if (files_)
        images.push_back(files_->get<ImageRgb>("image " + key, read));
    else
        images.push_back(read().value);
    if (std::find(scene_->files.begin(), scene_->files.end(), file) == scene_->files.end())
        scene_->files.push_back(file);
    return entry->second;
}

namespace {

Texture read_image_texture(const JsonValue& value, ImageCache& images) {
    value.check_keys(scene_keys("image_texture"));
    ImageTexture texture;
    if (value.has("scale")) {
        const JsonValue scale = value.at("scale");
        const bool uniform = scale.is(JsonNode::Kind::kNumber);
        const Vec2d s =
            uniform ? Vec2d(scale.number(), scale.number()) : Vec2d(scale.numbers(2)[0], scale.numbers(2)[1]);
        texture.scale = Vec2(s);
    }
    if (value.has("filter"))
        texture.filter = static_cast<TextureFilter>(
            value.at("filter").one_of({"nearest", "bilinear", "trilinear", "anisotropic"}));
    ChannelSelection selection;
    if (value.has("values"))
        selection.values = static_cast<ChannelSelection::Values>(value.at("values").one_of({"colors", "data"}));
    if (value.has("channel"))
        selection.channel = static_cast<ChannelSelection::Channel>(
            value.at("channel").one_of({"all", "red", "green", "blue", "alpha"}));
    const fs::path file = resolve_path(value.file(), value.at("file").string());
    try {
        texture.image = images.load(file, selection);
    } catch (const Error& error) {
        value.at("file").fail(error.what());
    }
    return texture;
}

Texture read_texture(const JsonValue& value, ImageCache& images) {
    switch (value.at("type").one_of({"image", "checker", "noise"})) {
    case 0:
        return read_image_texture(value, images);
    case 1: {
        value.check_keys(scene_keys("checker_texture"));
        CheckerTexture texture;
        texture.even = value.rgb_or("even", texture.even);
        texture.odd = value.rgb_or("odd", texture.odd);
        texture.scale = static_cast<float>(value.number_or("scale", texture.scale, kPositive));
        texture.solid = value.boolean_or("solid", texture.solid);
        return texture;
    }
    default: {
        value.check_keys(scene_keys("noise_texture"));
        NoiseTexture texture;
        texture.low = value.rgb_or("low", texture.low);
        texture.high = value.rgb_or("high", texture.high);
        texture.scale = static_cast<float>(value.number_or("scale", texture.scale, kPositive));
        if (value.has("octaves")) texture.octaves = value.at("octaves").integer(1, 16);
        texture.marble = value.boolean_or("marble", texture.marble);
        return texture;
    }
    }
}

} // namespace

std::uint32_t look_up(const JsonValue& name, const NameIndex& index, std::string_view what) {
    const auto found = index.find(name.string());
    if (found != index.end()) return found->second;
    std::vector<std::string_view> known;
    for (const auto& entry : index) known.push_back(entry.first);
    name.fail(message("unknown ", what, " ", quoted_text(name.string()), suggestion(name.string(), known)));
}

NameIndex read_textures(const JsonValue& textures, Scene& scene, ImageCache& images) {
    NameIndex index;
    for (const auto& [name, value] : textures.members()) {
        index[name] = static_cast<std::uint32_t>(scene.textures.textures.size());
        scene.textures.textures.push_back(read_texture(value, images));
    }
    return index;
}

} // namespace duet
