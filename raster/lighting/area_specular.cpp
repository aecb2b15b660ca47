#include "raster/lighting/area_specular.h"

#include "common/light/form_factor.h"
#include "common/material/ggx.h"
#include "common/material/ggx_albedo.h"
#include "raster/lighting/ggx_table.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace duet::raster {
namespace {

/// Maps vectors from a shading point to the space of the clamped cosine. The local frame has its normal on the
/// viewer's side, and the viewer lies in the plane y = 0.
class ToCosine {
public:
    ToCosine(const ShadingPoint& point, float alpha) : point_(point), flip_(point.wo.z < 0 ? -1.0f : 1.0f) {
        const float flat = std::sqrt(sin2_theta(point.wo));
        if (flat > 1e-6f) turn_ = {point.wo.x / flat, point.wo.y / flat};
        lobe_ = ggx_lobe(alpha, std::abs(point.wo.z));
    }
    Vec3 operator()(Vec3 direction) const {
        const Vec3 w = point_.frame.to_local(direction);
        return lobe_.to_cosine({turn_.x * w.x + turn_.y * w.y, turn_.x * w.y - turn_.y * w.x, flip_ * w.z});
    }

private:
    const ShadingPoint& point_;
    float flip_;
    Vec2 turn_{1, 0};
    LobeMatrix lobe_;
};

// Each overload returns π times the form factor of a shape under the transformed cosine.

double form_factor_times_pi(std::span<Vec3> corners, const ToCosine& to_cosine, Vec3 p) {
    for (Vec3& corner : corners) corner = to_cosine(corner - p);
    return polygon_form_factor_times_pi({}, {0, 0, 1}, corners);
}
double form_factor_times_pi(const SurfaceLight::Triangle& t, const ToCosine& to_cosine, Vec3 p) {
    std::array<Vec3, 3> all{t.a, t.b, t.c};
    return form_factor_times_pi(all, to_cosine, p);
}
double form_factor_times_pi(const Quad& quad, const ToCosine& to_cosine, Vec3 p) {
    std::array<Vec3, 4> all = corners(quad);
    return form_factor_times_pi(all, to_cosine, p);
}
/// Returns the greatest root of μ³ − trace μ² + minors μ − determinant, the characteristic polynomial of a
/// matrix whose roots are all real. Newton's method starts from `bound`, an upper bound, and descends monotonically.
double greatest_eigenvalue(double trace, double minors, double determinant, double bound) {
    double mu = bound;
    for (int i = 0; i < 32; ++i) {
        const double value = ((mu - trace) * mu + minors) * mu - determinant,
                     slope = (3 * mu - 2 * trace) * mu + minors;
        if (!(value > 1e-12 * mu * slope)) break;
        mu -= value / slope;
    }
    return mu;
}

/// Returns an eigenvector of a symmetric matrix: the longest cross product of two rows of the matrix minus the
/// eigenvalue, since at most two of its rows are independent. It is not normalized, and 0 where it is not unique.
Vec3d eigenvector(std::array<Vec3d, 3> rows, double eigenvalue) {
    for (std::size_t i = 0; i < 3; ++i) rows[i][i] -= eigenvalue;
    Vec3d longest;
    for (const Vec3d& across : {cross(rows[0], rows[1]), cross(rows[1], rows[2]), cross(rows[2], rows[0])})
        if (dot(across, across) > dot(longest, longest)) longest = across;
    return longest;
}

/// A sphere subtends a cone about the direction d, in which (w·d)² ≥ cos²σ w². In the cosine's space this is an
/// elliptical cone. An eigenvalue and its eigenvector give the form factor and the axis of that cone (Heitz and Hill
/// 2017, "Real-Time Line- and Disk-Light Shading with Linearly Transformed Cosines"; here for the cone itself,
/// without a disk). The horizon clips it as it clips the circular cone of the same axis and form factor (Hill and
/// Heitz 2016, "Real-Time Area Lighting: a Journey from Research to Production").
double form_factor_times_pi(const Sphere& sphere, const ToCosine& to_cosine, Vec3 p) {
    const Vec3 direction = sphere.center - p;
    const double squared = dot(Vec3d(direction), Vec3d(direction));
    const double sine2 = std::min(sqr(static_cast<double>(sphere.radius)) / squared, 1 - 1e-6);
    // The dual cone's matrix B = u uᵀ − sin²σ (a aᵀ + b bᵀ + c cᵀ) has one eigenvalue μ > 0.
    const Vec3d u(to_cosine(direction / static_cast<float>(std::sqrt(squared))));
    const Vec3d a(to_cosine({1, 0, 0})), b(to_cosine({0, 1, 0})), c(to_cosine({0, 0, 1}));
    const auto row = [&](std::size_t i) { return u * u[i] - (a * a[i] + b * b[i] + c * c[i]) * sine2; };
    const std::array<Vec3d, 3> rows{row(0), row(1), row(2)};
    const double trace = rows[0].x + rows[1].y + rows[2].z,
                 determinant = sqr(sine2 * dot(a, cross(b, c))) * (1 - sine2);
    const double minors = rows[0].x * rows[1].y - sqr(rows[0].y) + rows[0].x * rows[2].z - sqr(rows[0].z) +
                          rows[1].y * rows[2].z - sqr(rows[1].z);
    const double mu = greatest_eigenvalue(trace, minors, determinant, dot(u, u));
    Vec3d axis = eigenvector(rows, mu);
    const double size = length(axis);
    if (!(size > 0)) return 0;
    axis = axis * ((dot(axis, u) < 0 ? -1 : 1) / size);
    const double form_factor = 1 / std::sqrt(1 + sqr(mu) * (2 * mu - trace) / determinant);
    return sphere_form_factor_times_pi({}, {0, 0, 1}, Sphere{Vec3(axis), static_cast<float>(std::sqrt(form_factor))});
}

} // namespace

Rgb area_reflection(const SurfaceLight& light, const MetalBsdf& bsdf, const ShadingPoint& point) {
    const SurfacePoint& surface = point.surface;
    if (light.object == surface.object && light.primitive == surface.primitive) return {};
    if (!emits_towards(light, surface.p)) return {};
    const ToCosine to_cosine(point, bsdf.alpha);
    const double part =
        std::visit([&](const auto& shape) { return form_factor_times_pi(shape, to_cosine, surface.p); }, light.shape);
    // The light of multiple scattering is nearly uniform over directions, so it is treated as diffuse.
    const GgxAlbedo single = ggx_albedo(bsdf.alpha, std::abs(point.wo.z));
    const Rgb multiple_scattering =
        bsdf.multiple_scattering * ((1 - single.energy) * ggx_average_albedo(bsdf.alpha).energy_loss);
    return light.radiance * single.albedo(bsdf.reflectance) * static_cast<float>(part / kPiDouble) +
           irradiance(light, point) * multiple_scattering;
}

} // namespace duet::raster
