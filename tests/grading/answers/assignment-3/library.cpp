// The library's microfacets (common/material/ggx.h), which draw visible normals.
#include "common/material/ggx.h"
#include "common/material/microfacet.h"
#include "compare/lessons/assignments/3-material/lab.h"

namespace duet::lab {

float ggx_distribution(Vec3 m, float alpha) { return m.z > 0 ? ggx_d(m, alpha) : 0.0f; }
float smith_lambda(Vec3 w, float alpha) { return ggx_lambda(w, alpha); }

std::vector<Rgb> metal_eval(Vec3 wo, const std::vector<Vec3>& wi, float alpha, Rgb f0) {
    std::vector<Rgb> result;
    for (const Vec3 w : wi) {
        if (wo.z <= 0 || w.z <= 0) {
            result.push_back(Rgb(0));
            continue;
        }
        const Microfacet h = microfacet(wo, w);
        result.push_back(fresnel_schlick(f0, h.cosine) * ggx_reflection(wo, w, h.normal, alpha));
    }
    return result;
}

std::vector<Vec3> metal_sample(Vec3 wo, float alpha, const std::vector<Vec2>& random) {
    std::vector<Vec3> result;
    for (const Vec2 u : random) {
        const Vec3 wi = reflect(wo, ggx_sample_visible_normal(wo, alpha, u));
        result.push_back(wi.z > 0 ? wi : Vec3{0, 0, 0});
    }
    return result;
}

std::vector<float> metal_pdf(Vec3 wo, const std::vector<Vec3>& wi, float alpha) {
    std::vector<float> result;
    for (const Vec3 w : wi) result.push_back(w.z > 0 ? ggx_reflection_pdf(wo, microfacet(wo, w).normal, alpha) : 0.0f);
    return result;
}

} // namespace duet::lab
