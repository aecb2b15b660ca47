// These tests compare screen-space reflections on metal with exact reflected rays.
#include "tests/raster/scenes.h"

#include "raster/screen_space/ray_march.h"
#include "raster/screen_space/screen_space_tracer.h"
#include "raster/shading/light_components.h"

#include <doctest/doctest.h>

#include <limits>
#include <random>

using namespace duet;
using namespace duet::test;

namespace {

const View kView{look({0, 1.5, 4}, {0, 0.6, 0}, 50), 160, 120};

/// Returns a metal floor in front of an emissive wall, red on the left and green on the right.
Scene before_wall(float roughness, bool ring = false) {
    Scene scene;
    add(scene, QuadList{{{Vec3(-4, 0, 4), Vec3(8, 0, 0), Vec3(0, 0, -6)}}}, Mat4(), Metal{{Rgb(1.0f)}, roughness});
    add(scene, QuadList{{{Vec3(-4, 0, -2), Vec3(4, 0, 0), Vec3(0, 2, 0)}}}, Mat4(), Diffuse{{Rgb(1, 0, 0)}});
    add(scene, QuadList{{{Vec3(0, 0, -2), Vec3(4, 0, 0), Vec3(0, 2, 0)}}}, Mat4(), Diffuse{{Rgb(0, 1, 0)}});
    if (ring) add(scene, torus(24, 12), translation(Vec3(0, 1.2f, -1)) * scaling(Vec3(0.4f, 0.4f, 0.4f)));
    scene.environment = ConstantEnvironment{Rgb(1.0f)};
    finish_scene(scene);
    return scene;
}

/// Returns where a floor pixel's reflected ray hits the wall's plane, and false for other pixels.
bool mirrored(int x, int y, Vec3d& hit) {
    const Rayd ray = CameraModel(kView).pinhole().ray({x + 0.5, y + 0.5});
    const double t = -ray.origin.y / ray.direction.y;
    if (!(t > 0)) return false;
    const Vec3d p = ray.at(t), direction(ray.direction.x, -ray.direction.y, ray.direction.z);
    if (p.z < -1.9 || p.z > 2 || std::abs(p.x) > 3.9) return false;
    hit = p + direction * ((-2 - p.z) / direction.z);
    return std::abs(hit.x) < 3.9;
}

/// Returns the reflected ray of a ray that hits a sphere.
Rayd mirrored_ray(const Rayd& ray, const Hit& hit, Vec3d center) {
    const Vec3d direction = normalize(ray.direction), p = ray.at(static_cast<double>(hit.t) / length(ray.direction)),
                n = normalize(p - center);
    return {p, direction - n * (2 * dot(direction, n))};
}

Rendering render_with_hits(const Scene& scene, const View& view) {
    raster::RasterSettings settings = plain();
    settings.aovs.hit = true;
    return render(scene, view, settings);
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("a mirror shows what its rays meet, up to the wall's edges by three pixels") {
        const ImageRgb found = render(before_wall(0), kView, plain()).radiance;
        int red = 0, green = 0, sky = 0, wrong = 0;
        for (int y = 0; y < kView.height; ++y)
            for (int x = 0; x < kView.width; ++x) {
                Vec3d hit;
                if (!mirrored(x, y, hit) || std::abs(hit.x) < 0.15 || std::abs(hit.y - 2) < 0.15) continue;
                const Rgb expected = hit.y > 2 ? Rgb(1.0f) : hit.x < 0 ? Rgb(1, 0, 0) : Rgb(0, 1, 0);
                ++(hit.y > 2 ? sky : hit.x < 0 ? red : green);
                for (std::size_t c = 0; c < 3; ++c)
                    if (std::abs(found(x, y)[c] - expected[c]) > 0.02f) {
                        ++wrong;
                        break;
                    }
            }
        CHECK(std::min({red, green, sky}) > 300);
        CHECK(wrong * 50 < red + green + sky); // rays that leave the image are extrapolated
    }

    TEST_CASE("a mirror ball shows a lamp of the picture with its own edge: no halo where no ray near a pixel's meets it") {
        const Sphere ball{Vec3(0, 0.5f, 0), 0.5f};
        // The light faces down and is a thin stripe in the image.
        const Quad lamp{Vec3(-0.6f, 2, -0.6f), Vec3(1.2f, 0, 0), Vec3(0, 0, 0.6f)};
        Scene scene;
        add(scene, ball, Mat4(), Metal{{Rgb(1.0f)}, 0});
        add(scene, QuadList{{{Vec3(-4, 2.01f, -4), Vec3(8, 0, 0), Vec3(0, 0, 8)}}}, Mat4(), Diffuse{{Rgb()}});
        add(scene, QuadList{{lamp}}, Mat4(), Emissive{{Rgb(8.0f)}});
        finish_scene(scene);
        const View view{look({0, 1.2f, 4}, {0, 1.2f, 0}, 40), 240, 160};
        const ImageRgb found = render(scene, view, plain()).radiance;
        const Pinhole pinhole = CameraModel(view).pinhole();
        const auto meets_lamp = [&](int x, int y) {
            const Rayd ray = pinhole.ray({x + 0.5, y + 0.5});
            const Vec3d direction = normalize(ray.direction), to = Vec3d(ball.center) - ray.origin;
            const double along = dot(direction, to), half = sqr(double(ball.radius)) - dot(to, to) + sqr(along);
            if (!(half > 0)) return false;
            const Vec3d p = ray.origin + direction * (along - std::sqrt(half)),
                        n = (p - Vec3d(ball.center)) / double(ball.radius);
            const Vec3d mirrored = direction - n * (2 * dot(direction, n)),
                        at = p + mirrored * ((lamp.corner.y - p.y) / mirrored.y);
            return mirrored.y > 0 && std::abs(at.x) < 0.6 && at.z > -0.6 && at.z < 0;
        };
        int within = 0;
        for (int y = 80; y < view.height - 1; ++y) // below the light itself
            for (int x = 1; x < view.width - 1; ++x) {
                int met = 0;
                for (const int dy : {-1, 0, 1})
                    for (const int dx : {-1, 0, 1}) met += meets_lamp(x + dx, y + dy);
                if (met == 0) CHECK(found(x, y) == Rgb());
                if (met == 9) CHECK(found(x, y).g == doctest::Approx(8));
                within += met == 9;
            }
        CHECK(within > 3);
    }

    TEST_CASE("a mirror shows a board that stands a little before a lamp, down to its lower edge, and beside it the lamp") {
        Scene scene;
        add(scene, QuadList{{{Vec3(-9, 0, 15), Vec3(18, 0, 0), Vec3(0, 0, -60)}}}, Mat4(), Metal{{Rgb(1.0f)}, 0});
        add(scene, QuadList{{{Vec3(-6, 1, -40), Vec3(12, 0, 0), Vec3(0, 6, 0)}}}, Mat4(), Emissive{{Rgb(4.0f)}});
        add(scene, QuadList{{{Vec3(-2, 1, -39.5f), Vec3(4, 0, 0), Vec3(0, 6, 0)}}}, Mat4(), Diffuse{{Rgb()}});
        finish_scene(scene);
        const View view{look({0, 3, 20}, {0, 1, -20}, 30), 320, 240};
        const Rendering found = render_with_hits(scene, view);
        int dark = 0, bright = 0, wrong = 0;
        for (int y = 0; y < view.height; ++y)
            for (int x = 0; x < view.width; ++x) {
                if (found.hit(x, y).object != 0) continue;
                const Rayd ray = CameraModel(view).pinhole().ray({x + 0.5, y + 0.5});
                const Vec3d p = ray.at(-ray.origin.y / ray.direction.y);
                const Vec3d direction(ray.direction.x, -ray.direction.y, ray.direction.z),
                    at = p + direction * ((-39.5 - p.z) / direction.z);
                const double aside = std::abs(at.x);
                if (p.z < -39 || at.y < 1.5 || at.y > 6.5 || std::abs(aside - 2) < 0.5 || aside > 5.5) continue;
                ++(aside < 2 ? dark : bright);
                wrong += std::abs(found.radiance(x, y).g - (aside < 2 ? 0.0f : 4.0f)) > 0.1f;
            }
        CHECK(std::min(dark, bright) > 500);
        CHECK(wrong == 0);
    }

    TEST_CASE("a mirror behind a lamp shows its back, which is black, and nothing of its light") {
        Scene scene;
        add(scene, QuadList{{{Vec3(-3, -2, -2), Vec3(6, 0, 0), Vec3(0, 4, 0)}}}, Mat4(), Metal{{Rgb(1.0f)}, 0});
        // The light faces the viewer.
        add(scene, QuadList{{{Vec3(0.6f, 0.2f, -1), Vec3(0.8f, 0, 0), Vec3(0, 0.7f, 0)}}}, Mat4(),
            Emissive{{Rgb(4.0f)}});
        scene.environment = ConstantEnvironment{Rgb(1.0f)};
        finish_scene(scene);
        const Rendering found = render_with_hits(scene, kView);
        int back = 0, sky = 0, wrong = 0;
        for (int y = 0; y < kView.height; ++y)
            for (int x = 0; x < kView.width; ++x) {
                if (found.hit(x, y).object != 0) continue;
                const Rayd ray = CameraModel(kView).pinhole().ray({x + 0.5, y + 0.5});
                const Vec3d p = ray.at((-2 - ray.origin.z) / ray.direction.z),
                            direction(ray.direction.x, ray.direction.y, -ray.direction.z);
                const Vec3d at = p + direction * ((-1 - p.z) / direction.z);
                // This is the distance from the light's edge.
                const double beside = std::max(std::abs(at.x - 1) - 0.4, std::abs(at.y - 0.55) - 0.35);
                if (std::abs(beside) < 0.06) continue;
                ++(beside < 0 ? back : sky);
                wrong += std::abs(found.radiance(x, y).g - (beside < 0 ? 0.0f : 1.0f)) > 0.02f;
            }
        CHECK(back > 50);
        CHECK(sky > 2000);
        CHECK(wrong == 0);
    }

    // The image shows the wall's upper edge and the sky above it. In front of the sky is a light that the image
    // border cuts.
    TEST_CASE("a wall that has ended in the picture does not go on behind a lamp at the picture's edge") {
        Scene scene;
        // The wall extends up to y = 0.
        add(scene, QuadList{{{Vec3(-20, -3, -6), Vec3(40, 0, 0), Vec3(0, 3, 0)}}}, Mat4(), Diffuse{{Rgb()}});
        add(scene, QuadList{{{Vec3(-4, 0.4f, -3), Vec3(3, 0, 0), Vec3(0, 2, 0)}}}, Mat4(), Emissive{{Rgb(4.0f)}});
        // The small metal sphere makes the renderer compute reflections.
        add(scene, Sphere{Vec3(9, 0, -9), 0.1f}, Mat4(), Metal{{Rgb(1.0f)}, 0});
        scene.environment = ConstantEnvironment{Rgb(1.0f)};
        finish_scene(scene);
        const raster::RasterSettings settings = plain();
        const View view{look({0, 0, 0}, {0, 0, -1}, 60), 320, 240};
        const auto gbuffer = raster::make_screen_gbuffer(raster::prepare(scene, settings), view, settings);
        const Box3 bounds{gbuffer->to_eye_relative(scene.bounds.low), gbuffer->to_eye_relative(scene.bounds.high)};
        const Vec3 from(-0.2f, -0.3f, -5);
        for (const float up : {0.3f, 0.4f, 0.5f}) {
            // The ray passes in front of the wall, over its edge, then behind the light.
            const Vec3 direction = normalize(Vec3(-1, up, -0.02f));
            CHECK_FALSE(raster::march_ray({*gbuffer, nullptr, 2}, bounds, {from, direction, direction, false, true}));
        }
        const Vec3 down = normalize(Vec3(-1, -0.05f, -0.2f));
        // Beyond the edge the wall continues.
        CHECK(raster::march_ray({*gbuffer, nullptr, 2}, bounds, {from, down, down, false, true}));
    }

    TEST_CASE("a mirror behind a ball shows the ball's far side as wide as it is, and what is beside it") {
        Scene scene;
        const Vec3 center(0.8f, 0.7f, -0.2f);
        constexpr double kRadius = 0.5;
        add(scene, QuadList{{{Vec3(-3, -1, -2), Vec3(6, 0, 0), Vec3(0, 4, 0)}}}, Mat4(), Metal{{Rgb(1.0f)}, 0});
        add(scene, Sphere{center, static_cast<float>(kRadius)}, Mat4(), Diffuse{{Rgb(1, 0, 0)}});
        scene.environment = ConstantEnvironment{Rgb(1.0f)};
        finish_scene(scene);
        const Rendering found = render_with_hits(scene, kView);
        int red = 0, white = 0, wrong = 0;
        for (int y = 0; y < kView.height; ++y)
            for (int x = 0; x < kView.width; ++x) {
                if (found.hit(x, y).object != 0) continue;
                const Rayd ray = CameraModel(kView).pinhole().ray({x + 0.5, y + 0.5});
                const Vec3d p = ray.at((-2 - ray.origin.z) / ray.direction.z),
                            direction(ray.direction.x, ray.direction.y, -ray.direction.z);
                const Vec3d to = Vec3d(center) - p;
                const double beside = length(to - direction * dot(to, direction));
                if (std::abs(beside - kRadius) < 0.08) continue;
                ++(beside < kRadius ? red : white);
                wrong += std::abs(found.radiance(x, y).g - (beside < kRadius ? 0.0f : 1.0f)) > 0.3f; // blurred
            }
        CHECK(red > 60);
        CHECK(white > 2000);
        CHECK(wrong * 50 < red);
    }

    TEST_CASE("a mirror shows a ball before it, however much nearer to the viewer that is") {
        constexpr double kDeep = 5;
        for (const auto projection : {Camera::Projection::kPerspective, Camera::Projection::kOrthographic})
            for (const double part : {0.1, 0.3, 0.45, 0.55, 0.7, 0.9}) {
                const bool perspective = projection == Camera::Projection::kPerspective;
                const double depth = part * kDeep, radius = 0.08 * (perspective ? depth : 0.5 * kDeep);
                const Vec3d center = perspective ? Vec3d(0.25, 0.1, -1) * depth : Vec3d(0.5, 0.2, -depth);
                Scene scene;
                add(scene, QuadList{{{Vec3(-3, -3, -kDeep), Vec3(6, 0, 0), Vec3(0, 6, 0)}}}, Mat4(),
                    Metal{{Rgb(1.0f)}, 0});
                add(scene, Sphere{Vec3(center), static_cast<float>(radius)}, Mat4(), Diffuse{{Rgb(1, 0, 0)}});
                scene.environment = ConstantEnvironment{Rgb(1.0f)};
                finish_scene(scene);
                // In this view the sphere is visible beside its reflection.
                Camera camera = look({0, 0, 0}, {perspective ? 0.0 : 1.5, 0, -kDeep}, 40);
                camera.projection = projection;
                camera.height = 3.5;
                const View view{camera, 320, 240};
                const Rendering found = render_with_hits(scene, view);
                int red = 0, white = 0, wrong = 0;
                for (int y = 0; y < view.height; ++y)
                    for (int x = 0; x < view.width; ++x) {
                        if (found.hit(x, y).object != 0) continue;
                        const Rayd ray = CameraModel(view).pinhole().ray({x + 0.5, y + 0.5});
                        const Vec3d p = ray.at((-kDeep - ray.origin.z) / ray.direction.z);
                        const Vec3d direction = normalize(Vec3d(ray.direction.x, ray.direction.y, -ray.direction.z)),
                                    to = center - p;
                        const double beside = length(to - direction * dot(to, direction));
                        if (std::abs(beside / radius - 1) < 0.3) continue;
                        ++(beside < radius ? red : white);
                        wrong += std::abs(found.radiance(x, y).g - (beside < radius ? 0.0f : 1.0f)) > 0.1f;
                    }
                CAPTURE(perspective);
                CAPTURE(part);
                CHECK(red > 2);
                CHECK(white > 20000);
                CHECK(wrong == 0);
            }
    }

    // The sphere is viewed from below, where rays hit only its back side, and near its contact point with the mirror.
    TEST_CASE("a ball that lies on a mirror shows its own colour there, and nothing of the mirror and the sky beside it") {
        Scene scene;
        const Vec3d center(0, 0.7, 0);
        constexpr double kRadius = 0.7;
        add(scene, QuadList{{{Vec3(-6, 0, 6), Vec3(12, 0, 0), Vec3(0, 0, -12)}}}, Mat4(), Metal{{Rgb(1.0f)}, 0});
        add(scene, Sphere{Vec3(center), static_cast<float>(kRadius)}, Mat4(), Diffuse{{Rgb(1, 0, 0)}});
        scene.environment = ConstantEnvironment{Rgb(1.0f)};
        finish_scene(scene);
        const View view{look({0, 3.2, 4.4}, {0, 0.3, 0}, 40), 320, 240};
        const Rendering found = render_with_hits(scene, view);
        int within = 0;
        float worst = 0;
        for (int y = 0; y < view.height; ++y)
            for (int x = 0; x < view.width; ++x) {
                if (found.hit(x, y).object != 0) continue;
                const Rayd ray = CameraModel(view).pinhole().ray({x + 0.5, y + 0.5});
                const Vec3d p = ray.at(-ray.origin.y / ray.direction.y), to = center - p;
                const Vec3d direction = normalize(Vec3d(ray.direction.x, -ray.direction.y, ray.direction.z));
                if (length(to - direction * dot(to, direction)) > 0.95 * kRadius) continue;
                worst = std::max(worst, found.radiance(x, y).g);
                ++within;
            }
        CHECK(within > 2000);
        CHECK(worst < 0.02f);
    }

    TEST_CASE("where a floor meets a mirror the floor goes on in it: nothing of the mirror itself is seen between") {
        Scene scene;
        add(scene, QuadList{{{Vec3(-4, -1, -2), Vec3(8, 0, 0), Vec3(0, 5, 0)}}}, Mat4(), Metal{{Rgb(1.0f)}, 0});
        add(scene, QuadList{{{Vec3(-4, 0, 4), Vec3(8, 0, 0), Vec3(0, 0, -6)}}}, Mat4(), Diffuse{{Rgb(0, 1, 0)}});
        scene.environment = ConstantEnvironment{Rgb(1.0f)};
        finish_scene(scene);
        for (const int height : {120, 121, 122, 123, 124}) { // the line has different positions within a pixel
            const View view{look({0, 1, 6}, {0, 0.6f, 0}, 35), 160, height};
            const Rendering found = render_with_hits(scene, view);
            int pixels = 0;
            float worst = 0;
            for (int x = 40; x < 120; ++x)
                for (int y = 1; y + 1 < view.height; ++y) {
                    const bool floor_below = found.hit(x, std::min(y + 3, view.height - 1)).object == 1;
                    if (found.hit(x, y).object != 0 || !floor_below) continue;
                    worst = std::max(worst, found.radiance(x, y).r);
                    ++pixels;
                }
            CAPTURE(height);
            CHECK(pixels == 3 * 80);
            CHECK(worst < 0.1f); // filter footprints are slightly wider than a pixel
        }
    }

    // The G-buffer pass shades a mirror as if it reflected only the environment. In the second view the image border
    // cuts the sphere.
    TEST_CASE("a metal ball on a black floor shows the floor up to its edge, and where the picture ends: nothing of itself or the sky") {
        const Vec3d center(0, 0.7, 0);
        constexpr double kRadius = 0.7;
        Scene scene;
        add(scene, QuadList{{{Vec3(-9, 0, 9), Vec3(18, 0, 0), Vec3(0, 0, -18)}}}, Mat4(), Diffuse{{Rgb()}});
        add(scene, Sphere{Vec3(center), static_cast<float>(kRadius)}, Mat4(), Metal{{Rgb(1.0f)}, 0});
        scene.environment = ConstantEnvironment{Rgb(1.0f)};
        finish_scene(scene);
        for (const double middle : {0.4, 1.6}) {
            const View view{look({0, 1.6f, 5}, {0, middle, 0}, 30), 320, 240};
            const Rendering found = render_with_hits(scene, view);
            int within = 0;
            float worst = 0;
            for (int y = 0; y < view.height; ++y)
                for (int x = 0; x < view.width; ++x) {
                    if (found.hit(x, y).object != 1) continue;
                    const Rayd ray = CameraModel(view).pinhole().ray({x + 0.5, y + 0.5});
                    if (mirrored_ray(ray, found.hit(x, y), center).direction.y > -0.3) continue;
                    worst = std::max(worst, found.radiance(x, y).g);
                    ++within;
                }
            CAPTURE(middle);
            CHECK(within > 500);
            CHECK(worst < (middle < 1 ? 0.02f : 0.2f)); // surfaces outside the image are approximated and blurred
        }
    }

    // Bright boxes are beside the sphere, and the image border cuts them, too. The sky is visible only above.
    TEST_CASE("a metal ball that the picture's edge cuts shows the black floor below: a little of what else stands there, no sky") {
        const Vec3d center(0, 0.7, 0);
        for (const bool boxes : {false, true}) {
            Scene scene;
            add(scene, QuadList{{{Vec3(-9, 0, 9), Vec3(18, 0, 0), Vec3(0, 0, -18)}}}, Mat4(), Diffuse{{Rgb()}});
            add(scene, Sphere{Vec3(center), 0.7f}, Mat4(), Metal{{Rgb(1.0f)}, 0});
            for (const float x : {-1.0f, 0.8f})
                if (boxes) {
                    const Vec3 right(0.2f, 0, 0), up(0, 0.6f, 0), back(0, 0, -0.6f), corner(x, 0, 0.3f);
                    add(scene,
                        QuadList{{{corner, right, up},
                                  {corner, up, back},
                                  {corner + right, back, up},
                                  {corner + up, right, back}}},
                        Mat4(), Emissive{{Rgb(0, 0.8f, 0)}});
                }
            scene.environment = ConstantEnvironment{Rgb(1.0f)};
            finish_scene(scene);
            const View view{look({0, 1.6, 5}, {0, 1.6, 0}, 30), 320, 240};
            const Rendering found = render_with_hits(scene, view);
            const Oracle oracle(scene);
            int within = 0;
            double sum = 0, sky = 0;
            for (int y = 0; y < view.height; ++y)
                for (int x = 0; x < view.width; ++x) {
                    if (found.hit(x, y).object != 1) continue;
                    const Rayd ray =
                        mirrored_ray(CameraModel(view).pinhole().ray({x + 0.5, y + 0.5}), found.hit(x, y), center);
                    if (ray.direction.y > -0.1 || oracle.trace({ray.at(1e-3), ray.direction}).object != 0) continue;
                    sum += static_cast<double>(found.radiance(x, y).g);
                    sky += static_cast<double>(found.radiance(x, y).r);
                    ++within;
                }
            CAPTURE(boxes);
            CHECK(within > 1500);
            CHECK(sum < (boxes ? 0.065 : 0.05) * within); // surfaces outside the image are approximated and blurred
            CHECK(sky < (boxes ? 0.065 : 0.05) * within);
        }
    }

    TEST_CASE("a rough metal ball shows a black ball beside it black, and nothing of itself in that") {
        const Vec3d center(0.52, 0, 0), black(-0.52, 0, 0);
        constexpr double kRadius = 0.5;
        Scene scene;
        add(scene, Sphere{Vec3(black), static_cast<float>(kRadius)}, Mat4(), Diffuse{{Rgb()}});
        add(scene, Sphere{Vec3(center), static_cast<float>(kRadius)}, Mat4(), Metal{{Rgb(1.0f)}, 0.35f});
        scene.environment = ConstantEnvironment{Rgb(1.0f)};
        finish_scene(scene);
        const View view{look({0, 0, 5}, {0, 0, 0}, 30), 640, 480};
        const Rendering found = render_with_hits(scene, view);
        int within = 0;
        double sum = 0;
        for (int y = 0; y < view.height; ++y)
            for (int x = 0; x < view.width; ++x) {
                if (found.hit(x, y).object != 1) continue;
                const Rayd ray =
                    mirrored_ray(CameraModel(view).pinhole().ray({x + 0.5, y + 0.5}), found.hit(x, y), center);
                const Vec3d to = black - ray.origin;
                if (length(to - ray.direction * dot(to, ray.direction)) > 0.3 * kRadius || dot(to, ray.direction) < 0)
                    continue;
                sum += static_cast<double>(found.radiance(x, y).g);
                ++within;
            }
        CHECK(within > 100);
        CHECK(sum < 0.16 * within);
    }

    TEST_CASE("a ray hidden up to its end meets the floor it goes down to past what hides it, or else what is behind all") {
        Scene scene;
        add(scene, QuadList{{{Vec3(-50, 0, 50), Vec3(100, 0, 0), Vec3(0, 0, -100)}}});
        add(scene, Sphere{Vec3(0, 1, 0), 1});
        // The small metal sphere makes the renderer compute reflections.
        add(scene, Sphere{Vec3(3, 1, 0), 0.1f}, Mat4(), Metal{{Rgb(1.0f)}, 0});
        scene.environment = ConstantEnvironment{Rgb(1.0f)};
        finish_scene(scene);
        const raster::RasterSettings settings = plain();
        const View view{look({0, 1, 8}, {0, 1, 0}, 30), 160, 120};
        const auto gbuffer = raster::make_screen_gbuffer(raster::prepare(scene, settings), view, settings);
        const Box3 bounds{gbuffer->to_eye_relative(scene.bounds.low), gbuffer->to_eye_relative(scene.bounds.high)};
        const auto trace = [&](Vec3 direction) {
            return raster::march_ray(
                {*gbuffer}, bounds,
                {gbuffer->to_eye_relative(Vec3(0, 1, -2)), Vec3(0, 0, -1), normalize(direction), false});
        };
        CHECK_FALSE(trace({0.02f, 0.05f, -1}));
        const auto floor = trace({0.02f, -0.05f, -1});
        REQUIRE(floor);
        CHECK(floor->distance == doctest::Approx(20).epsilon(0.02));
    }

    // Reflections of lights use the lights' exact edges at every ray. If lights were extrapolated, too, they would
    // appear beside those edges.
    TEST_CASE("a ray that passes behind a lamp or beside it meets nothing of it, nor what goes on as the lamp does") {
        Scene scene;
        // The light faces down.
        add(scene, QuadList{{{Vec3(-1.5f, 1.5f, -7), Vec3(3, 0, 0), Vec3(0, 0, 3)}}}, Mat4(), Emissive{{Rgb(4.0f)}});
        add(scene, QuadList{{{Vec3(-2.5f, -1, -6), Vec3(1.5f, 0, 0), Vec3(0, 1, 0.5f)}}}, Mat4(),
            Emissive{{Rgb(4.0f)}});
        // The small metal sphere makes the renderer compute reflections.
        add(scene, Sphere{Vec3(9, 0, -9), 0.1f}, Mat4(), Metal{{Rgb(1.0f)}, 0});
        scene.environment = ConstantEnvironment{Rgb(1.0f)};
        finish_scene(scene);
        const raster::RasterSettings settings = plain();
        const View view{look({0, 0, 0}, {0, 0, -1}, 60), 320, 240};
        const auto gbuffer = raster::make_screen_gbuffer(raster::prepare(scene, settings), view, settings);
        const Box3 bounds{gbuffer->to_eye_relative(scene.bounds.low), gbuffer->to_eye_relative(scene.bounds.high)};
        const Oracle oracle(scene);
        std::minstd_rand random(3);
        const auto uniform = [&](double low, double high) {
            return std::uniform_real_distribution<double>(low, high)(random);
        };
        int past = 0, met = 0;
        for (int i = 0; i < 20'000; ++i) {
            const Vec3d p(uniform(-3, 3), uniform(-2, 2), uniform(-9, -2));
            const Vec3d direction = normalize(Vec3d(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)));
            if (oracle.trace({p, direction}).object != kNoObject) continue;
            ++past;
            met += raster::march_ray({*gbuffer, nullptr, 2}, bounds,
                                     {Vec3(p), Vec3(direction), Vec3(direction), false, true})
                       .has_value();
        }
        CHECK(past > 15'000);
        CHECK(met == 0);
    }

    // Every ray passes behind the front layer and hits the layer behind it. If the front layer is as near as
    // possible, no block of its depth pyramid is skipped. If it equals the layer behind, some blocks are skipped.
    TEST_CASE("rays that pass blocks of a random picture at once hit what those hit that go pixel by pixel; no look is infinitely wide") {
        std::mt19937 random(7);
        const auto uniform = [&](double low, double high) {
            return std::uniform_real_distribution<double>(low, high)(random);
        };
        int hits = 0;
        for (const auto& [width, height] :
             {std::pair(1, 1), std::pair(2, 7), std::pair(33, 40), std::pair(64, 64), std::pair(300, 9)}) {
            const View view{look({0, 0, 0}, {0, 0, -1}, 60), width, height};
            ImageFloat deep(width, height), nearest(width, height, 0.5f);
            const double part = uniform(0.002, 0.02);
            const auto near = static_cast<float>(CameraModel(view).pinhole().near);
            for (std::size_t i = 0; i < deep.size(); ++i)
                deep[i] = near / static_cast<float>(uniform(0, 1) < part ? uniform(2, 4) : uniform(8, 9));
            const auto gbuffer_with = [&](const ImageFloat& depths) {
                auto gbuffer = std::make_unique<raster::ScreenGBuffer>(CameraModel(view).pinhole(),
                                                                       raster::SampleOffset{}, depths);
                gbuffer->set_normals(ImageRgb(width, height, Rgb(0.5f, 0.5f, 1)));
                gbuffer->set_color_prepass(
                    {{}, Image<std::uint32_t>(width, height, 0), Image<std::uint8_t>(width, height, 0), {}, {}});
                gbuffer->set_normal_angles(ImageFloat(width, height, 0));
                return gbuffer;
            };
            const auto behind = gbuffer_with(deep), alike = gbuffer_with(deep), before = gbuffer_with(nearest);
            const Box3 bounds{Vec3(-20, -20, -20), Vec3(20, 20, 20)};
            for (int i = 0; i < 2000; ++i) {
                const Vec3 p(Vec3d(uniform(-2, 2), uniform(-2, 2), uniform(-9, -1)));
                const Vec3 direction = normalize(Vec3(Vec3d(uniform(-1, 1), uniform(-1, 1), uniform(-0.5, 0.5))));
                const auto at_once =
                    raster::march_ray({*alike, behind.get(), 0}, bounds, {p, Vec3(0, 0, 1), direction, false});
                const auto singly =
                    raster::march_ray({*before, behind.get(), 0}, bounds, {p, Vec3(0, 0, 1), direction, false});
                REQUIRE(at_once.has_value() == singly.has_value());
                if (!at_once) continue;
                ++hits;
                REQUIRE(at_once->x == singly->x);
                REQUIRE(at_once->y == singly->y);
                REQUIRE(at_once->distance == singly->distance);
            }
            const raster::ReflectionSource source{*behind, nullptr, kNoObject};
            CHECK(source.max_width_on_object(0, 0, kInfinity) == 1);
            CHECK(source.max_width_on_object(0, 0, std::numeric_limits<float>::quiet_NaN()) == 1);
        }
        CHECK(hits > 500);
    }

    TEST_CASE("a ray that begins beside the picture is followed through it") {
        const Scene scene = before_wall(0);
        const auto gbuffer = raster::make_screen_gbuffer(raster::prepare(scene, plain()), kView, plain());
        const Vec3 from(-5.5f, 1, 0), to(-1.2f, 0.8f, -2), direction = normalize(to - from);
        const Box3 bounds{gbuffer->to_eye_relative(scene.bounds.low), gbuffer->to_eye_relative(scene.bounds.high)};
        const auto hit =
            raster::march_ray({*gbuffer}, bounds, {gbuffer->to_eye_relative(from), Vec3(1, 0, 0), direction, false});
        REQUIRE(hit);
        const Vec3 place = gbuffer->project(gbuffer->to_eye_relative(to));
        CHECK(std::abs(hit->x - place.x) < 1);
        CHECK(std::abs(hit->y - place.y) < 1);
        CHECK(hit->distance == doctest::Approx(length(to - from)).epsilon(0.02));
        CHECK(hit->gap == 0);
        CHECK_FALSE(raster::march_ray({*gbuffer}, bounds,
                                      {gbuffer->to_eye_relative(from), Vec3(-1, 0, 0), Vec3(-1, 0, 0), false}));
    }

    TEST_CASE("a mirror behind a glass ball shows the floor under it, not what the ball shows the viewer") {
        Scene scene;
        const Vec3d center(0, 0.6, 1.5);
        constexpr double kRadius = 0.5;
        add(scene, QuadList{{{Vec3(-4, -1, -2), Vec3(8, 0, 0), Vec3(0, 5, 0)}}}, Mat4(), Metal{{Rgb(1.0f)}, 0});
        add(scene, QuadList{{{Vec3(-8, 0, 6), Vec3(16, 0, 0), Vec3(0, 0, -8)}}}, Mat4(), Diffuse{{Rgb(0, 1, 0)}});
        add(scene, Sphere{Vec3(center), static_cast<float>(kRadius)}, Mat4(), Dielectric{1.5f});
        scene.environment = ConstantEnvironment{Rgb(1.0f)};
        finish_scene(scene);
        const View view{look({1.8, 1.6, 5}, {0, 0.6, 0}, 45), 320, 240};
        const Rendering found = render_with_hits(scene, view);
        int within = 0;
        for (int y = 0; y < view.height; ++y)
            for (int x = 0; x < view.width; ++x) {
                if (found.hit(x, y).object != 0) continue;
                const Rayd ray = CameraModel(view).pinhole().ray({x + 0.5, y + 0.5});
                const Vec3d p = ray.at((-2 - ray.origin.z) / ray.direction.z);
                const Vec3d direction = normalize(Vec3d(ray.direction.x, ray.direction.y, -ray.direction.z)),
                            to = center - p;
                const Vec3d floor = p + direction * (-p.y / direction.y);
                if (length(to - direction * dot(to, direction)) > 0.9 * kRadius || !(direction.y < 0 && floor.z < 4))
                    continue;
                ++within;
                const Rgb seen = found.radiance(x, y);
                CHECK(seen.g - seen.r > 0.5f);
            }
        CHECK(within > 40);
    }

    TEST_CASE("lamps that are not looked for stay in the picture that mirrors see, those that are do not: of glass, too") {
        for (const bool glass : {false, true}) {
            Scene scene;
            add(scene, QuadList{{{Vec3(-4, 0, 4), Vec3(8, 0, 0), Vec3(0, 0, -6)}}}, Mat4(), Metal{{Rgb(1.0f)}, 0});
            if (glass) add(scene, Sphere{Vec3(0, 0.6f, 1), 0.3f}, Mat4(), Dielectric{1.5f});
            QuadList lamps; // the first is the weakest
            const auto count = static_cast<int>(raster::ScreenSpaceTracer::kMaxReflectedLights) + 1;
            for (int i = 0; i < count; ++i) {
                const float size = i == 0 ? 0.04f : 0.05f;
                const Vec3 corner(-1.6f + 0.2f * static_cast<float>(i % 17), 0.2f + 0.1f * static_cast<float>(i / 17),
                                  -1.8f);
                lamps.quads.push_back({corner, Vec3(size, 0, 0), Vec3(0, size, 0)});
            }
            add(scene, lamps, Mat4(), Emissive{Rgb(3.0f)});
            finish_scene(scene);
            raster::RasterSettings settings = plain();
            settings.shadows = false;
            const View large{kView.camera, 480, 360};
            settings.aovs.hit = true;
            const Image<Hit> hits = render(scene, large, settings).hit;
            settings.aovs = {};
            const auto gbuffer = raster::make_screen_gbuffer(raster::prepare(scene, settings), large, settings);
            const std::uint32_t object = glass ? 2 : 1;
            int weak = 0, strong = 0, wrong = 0;
            for (int y = 0; y < large.height; ++y)
                for (int x = 0; x < large.width; ++x) {
                    if (hits(x, y).object != object) continue;
                    const bool is_weak = hits(x, y).primitive == 0;
                    ++(is_weak ? weak : strong);
                    wrong += gbuffer->color_prepass().radiance_without_lights.finest()(x, y) !=
                             (is_weak ? Rgb(3.0f) : Rgb(0.0f));
                }
            CHECK(weak > 2);
            CHECK(strong > 500);
            CHECK(wrong == 0);
        }
    }

    TEST_CASE("slightly rough metal mirrors without grain: neighbours differ by 4 % at most where the wall is of one colour") {
        raster::RasterSettings settings = plain();
        for (const int spp : {1, 4}) {
            settings.samples_per_pixel = spp;
            const ImageRgb found = render(before_wall(0.25f), kView, settings).radiance;
            int pixels = 0;
            float worst = 0;
            for (int y = 0; y < kView.height; ++y)
                for (int x = 0; x + 1 < kView.width; ++x) {
                    Vec3d hit;
                    if (!mirrored(x, y, hit) || hit.x > -1 || hit.x < -3 || hit.y > 1.2) continue;
                    worst = std::max(worst, std::abs(found(x, y).r - found(x + 1, y).r));
                    ++pixels;
                }
            CAPTURE(spp);
            CHECK(pixels > 200);
            CHECK(worst < 0.04f);
        }
    }

    TEST_CASE("of a sheet of metal a mirror below shows what its back mirrors, not the sky that its front shows the viewer") {
        for (const float roughness : {0.0f, 0.2f}) {
            Scene scene;
            add(scene, QuadList{{{Vec3(-1, 0, 2), Vec3(2, 0, 0), Vec3(0, 0, -1)}}}, Mat4(), Metal{{Rgb(1.0f)}, 0});
            add(scene, QuadList{{{Vec3(-2, 0.6f, 0.9f), Vec3(4, 0, 0), Vec3(0, 0, -2.4f)}}}, Mat4(),
                Metal{{Rgb(0.8f, 0.8f, 0.4f)}, roughness});
            add(scene, QuadList{{{Vec3(-9, -0.01f, 9), Vec3(18, 0, 0), Vec3(0, 0, -18)}}}, Mat4(),
                Diffuse{{Rgb(0.2f)}});
            scene.environment = ConstantEnvironment{Rgb(1.0f)};
            finish_scene(scene);
            const View view{look({0, 2, 6}, {0, 0.3, 0}, 40), 160, 120};
            const ImageRgb found = render(scene, view, plain()).radiance;
            const auto at = [&](Vec3d p) {
                const Vec3d place = CameraModel(view).pinhole().project(p);
                return found(static_cast<int>(place.x), static_cast<int>(place.y));
            };
            CHECK(at({0, 0.6, 0.15}).g > 0.7f); // the sheet itself
            // The mirror at z = 1.5 reflects the ray up to the sheet's underside at z = 0.15, and the sheet reflects
            // it down to the floor at z = −1.2. Schlick's approximation gives the sheet's reflectance.
            const double cosine = 2 / std::hypot(2.0, 4.5), term = std::pow(1 - cosine, 5);
            const Rgb floor = at({0, -0.01, -1.22});
            CHECK(floor.g < 0.25f);
            for (const double x : {-0.5, 0.0, 0.5}) {
                const Rgb seen = at({x, 0, 1.5});
                CHECK(seen.g == doctest::Approx((0.8 + 0.2 * term) * static_cast<double>(floor.g)).epsilon(0.15));
                CHECK(seen.b == doctest::Approx((0.4 + 0.6 * term) * static_cast<double>(floor.b)).epsilon(0.15));
            }
        }
    }

    // All rays of a quadrant may point below the horizon.
    TEST_CASE("rough metal in a white room seen at a grazing angle is as bright in each quadrant's samples, and never black") {
        Scene scene;
        add(scene, QuadList{{{Vec3(-4, 0, 4), Vec3(8, 0, 0), Vec3(0, 0, -8)}}}, Mat4(), Metal{{Rgb(1.0f)}, 0.5f});
        scene.environment = ConstantEnvironment{Rgb(1.0f)};
        finish_scene(scene);
        for (const double height : {0.1, 0.4, 2.0}) {
            const View view{look({0, height, 6}, {0, 0, 0}, 20), 64, 48};
            raster::RasterSettings settings = plain();
            settings.samples_per_pixel = 16;
            const ImageRgb found = render(scene, view, settings).radiance;
            const Vec3d place = CameraModel(view).pinhole().project({0, 0, 1});
            const Rgb seen = found(static_cast<int>(place.x), static_cast<int>(place.y));
            CAPTURE(height);
            CHECK(seen.g == doctest::Approx(1).epsilon(0.03));
        }
    }

    TEST_CASE("moderately rough metal mirrors the wall before it, not the environment behind that") {
        const Vec3d place = CameraModel(kView).pinhole().project({-1, 0, -1.6});
        for (const float roughness : {0.35f, 0.5f}) {
            const Rgb seen = render(before_wall(roughness), kView, plain())
                                 .radiance(static_cast<int>(place.x), static_cast<int>(place.y));
            INFO("roughness ", roughness, ": ", seen.r, " ", seen.g, " ", seen.b);
            CHECK(seen.r > 0.9f);
            CHECK(seen.b < 0.7f); // 1 with the environment alone
        }
    }

    TEST_CASE("slightly rough metal mirrors an environment of stripes blurred, each ray by its share of the lobe") {
        Scene scene;
        add(scene, QuadList{{{Vec3(-4, 0, 4), Vec3(8, 0, 0), Vec3(0, 0, -6)}}}, Mat4(), Metal{{Rgb(1.0f)}, 0.25f});
        ImageRgb stripes(256, 64);
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 256; ++x) stripes(x, y) = Rgb(x % 4 < 2 ? 2.0f : 0.0f);
        scene.environment = make_image_environment(std::move(stripes), 1, 0);
        finish_scene(scene);
        const ImageRgb found = render(scene, kView, plain()).radiance;
        float least = kInfinity, most = 0;
        for (int x = 40; x < 120; ++x) least = std::min(least, found(x, 70).g), most = std::max(most, found(x, 70).g);
        CHECK(least > 0.5f);
        CHECK(most - least < 0.2f);
    }

