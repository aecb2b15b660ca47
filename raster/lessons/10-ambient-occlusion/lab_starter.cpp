// Your ambient occlusion. Write the functions from the top down. You may include the headers of earlier lessons.
#include "raster/lessons/10-ambient-occlusion/lab.h"

namespace duet::lab {

Vec3 hemisphere_direction(Vec3 n, Vec2 u) {
    not_attempted(); // Remove this line when you start.
    (void)u;
    // A point of the disk has an angle and a distance r from the center. For points that are spread evenly, r² is
    // uniform.
    return n;
}

bool is_hidden(const DepthImage& seen, Vec3 q, float bias, float range) {
    not_attempted(); // Remove this line when you start.
    (void)seen, (void)q, (void)bias, (void)range;
    // Multiply by the matrix, look at w first, then divide. y points up in clip space, and rows are counted from the
    // top.
    return false;
}

float occlusion(const DepthImage& seen, Vec3 p, const std::vector<Vec3>& directions, const Search& search) {
    not_attempted(); // Remove this line when you start.
    (void)seen, (void)p, (void)directions, (void)search;
    // A direction counts once, however many of its points are hidden.
    return 0;
}

ImageFloat blur(const ImageFloat& values, const ImageFloat& distance, int reach, float tolerance) {
    not_attempted(); // Remove this line when you start.
    (void)distance, (void)reach, (void)tolerance;
    return values;
}

ImageFloat occlusion_image(const DepthImage& seen, const Image<Vec3>& points, const Image<Vec3>& normals, int count,
                           const Search& search) {
    not_attempted(); // Remove this line when you start.
    (void)seen, (void)count, (void)search;
    // For now what looks down is dark. That is not so bad a guess.
    ImageFloat result(points.width(), points.height(), 0);
    for (int y = 0; y < result.height(); ++y)
        for (int x = 0; x < result.width(); ++x)
            if (length(normals(x, y)) > 0) result(x, y) = 0.5f - 0.5f * normals(x, y).y;
    return result;
}

} // namespace duet::lab
