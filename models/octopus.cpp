// This file generates octopus.obj: an octopus on the ground, with one arm wound around a ball. It is an implicit
// surface, polygonized to about 200,000 triangles (or a hundred thousand, or a million). octopus-fine.obj has lids and
// a finer skin. The scene places the eyes and the ball by the constants of octopus.h.
#include "models/octopus.h"

#include "models/distance_field.h"
#include "models/implicit.h"
#include "models/profile.h"

namespace duet::models {
namespace {

constexpr int kSteps = 160; ///< spheres per arm

struct Sucker {
    Vec3d center, outwards;
    double radius;
};

/// Describes the course of an arm: it descends from the head to the ground, winds along it, and curls its tip.
struct ArmPlan {
    double azimuth_degrees; ///< direction in which the arm leaves the head; 0 = +x, 90 = +z, the front
    double length;
    double sway, phase; ///< amplitude (radians) and phase of the arm's bends along the ground
    double curl;        ///< turns of the tip, signed: counter-clockwise seen from above
    double uprightness; ///< upward fraction of the curl: 0 is flat, 1 is upright
};

constexpr ArmPlan kArms[] = {
    {-8, 2.5, 0.8, 0.05, 1.5, 0.0},   {95, 2.2, 0.8, 0.55, -1.5, 0.0}, {142, 2.5, 0.7, 0.3, 1.4, 0.3},
    {184, 2.6, 0.8, 0.85, -1.6, 0.0}, {228, 2.4, 0.8, 0.2, -1.4, 0.0}, {272, 2.4, 0.6, 0.65, 1.4, 0.0},
    {312, 2.6, 0.8, 0.45, -1.3, 0.4},
};

double arm_radius(double s) { return 0.014 + 0.131 * std::pow(1 - s, 1.05); }

/// An Arm has two rows of suckers along the underside.
struct Arm {
    std::vector<LimbSphere> spheres;
    std::vector<Sucker> suckers;
};

/// Transports a frame along the spheres without twist and places suckers in two rows about the preferred direction
/// `underside(i)`.
template <typename Underside> void add_suckers(Arm& arm, const Underside& underside) {
    double traveled = 0, next = 0.3;
    for (std::size_t i = 1; i + 1 < arm.spheres.size(); ++i) {
        traveled += length(arm.spheres[i].center - arm.spheres[i - 1].center);
        const double r = arm.spheres[i].radius;
        if (traveled < next || r < 0.042) continue;
        const Vec3d tangent = normalize(arm.spheres[i + 1].center - arm.spheres[i - 1].center);
        const Vec3d preferred = underside(i);
        const Vec3d down = normalize(preferred - tangent * dot(preferred, tangent)), side = cross(tangent, down);
        const double size = 0.42 * r;
        for (const double sign : {-1.0, 1.0}) {
            const Vec3d outwards = normalize(down * 0.86 + side * (sign * 0.5));
            arm.suckers.push_back(
                {arm.spheres[i].center + outwards * (0.93 * r) + tangent * (sign * 0.25 * size), outwards, size});
        }
        next = traveled + 2.15 * size;
    }
}

Arm ground_arm(const ArmPlan& plan) {
    Arm arm;
    const double azimuth0 = radians(plan.azimuth_degrees);
    const double step = plan.length / kSteps;
    Vec3d p(0.16 * std::cos(azimuth0), 0.40, 0.16 * std::sin(azimuth0));
    double curled = 0, elevation = -0.5;
    std::vector<Vec3d> undersides;
    for (int i = 0; i <= kSteps; ++i) {
        const double s = static_cast<double>(i) / kSteps, r = arm_radius(s);
        arm.spheres.push_back({p, r});
        const double tip = smooth_step(0.45, 1.0, s);
        curled += plan.curl * 2 * kPiDouble * tip * tip * 2.6 / kSteps;
        const double sway = plan.sway * std::sin(2 * kPiDouble * (1.1 * s + plan.phase)) * smooth_step(0.1, 0.4, s);
        const double azimuth = azimuth0 + sway + curled * (1 - plan.uprightness);
        const double landing = -std::atan(5 * (p.y - 0.97 * r)); // steers the arm onto the ground
        elevation = lerp(elevation, clamp(landing, -1.0, 0.6), 0.12);
        const double rise = elevation * (1 - plan.uprightness * tip) + std::abs(curled) * plan.uprightness;
        const Vec3d ahead(std::cos(azimuth) * std::cos(rise), std::sin(rise), std::sin(azimuth) * std::cos(rise));
        // Suckers face the ground. Along the tip they face the inside of its curl or, where it is upright, upward and
        // back.
        const double turn = plan.curl > 0 ? 1 : -1;
        const Vec3d inwards = Vec3d(-std::sin(azimuth), 0, std::cos(azimuth)) * turn;
        const Vec3d standing(-std::cos(azimuth) * std::sin(rise), std::cos(rise), -std::sin(azimuth) * std::sin(rise));
        const double toward_tip = smooth_step(0.12, 0.45, s);
        undersides.push_back(
            lerp(Vec3d(0, -1, 0), lerp(inwards * 0.9 + Vec3d(0, 0.35, 0), standing, plan.uprightness), toward_tip) +
            ahead * 0.01);
        p += ahead * step;
        p.y = max(p.y, 0.97 * arm_radius(min(s + 1.0 / kSteps, 1.0)));
    }
    add_suckers(arm, [&](std::size_t i) { return undersides[i]; });
    return arm;
}

/// Returns a point on the uniform Catmull-Rom spline through the points; t in [0, 1] runs from the second to the last
/// but one.
Vec3d spline(std::span<const Vec3d> points, double t) {
    const double x = t * static_cast<double>(points.size() - 3);
    const auto i = std::min(static_cast<std::size_t>(x), points.size() - 4);
    return catmull_rom(points[i], points[i + 1], points[i + 2], points[i + 3], x - static_cast<double>(i));
}

/// Returns the arm that extends to the ball and winds around it, from below upward.
Arm holding_arm() {
    std::vector<Vec3d> path{{0.05, 0.55, -0.02}, {0.15, 0.42, 0.07}, {0.36, 0.25, 0.21}, {0.66, 0.17, 0.35}};
    constexpr int kTurnSteps = 14;
    for (int i = 0; i <= kTurnSteps; ++i) {
        const double f = static_cast<double>(i) / kTurnSteps;
        const double azimuth = radians(lerp(-44.0, 404.0, f)), latitude = radians(lerp(-36.0, 44.0, std::pow(f, 1.2)));
        const double distance = kBallRadius + arm_radius(lerp(0.3, 1.0, f)) * 0.97;
        path.push_back(kBallCenter + Vec3d(std::cos(latitude) * std::cos(azimuth), std::sin(latitude),
                                           std::cos(latitude) * std::sin(azimuth)) *
                                         distance);
    }
    path.push_back(path.back() * 2.0 - path[path.size() - 2]);
    Arm arm;
    for (int i = 0; i <= kSteps; ++i) {
        const double s = static_cast<double>(i) / kSteps;
        arm.spheres.push_back({spline(path, s), arm_radius(s)});
    }
    add_suckers(arm, [&](std::size_t i) {
        const double s = static_cast<double>(i) / kSteps;
        return lerp(Vec3d(0, -1, 0), normalize(kBallCenter - arm.spheres[i].center), smooth_step(0.1, 0.3, s)) +
               Vec3d(0.001, 0, 0);
    });
    return arm;
}

/// Selects the eyes and the skin.
enum class Look {
    kPlain, ///< eyes on the skin
    kFine,  ///< eyes within lids, and small warts that only a fine mesh shows
};

class Octopus {
public:
    explicit Octopus(Look look) : look_(look) {
        for (const ArmPlan& plan : kArms) add(ground_arm(plan));
        add(holding_arm());
    }

