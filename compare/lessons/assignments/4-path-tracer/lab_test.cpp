// The examiner of assignment 4. Scenes have answers in closed form where there are any: the irradiance of a polygon
// (Lambert 1760), and the room whose walls all shine alike. Where there is none, the three strategies judge each other.
#include "compare/lessons/assignments/4-path-tracer/scenes.h"
#include "tests/grading/judge.h"

#include <algorithm>
#include <array>
#include <cmath>

using namespace duet;
using namespace duet::grading;
using lab::Strategy;

LAB_TITLE("assignment-4", "A path tracer with multiple importance sampling")

namespace {

constexpr std::array<Strategy, 3> kStrategies{Strategy::kBsdf, Strategy::kLight, Strategy::kMis};
const char* name(Strategy s) { return s == Strategy::kBsdf ? "kBsdf" : s == Strategy::kLight ? "kLight" : "kMis"; }

/// The irradiance at p, with normal n, under a polygon of radiance 1 that lies above the horizon (Lambert's formula).
double polygon_irradiance(const std::array<Vec3d, 4>& corners, Vec3d p, Vec3d n) {
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec3d a = normalize(corners[i] - p), b = normalize(corners[(i + 1) % 4] - p), axis = cross(a, b);
        sum += std::acos(std::clamp(dot(a, b), -1.0, 1.0)) * dot(normalize(axis), n);
    }
    return std::abs(sum) / 2;
}
double irradiance(const Quad& q, Vec3 p, Vec3 n) {
    const Vec3d c(q.corner), u(q.u), v(q.v);
    return polygon_irradiance({c, c + u, c + u + v, c + v}, Vec3d(p), Vec3d(n));
}

/// The solid angle of a quad from p: that of two triangles. (Van Oosterom and Strackee 1983)
double solid_angle(const Quad& q, Vec3 p) {
    const auto toward = [&](Vec3 corner) { return normalize(Vec3d(corner) - Vec3d(p)); };
    const Vec3d a = toward(q.corner), b = toward(q.corner + q.u), c = toward(q.corner + q.u + q.v),
                d = toward(q.corner + q.v);
    const auto triangle = [](Vec3d x, Vec3d y, Vec3d z) {
        return 2 * std::atan2(std::abs(dot(x, cross(y, z))), 1 + dot(x, y) + dot(y, z) + dot(z, x));
    };
    return triangle(a, b, c) + triangle(a, c, d);
}

double mean(const std::vector<Rgb>& values) {
    double sum = 0;
    for (const Rgb& value : values) sum += average(value);
    return sum / static_cast<double>(values.size());
}

/// Rays that all look straight down at the point p of the floor, so that the mean over them has many samples.
std::vector<Ray> down_at(Vec3 p, std::size_t n) { return std::vector<Ray>(n, Ray{p + Vec3{0, 0.5f, 0}, {0, -1, 0}}); }

/// Mean and standard error of the mean over 40 calls' values.
struct Estimate {
    double mean, error;
};
Estimate estimate(const Scene& scene, Vec3 p, int samples, int bounces, Strategy strategy, std::uint32_t seed) {
    const auto values = STUDENT(radiance)(scene, down_at(p, 40), samples, bounces, strategy, seed);
    const double m = mean(values);
    double variance = 0;
    for (const Rgb& value : values) variance += std::pow(average(value) - m, 2);
    return {m, std::sqrt(variance / 39 / 40)};
}
/// Six standard errors, and a thousandth for rounding: a right answer fails once in two million runs (Student's t of 39
/// degrees of freedom).
bool agrees(Estimate e, double expected) { return std::abs(e.mean - expected) <= 6 * e.error + 1e-3 * expected + 1e-6; }
std::uint32_t seed_of(Item& item) { return static_cast<std::uint32_t>(item.random().bits() >> 32); }
float draw(Item& item, double low, double high) { return static_cast<float>(item.random().uniform(low, high)); }

