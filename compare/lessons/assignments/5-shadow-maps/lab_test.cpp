// The examiner of assignment 5. The truth is rays in double (reference_shadows.h). A pixel is judged where the truth is
// the same all around it within the size of a texel; elsewhere a shadow map may be wrong.
#include "compare/lessons/assignments/5-shadow-maps/reference_shadow_map.h"

using namespace duet;
using namespace duet::grading;
using Floats = std::vector<Mistake<ImageFloat>>;

LAB_TITLE("assignment-5", "Shadow maps against the traced truth")

namespace {

constexpr int kWidth = 96, kHeight = 60;
const Scene kGarden = garden(8);
const PrimaryHits kPicture = primary_hits(kGarden, kWidth, kHeight);

/// Judges shadows with reach 0 by a map. Of the judged pixels 1 in 200 may be wrong.
void check_hard(Item& item, const Light& light, const PrimaryHits& primary, int side) {
    const std::string name = message(name_of(light), ", ", side, " texels a side");
    const ShadowMap map = traced_map(kGarden, light, view_of(light, kGarden), side);
    const ImageFloat found = STUDENT(shadows)(map, light, primary.gbuffer, 0);
    item.size(found, kWidth, kHeight);
    const auto truth = classify_pixels(kGarden, light, primary, d(map.view.width) / side);
    for (const float value : found)
        item.require(value == 0 || value == 1,
                     message("With reach 0 a pixel is ", value, "; expected 0 or 1: there is one texel to ask."));
    const auto [expected, lit, acne, dark, leaks, farthest] = find_shadow_errors(kGarden, light, primary, truth, found);
    if (acne <= lit / 200 && leaks <= dark / 200) return item.show(name, found);
    Floats mistakes = mistakes_of(map, light, primary.gbuffer, 0);
    mistakes.push_back({found, acne * dark > leaks * lit
                                   ? message("Shadow acne: of ", lit, " pixels in full light ", acne,
                                             " are dark. The bias is too small where the surface is tilted: a texel's "
                                             "center is up to 0.71 texels away from the point.")
                                   : message("Light leaks: of ", dark, " pixels in full shadow ", leaks,
                                             " are lit. What lies up to ", std::round(100 * farthest) / 100,
                                             " m in front of them throws no shadow (peter-panning): the bias is too "
                                             "large.")});
    item.image(name, found, expected, 1e-3, mistakes);
}

/// Points at random columns and rows of a map, not close to a texel's border, that face the light. Whether they are lit
/// is compared for a map whose texels are empty or hold something close to the light, so that no bias plays a part.
void check_points(Item& item, const Light& light, int side, double from, double to, int reach) {
    Rng& rng = item.random();
    const LightFrame frame(light);
    const LightView view = view_of(light, 0.5, 6, {}, 4);
    const ShadowMap map{view,
                        each_pixel(side, side, [&](int, int) { return rng.uniform() < 0.5 ? 0.001f : kInfinity; })};
    GBuffer gbuffer{{16, 12}, {16, 12}};
    for (std::size_t i = 0; i < gbuffer.point.size(); ++i) {
        const auto place = [&] {
            return 2 * (std::floor(rng.uniform(from, to) * side) + rng.uniform(0.1, 0.9)) / side - 1;
        };
        const double t = rng.uniform(2, 5), x = place(), y = place(), half = (light.spot ? t : 1) * d(view.width) / 2;
        const Vec3d origin = light.spot ? frame.position : frame.forward * -3.0; // where the distance is 0
        gbuffer.point[i] = Vec3(origin + frame.forward * t + (frame.right * x + frame.up * y) * half);
        gbuffer.normal[i] = Vec3(normalize(frame.toward(Vec3d(gbuffer.point[i]))));
    }
    item.image(message("points in the light of ", name_of(light), ", reach ", reach, ", columns and rows from ",
                       side * from, " to ", side * to),
               STUDENT(shadows)(map, light, gbuffer, reach), looked_up_visibility(map, light, gbuffer, reach), 1e-4,
               mistakes_of(map, light, gbuffer, reach));
}

} // namespace