    double value(Vec3d p) const {
        // Limbs blend together near the head and stay separate farther out.
        const double from_head = length(Vec3d(p.x, 0.6 * (p.y - 0.45), p.z));
        const double k = lerp(0.16, 0.02, smooth_step(0.25, 0.75, from_head));
        double d = body(p);
        const double far = d + 0.3;
        for (const ArmShape& arm : arms_) {
            const double reach = arm.limb.distance(p, max(d, 0.0) + 0.35);
            d = smooth_min(d, with_suckers(p, reach, arm), k);
        }
        d = min(d, far);
        const Vec3d from_eye = Vec3d(std::abs(p.x), p.y, p.z) - Vec3d(kEyeX, kEyeY, kEyeZ);
        const double eye = length(from_eye) - kEyeRadius;
        if (std::abs(d) < 0.15) d -= skin(p) * smooth_step(0.0, 0.12, eye);
        if (look_ == Look::kFine) return with_lids(d, from_eye);
        return smooth_max(d, -eye, 0.05);
    }

    static constexpr Vec3d kLow{-2.3, -0.2, -2.3}, kHigh{2.3, 2.2, 2.3};

private:
    struct ArmShape {
        Limb limb;
        std::vector<Sucker> suckers;
    };
    void add(Arm arm) { arms_.push_back({Limb(std::move(arm.spheres)), std::move(arm.suckers)}); }

