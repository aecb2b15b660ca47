// Sampling lights that are slivers, far away, near or edge-on.
#include "common/light/solid_angle.h"
#include "common/light/spherical_triangle.h"
#include "compare/stress/errors.h"
#include "compare/stress/odds.h"
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

/// Of size 1, as thin as 1e-5 of it.
Flat random_flat(TrialRandom& random) {
    const Vec3 a = random.vector(), along = random.direction();
    const Vec3 across = along * random.uniform() + random.direction() * random.magnitude(1e-5f, 1);
    return random.coin() ? Flat(Triangle{a, a + along, a + across}) : Flat(Quad{a, along, across});
}

/// Beside or before it, 0.01 to 1e4 away.
Vec3 viewpoint(TrialRandom& random) { return random.direction() * random.magnitude(1e-2f, 1e4f); }

/// |tan(Ω/2)| by Van Oosterom and Strackee 1983, eq. 8, from the corners themselves in long double: no vector is
/// rounded to unit length.
long double exact_solid_angle(Vec3d p, Vec3d a, Vec3d b, Vec3d c) {
    using Wide = Vec3T<long double>;
    const Wide o(p), x = Wide(a) - o, y = Wide(b) - o, z = Wide(c) - o;
    const long double nx = length(x), ny = length(y), nz = length(z);
    const long double volume = std::abs(dot(x, cross(Wide(b) - Wide(a), Wide(c) - Wide(a))));
    return 2 * std::atan2(volume, nx * ny * nz + dot(x, y) * nz + dot(y, z) * nx + dot(z, x) * ny);
}

StressResult solid_angles(const StressTest& test, const StressSetting& setting) {
    return run_trials(test, setting, [](Trial& trial) {
        const auto corners = corners_of(random_flat(trial.random));
        const Vec3d p(viewpoint(trial.random));
        const SphericalTriangle t{normalize(corners[0] - p), normalize(corners[1] - p), normalize(corners[2] - p)};
        const long double truth = exact_solid_angle(p, corners[0], corners[1], corners[2]);
        // A corner that is off by 2^-53 moves the area by that times the longest side; more, where two are nearly
        // opposite and the great circle through them turns.
        const double longest = std::max({length(t.b - t.a), length(t.c - t.b), length(t.a - t.c)});
        const double side = longest / std::min({1.0, length(t.a + t.b), length(t.b + t.c), length(t.c + t.a)});
        const auto error = [&](double angle) {
            return static_cast<double>(std::abs(static_cast<long double>(angle) - truth)) / (side * 0x1p-53);
        };
        const auto angle_at = [](Vec3d a, Vec3d b, Vec3d c) {
            const Vec3d ab = cross(a, b), ac = cross(a, c);
            return std::acos(dot(ab, ac) / (length(ab) * length(ac)));
        };
        trial.note("corners ", exact(Vec3(corners[0])), ", ", exact(Vec3(corners[1])), ", ", exact(Vec3(corners[2])),
                   " seen from ", exact(Vec3(p)));
        trial.careful(error(t.solid_angle()));
        trial.naive(error(angle_at(t.a, t.b, t.c) + angle_at(t.b, t.c, t.a) + angle_at(t.c, t.a, t.b) - kPiDouble));
    });
}

/// How far a point is from the shape, its plane and its edges, as seen from p.
double off_shape(const Flat& flat, Vec3d p, Vec3d q) {
    const auto c = corners_of(flat);
    const Vec3d n = normalize(cross(c[1] - c[0], c[2] - c[0]));
    double off = std::abs(dot(n, q - c[0]));
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec3d edge = c[(i + 1) % 4] - c[i];
        if (length(edge) > 0) off = std::max(off, -dot(cross(n, edge), q - c[i]) / length(edge));
    }
    return off / length(q - p);
}