LAB_ITEM(0, "your pictures") {
    const Scene scene = garden(32);
    const PrimaryHits primary = primary_hits(scene, 320, 200);
    item.limit(30);
    for (const Light& light : {kSun, kSpot}) {
        const ShadowMap map = traced_map(scene, light, view_of(light, scene), 384);
        const auto show = [&](const std::string& what, const ImageFloat& lit) {
            item.size(lit, 320, 200);
            item.show(what + ", " + name_of(light), shade(scene, light, primary, lit));
        };
        show("one texel", STUDENT(shadows)(map, light, primary.gbuffer, 0));
        show("filtered", STUDENT(shadows)(map, light, primary.gbuffer, 2));
        show("soft", STUDENT(soft_shadows)(map, light, primary.gbuffer));
        show("truth by rays", traced_visibility(scene, light, primary, 24, 0.5, false, 3));
        const ImageFloat own = STUDENT(depth_map)(scene.triangles, map.view, 200);
        item.show("your map, " + name_of(light), each_pixel(own.width(), own.height(), [&](int x, int y) {
                      const double t = distance_at(map.view, light.spot, d(own(x, y))) / d(map.view.far);
                      return static_cast<float>(sqr(std::clamp(1.1 - t, 0.0, 1.0)));
                  }));
    }
}

LAB_ITEM(5, "light_view: the sun's map holds the scene, in any direction") {
    Rng& rng = item.random();
    for (int i = 0; i < 40; ++i) {
        const Vec3d any = rng.unit_vector(), direction = i == 0 ? Vec3d(0, -1, 0) : i == 1 ? Vec3d(0, 0, 1) : any;
        const Scene scene =
            random_triangles(5, [&] { return rng.unit_vector() * rng.uniform(1, 5) + Vec3d(i, 2, -3); });
        const LightView view = STUDENT(light_view)({Vec3(direction)}, scene.triangles);
        const Mat4d m(view.clip_from_world);
        const std::string where = message(" for the direction ", describe(Vec3(direction)));
        const Vec3d x(m[0][0], m[0][1], m[0][2]), y(m[1][0], m[1][1], m[1][2]);
        item.require(std::isfinite(dot(x, y)), "The matrix is not a number" + where +
                                                   ". Is `up` parallel to the light? Then the cross product is zero.");
        item.near("near" + where, view.near, 0.0f, 1e-6);
        item.near("width" + where, view.width, static_cast<float>(2 / length(x)), 1e-3,
                  {{static_cast<float>(1 / length(x)), "From -1 to 1 there are two radii."}});
        item.require(dot(cross(x, y), direction) < 0,
                     "The map is mirrored" + where + ": right is cross(direction, up).");
        std::array<double, 2> shift{kInfinity, -kInfinity};
        for (const Triangle& t : scene.triangles)
            for (const Vec3 p : {t.a, t.b, t.c}) {
                const Vec4d q = m * Vec4d(Vec3d(p), 1.0);
                item.near("w" + where, q.w, 1.0, 1e-5);
                item.require(std::max({std::abs(q.x), std::abs(q.y), std::abs(2 * q.z - 1)}) < 1.0001,
                             message("A corner is not in the map", where, ": it has x ", q.x, ", y ", q.y,
                                     " and depth ", q.z, ". x and y must be from -1 to 1, depth from 0 to 1."));
                const double more = q.z - dot(Vec3d(p), direction) / d(view.far);
                shift = {std::min(shift[0], more), std::max(shift[1], more)};
            }
        item.require(shift[1] - shift[0] < 1e-3, "Depth doesn't grow by 1 over `far` meters along the light" + where +
                                                     ": depth 0 is at the light's side.");
        const double diagonal = length(scene.objects[0].box.diagonal());
        item.require(std::max(d(view.width), d(view.far)) < 1.1001 * diagonal,
                     message("The map is ", view.width, " m wide and ", view.far, " m deep", where,
                             "; the diagonal of the box is ", diagonal, " m. Texels are wasted."));
    }
}

