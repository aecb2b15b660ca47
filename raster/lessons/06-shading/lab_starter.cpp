// Your shading. The picture shows a sphere, lit by your blinn_phong. For now it has one color.
#include "raster/lessons/06-shading/lab.h"

namespace duet::lab {

float lambert(Vec3 n, Vec3 to_light) {
    not_attempted(); // Remove this line when you start.
    (void)n, (void)to_light;
    // The dot product of two vectors of length 1 is the cosine of their angle. There are normalize and dot.
    return 1;
}

std::optional<Vec3> flat_normal(Vec3 a, Vec3 b, Vec3 c) {
    not_attempted(); // Remove this line when you start.
    (void)a, (void)b, (void)c;
    // Which product of two edges is at right angles to both? In which order must the edges stand?
    return std::nullopt;
}

Vec3 transform_normal(std::array<Vec3, 3> columns, Vec3 n) {
    not_attempted(); // Remove this line when you start.
    (void)columns;
    // The page has a formula of three cross products. What does a map that mirrors need besides?
    return n;
}

Vec3 interpolated_normal(std::array<Vec3, 3> normals, Vec3 weights) {
    not_attempted(); // Remove this line when you start.
    (void)weights;
    return normals[0];
}

Rgb blinn_phong(Vec3 p, Vec3 n, Vec3 light, Vec3 eye, Rgb diffuse, float specular, float shininess) {
    not_attempted(); // Remove this line when you start.
    (void)p, (void)n, (void)light, (void)eye, (void)specular, (void)shininess;
    // Begin with the direction from p to the light source, and use your lambert. Then add the highlight.
    return diffuse;
}

} // namespace duet::lab
