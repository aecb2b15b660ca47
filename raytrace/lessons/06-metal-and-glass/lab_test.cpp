// The examiner of lab 06. Expected values are computed by hand or, in double precision, from angles: a direction at an
// angle from the normal is a sum of a sine along the surface and a cosine along the normal.
#include "common/image/rgb.h"
#include "raytrace/lessons/02-sphere/sky.h"
#include "raytrace/lessons/03-surfaces/surfaces.h"
#include "raytrace/lessons/06-metal-and-glass/lab.h"
#include "tests/grading/judge.h"

#include <cmath>

using namespace duet;
using namespace duet::grading;

LAB_TITLE("raytrace-06", "Metal and glass")

namespace {

using Direction = std::optional<Vec3>;

/// A surface and a direction along it.
struct Surface {
    Vec3d n, along;
    /// The unit direction at an angle, in degrees, from the normal (negative `up`: from the normal's opposite).
    Vec3d at(double angle, double up) const {
        return along * std::sin(radians(angle)) + n * (up * std::cos(radians(angle)));
    }
};
const Surface kFloor{{0, 0, 1}, {1, 0, 0}};

Surface random_surface(Rng& rng) {
    const Vec3d n = rng.unit_vector();
    for (;;) {
        const Vec3d along = cross(n, rng.unit_vector());
        if (length(along) > 0.1) return {n, normalize(along)};
    }
}

/// Schlick's formula with its parts named.
double reflected(double cosine, double ior) {
    const double r0 = std::pow((ior - 1) / (ior + 1), 2);
    return r0 + (1 - r0) * std::pow(1 - cosine, 5);
}

/// Snell's law by angles: the direction beyond, for a ray at `angle` from the normal; nothing at total reflection.
Direction bent(const Surface& surface, double angle, double ratio) {
    const double sine = ratio * std::sin(radians(angle));
    if (sine > 1) return std::nullopt;
    return Vec3(surface.at(degrees(std::asin(sine)), -1));
}

Direction unit(Vec3 v) { return normalize(v); }

/// Judges refract at one angle; the direction that it is given is `scale` long.
void check_refract(Item& item, const Surface& surface, double angle, double ratio, double scale,
                   const std::string& name) {
    const Vec3d d = surface.at(angle, -1);
    const Direction expected = bent(surface, angle, ratio), nan = Vec3(NAN, NAN, NAN);
    const Direction found = STUDENT(refract)(Vec3(d * scale), Vec3(surface.n), static_cast<float>(ratio));
    std::vector<Mistake<Direction>> mistakes{
        {nan, "It is not a number: the square root of a negative value. Where the squared sine beyond exceeds 1, all "
              "light is reflected, and there is nothing to return."}};
    if (!expected && found)
        item.near(name, found, expected, 0,
                  {mistakes[0],
                   {found, "Where ratio · sin θ exceeds 1, no angle fulfills Snell's law, and all light is reflected: "
                           "return nothing."}});
    if (!expected) return;
    const double sine = ratio * std::sin(radians(angle)), cosine = std::sqrt(1 - sine * sine);
    const double inverse = std::sin(radians(angle)) / ratio;
    const char* const kUpside = "The ratio is upside down: multiply the sine by the ratio, which is the index on the "
                                "ray's own side by that beyond.";
    mistakes.push_back({Vec3(d), "The ray goes straight on: the ratio plays no part."});
    mistakes.push_back({Vec3(d * scale), "The ray goes straight on: the ratio plays no part."});
    mistakes.push_back({bent(surface, angle, 1 / ratio), inverse > 1
                                                             ? std::string(kUpside) + " There is an angle that "
                                                                                      "fulfills Snell's law here."
                                                             : kUpside});
    mistakes.push_back({Vec3(surface.along * sine + surface.n * cosine),
                        "It comes back on the side of the normal. It must go on to the other side: subtract the "
                        "cosine times n."});
    mistakes.push_back({Vec3(surface.along * -sine - surface.n * cosine),
                        "The part along the surface has the wrong sign: light goes on, it doesn't turn back."});
    mistakes.push_back({Vec3(surface.at(angle, 1)), "This is the mirror direction."});
    const double linear = 1 - ratio * std::pow(std::sin(radians(angle)), 2);
    if (linear >= 0)
        mistakes.push_back({Vec3(surface.along * sine - surface.n * std::sqrt(linear)),
                            "In the squared sine beyond, ratio² · (1 - cos²), the ratio must be squared."});
    const double wrong_cosine = scale * std::cos(radians(angle));
    const double wrong_sine2 = ratio * ratio * (1 - wrong_cosine * wrong_cosine);
    if (scale != 1 && wrong_sine2 <= 1)
        mistakes.push_back({Vec3(d * (ratio * scale) + surface.n * (ratio * wrong_cosine - std::sqrt(1 - wrong_sine2))),
                            message("d is ", scale, " long: normalize it first, or -d·n is no cosine.")});
    if (scale != 1) { // with the squared length of the part along the surface
        const double long_sine = scale * sine;
        mistakes.push_back(
            {long_sine > 1
                 ? Direction()
                 : Direction(Vec3(surface.along * long_sine - surface.n * std::sqrt(1 - long_sine * long_sine))),
             message("d is ", scale, " long: normalize it first, or its parts are no sine and cosine.")});
    }
    item.near(name, found, expected, 2e-5, mistakes);
}

} // namespace