LAB_ITEM(10, "light_view: the spot light's cone, and the precision of its depths") {
    Rng& rng = item.random();
    for (int i = 0; i < 40; ++i) {
        const Vec3d any = rng.unit_vector();
        const Light light{i == 0 ? Vec3{0, -1, 0} : Vec3(any), 0.1f, true, Vec3(rng.unit_vector() * 3.0),
                          static_cast<float>(rng.uniform(0.3, 1.1))};
        const LightFrame frame(light);
        const double from = i % 4 == 0 ? -2 : rng.uniform(0.5, 5);
        const Scene scene = random_triangles(20, [&] {
            const Vec3d aside = cross(frame.forward, rng.unit_vector()) * 3.0;
            return frame.position + frame.forward * rng.uniform(from, 12) + aside;
        });
        const double near = std::max(extent_of(light, scene).near, 0.05), far = extent_of(light, scene).far;
        const LightView view = STUDENT(light_view)(light, scene.triangles);
        const double t = (near + far) / 2, tangent = std::tan(d(light.half_angle)), n = view.near, f = view.far;
        const auto place = [&](Vec3d p) { return Mat4d(view.clip_from_world) * Vec4d(frame.position + p * t, 1.0); };
        const Vec4d center = place(frame.forward), rim = place(frame.forward + frame.right * tangent);
        item.near(message("w at the distance ", t), center.w, t, 1e-4 * t,
                  {{-t, "It must be positive in front of the light."},
                   {1, "A spot light needs perspective: w is the distance along it."}});
        item.near("The place of the light's axis in the map", Vec2d(center.x / t, center.y / t), Vec2d(0, 0), 1e-4);
        item.near("The distance of the cone's rim from the middle of the map", std::hypot(rim.x, rim.y) / t, 1.0, 1e-3,
                  {{tangent / std::tan(d(light.half_angle) / 2), "half_angle is already half of the cone."},
                   {tangent, "Divide x and y by tan(half_angle)."},
                   {sqr(tangent), "Divide x and y by tan(half_angle), don't multiply."}});
        item.near("width", d(view.width), 2 * tangent, 1e-3,
                  {{tangent, "This is half of it: the cone reaches to both sides."}});
        item.require(
            n >= 0.799 * near,
            message("near is ", n, " m, but the nearest corner in front of the light is at ", near,
                    " m. So depths are less precise than they could be: at the far end two neighboring depths are ",
                    1000 * far * far * (f - n) / (f * n) * 0x1p-24, " mm apart. Make near as large as possible."));
        item.require(n <= near + 1e-4,
                     message("near is ", n, " m, and the nearest corner is at ", near, " m: it is cut off."));
        item.require(f >= far - 1e-3 && f <= 1.101 * far,
                     message("far is ", f, " m; the farthest corner is at ", far, " m."));
        item.near(message("The depth at the distance ", t), center.z / t, depth_at(view, true, t), 1e-3,
                  {{2 * depth_at(view, true, t) - 1, "Depths go from 0 to 1, not from -1 to 1."}});
    }
}

LAB_ITEM(15, "depth_map: the nearest triangle at the center of each texel") {
    constexpr int kSide = 72;
    Light below_roof = kSpot; // the terrace reaches behind it
    below_roof.position = {0.3f, 1.2f, 0.9f}, below_roof.direction = normalize(Vec3{0.3f, -0.25f, -1});
    for (const Light& light : {kSun, kSpot, below_roof}) {
        const LightView view = view_of(light, kGarden);
        const double near = view.near, far = view.far;
        const ImageFloat depth = STUDENT(depth_map)(kGarden.triangles, view, kSide);
        item.size(depth, kSide, kSide);
        const auto at = [&](double x, double y) {
            return first_distance(kGarden, map_ray(light, view, kSide, x, y), view);
        };
        // Depths of a spot light are all close to 1, so distances are compared, in units of far; 1.1 where nothing is.
        const auto image = [&](const auto& distance) {
            return each_pixel(kSide, kSide, [&](int x, int y) {
                const double t = distance(x + 0.5, y + 0.5);
                return static_cast<float>(t < kInfinity ? t / far : 1.1);
            });
        };
        const auto stored = [&](double x, double y) {
            return distance_at(view, light.spot, d(depth(static_cast<int>(x), static_cast<int>(y))));
        };
        const ImageFloat found = image(stored),
                         expected = image([&](double x, double y) {
                             double least = kInfinity, most = 0; // corners may be snapped to 1/256 of a texel
                             for (int k = 0; k < 9; ++k) {
                                 const double t = at(x + (k % 3 - 1) / 128.0, y + (k / 3 - 1) / 128.0);
                                 least = std::min(least, t), most = std::max(most, t);
                             }
                             const double t = stored(x, y), slack = 1e-6 * far * far / std::max(near, 0.05);
                             return t == most || (t > least - slack && t < most + slack) ? t : at(x, y);
                         });
        const bool below = light.position == below_roof.position; // it alone has triangles behind it
        const std::string name = message("the map of ", name_of(light), below ? " below the roof" : "");
        if (std::ranges::equal(found, expected, [](float a, float b) { return std::abs(a - b) <= 2e-3f; })) {
            item.show(name, found);
            continue; // what mistakes would give takes a while
        }
        const auto mode = [&](DepthMistake m) {
            return image([&](double x, double y) {
                return first_distance(kGarden, map_ray(light, view, kSide, x, y), view, m);
            });
        };
        Floats mistakes{
            {image([&](double x, double y) { return at(x, kSide - y); }),
             "It is upside down: y points up in clip space, and row 0 is the top row."},
            {image([&](double x, double y) { return at(kSide - x, y); }), "It is mirrored."},
            {image([&](double x, double y) { return at(x - 0.5, y - 0.5); }),
             "It is displaced by half a texel: a texel's center is at (x + 0.5, y + 0.5)."},
            {image([&](double, double) { return kInfinity; }), "It is empty."},
            {image([&](double x, double y) { return distance_at(view, light.spot, at(x, y)); }),
             "These are distances. A map holds depths: z / w."},
            {mode(kFarthest), "The farthest triangle is kept: keep the smallest depth, and begin with infinity."},
            {mode(kLast), "The triangle that is drawn last is kept: compare depths."},
            {mode(kDropped), "Triangles that cross the near plane are missing: clip them, and draw the part in front."},
            {mode(kUnclipped), "What lies between the light and near is in the map: clip at z = 0."}};
        if (below) mistakes.push_back({found, "Are triangles clipped at z = 0, before the division by w?"});
        item.image(name, found, expected, 2e-3, mistakes);
    }
}