/// What may be wrong with direct light. `evenly` is what directions give that are drawn evenly over the hemisphere,
/// with the weight of the cosine's density.
std::string why_direct(Strategy strategy, Estimate found, double expected, double evenly) {
    const double ratio = found.mean / expected;
    if (std::abs(ratio - kPiDouble) < 0.1) return "The BRDF of a matte surface is albedo / π.";
    if (std::abs(ratio - 2) < 0.1)
        return "The light is counted twice: a path that ran into a light must not count it again where the light was "
               "sampled.";
    if (strategy == Strategy::kBsdf && agrees(found, evenly))
        return "The directions are drawn evenly over the hemisphere. Draw them with the density cos θ / π, or weight "
               "each by 2 cos θ.";
    if (ratio > 1.03)
        return "Too bright: is the cosine at the surface there, and is the light counted twice, by sampling and by "
               "chance?";
    return strategy == Strategy::kBsdf
               ? "Too dark: does a path hit the surface that it leaves, or end one bounce too early?"
               : "Too dark: does a shadow ray hit the surface it leaves, or the light itself?";
}

void require_count(Item& item, const std::vector<Rgb>& values, std::size_t count) {
    item.require(values.size() == count,
                 message("One color is expected for each ray: expected ", count, ", found ", values.size(), "."));
    item.require(std::all_of(values.begin(), values.end(), [](const Rgb& c) { return is_finite(c); }),
                 "Some colors are infinite or not a number: look for a division by a density of 0.");
}

/// The same seed gives the same numbers, another one others.
void require_seeds(Item& item) {
    const Scene scene = colored_room();
    const auto rays = camera_rays(4, 4);
    const auto first = STUDENT(radiance)(scene, rays, 4, 2, Strategy::kMis, 21u);
    require_count(item, first, rays.size());
    item.require(STUDENT(radiance)(scene, rays, 4, 2, Strategy::kMis, 21u) == first,
                 "The same seed must give the same numbers: make a new generator from the seed in each call.");
    item.require(STUDENT(radiance)(scene, rays, 4, 2, Strategy::kMis, 22u) != first,
                 "Two seeds give the same numbers: the seed is ignored.");
}

/// A small light is rarely found by chance; a large one close by is found badly by its area. kMis must be good at both.
void require_strategies(Item& item) {
    for (const bool small : {true, false}) {
        Scene scene;
        scene.quads.push_back({{-5, 0, -5}, {0, 0, 10}, {10, 0, 0}, Rgb(0.5f), Rgb(0)});
        scene.quads.push_back(small ? ceiling_light(0.2f, 2) : ceiling_light(2, 0.2f));
        scene.lights.push_back(1);
        std::array<double, 3> error{};
        const std::vector<Ray> rays(40, Ray{{0, 0.1f, 0}, {0, -1, 0}}); // from below either light
        for (std::size_t s = 0; s < 3; ++s) {
            const auto values = STUDENT(radiance)(scene, rays, 400, 1, kStrategies[s], seed_of(item));
            require_count(item, values, rays.size());
            const double m = mean(values);
            for (const Rgb& value : values) error[s] += std::pow(average(value) - m, 2) / 39;
        }
        const std::string values =
            message("Below a ", small ? "small light" : "large light close by", " the mean squared error of kBsdf is ",
                    error[0], ", of kLight ", error[1], " and of kMis ", error[2], ". ");
        const double good = small ? error[1] : error[0], bad = small ? error[0] : error[1];
        item.require(good < 0.1 * bad,
                     values + (small ? "kLight must be far better than kBsdf here" : "kBsdf must be far better here") +
                         ": do all strategies draw their directions alike?");
        item.require(error[2] < 0.2 * bad,
                     values + "kMis must be near the better one: does it use both ways, and weigh them?");
    }
}

} // namespace

