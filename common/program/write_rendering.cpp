#include "common/program/render_program.h"

#include "common/image/image_file.h"
#include "common/system/file.h"

namespace duet {

namespace {

using Channels = std::vector<ExrChannel>;

struct Layer {
    std::string name;
    Channels channels;
};

std::vector<Layer> auxiliary_layers(const Rendering& r) {
    std::vector<Layer> layers;
    if (!r.depth.empty()) layers.push_back({"depth", {exr_channel("depth.Z", r.depth, std::identity())}});
    if (!r.normal.empty())
        layers.push_back({"normal",
                          {exr_channel("normal.X", r.normal, &Vec3::x), exr_channel("normal.Y", r.normal, &Vec3::y),
                           exr_channel("normal.Z", r.normal, &Vec3::z)}});
    if (!r.albedo.empty()) layers.push_back({"albedo", rgb_channels("albedo.", r.albedo)});
    if (!r.hit.empty())
        layers.push_back({"hit",
                          {exr_channel("hit.object", r.hit, &Hit::object),
                           exr_channel("hit.primitive", r.hit, &Hit::primitive), exr_channel("hit.u", r.hit, &Hit::u),
                           exr_channel("hit.v", r.hit, &Hit::v), exr_channel("hit.t", r.hit, &Hit::t)}});
    if (!r.variance.empty()) layers.push_back({"variance", rgb_channels("variance.", r.variance)});
    if (!r.samples.empty()) layers.push_back({"samples", {exr_channel("samples", r.samples, std::identity())}});
    return layers;
}

} // namespace

std::filesystem::path undenoised_path(const std::filesystem::path& path) {
    std::filesystem::path result = path;
    return result.replace_extension(".noisy" + path.extension().string());
}

void write_rendering(const std::filesystem::path& path, const Rendering& rendering, const WriteOptions& options) {
    const bool denoised = !rendering.denoised.empty();
    const ImageRgb& image = denoised ? rendering.denoised : rendering.radiance;
    if (denoised) write_image(undenoised_path(path), rendering.radiance, options);
    const int width = rendering.radiance.width(), height = rendering.radiance.height();
    std::vector<Layer> layers = auxiliary_layers(rendering);
    if (lower_case_extension(path) == ".exr" && !layers.empty()) {
        Channels all = rgb_channels("", image);
        for (Layer& layer : layers) std::move(layer.channels.begin(), layer.channels.end(), std::back_inserter(all));
        write_exr(path, width, height, all);
        return;
    }
    write_image(path, image, options);
    for (const Layer& layer : layers) {
        std::filesystem::path aov_path = path;
        write_exr(aov_path.replace_extension("." + layer.name + ".exr"), width, height, layer.channels);
    }
}

} // namespace duet