LAB_ITEM(10, "traced_shadows: the truth by rays") {
    Scene scene = kGarden;
    scene.begin({}), scene.add_block({3.7, 1.8, 1.2}, {3.8, 3.3, 2.8}); // behind the spot light
    const PrimaryHits primary = primary_hits(scene, 44, 28);
    item.limit(20);
    for (const Light& light : {kSun, kSpot})
        for (const int samples : {1, 200}) {
            const ImageFloat found = STUDENT(traced_shadows)(scene.triangles, light, primary.gbuffer, samples);
            item.size(found, 44, 28);
            const auto truth = classify_pixels(scene, light, primary, 1e-3);
            const ImageFloat right = traced_visibility(scene, light, primary, samples);
            ImageFloat expected = right;
            int wrong = 0, lit = 0, acne = 0, edge = 0;
            double error = 0;
            for (std::size_t i = 0; i < found.size(); ++i) {
                const double difference = d(found[i] - right[i]);
                const bool partly = right[i] > 0 && right[i] < 1, unsure = truth[i] == kUncertain && !partly;
                if (unsure) expected[i] = found[i];
                if (partly) error += sqr(difference), ++edge;
                wrong += !unsure && !(std::abs(difference) < 0.25);
                lit += right[i] == 1, acne += right[i] == 1 && difference < -0.1;
            }
            error = std::sqrt(error / std::max(edge, 1));
            const std::string name = message(samples, samples == 1 ? " ray to " : " rays to ", name_of(light));
            if (wrong <= 2 && error < 0.05) continue;
            item.image(
                name, found, expected, 0.04,
                {{traced_visibility(scene, light, primary, samples == 1 ? 200 : 1),
                  "The rays lead to the light's center for samples = 1, and are spread over its disk otherwise."},
                 {traced_visibility(scene, light, primary, samples, 1),
                  "The points are too dense in the middle of the disk: a radius of √u spreads them evenly, not u."},
                 {traced_visibility(scene, light, primary, samples, 0.5, true),
                  "What lies behind the light throws a shadow: a ray must end at the light."},
                 {looked_up_visibility({view_of(light, scene), ImageFloat(1, 1, kInfinity)}, light, primary.gbuffer, 0),
                  "There are no shadows: all that faces the light is lit."},
                 {ImageFloat(44, 28, 1), "All is lit, also what must be 0 as in `shadows`: what is turned away."},
                 {found,
                  acne > lit / 50
                      ? message(
                            "Of ", lit, " pixels in full light ", acne,
                            " are dark: a ray meets the triangle that it leaves. Start it a little above the surface.")
                      : message("In the penumbra the error is ", error, " (root mean square); expected below 0.05.")}});
        }
}

