// Your shadows. The starter takes everything as lit that faces the light. Begin with traced_shadows: it is short, and
// shows what all others must give.
#include "compare/lessons/assignments/5-shadow-maps/lab.h"

namespace duet::lab {

LightView light_view(const Light& light, const std::vector<Triangle>& triangles) {
    not_attempted(); // Remove this line when you start.
    (void)light, (void)triangles;
    return {};
}

ImageFloat depth_map(const std::vector<Triangle>& triangles, const LightView& view, int side) {
    not_attempted(); // Remove this line when you start.
    (void)triangles, (void)view;
    return ImageFloat(side, side, kInfinity); // The light sees nothing.
}

ImageFloat shadows(const ShadowMap& map, const Light& light, const GBuffer& gbuffer, int reach) {
    not_attempted(); // Remove this line when you start.
    (void)map, (void)reach;
    ImageFloat lit(gbuffer.point.width(), gbuffer.point.height(), 0);
    for (std::size_t i = 0; i < lit.size(); ++i) {
        const Vec3 to_light = light.spot ? light.position - gbuffer.point[i] : -light.direction;
        if (dot(gbuffer.normal[i], to_light) > 0) lit[i] = 1;
    }
    return lit;
}

float penumbra_width(const Light& light, float blocker, float receiver) {
    not_attempted(); // Remove this line when you start.
    (void)light, (void)blocker, (void)receiver;
    return 0;
}

ImageFloat soft_shadows(const ShadowMap& map, const Light& light, const GBuffer& gbuffer) {
    not_attempted(); // Remove this line when you start.
    return shadows(map, light, gbuffer, 0);
}

ImageFloat traced_shadows(const std::vector<Triangle>& triangles, const Light& light, const GBuffer& gbuffer,
                          int samples) {
    not_attempted(); // Remove this line when you start.
    (void)triangles, (void)light, (void)samples;
    return ImageFloat(gbuffer.point.width(), gbuffer.point.height(), 1); // Nothing stands in the way.
}

} // namespace duet::lab
