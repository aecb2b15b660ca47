// Rough metal by Walter et al. 2007, sampled by its distribution of normals.
#include "compare/lessons/assignments/3-material/lab.h"

namespace duet::lab {

float ggx_distribution(Vec3 m, float alpha) {
    if (m.z <= 0) return 0;
    const float a2 = alpha * alpha;
    const float cos2 = m.z * m.z;
    const float tan2 = (1 - cos2) / cos2;
    return a2 / (kPi * cos2 * cos2 * (a2 + tan2) * (a2 + tan2));
}

float smith_lambda(Vec3 w, float alpha) {
    const float tan2 = (w.x * w.x + w.y * w.y) / (w.z * w.z);
    return (std::sqrt(1 + alpha * alpha * tan2) - 1) / 2;
}

std::vector<Rgb> metal_eval(Vec3 wo, const std::vector<Vec3>& wi, float alpha, Rgb f0) {
    std::vector<Rgb> result;
    for (const Vec3 w : wi) {
        if (wo.z <= 0 || w.z <= 0) {
            result.push_back(Rgb(0));
            continue;
        }
        const Vec3 m = normalize(wo + w);
        const Rgb fresnel = f0 + (Rgb(1) - f0) * std::pow(1 - dot(wo, m), 5.0f);
        const float g2 = 1 / (1 + smith_lambda(wo, alpha) + smith_lambda(w, alpha));
        result.push_back(fresnel * (ggx_distribution(m, alpha) * g2 / (4 * wo.z * w.z)));
    }
    return result;
}

std::vector<Vec3> metal_sample(Vec3 wo, float alpha, const std::vector<Vec2>& random) {
    std::vector<Vec3> result;
    for (const Vec2 u : random) {
        const float tan2 = alpha * alpha * u.x / (1 - u.x);
        const float cosine = 1 / std::sqrt(1 + tan2);
        const float sine = std::sqrt(tan2) * cosine;
        const float phi = 2 * kPi * u.y;
        const Vec3 m{sine * std::cos(phi), sine * std::sin(phi), cosine};
        const Vec3 wi = m * (2 * dot(wo, m)) - wo;
        result.push_back(wi.z > 0 && dot(wo, m) > 0 ? wi : Vec3{0, 0, 0});
    }
    return result;
}

std::vector<float> metal_pdf(Vec3 wo, const std::vector<Vec3>& wi, float alpha) {
    std::vector<float> result;
    for (const Vec3 w : wi) {
        if (w.z <= 0) {
            result.push_back(0);
            continue;
        }
        const Vec3 m = normalize(wo + w);
        result.push_back(ggx_distribution(m, alpha) * m.z / (4 * dot(wo, m)));
    }
    return result;
}

} // namespace duet::lab