    /// Returns the distance to mantle, head and brows.
    static double body(Vec3d p) {
        static const Limb mantle(mantle_spheres());
        double d = mantle.distance(p, 10);
        d = smooth_min(d, round_cone_distance(p, {{0, 0.36, 0.0}, 0.27}, {{0, 0.62, 0.04}, 0.25}), 0.15);
        const Vec3d q(std::abs(p.x), p.y, p.z); // mirror symmetry
        return smooth_min(d, length(q - Vec3d(kEyeX - 0.10, kEyeY - 0.01, kEyeZ - 0.07)) - kEyeRadius * 1.5, 0.08);
    }

    static std::vector<LimbSphere> mantle_spheres() {
        // The mantle leans back over the arms. The radii follow a spline of their own.
        const Vec3d path[] = {{0, 0.4, 0.1},    {0, 0.62, 0.03},  {0, 0.85, -0.08}, {0, 1.10, -0.30},
                              {0, 1.22, -0.62}, {0, 1.14, -0.95}, {0, 1.02, -1.16}, {0, 0.95, -1.3}};
        const Vec3d radii[] = {{0.2, 0, 0},  {0.24, 0, 0}, {0.27, 0, 0}, {0.39, 0, 0},
                               {0.44, 0, 0}, {0.31, 0, 0}, {0.12, 0, 0}, {0.0, 0, 0}};
        std::vector<LimbSphere> spheres;
        for (int i = 0; i <= 40; ++i) spheres.push_back({spline(path, i / 40.0), spline(radii, i / 40.0).x});
        return spheres;
    }

    static double with_suckers(Vec3d p, double arm, const ArmShape& arm_shape) {
        if (arm > 0.1) return arm;
        double d = arm;
        for (const Sucker& sucker : arm_shape.suckers) {
            const Vec3d away = p - sucker.center;
            if (length_squared(away) > sqr(sucker.radius + 0.1)) continue;
            // A sucker is a flattened sphere with a hollow in its face.
            const double height = dot(away, sucker.outwards);
            const double flat = length(away + sucker.outwards * (height * 0.5)) - sucker.radius;
            const double cup = length(away - sucker.outwards * (sucker.radius * 1.0)) - sucker.radius * 0.72;
            d = smooth_min(d, flat, 0.4 * sucker.radius);
            d = smooth_max(d, -cup, 0.4 * sucker.radius);
        }
        return d;
    }

    /// Adds a lid around the eye, with an opening in the direction of gaze: a slot with round ends.
    static double with_lids(double d, Vec3d from_eye) {
        const Vec3d ahead = normalize(kEyeGaze), across = normalize(cross(Vec3d(0, 1, 0), ahead));
        const double x = max(std::abs(dot(from_eye, across)) - 0.35 * kEyeRadius, 0.0);
        const double y = dot(from_eye, cross(ahead, across)), z = dot(from_eye, ahead);
        const double slot = max(std::sqrt(x * x + y * y) - (0.3 * kEyeRadius + 0.35 * max(z - 0.8 * kEyeRadius, 0.0)),
                                -z);
        d = smooth_min(d, length(from_eye) - 1.22 * kEyeRadius, 0.07);
        return smooth_max(d, -slot, 0.025);
    }

    /// Returns the height of the skin's wrinkles and warts.
    double skin(Vec3d p) const {
        const double upper = smooth_step(0.5, 0.8, p.y);
        const double folds = gradient_noise(p * 5.0) * 0.012;
        const double warts = max(gradient_noise(p * 16.0 + Vec3d(7, 3, 5)) - 0.1, 0.0) * 0.022;
        if (look_ == Look::kPlain) return upper * (folds + warts);
        const double small = max(gradient_noise(p * 42.0 + Vec3d(3, 8, 1)) - 0.05, 0.0) * 0.009;
        return upper * (folds + warts) + smooth_step(0.1, 0.6, p.y) * small;
    }

    Look look_;
    std::vector<ArmShape> arms_;
};

void write_octopus_mesh(const std::filesystem::path& path, double cell, Look look = Look::kPlain) {
    const Octopus octopus(look);
    const Implicit surface{[&](Vec3d p) { return octopus.value(p); }, Octopus::kLow, Octopus::kHigh};
    write_obj(path, polygonize(surface, cell), "An octopus, made by models/octopus.cpp.");
}

} // namespace

void write_octopus(const std::filesystem::path& folder) { write_octopus_mesh(folder / kOctopusFile, 0.029); }
void write_octopus_hundred_thousand(const std::filesystem::path& folder) {
    write_octopus_mesh(folder / kOctopusSmallFile, 0.0416);
}
void write_octopus_million(const std::filesystem::path& folder) {
    write_octopus_mesh(folder / kOctopusMillionFile, 0.013);
}
void write_octopus_fine(const std::filesystem::path& folder) {
    write_octopus_mesh(folder / kOctopusFineFile, 0.0125, Look::kFine);
}

} // namespace duet::models