StressResult samples(const StressTest& test, const StressSetting& setting) {
    return run_trials(test, setting, [](Trial& trial) {
        const Flat flat = random_flat(trial.random);
        const Vec3d p(viewpoint(trial.random));
        const Vec2d u(trial.random.uniform_2d());
        const auto s = std::visit([&](const auto& shape) { return sample_solid_angle(shape, p, u); }, flat);
        if (!s) return; // seen edge-on
        const Vec3d q = p + s->wi * s->distance;
        const double pdf = std::visit([&](const auto& shape) { return solid_angle_pdf(shape, p, q); }, flat);
        const auto corners = corners_of(flat);
        trial.note(flat.index() == 0 ? "triangle " : "quad ", exact(Vec3(corners[0])), ", ", exact(Vec3(corners[1])),
                   ", ", exact(Vec3(corners[2])), " seen from ", exact(Vec3(p)), ", u = (", u.x, ", ", u.y, "): pdf ",
                   s->pdf, " and ", pdf);
        if (!(s->pdf > 0) || !std::isfinite(s->pdf)) return trial.careful(std::numeric_limits<double>::infinity());
        trial.careful(relative_error(s->pdf, pdf));
        trial.careful(off_shape(flat, p, q));
        trial.careful(std::abs(length(s->wi) - 1));
    });
}

/// The mean of 1/pdf is the solid angle.
StressResult densities(const StressTest& test, const StressSetting& setting) {
    return run_trials(test, setting, [](Trial& trial) {
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
        if (error > 0.05 * truth) return; // too slanted for its mean to be normally distributed
        trial.note("solid angle ", truth, ", estimated ", mean, " ± ", error);
        trial.careful(family_odds(two_sided_p(std::abs(mean - truth) / error), trial.count()));
    });
}

StressResult far_spheres(const StressTest& test, const StressSetting& setting) {
    return run_trials(test, setting, [](Trial& trial) {
        TrialRandom& random = trial.random;
        const Sphere sphere{random.vector(), random.magnitude(1e-3f, 1)};
        const Vec3 p = sphere.center + random.direction() * (sphere.radius * random.magnitude(1.001f, 1e6f));
        using Wide = Vec3T<long double>;
        const long double d2 = length_squared(Wide(sphere.center) - Wide(p));
        const long double r2 = sqr(static_cast<long double>(sphere.radius));
        if (d2 <= r2 * 1.001L) return;
        const long double sin2 = r2 / d2, gap = sin2 / (1 + std::sqrt(1 - sin2));
        const auto truth = static_cast<double>(1 / (2 * static_cast<long double>(kPiDouble) * gap));
        const auto s = sample_solid_angle(sphere, Vec3d(p), Vec2d(random.uniform_2d()));
        trial.note("radius ", exact(sphere.radius), " at ", exact(sphere.center), " from ", exact(p));
        if (!s) return trial.careful(std::numeric_limits<double>::infinity());
        trial.careful(relative_error(s->pdf, truth));
        trial.careful(relative_error(solid_angle_pdf(sphere, Vec3d(p), Vec3d(sphere.center)), truth));
        // The point lies on the sphere, as exactly as its distance allows.
        const double off =
            length(Vec3d(p) + s->wi * s->distance - Vec3d(sphere.center)) - std::sqrt(static_cast<double>(r2));
        trial.careful(std::abs(off) / s->distance);
        const Vec3 w = sphere.center - p;
        const float cosine = std::sqrt(1 - sphere.radius * sphere.radius / length_squared(w));
        trial.naive(relative_error(static_cast<double>(1 / (2 * kPi * (1 - cosine))), truth));
    });
}

constexpr StressTest kTests[] = {
    {"light/solid-angles", "solid angles of triangles, as thin as 1e-5, 0.01 to 1e4 away", 1000, "2^-53 of its side",
     "10 roundings, times up to 100 where it is seen nearly edge-on; judged by long double", "the angles' sum - π",
     500'000, solid_angles},
    {"light/samples", "samples of such triangles and quads lie on them and have the density that is asked for", 1e-6,
     "relative", "sampling by solid angle begins at 1e-4, where 2^-53 and a cosine of Arvo's leave 1e-8", "", 500'000,
     samples},
    {"light/densities", "the mean of 1/pdf is the solid angle", 6, "-log10 odds",
     "odds of a false alarm 1e-6 for the row (Šidák 1967); judged by long double", "", 1'000, densities},
    {"light/far-spheres", "density and samples of spheres 1.001 to 1e6 radii away", 1e-9, "relative",
     "roundings of double, and at the limb the root of a difference; judged by long double",
     "1 - sqrt(1 - r²/d²) in float", 500'000, far_spheres},
};

} // namespace

std::span<const StressTest> light_tests() { return kTests; }

} // namespace duet::compare
