#include "raster/shading/built_in_shaders.h"

namespace duet::raster {

std::unique_ptr<ShaderProgram> built_in_program(Shading shading, const Camera& camera) {
    switch (shading) {
    case Shading::kLit:
        break;
    case Shading::kPhong:
        return phong_program();
    case Shading::kGouraud:
        return gouraud_program();
    case Shading::kFlat:
        return flat_program();
    case Shading::kToon:
        return toon_program();
    case Shading::kWireframe:
        return wireframe_program();
    case Shading::kNormal:
        return normal_program();
    case Shading::kAlbedo:
        return albedo_program();
    case Shading::kLines:
    case Shading::kEdges: // the overlay replaces the colors of both
    case Shading::kDepth:
        return depth_program(camera);
    }
    return nullptr;
}

} // namespace duet::raster