LAB_ITEM(0, "the picture") {
    const std::vector<lesson::Sphere> spheres{
        {{-0.95f, 0, -3}, 0.45f}, {{0, 0, -3}, 0.45f}, {{0.95f, 0, -3}, 0.45f}, {{0, -100.45f, -3}, 100}};
    ImageRgb image(96, 44);
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            Ray ray{{0, 0.2f, 0}, Vec3(Vec3d((x - 47.5) / 96, (19.5 - y) / 96, -1))};
            Rgb weight(1);
            for (int i = 0; i < 8; ++i) {
                const auto hit = lesson::closest_hit(spheres, ray);
                if (!hit || hit->index == 3) {
                    const bool odd = hit && (std::lround(3 * hit->p.x) + std::lround(3 * hit->p.z)) % 2 != 0;
                    image(x, y) = weight * (hit ? Rgb(odd ? 0.6f : 0.25f) : lesson::sky_color(ray.direction));
                    break;
                }
                Direction d;
                const Vec3 u(item.random().unit_vector());
                if (hit->index == 0) d = STUDENT(mirror)(ray.direction, hit->n);
                if (hit->index == 2) d = STUDENT(scatter_metal)(ray.direction, hit->n, 0.2f, u);
                if (hit->index == 1)
                    d = STUDENT(scatter_glass)(ray.direction, hit->n, hit->front, 1.5f,
                                               static_cast<float>(item.random().uniform()));
                if (!d) break;
                if (hit->index == 2) weight *= Rgb(0.95f, 0.75f, 0.4f);
                ray = {hit->p, *d, 1e-3f};
            }
        }
    item.show("a mirror, glass, metal with fuzz", image);
}