LAB_ITEM(15, "a light sample: direction, distance and density per steradian") {
    const Quad light = ceiling_light(0.5f, 2);
    for (const auto& [p, random] :
         {std::pair{Vec3{2, 0, -1}, Vec2{0.25f, 0.75f}}, std::pair{Vec3{0, 0, 0}, Vec2{0.5f, 0.5f}}}) {
        const Vec3 to = light.corner + light.u * random.x + light.v * random.y - p;
        const double distance = length(Vec3d(to)), cosine = to.y / distance, pdf = distance * distance / cosine;
        const auto found = STUDENT(sample_light)(light, p, random);
        const auto as = [](double v) { return static_cast<float>(v); };
        item.near("the direction", found.wi, normalize(to), 1e-5f,
                  {{-normalize(to), "The direction must point from the point to the light."},
                   {to, "The direction must have length 1."}});
        item.near("the distance", found.distance, as(distance), 1e-4f,
                  {{as(distance * distance), "This is the square of the distance."}});
        item.near(
            "the density per steradian", found.pdf, as(pdf), as(1e-4 * pdf),
            {{1.0f, "This is the density by area, 1/A: turn it into one by solid angle, with distance² / cosine."},
             {as(1 / cosine), "The square of the distance is missing."},
             {as(distance * distance), "The cosine at the light is missing."},
             {as(pdf * cosine * cosine), "The cosine at the light belongs in the denominator."}});
    }
    Quad wide = light;
    wide.u = wide.u * 4.0f;
    item.near("the density of a light of area 4 straight above",
              STUDENT(sample_light)(wide, Vec3{0.0f, 0, 0}, Vec2{0.125f, 0.5f}).pdf, 1.0f, 1e-4f,
              {{4.0f, "The area of the light is missing."}});
    item.near("the density seen from behind the light",
              STUDENT(sample_light)(light, Vec3{0, 3, 0}, Vec2{0.5f, 0.5f}).pdf, 0.0f, 0.0f);
}

LAB_ITEM(10, "light_pdf is the density of sample_light's directions") {
    const Quad light{{-1, 2, -0.5f}, {1.5f, 0.3f, 0}, {0, -0.4f, 1}, Rgb(0), Rgb(1)};
    for (int i = 0; i < 100; ++i) {
        const Vec3 p = Vec3(item.random().unit_vector()) * 1.2f;
        const Vec2 random{static_cast<float>(item.random().uniform(0.05, 0.95)),
                          static_cast<float>(item.random().uniform(0.05, 0.95))};
        const auto sample = STUDENT(sample_light)(light, p, random);
        const float found = STUDENT(light_pdf)(light, p, sample.wi);
        item.near("light_pdf of a direction that sample_light drew", found, sample.pdf, 2e-3f * sample.pdf,
                  {{0.0f, "This direction meets the light's bright side, so the density isn't 0."}});
        item.near("light_pdf of a direction away from the light", STUDENT(light_pdf)(light, p, -sample.wi), 0.0f, 0.0f);
    }
    const Vec3 beside = light.corner + light.u * 1.4f + light.v * 0.5f;
    item.near("light_pdf of a direction that passes beside the light",
              STUDENT(light_pdf)(light, Vec3{0, 0, 0}, normalize(beside)), 0.0f, 0.0f);
    item.near("light_pdf toward the dark side", STUDENT(light_pdf)(ceiling_light(1, 1), Vec3{0, 2, 0}, Vec3{0, -1, 0}),
              0.0f, 0.0f);
}

LAB_ITEM(10, "the power heuristic") {
    item.near("the weight of equal densities", STUDENT(power_heuristic)(2.0f, 2.0f), 0.5f, 1e-6f);
    item.near("the weight of 3 against 1", STUDENT(power_heuristic)(3.0f, 1.0f), 0.9f, 1e-5f,
              {{0.75f, "This is the balance heuristic: square both densities."},
               {0.1f, "This is the weight of the other way: exchange the two."}});
    item.near("the weight of a density 0", STUDENT(power_heuristic)(0.0f, 5.0f), 0.0f, 0.0f);
    item.near("the weight of 0 against 0", STUDENT(power_heuristic)(0.0f, 0.0f), 0.0f, 0.0f);
    item.near("the weight of 3e30 against 1e30", STUDENT(power_heuristic)(3e30f, 1e30f), 0.9f, 1e-5f,
              {{0.0f, "The squares overflow: divide before you square."},
               {NAN, "The squares overflow: divide before you square."}});
    item.near("the weight of 3e-30 against 1e-30", STUDENT(power_heuristic)(3e-30f, 1e-30f), 0.9f, 1e-5f,
              {{0.0f, "The squares vanish: divide before you square."}});
}

