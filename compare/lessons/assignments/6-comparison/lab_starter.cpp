// Your two pipelines and your report. The starter draws the sky. Begin with ray_trace: it is the shorter one.
#include "compare/lessons/assignments/6-comparison/lab.h"

namespace duet::lab {

Rendering rasterize(const Scene& scene, const Camera& camera, int width, int height) {
    not_attempted(); // Remove this line when you start.
    (void)scene, (void)camera;
    return {ImageRgb(width, height), Image<int>(width, height, -1), ImageFloat(width, height, kInfinity)};
}

Rendering ray_trace(const Scene& scene, const Camera& camera, int width, int height, bool shadows) {
    not_attempted(); // Remove this line when you start.
    (void)camera, (void)shadows;
    return {ImageRgb(width, height, scene.sky), Image<int>(width, height, -1), ImageFloat(width, height, kInfinity)};
}

int triangle_at(const Scene& scene, const Camera& camera, int width, int height, float x, float y) {
    not_attempted(); // Remove this line when you start.
    (void)scene, (void)camera, (void)width, (void)height, (void)x, (void)y;
    return -1;
}

Errors errors(const ImageRgb& image, const ImageRgb& reference) {
    not_attempted(); // Remove this line when you start.
    (void)image, (void)reference;
    return {};
}

HitCounts compare_hits(const Scene& scene, const Camera& camera, const Rendering& raster, const Rendering& traced) {
    not_attempted(); // Remove this line when you start.
    (void)scene, (void)camera, (void)traced;
    return {.unexplained = static_cast<int>(raster.triangle.size())}; // nothing is explained yet
}

ImageRgb difference_image(const ImageRgb& image, const ImageRgb& reference, float range) {
    not_attempted(); // Remove this line when you start.
    (void)reference, (void)range;
    return ImageRgb(image.width(), image.height());
}

} // namespace duet::lab
