#include "common/system/error.h"
#include "raster/render.h"

#include <array>
#include <utility>

namespace duet::raster {

Shading shading(std::string_view name) {
    constexpr std::array<std::pair<std::string_view, Shading>, 5> kNames{{{"lit", Shading::kLit},
                                                                          {"normal", Shading::kNormal},
                                                                          {"albedo", Shading::kAlbedo},
                                                                          {"depth", Shading::kDepth},
                                                                          {"phong", Shading::kPhong}}};
    for (const auto& [known, value] : kNames)
        if (known == name) return value;
    throw Error(message("shading: found ", name, ", expected lit, normal, albedo, depth or phong"));
}

AmbientOcclusion ambient_occlusion(std::string_view name) {
    if (name == "none") return AmbientOcclusion::kNone;
    if (name == "ssao") return AmbientOcclusion::kSsao;
    if (name == "gtao") return AmbientOcclusion::kGtao;
    throw Error(message("ambient occlusion: found ", name, ", expected none, ssao or gtao"));
}

} // namespace duet::raster