LAB_ITEM(15, "direct light has the value of Lambert's formula, by all three strategies") {
    item.limit(10);
    Scene scene;
    const float albedo = draw(item, 0.4, 0.8);
    scene.quads.push_back({{-5, 0, -5}, {0, 0, 10}, {10, 0, 0}, Rgb(albedo), Rgb(0)});
    scene.quads.push_back(ceiling_light(draw(item, 0.8, 1.2), draw(item, 1.3, 1.7)));
    scene.lights.push_back(1);
    for (const float x : {0.0f, 1.5f}) {
        const Vec3 p{x, 0, 0.2f};
        const double e = irradiance(scene.quads[1], p, {0, 1, 0}), expected = albedo * e / kPiDouble;
        const double evenly = albedo * solid_angle(scene.quads[1], p) / (2 * kPiDouble);
        for (const Strategy strategy : kStrategies) {
            const auto found = estimate(scene, p, 400, 1, strategy, seed_of(item));
            const std::string what =
                message("With ", name(strategy), " the floor at x = ", x, " shows ", found.mean, " (standard error ",
                        found.error, "); Lambert's formula says ", expected, ". ");
            item.require(agrees(found, expected), what + why_direct(strategy, found, expected, evenly));
        }
    }
}

LAB_ITEM(15, "the room whose walls all shine: every bounce adds its share") {
    item.limit(10);
    const float albedo = draw(item, 0.5, 0.7);
    const Scene room = closed_room(albedo, 1);
    double expected = 0;
    for (int bounces = 0; bounces <= 3; ++bounces) {
        expected += std::pow(albedo, bounces);
        for (const Strategy strategy : kStrategies) {
            const auto found = estimate(room, {0.3f, -1, 0.2f}, 50, bounces, strategy, seed_of(item));
            const std::string what = message("With ", name(strategy), " and ", bounces, " bounces the floor shows ",
                                             found.mean, "; expected ", expected, ", the sum of albedo⁰ to albedo^",
                                             bounces, " (albedo ", albedo, "). ");
            item.require(bounces > 0 || found.mean > 0.5,
                         what + "A light that the camera's own ray runs into must be seen, whatever the strategy.");
            item.require(agrees(found, expected),
                         what + (found.mean > expected
                                     ? "Too bright: is light counted twice, by sampling and by chance, or is there one "
                                       "bounce too many? Mind the chance of choosing it where there are several lights."
                                     : "Too dark: is one bounce missing, or the division by the chance of choosing it "
                                       "where there are several lights?"));
        }
    }
}

LAB_ITEM(10, "lights shine on their front alone, and shadows are black") {
    Scene scene;
    scene.quads.push_back({{-5, 0, -5}, {0, 0, 10}, {10, 0, 0}, Rgb(0.5f), Rgb(0)});
    scene.quads.push_back(ceiling_light(0.4f, 2));
    scene.lights.push_back(1);
    Scene shadowed = scene, turned = scene;
    shadowed.quads.push_back({{-2, 1, -2}, {4, 0, 0}, {0, 0, 4}, Rgb(0.5f), Rgb(0)});
    std::swap(turned.quads[1].u, turned.quads[1].v); // now it shines upward
    for (const Strategy strategy : kStrategies) {
        const auto dark = STUDENT(radiance)(shadowed, down_at({0, 0, 0}, 20), 50, 1, strategy, 3u);
        require_count(item, dark, 20);
        item.near(message("the floor below a roof, with ", name(strategy)), static_cast<float>(mean(dark)), 0.0f, 0.0f);
        const auto behind = STUDENT(radiance)(turned, down_at({0, 0, 0}, 20), 50, 1, strategy, 3u);
        item.require(mean(behind) == 0,
                     message("With ", name(strategy), " the floor under the dark side of a light shows ", mean(behind),
                             "; expected 0."));
    }
    const std::vector<Ray> up{Ray{{0, 1, 0}, {0, 1, 0}}};
    item.near("a light seen from below", STUDENT(radiance)(scene, up, 4, 0, Strategy::kMis, 1u).at(0), Rgb(1), 1e-5f);
    item.near("the dark side of a light", STUDENT(radiance)(turned, up, 4, 0, Strategy::kMis, 1u).at(0), Rgb(0), 0.0f);
}