LAB_ITEM(15, "the angle of reflection is the angle of incidence") {
    const float r = std::sqrt(0.5f);
    item.near("the mirror direction of (r, 0, -r), r = √½, which arrives at 45 degrees",
              STUDENT(mirror)(Vec3{r, 0, -r}, Vec3{0, 0, 1}), Vec3{r, 0, r}, 1e-6,
              {{Vec3{r, 0, -3 * r}, "The part along the normal was added: subtract it, twice."},
               {Vec3{r, 0, 0}, "The ray runs along the surface. The factor 2 is missing: d - 2 (d·n) n."},
               {Vec3{-r, 0, -r}, "This is the formula for a vector that points away from the surface. Here d points "
                                 "toward it: d - 2 (d·n) n."},
               {Vec3{-r, 0, r}, "It goes back where it came from. Only the part along the normal turns around."},
               {Vec3{r, 0, -r}, "It goes straight on, into the surface."},
               {Vec3{0, 0, 1}, "This is the normal."}});
    item.near("the mirror direction of (1, 2, -3) at n = (0, 0, 1)", STUDENT(mirror)(Vec3{1, 2, -3}, Vec3{0, 0, 1}),
              Vec3{1, 2, 3}, 1e-5, {{normalize(Vec3{1, 2, 3}), "Its length must be that of d: don't normalize it."}});
    for (int i = 0; i < 200; ++i) {
        const Surface surface = random_surface(item.random());
        const double angle = item.random().uniform(0, 90), scale = item.random().uniform(0.2, 4);
        item.near(message("the mirror direction at ", angle, " degrees from the normal"),
                  STUDENT(mirror)(Vec3(surface.at(angle, -1) * scale), Vec3(surface.n)),
                  Vec3(surface.at(angle, 1) * scale), 2e-5);
    }
}

LAB_ITEM(25, "Snell's law for known indices") {
    // sin 30° / 1.5 = 1/3, the sine of 19.47°. sin 45° / 1.5 = 0.4714, the sine of 28.13°; and so on.
    check_refract(item, kFloor, 30, 1 / 1.5, 1, "From air into glass (1.5) at 30 degrees, the ray at 19.47 degrees");
    check_refract(item, kFloor, 45, 1 / 1.5, 1, "From air into glass (1.5) at 45 degrees, the ray at 28.13 degrees");
    check_refract(item, kFloor, 45, 1 / 1.33, 1, "From air into water (1.33) at 45 degrees, the ray at 32.12 degrees");
    check_refract(item, kFloor, 60, 1 / 2.42, 1,
                  "From air into diamond (2.42) at 60 degrees, the ray at 20.97 degrees");
    check_refract(item, kFloor, 30, 1.5, 1, "From glass (1.5) into air at 30 degrees, the ray at 48.59 degrees");
    check_refract(item, kFloor, 0, 1 / 1.5, 1, "From air into glass along the normal, the ray");
    check_refract(item, kFloor, 45, 1 / 1.5, 2,
                  "From air into glass at 45 degrees with a direction of length 2, the ray");
    check_refract(item, kFloor, 45, 1 / 1.5, 0.5,
                  "From air into glass at 45 degrees with a direction of length 0.5, the ray");
    for (int i = 0; i < 200; ++i) {
        const Surface surface = random_surface(item.random());
        const double ratio = item.random().uniform(0.4, 1.0), angle = item.random().uniform(0, 89);
        check_refract(item, surface, angle, ratio, item.random().uniform(0.3, 3),
                      message("At ", angle, " degrees with the ratio ", ratio, ", the ray"));
    }
}

LAB_ITEM(15, "total reflection") {
    // The critical angle of glass is asin(1 / 1.5) = 41.81°.
    check_refract(item, kFloor, 41.7, 1.5, 1,
                  "From glass (1.5) into air at 41.7 degrees, just below the critical "
                  "angle, the ray");
    check_refract(item, kFloor, 41.9, 1.5, 1,
                  "From glass (1.5) into air at 41.9 degrees, just above the critical "
                  "angle of 41.81, the ray");
    check_refract(item, kFloor, 60, 1.5, 1, "From glass (1.5) into air at 60 degrees, the ray");
    check_refract(item, kFloor, 48.9, 1.33, 1,
                  "From water (1.33) into air at 48.9 degrees, just above the critical "
                  "angle of 48.75, the ray");
    for (int i = 0; i < 200; ++i) {
        const Surface surface = random_surface(item.random());
        const double ratio = item.random().uniform(1.05, 2.5), angle = item.random().uniform(0, 89);
        if (std::abs(ratio * std::sin(radians(angle)) - 1) < 1e-3) continue; // rounding decides
        check_refract(item, surface, angle, ratio, 1,
                      message("At ", angle, " degrees with the ratio ", ratio, ", the ray"));
    }
}

