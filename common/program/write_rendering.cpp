#include "common/program/render_program.h"

#include "common/image/image_file.h"
#include "common/system/file.h"

namespace duet {

namespace {

using Channels = std::vector<ExrChannel>;

template <typename Pixel, typename Get> ExrChannel floats(std::string name, const Image<Pixel>& image, Get get) {
    ExrChannel channel{std::move(name), {}, {}};
    channel.floats.reserve(image.size());
    for (const Pixel& pixel : image) channel.floats.push_back(get(pixel));
    return channel;
}
template <typename Pixel, typename Get> ExrChannel integers(std::string name, const Image<Pixel>& image, Get get) {
    ExrChannel channel{std::move(name), {}, {}};
    channel.integers.reserve(image.size());
    for (const Pixel& pixel : image) channel.integers.push_back(get(pixel));
    return channel;
}
struct Layer {
    std::string name;
    Channels channels;
};

std::vector<Layer> auxiliary_layers(const Rendering& r) {
    std::vector<Layer> layers;
    if (!r.depth.empty()) layers.push_back({"depth", {floats("depth.Z", r.depth, [](float z) { return z; })}});
    if (!r.normal.empty())
        layers.push_back({"normal",
                          {floats("normal.X", r.normal, [](const Vec3& n) { return n.x; }),
                           floats("normal.Y", r.normal, [](const Vec3& n) { return n.y; }),
                           floats("normal.Z", r.normal, [](const Vec3& n) { return n.z; })}});
    if (!r.albedo.empty()) layers.push_back({"albedo", rgb_channels("albedo.", r.albedo)});
    if (!r.hit.empty())
        layers.push_back({"hit",
                          {integers("hit.object", r.hit, [](const Hit& h) { return h.object; }),
                           integers("hit.primitive", r.hit, [](const Hit& h) { return h.primitive; }),
                           floats("hit.u", r.hit, [](const Hit& h) { return h.u; }),
                           floats("hit.v", r.hit, [](const Hit& h) { return h.v; }),
                           floats("hit.t", r.hit, [](const Hit& h) { return h.t; })}});
    if (!r.variance.empty()) layers.push_back({"variance", rgb_channels("variance.", r.variance)});
    if (!r.samples.empty())
        layers.push_back({"samples", {integers("samples", r.samples, [](std::uint32_t n) { return n; })}});
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
