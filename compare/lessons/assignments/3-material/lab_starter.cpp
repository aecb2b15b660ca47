// Your rough metal. Begin with ggx_distribution: the later functions use it.
#include "compare/lessons/assignments/3-material/lab.h"

namespace duet::lab {

float ggx_distribution(Vec3 m, float alpha) {
    not_attempted(); // Remove this line when you start.
    (void)m, (void)alpha;
    return 1; // Write eq. 33 of the paper with the squares of the cosine and the tangent of m's angle with +z.
}

float smith_lambda(Vec3 w, float alpha) {
    not_attempted(); // Remove this line when you start.
    (void)w, (void)alpha;
    return 0; // Nothing is hidden: right for a mirror alone.
}

std::vector<Rgb> metal_eval(Vec3 wo, const std::vector<Vec3>& wi, float alpha, Rgb f0) {
    not_attempted(); // Remove this line when you start.
    (void)wo, (void)alpha;
    return std::vector<Rgb>(wi.size(), f0 * kInvPi); // a matte surface, for the time being
}

std::vector<Vec3> metal_sample(Vec3 wo, float alpha, const std::vector<Vec2>& random) {
    not_attempted(); // Remove this line when you start.
    (void)alpha;
    return std::vector<Vec3>(random.size(), Vec3{-wo.x, -wo.y, wo.z}); // the mirror direction, always
}

std::vector<float> metal_pdf(Vec3 wo, const std::vector<Vec3>& wi, float alpha) {
    not_attempted(); // Remove this line when you start.
    (void)wo, (void)alpha;
    return std::vector<float>(wi.size(), 1 / (2 * kPi)); // as if all directions were equally likely
}

} // namespace duet::lab