LAB_ITEM(15, "all strategies draw the same picture of a colored room") {
    item.limit(20);
    const Scene scene = colored_room();
    constexpr int kSize = 24;
    const auto rays = camera_rays(kSize, kSize);
    std::array<std::vector<Rgb>, 3> found;
    for (std::size_t s = 0; s < 3; ++s) {
        found[s] = STUDENT(radiance)(scene, rays, kStrategies[s] == Strategy::kBsdf ? 256 : 64, 3, kStrategies[s],
                                     seed_of(item));
        require_count(item, found[s], rays.size());
    }
    for (std::size_t s = 0; s < 2; ++s) { // the whole image first: there the noise is least
        double sum = 0, squares = 0;
        const double n = static_cast<double>(rays.size());
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const double difference = average(found[s][i]) - average(found[2][i]);
            sum += difference, squares += difference * difference;
        }
        const double noise = 6 * std::sqrt((squares - sum * sum / n) / (n - 1) / n);
        item.require(std::abs(sum / n) <= noise + 0.005 * mean(found[2]),
                     message("The mean of the image by ", name(kStrategies[s]), " is ", mean(found[s]), ", by kMis ",
                             mean(found[2]), "; at most ", noise,
                             " of the difference could be noise. One of the two loses light, or counts it twice."));
    }
    // Each block of 6 × 6 pixels: its mean by two strategies, and the spread of the difference over its pixels.
    for (std::size_t s = 0; s < 2; ++s)
        for (int block = 0; block < 16; ++block) {
            double sum = 0, squares = 0, level = 0;
            for (int i = 0; i < 36; ++i) {
                const int x = block % 4 * 6 + i % 6, y = block / 4 * 6 + i / 6;
                const auto index = static_cast<std::size_t>(y * kSize + x);
                const double a = average(found[s][index]), b = average(found[2][index]);
                sum += a - b, squares += (a - b) * (a - b), level += b;
            }
            const double error = std::sqrt((squares - sum * sum / 36) / 35 / 36), difference = sum / 36;
            item.require(std::abs(difference) <= 6 * error + 0.01 * level / 36,
                         message(name(kStrategies[s]), " and kMis differ in the block of pixels from (", block % 4 * 6,
                                 ", ", block / 4 * 6, ") on: by ", difference, " where ", 6 * error,
                                 " could be noise. With two lights the density of a light sample is that on the light "
                                 "times the chance of choosing it."));
        }
}

LAB_ITEM(10, "each strategy has its own noise, and kMis is never much worse than the better of both") {
    item.limit(20);
    require_seeds(item);
    require_strategies(item);
    const Scene scene = colored_room();
    constexpr int kSize = 20;
    const auto rays = camera_rays(kSize, kSize);
    std::array<double, 3> error{};
    for (std::size_t s = 0; s < 3; ++s) {
        // Half the mean squared difference of two runs with independent seeds is the variance of one. Two pairs of runs
        // of 400 rays know it to a tenth or better.
        for (int pair = 0; pair < 2; ++pair) {
            const auto a = STUDENT(radiance)(scene, rays, 32, 1, kStrategies[s], seed_of(item)),
                       b = STUDENT(radiance)(scene, rays, 32, 1, kStrategies[s], seed_of(item));
            require_count(item, a, rays.size());
            require_count(item, b, rays.size());
            for (std::size_t i = 0; i < a.size(); ++i)
                error[s] += std::pow(average(a[i]) - average(b[i]), 2) / 4 / static_cast<double>(a.size());
        }
    }
    const double better = std::min(error[0], error[1]);
    item.require(error[2] <= 1.5 * better, message("The mean squared error of kMis is ", error[2], ", that of kBsdf ",
                                                   error[0], " and of kLight ", error[1],
                                                   ": expected at most 1.5 times the better one. Are the weights of "
                                                   "both ways made of the same two densities?"));
}

LAB_ITEM(0, "the picture: the colored room by the three strategies, 24 samples") {
    item.limit(20);
    constexpr int kSize = 144;
    for (const Strategy strategy : kStrategies) {
        const auto found = STUDENT(radiance)(colored_room(), camera_rays(kSize, kSize), 24, 3, strategy, 1u);
        ImageRgb image(kSize, kSize);
        for (std::size_t i = 0; i < std::min(found.size(), image.size()); ++i) image[i] = found[i] * 2.5f;
        item.show(message("your room by ", name(strategy)), image);
    }
}