LAB_ITEM(15, "Schlick's approximation") {
    const auto check = [&](double cosine, double ior) {
        const double root = (ior - 1) / (ior + 1), r0 = root * root, x = 1 - cosine;
        const auto number = [](double value) { return static_cast<float>(value); };
        item.near(
            message("the fraction reflected for the cosine ", cosine, " and the index ", ior),
            STUDENT(schlick)(number(cosine), number(ior)), number(reflected(cosine, ior)), 1e-5,
            {{number(std::abs(root) + (1 - std::abs(root)) * std::pow(x, 5)), "(1 - ior) / (1 + ior) must be squared."},
             {number(root + (1 - root) * std::pow(x, 5)), "(1 - ior) / (1 + ior) must be squared."},
             {number(-root + (1 + root) * std::pow(x, 5)), "(1 - ior) / (1 + ior) must be squared."},
             {number(r0 + (1 - r0) * std::pow(cosine, 5)),
              "It grows toward the normal: take the fifth power of 1 - cosine."},
             {number(r0 + (1 - r0) * std::pow(x, 4)), "This is the fourth power of 1 - cosine: the fifth power is "
                                                      "wanted."},
             {number(r0 + std::pow(x, 5)), "Reflected are more than 100 percent at the rim: the power's factor is "
                                           "1 - r0."},
             {number(r0), "The cosine plays no part: the fraction grows to 1 where light grazes the surface."}});
    };
    check(1, 1.5);   // 0.04: (0.5 / 2.5)²
    check(0.5, 1.5); // 0.07: 0.04 + 0.96 / 32
    check(0, 1.5);   // 1
    check(1, 2.42);  // 0.172: diamond
    check(0.3, 1 / 1.5);
    for (int i = 0; i < 100; ++i) check(item.random().uniform(), item.random().uniform(0.4, 3));
}

LAB_ITEM(10, "metal with fuzz") {
    const Vec3 d{1, 0, -1}, n{0, 0, 1}, m = normalize(Vec3{1, 0, 1});
    const auto scatter = [](Vec3 from, Vec3 normal, float fuzz, Vec3 u) {
        const Direction found = STUDENT(scatter_metal)(from, normal, fuzz, u);
        return found ? unit(*found) : found;
    };
    item.near("the direction off metal without fuzz", scatter(d, n, 0, Vec3{0, 1, 0}), Direction(m), 1e-5,
              {{unit(m + Vec3{0, 1, 0}), "fuzz plays no part: multiply u by it."},
               {Direction(), "Without fuzz it is the mirror direction, and that never points into the metal."}});
    item.near("the direction for fuzz = 0.5 and u = (0, 1, 0)", scatter(d * 4.0f, n, 0.5f, Vec3{0, 1, 0}),
              unit(m + Vec3{0, 0.5f, 0}), 1e-5,
              {{unit(Vec3{4, 0.5f, 4}), "The mirror direction is as long as d, here 5.7, and so the blur is too small: "
                                        "make it 1 long before u is added."},
               {Direction(m), "u plays no part."},
               {unit(m + Vec3{0, 1, 0}), "fuzz plays no part: multiply u by it."}});
    const Direction down = scatter({1, 0, -0.1f}, n, 1, {0, 0, -1});
    item.require(!down, "For d = (1, 0, -0.1), fuzz = 1 and u = (0, 0, -1) the sum points into the metal; the light is "
                        "absorbed there. Return nothing. Is the sum's dot product with n below 0?");
    for (int i = 0; i < 200; ++i) {
        const Surface surface = random_surface(item.random());
        const double angle = item.random().uniform(0, 89), fuzz = item.random().uniform();
        const Vec3d u = item.random().unit_vector(), sum = surface.at(angle, 1) + u * fuzz;
        if (std::abs(dot(sum, surface.n)) < 1e-3) continue; // rounding decides
        item.near(message("the direction off metal at ", angle, " degrees with the fuzz ", fuzz),
                  scatter(Vec3(surface.at(angle, -1) * 1.7), Vec3(surface.n), static_cast<float>(fuzz), Vec3(u)),
                  dot(sum, surface.n) > 0 ? unit(Vec3(sum)) : Direction(), 2e-4);
    }
}