    TEST_CASE("a metal that no object is of asks for no look at the picture") {
        for (const bool used : {false, true}) {
            Scene scene;
            add(scene, Sphere{Vec3(0, 0, 0), 1});
            add(scene, Sphere{Vec3(2, 0, 0), 1}, Mat4(), Metal{{Rgb(1.0f)}, 0});
            if (!used) scene.objects.pop_back();
            finish_scene(scene);
            const raster::RasterScene prepared = raster::prepare(scene, plain());
            const std::shared_ptr<const raster::ScreenGBuffer> gbuffer =
                raster::make_screen_gbuffer(prepared, kView, plain());
            CHECK((gbuffer != nullptr) == used);
            if (gbuffer != nullptr) CHECK_FALSE(gbuffer->color_prepass().radiance.empty());
        }
    }

    TEST_CASE("with multisampling what the first look has shaded is not shaded again: the same bits where no metal is seen") {
        const Scene scene = before_wall(0, true);
        raster::RasterSettings settings;
        settings.multisamples = 4;
        const ImageRgb with = render(scene, kView, settings).radiance;
        settings.screen_reflections = false;
        const ImageRgb without = render(scene, kView, settings).radiance;
        settings.multisamples = 0;
        settings.aovs.hit = true;
        const Image<Hit> hits = render(scene, kView, settings).hit;
        int same = 0, other = 0;
        for (int y = 1; y + 1 < kView.height; ++y)
            for (int x = 1; x + 1 < kView.width; ++x) {
                bool metal = false;
                for (int i = 0; i < 9; ++i) {
                    const Hit& hit = hits(x + i % 3 - 1, y + i / 3 - 1);
                    metal = metal || (hit.valid() && hit.object == 0);
                }
                if (!metal) ++(with(x, y) == without(x, y) ? same : other);
            }
        CHECK(other == 0);
        CHECK(same > 3000);
    }
}