LAB_ITEM(15, "shadows: no acne, no leaks") {
    const PrimaryHits stones = primary_hits(kGarden, kWidth, kHeight, {-1.6, 2.2, 3.4}, {-1.7, 0.05, 1.1}, 0.24);
    for (const Light& light : {kSun, kSpot}) {
        check_hard(item, light, kPicture, 200);
        check_hard(item, light, stones, 700);
    }
}

LAB_ITEM(5, "shadows: beside the map, outside the cone, behind the light") {
    for (const Light& light : {kSun, kSpot}) check_points(item, light, 12, -0.5, 1.5, 0);
    const GBuffer behind{{1, 1, kSpot.position - kSpot.direction}, {1, 1, -kSpot.direction}};
    const ShadowMap empty{view_of(kSpot, 0.5, 6), ImageFloat(12, 12, kInfinity)};
    const ImageFloat found = STUDENT(shadows)(empty, kSpot, behind, 0);
    item.size(found, 1, 1);
    item.require(found[0] == 0, "A point behind the spot light is lit. There w is negative, and the division by it "
                                "mirrors the point into the map: what is outside the cone is dark.");
}

LAB_ITEM(10, "shadows: the filter") {
    for (const int reach : {1, 3})
        for (const Light& light : {kSun, kSpot}) {
            check_points(item, light, 24, 0.2, 0.8, reach);
            check_points(item, light, 24, -0.1, 1.1, reach);
        }
}

LAB_ITEM(5, "penumbra_width") {
    for (int i = 0; i < 42; ++i) {
        Rng& rng = item.random();
        Light light = i % 2 ? kSpot : kSun;
        light.radius = i < 2 ? 0.5f : static_cast<float>(rng.uniform(0.01, 0.5));
        const double blocker = i < 2 ? 2 : rng.uniform(0.3, 4), receiver = i < 2 ? 5 : blocker + rng.uniform(0.1, 5),
                     radius = light.radius;
        const double sun = 2 * radius * (receiver - blocker), right = light.spot ? sun / blocker : sun; // i = 1: 1.5 m
        item.near(
            message("The width for ", name_of(light), " of radius ", radius, ", the blocker at ", blocker,
                    " and the receiver at ", receiver),
            d(STUDENT(penumbra_width)(light, static_cast<float>(blocker), static_cast<float>(receiver))), right,
            1e-4 * right,
            {{right / 2, "This is half of it: the light is as wide as its diameter, 2 · radius."},
             {sun / receiver, "Divide by the distance of the blocker: the triangles meet at its edge."},
             {2 * radius * receiver / blocker, "The triangle behind the blocker is receiver - blocker long."},
             {sun, "The triangles are similar: divide by the blocker's distance from the light."},
             {sun / blocker, "The sun's radius is the tangent of an angle: the blocker's distance plays no part."}});
    }
    for (const Light& light : {kSun, kSpot})
        for (const auto& [blocker, receiver] : {std::pair{3.0f, 2.0f}, {2.0f, 2.0f}, {0.0f, 2.0f}})
            item.near(message("The width for a blocker at ", blocker, " and a receiver at ", receiver),
                      STUDENT(penumbra_width)(light, blocker, receiver), 0.0f, 0);
}

