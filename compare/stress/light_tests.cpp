// These tests sample lights that are slivers, far away, near or edge-on.
#include "common/light/light.h"
#include "compare/stress/errors.h"
#include "compare/stress/log_p_value.h"
#include "compare/stress/trials.h"

#include <algorithm>
#include <array>
#include <variant>

namespace duet::compare {

namespace {

using Triangle = SurfaceLight::Triangle;
using Flat = std::variant<Triangle, Quad>;

std::array<Vec3d, 4> corners_of(const Flat& flat) {
    if (const auto* t = std::get_if<Triangle>(&flat)) return {Vec3d(t->a), Vec3d(t->b), Vec3d(t->c), Vec3d(t->c)};
    const Quad& q = std::get<Quad>(flat);
    const Vec3d corner(q.corner), u(q.u), v(q.v);
    return {corner, corner + u, corner + u + v, corner + v};
}

/// Returns a shape of size 1, as thin as 1e-5.
Flat random_flat(TrialRandom& random) {
    const Vec3 a = random.vector(), along = random.direction();
    const Vec3 across = along * random.uniform() + random.direction() * random.log_uniform(1e-5f, 1);
    return random.coin() ? Flat(Triangle{a, a + along, a + across}) : Flat(Quad{a, along, across});
}

/// Returns a viewpoint in a random direction, 0.01 to 1e4 away.
Vec3 viewpoint(TrialRandom& random) { return random.direction() * random.log_uniform(1e-2f, 1e4f); }

/// Returns the solid angle Ω from |tan(Ω/2)| (Van Oosterom and Strackee 1983, eq. 8). It uses the corners themselves
/// in long double, so no vector is rounded to unit length.
long double exact_solid_angle(Vec3d p, Vec3d a, Vec3d b, Vec3d c) {
    using Wide = Vec3T<long double>;
    const Wide o(p), x = Wide(a) - o, y = Wide(b) - o, z = Wide(c) - o;
    const long double nx = length(x), ny = length(y), nz = length(z);
    const long double volume = std::abs(dot(x, cross(Wide(b) - Wide(a), Wide(c) - Wide(a))));
    return 2 * std::atan2(volume, nx * ny * nz + dot(x, y) * nz + dot(y, z) * nx + dot(z, x) * ny);
}

/// Returns the distance of a point q from the shape, its plane and its edges, relative to the distance of q from p.
double off_shape(const Flat& flat, Vec3d p, Vec3d q) {
    using Wide = Vec3T<long double>; // the normal of a sliver is a difference that cancels
    const auto c = corners_of(flat);
    const Wide n = normalize(cross(Wide(c[1]) - Wide(c[0]), Wide(c[2]) - Wide(c[0]))), at(q);
    long double off = std::abs(dot(n, at - Wide(c[0])));
    for (std::size_t i = 0; i < 4; ++i) {
        const Wide edge = Wide(c[(i + 1) % 4]) - Wide(c[i]);
        if (length(edge) > 0) off = std::max(off, -dot(cross(n, edge), at - Wide(c[i])) / length(edge));
    }
    return static_cast<double>(off) / length(q - p);
}

/// Returns |cos| of the angle between the shape's normal and wi.
double slant(const std::array<Vec3d, 4>& corners, Vec3d wi) {
    return std::abs(dot(normalize(cross(corners[1] - corners[0], corners[2] - corners[0])), wi));
}

void samples(Trial& trial) {
    const Flat flat = random_flat(trial.random);
    const Vec3d p(viewpoint(trial.random));
    const Vec2d u(trial.random.uniform_2d());
    const auto s = std::visit([&](const auto& shape) { return sample_solid_angle(shape, p, u); }, flat);
    if (!s) return; // edge-on
    const Vec3d q = p + s->wi * s->distance;
    const auto pdf_of = [&](Vec3d at) {
        return std::visit([&](const auto& shape) { return solid_angle_pdf(shape, p, at); }, flat);
    };
    const double pdf = pdf_of(q);
    const auto corners = corners_of(flat);
    trial.note(flat.index() == 0 ? "triangle " : "quad ", exact(Vec3(corners[0])), ", ", exact(Vec3(corners[1])), ", ",
               exact(Vec3(corners[2])), " seen from ", exact(Vec3(p)), ", u = (", u.x, ", ", u.y, "): pdf ", s->pdf,
               " and ", pdf);
    if (!(s->pdf > 0) || !std::isfinite(s->pdf)) return trial.record(std::numeric_limits<double>::infinity());
    const double place = 1 + length(q) / s->distance;       // the test itself rounds q
    const double terms = place + 1 / slant(corners, s->wi); // an error of wi moves the point by this factor
    trial.record(in_double_roundoffs(relative_error(s->pdf, pdf)) / place);
    trial.record(in_double_roundoffs(off_shape(flat, p, q)) / terms);
    trial.record(in_double_roundoffs(length(s->wi) - 1));
}

/// Tests that the mean of 1/pdf is the solid angle.
void densities(Trial& trial) {
    TrialRandom& random = trial.random;
    const Flat flat = random_flat(random);
    const Vec3d p(viewpoint(random));
    const auto c = corners_of(flat);
    const auto truth =
        static_cast<double>(exact_solid_angle(p, c[0], c[1], c[2]) + exact_solid_angle(p, c[0], c[2], c[3]));
    constexpr int kSamples = 2'000;
    double mean = 0, square = 0;
    for (int i = 0; i < kSamples; ++i) {
        const Vec2d u(random.uniform_2d());
        const auto s = std::visit([&](const auto& shape) { return sample_solid_angle(shape, p, u); }, flat);
        const double value = s ? 1 / s->pdf : 0;
        mean += value / kSamples, square += value * value / kSamples;
    }
    if (mean == 0) return; // edge-on
    const double error = std::sqrt(std::max(0.0, square - mean * mean) / kSamples) + 1e-6 * truth;
    if (error > 0.05 * truth) return; // too slanted for a normally distributed mean
    trial.note("solid angle ", truth, ", estimated ", mean, " ± ", error);
    trial.record(family_log_p_value(two_sided_p(std::abs(mean - truth) / error), trial.count()));
}

void far_spheres(Trial& trial) {
    TrialRandom& random = trial.random;
    const Sphere sphere{random.vector(), random.log_uniform(1e-3f, 1)};
    const Vec3 p = sphere.center + random.direction() * (sphere.radius * random.log_uniform(1.001f, 1e6f));
    using Wide = Vec3T<long double>;
    const long double d2 = length_squared(Wide(sphere.center) - Wide(p));
    const long double r2 = sqr(static_cast<long double>(sphere.radius));
    if (d2 <= r2 * 1.001L) return;
    const long double sin2 = r2 / d2, gap = sin2 / (1 + std::sqrt(1 - sin2));
    const auto truth = static_cast<double>(1 / (2 * static_cast<long double>(kPiDouble) * gap));
    // A rounding error of sin² changes the density by the same relative error. At the limb, the error of √(1 − sin²) is
    // larger.
    const auto terms = static_cast<double>(1 + sin2 / std::sqrt(1 - sin2));
    const auto density_error = [&](double pdf) { return in_double_roundoffs(relative_error(pdf, truth)) / terms; };
    const auto s = sample_solid_angle(sphere, Vec3d(p), Vec2d(random.uniform_2d()));
    trial.note("radius ", exact(sphere.radius), " at ", exact(sphere.center), " from ", exact(p));
    if (!s) return trial.record(std::numeric_limits<double>::infinity());
    trial.record(density_error(s->pdf));
    trial.record(density_error(solid_angle_pdf(sphere, Vec3d(p), Vec3d(sphere.center))));
    // The point is on the sphere, up to the rounding of the center's distance.
    const double off =
        length(Vec3d(p) - Vec3d(sphere.center) + s->wi * s->distance) - static_cast<double>(sphere.radius);
    trial.record(in_double_roundoffs(off) / std::sqrt(static_cast<double>(d2)));
    const Vec3 w = sphere.center - p;
    const float cosine = std::sqrt(1 - sphere.radius * sphere.radius / length_squared(w));
    trial.record_naive(density_error(static_cast<double>(1 / (2 * kPi * (1 - cosine)))));
}

constexpr StressTest kTests[] = {
    {"light/samples",
     "samples of triangles and quads, as thin as 1e-5, 0.01 to 1e4 away, lie on them and have the density that is "
     "requested",
     17, "2^-53 of its terms", "17 roundings: 14 of both densities d³/(A·w), 3 of the point", "", 500'000,
     trials_of<samples>},
    {"light/densities", "the mean of 1/pdf is the solid angle", 6, "-log10 odds",
     "odds of a false alarm 1e-6 for the row (Šidák 1967); judged by long double", "", 1'000, trials_of<densities>},
    {"light/far-spheres", "density and samples of spheres 1.001 to 1e6 radii away", 10, "2^-53 of its terms",
     "10 roundings of r²/d², 1 - cos and what is made of it; at the limb √(1 - r²/d²) divides; judged by long double",
     "1 - sqrt(1 - r²/d²) in float", 500'000, trials_of<far_spheres>},
};

} // namespace

std::span<const StressTest> light_tests() { return kTests; }

} // namespace duet::compare
