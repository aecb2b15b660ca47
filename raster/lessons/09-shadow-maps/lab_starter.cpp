// Your shadows. Write the functions from the top down. You may include the headers of earlier lessons.
#include "raster/lessons/09-shadow-maps/lab.h"

namespace duet::lab {

Mat4 sun_matrix(Vec3 to_sun, Vec3 center, float radius) {
    not_attempted(); // Remove this line when you start.
    (void)to_sun, (void)center, (void)radius;
    // look_at of lesson 04 puts an eye on the sphere. What remains is a scaling. Which of the two is applied first?
    return Mat4();
}

bool in_shadow(const ShadowMap& map, Vec3 p, float bias) {
    not_attempted(); // Remove this line when you start.
    (void)map, (void)p, (void)bias;
    // In clip space y points up, but the rows of the map are counted from the top. Depths have no unit, the bias has.
    return false;
}

float slope_bias(float texel, Vec3 to_sun, Vec3 n, int reach) {
    not_attempted(); // Remove this line when you start.
    (void)texel, (void)to_sun, (void)n, (void)reach;
    // The tangent follows from the cosine: sin² + cos² = 1. Keep the cosine within [0.1, 1].
    return 0;
}

float lit_fraction(const ShadowMap& map, Vec3 p, float bias, int reach) {
    not_attempted(); // Remove this line when you start.
    (void)map, (void)p, (void)bias, (void)reach;
    // Compare first, then take the mean of the answers.
    return 1;
}

ImageFloat sunlight(const ShadowMap& map, Vec3 to_sun, const Image<Vec3>& points, const Image<Vec3>& normals,
                    int reach) {
    not_attempted(); // Remove this line when you start.
    (void)map, (void)reach;
    // For now nothing throws a shadow: this is the cosine alone.
    ImageFloat light(points.width(), points.height(), 0);
    for (int y = 0; y < light.height(); ++y)
        for (int x = 0; x < light.width(); ++x) light(x, y) = max(dot(normals(x, y), to_sun), 0.0f);
    return light;
}

} // namespace duet::lab