LAB_ITEM(10, "soft_shadows: the width of the penumbra") {
    constexpr int kPoints = 201;
    item.limit(10);
    std::vector<double> widths, ratios;
    std::string table;
    for (const Light& light : {Light{{0, -1, 0}, 0.12f}, {{0, -1, 0}, 0.1f, true, {0, 2, 0}, 0.6f}})
        for (const double height : {0.4, 0.8, 1.2}) { // of a plate above the floor, with its edge at x = 0
            Scene scene;
            scene.begin({}), scene.add_quad({-1.2, 0, -1.2}, {0, 0, 2.4}, {2.4, 0, 0});
            scene.begin({}), scene.add_quad({-1.2, height, -1.2}, {0, 0, 2.4}, {1.2, 0, 0});
            const double width = 2 * d(light.radius) * height / (light.spot ? 2 - height : 1);
            const auto x_of = [&](double i) { return (2 * i / (kPoints - 1) - 1) * 1.2 * width; };
            GBuffer gbuffer{{kPoints, 1}, {kPoints, 1, {0, 1, 0}}};
            for (int i = 0; i < kPoints; ++i) gbuffer.point(i, 0) = Vec3(Vec3d(x_of(i), 0, 0.0131));
            const ImageFloat lit =
                STUDENT(soft_shadows)(traced_map(scene, light, view_of(light, scene), 512), light, gbuffer);
            item.size(lit, kPoints, 1);
            const std::string what = message("Below an edge ", height, " m above the floor, in the light of ",
                                             name_of(light), ", the penumbra is ", width, " m wide. ");
            item.require(lit(0, 0) < 0.1f, what + message("Beyond its dark end the light is not 0: ", lit(0, 0)));
            item.require(lit(kPoints - 1, 0) > 0.9f,
                         what + message("Beyond its bright end the light is ", lit(kPoints - 1, 0),
                                        "; expected 1. Does the floor count as its own blocker?"));
            widths.push_back(measure_penumbra(lit, 2.4 * width)), ratios.push_back(widths.back() / width);
            table += message(table.empty() ? "" : ", ", std::round(1000 * widths.back()) / 1000, " m (expected ",
                             std::round(1000 * width) / 1000, ")");
        }
    const auto all = [&](double low, double high) {
        return std::ranges::all_of(ratios, [&](double r) { return r > low && r < high; });
    };
    const std::string what = "The widths of six penumbras are " + table + ". ";
    const auto [least, most] = std::ranges::minmax(widths);
    item.require(most > 1.5 * least, what + "They hardly differ: the filter must be as wide as the penumbra.");
    item.require(!all(0.3, 0.72), what + "They are too narrow. Does the filter reach half the width to each side? Does "
                                         "the mean of the blockers count texels that block nothing?");
    item.require(!all(1.4, 2.8), what + "They are too wide: the filter reaches half of the width to each side.");
    item.require(all(0.72, 1.4), what + "They must agree within a third. Are depths turned into distances, and meters "
                                        "into texels at the receiver?");
}

LAB_ITEM(5, "soft_shadows: nearer to the truth than hard ones") {
    item.limit(20);
    double soft_error = 0, hard_error = 0;
    for (const Light& light : {kSun, kSpot}) {
        const ImageFloat found =
            STUDENT(soft_shadows)(traced_map(kGarden, light, view_of(light, kGarden), 400), light, kPicture.gbuffer);
        const ImageFloat truth = traced_visibility(kGarden, light, kPicture, 64),
                         hard = traced_visibility(kGarden, light, kPicture, 1);
        item.size(found, kWidth, kHeight);
        for (std::size_t i = 0; i < truth.size(); ++i)
            soft_error += sqr(d(found[i] - truth[i])), hard_error += sqr(d(hard[i] - truth[i]));
        item.show("difference from the truth (red is too bright, blue too dark), " + name_of(light),
                  signed_difference(found, truth));
    }
    const double ratio = std::sqrt(soft_error / hard_error);
    item.require(ratio < 0.85,
                 message("The error of your soft shadows is ", ratio,
                         " times that of hard shadows by rays; expected below 0.85. Is the difference image red where "
                         "things touch? Then give each texel the bias for its own place: one bias for the whole filter "
                         "is too large."));
}

LAB_ITEM(10, "your own maps: the error falls with the resolution") {
    for (const Light& light : {kSun, kSpot}) {
        const LightView view = STUDENT(light_view)(light, kGarden.triangles);
        const ImageFloat truth = traced_visibility(kGarden, light, kPicture, 1);
        std::vector<double> percent;
        for (const int side : {64, 128, 256, 512}) {
            const ImageFloat found =
                STUDENT(shadows)({view, STUDENT(depth_map)(kGarden.triangles, view, side)}, light, kPicture.gbuffer, 0);
            item.size(found, kWidth, kHeight);
            percent.push_back(0);
            for (std::size_t i = 0; i < truth.size(); ++i)
                percent.back() += 100.0 * (found[i] != truth[i]) / static_cast<double>(truth.size());
            item.show(message(name_of(light), ", your map of ", side, " texels a side"), found);
        }
        const std::string what =
            message("In the light of ", name_of(light), ", your maps of 64 to 512 texels a side get ",
                    describe(percent), " percent of the pixels wrong. ");
        item.require(percent[3] < 2, what + "With 512 it must be below 2.");
        item.require(percent[3] < 0.4 * percent[0],
                     what + "With eight times as many texels a side it must fall to less than 0.4: an error that stays "
                            "comes from a bias that doesn't shrink with the texels.");
    }
}