LAB_ITEM(20, "glass reflects and refracts") {
    const auto check = [&](const Surface& surface, double angle, bool front, double ior, double choice) {
        const double ratio = front ? 1 / ior : ior;
        const Direction beyond = bent(surface, angle, ratio);
        const double cos_here = std::cos(radians(angle)),
                     cos_beyond = beyond ? -dot(Vec3d(*beyond), surface.n) : cos_here;
        const double fraction = beyond ? reflected(ratio < 1 ? cos_here : cos_beyond, ior) : 1;
        if (std::abs(fraction - choice) < 1e-4) return; // rounding decides
        const bool mirrored = choice < fraction;
        const Vec3 mirror(surface.at(angle, 1)), d(surface.at(angle, -1));
        const std::string side = front ? "from outside" : "from inside";
        const std::string name =
            message("the direction at ", angle, " degrees ", side, " with ior ", ior, " and the choice ", choice,
                    ", where ", fraction, " of the light is reflected,");
        const Vec3 found = normalize(STUDENT(scatter_glass)(d * 1.3f, Vec3(surface.n), front, static_cast<float>(ior),
                                                            static_cast<float>(choice)));
        std::vector<Mistake<Vec3>> mistakes;
        if (const Direction other = bent(surface, angle, 1 / ratio))
            mistakes.push_back({*other, front ? "On the way in the ratio is 1 / ior (the index outside by that inside)."
                                              : "On the way out the ratio is ior (the index inside by that outside)."});
        if (mirrored && beyond)
            mistakes.push_back({*beyond,
                                "It was refracted. Some light is always reflected: reflect where choice is less "
                                "than what schlick says, for the cosine in the thinner medium, which is outside "
                                "for ior > 1 and inside for ior < 1."});
        if (!mirrored)
            mistakes.push_back({mirror, "It was reflected. Refract where choice is at least what schlick says, for the "
                                        "cosine in the thinner medium, which is outside for ior > 1 and inside for "
                                        "ior < 1."});
        mistakes.push_back({Vec3(NAN, NAN, NAN), "It is not a number. Where refract returns nothing, all light is "
                                                 "reflected."});
        item.near(name, found, mirrored ? mirror : *beyond, 2e-4, mistakes);
    };
    check(kFloor, 30, true, 1.5, 0.5);      // into glass
    check(kFloor, 30, false, 1.5, 0.5);     // out of it
    check(kFloor, 45, false, 1.5, 0.5);     // above the critical angle
    check(kFloor, 30, true, 1.5, 0.03);     // 4 percent are reflected
    check(kFloor, 40, false, 1.5, 0.15);    // 0.26 in the thinner medium, 0.04 in the glass
    check(kFloor, 40, true, 1 / 1.5, 0.15); // into a bubble: the same
    check(kFloor, 80, true, 1.5, 0.3);      // 0.41 at a grazing angle
    for (int i = 0; i < 300; ++i) {
        const Surface surface = random_surface(item.random());
        const double ior = item.random().uniform(1.1, 2.5);
        const double angle = item.random().uniform(0, 89);
        const bool front = item.random().uniform() < 0.5, bubble = item.random().uniform() < 0.3;
        const double sine = (front != bubble ? 1 / ior : ior) * std::sin(radians(angle));
        if (std::abs(sine - 1) < 1e-3) continue; // rounding decides
        check(surface, angle, front, bubble ? 1 / ior : ior, item.random().uniform());
    }
}
