// These tests check programmable shading: custom shaders, the inputs that they receive, and packets of samples.
#include "raster/draw.h"
#include "raster/shading/built_in_shaders.h"
#include "raster/visibility/rasterize_tile.h"
#include "tests/raster/varied_scene.h"

#include <doctest/doctest.h>

#include <optional>

using namespace duet;
using namespace duet::test;
using raster::select_each, raster::VertexInput;

namespace {

/// The color shows the quantity under test, with an offset that keeps it non-negative.
constexpr float kLift = 100;

enum class Asked { kPoint, kInterpolated, kNormal, kVertexNormal, kAlongX, kAlongY, kUv };

/// Outputs the inputs of fragments.
struct Probe {
    static constexpr bool kDerivatives = true;
    Asked asked;

    template <typename T> struct Varyings {
        Vec3T<T> p, n;
        Vec2T<T> uv;
    };
    template <typename T> Varyings<T> vertex(const VertexInput<T>& v) const { return {v.world_p(), v.n, v.uv}; }
    template <typename T, typename F> RgbT<T> fragment(const F& f) const {
        const Vec3T<T> v = asked == Asked::kPoint          ? f.p()
                           : asked == Asked::kInterpolated ? f.at.p
                           : asked == Asked::kNormal       ? f.normal(f.at.n).unit()
                           : asked == Asked::kVertexNormal ? f.at.n
                           : asked == Asked::kAlongX       ? f.dx.p
                           : asked == Asked::kAlongY       ? f.dy.p
                                                           : Vec3T<T>(f.at.uv.x, f.at.uv.y, T(0));
        return RgbT<T>(v.x, v.y, v.z) + RgbT<T>(T(kLift));
    }
};

/// This shader is the example of raster/README.md.
struct Stripes {
    template <typename T> struct Varyings { T height; };
    template <typename T> Varyings<T> vertex(const VertexInput<T>& v) const { return {v.world_p().y}; }
    template <typename T, typename F> RgbT<T> fragment(const F& f) const {
        return select_each(f.at.height > T(0.5f), f.base_color(), RgbT<T>(T(1)));
    }
};

Rendering show(const Scene& scene, const View& view, Asked asked, raster::RasterSettings settings = with_hits()) {
    Control control;
    return raster::draw(raster::prepare(scene, settings), view, settings, Probe{asked}, control);
}

Vec3 shown(const Rendering& shown_image, int x, int y) {
    const Rgb c = shown_image.radiance(x, y);
    return Vec3(c.r, c.g, c.b) - Vec3(kLift, kLift, kLift);
}

SurfacePoint surface_at(const Scene& scene, const View& view, Vec2d pixel, const Hit& hit) {
    const Rayd exact = CameraModel(view).pinhole().ray(pixel);
    const Ray ray{
        .origin = Vec3(exact.origin), .direction = Vec3(exact.direction), .t_min = static_cast<float>(exact.t_min)};
    return surface_point(scene, ray, hit);
}

/// Returns the point at which the ray of another pixel position meets the plane of a hit.
Vec3d on_plane(const SurfacePoint& surface, const View& view, Vec2d pixel) {
    const Rayd ray = CameraModel(view).pinhole().ray(pixel);
    const Vec3d n(surface.ng);
    return ray.origin + ray.direction * (dot(Vec3d(surface.p) - ray.origin, n) / dot(ray.direction, n));
}

/// Compares an image's samples, shaded in batches and one at a time.
struct Compared {
    int samples = 0, of_quads = 0, of_spheres = 0;
    int of_several = 0; ///< batches with more than one visible object
    int apart = 0;      ///< samples that differ
    int by_company = 0; ///< samples whose bits depend on how many batches are shaded together
    double mean = 0;    ///< mean color of the visible surfaces
};

Compared packets_against_single(const Scene& scene, const View& view, const raster::ShaderProgram& program) {
    const ImageGeometry drawn(scene, view);
    const raster::RasterSceneData& data = drawn.prepared.data();
    const raster::PassView& pass = drawn.pass;
    const raster::Geometry& geometry = drawn.geometry;
    Compared found;
    for (std::size_t t = 0; t < drawn.grid.size(); ++t) {
        const raster::PixelRect& r = drawn.grid.tile(t);
        raster::DepthTile depths;
        rasterize_tile(geometry, pass, drawn.samples[0], r, t, depths);
        std::vector<raster::SamplePacket> packets;
        for (int y = r.y0; y + 2 <= r.y1; y += 2)
            for (int x = r.x0; x + 8 <= r.x1; x += 8) packets.push_back(raster::sample_packet(depths, x, y));
        std::vector<raster::ColorPacket> together(packets.size());
        std::vector<std::uint32_t> seen(packets.size());
        program.for_tile(data, geometry, pass, r)->shade(packets, together.data(), seen.data());
        const auto one_by_one = program.for_tile(data, geometry, pass, r);
        for (std::size_t s = 0; s < packets.size(); ++s) {
            const raster::SamplePacket& packet = packets[s];
            raster::ColorPacket by_itself;
            CHECK(one_by_one->shade(packet, by_itself) == seen[s]);
            std::optional<std::uint32_t> first_object;
            bool several = false;
            for (std::size_t i = 0; i < raster::kPacketSize; ++i) {
                const auto id = static_cast<std::uint32_t>(packet.ids[i]);
                REQUIRE((id != raster::kNoTriangle) == (seen[s] >> i & 1));
                if (id == raster::kNoTriangle) continue;
                const Vec2d pixel = packet.position(i);
                const Hit hit = find_hit(geometry, pass, id, pixel);
                const Rgb alone = program.shade_hit(data, pass, hit, pixel);
                const auto shown = [&](const raster::ColorPacket& c) {
                    return std::array<float, 3>{c.r[i], c.g[i], c.b[i]};
                };
                const std::array<float, 3> wanted{alone.r, alone.g, alone.b}, here = shown(together[s]);
                ++found.samples;
                several = several || first_object.value_or(hit.object) != hit.object;
                first_object = hit.object;
                const Shape& shape = scene.shapes[scene.objects[hit.object].shape];
                found.of_quads += std::holds_alternative<QuadList>(shape);
                found.of_spheres += std::holds_alternative<Sphere>(shape);
                found.by_company += here != shown(by_itself);
                bool same = true;
                for (std::size_t c = 0; c < 3; ++c)
                    same = same && std::abs(here[c] - wanted[c]) <= 2e-4f * (1 + std::abs(wanted[c]));
                found.apart += !same;
                found.mean += static_cast<double>(here[0] + here[1] + here[2]) / 3;
            }
            found.of_several += several;
        }
    }
    found.mean /= found.samples;
    return found;
}
Compared packets_against_single(const Scene& scene, const View& view, raster::Shading shading) {
    const auto program = raster::built_in_program(shading, view.camera);
    REQUIRE(program != nullptr);
    return packets_against_single(scene, view, *program);
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("a fragment knows its point, and varyings are interpolated as perspective shows them") {
        for (const View& view : {perspective(), orthographic()}) {
            const Scene scene = varied_scene(60);
            const Rendering points = show(scene, view, Asked::kPoint),
                            varyings = show(scene, view, Asked::kInterpolated),
                            normals = show(scene, view, Asked::kNormal);
            double worst_point = 0, worst_varying = 0, worst_normal = 0;
            int seen = 0;
            for (int y = 0; y < view.height; ++y)
                for (int x = 0; x < view.width; ++x) {
                    const Hit& hit = points.hit(x, y);
                    if (!hit.valid()) {
                        REQUIRE(is_black(points.radiance(x, y)));
                        continue;
                    }
                    ++seen;
                    const SurfacePoint surface = surface_at(scene, view, {x + 0.5, y + 0.5}, hit);
                    const auto apart = [](Vec3 a, Vec3 b) { return static_cast<double>(length(a - b)); };
                    worst_point = std::max(worst_point, apart(shown(points, x, y), surface.p));
                    worst_varying = std::max(worst_varying, apart(shown(varyings, x, y), surface.p));
                    const Vec3 wo = Vec3(CameraModel(view).pinhole().ray({x + 0.5, y + 0.5}).direction) * -1.0f;
                    worst_normal = std::max(
                        worst_normal, apart(shown(normals, x, y), dot(surface.ng, wo) < 0 ? -surface.ns : surface.ns));
                }
            CHECK(seen > 30'000);
            CHECK(worst_point < 5e-5); // colors of about 100 are rounded to 4e-6, distances of 8 to 1e-6
            CHECK(worst_varying < 1.5e-5);
            CHECK(worst_normal < 2e-5);
        }
    }

    TEST_CASE("gbuffer derivatives of varyings are those of the triangle's plane") {
        for (const View& view : {perspective(), orthographic()}) {
            const Scene scene = varied_scene(30);
            const Rendering along_x = show(scene, view, Asked::kAlongX), along_y = show(scene, view, Asked::kAlongY);
            double worst = 0;
            int compared = 0;
            for (int y = 0; y < view.height; ++y)
                for (int x = 0; x < view.width; ++x) {
                    const Hit& hit = along_x.hit(x, y);
                    // A sphere's varyings differ from those of its tangent plane.
                    if (!hit.valid() || std::holds_alternative<Sphere>(scene.shapes[scene.objects[hit.object].shape]))
                        continue;
                    const SurfacePoint surface = surface_at(scene, view, {x + 0.5, y + 0.5}, hit);
                    const auto compare_one = [&](Vec2d step, Vec3 found) {
                        const double h = 1e-3; // a central difference in double, with error of order h²
                        const Vec3d after = on_plane(surface, view, {x + 0.5 + step.x * h, y + 0.5 + step.y * h}),
                                    before = on_plane(surface, view, {x + 0.5 - step.x * h, y + 0.5 - step.y * h});
                        const Vec3d wanted = (after - before) * (0.5 / h);
                        worst = std::max(worst, length(Vec3d(found) - wanted) / (length(wanted) + 1e-2));
                    };
                    compare_one({1, 0}, shown(along_x, x, y));
                    compare_one({0, 1}, shown(along_y, x, y));
                    ++compared;
                }
            CHECK(compared > 30'000);
            CHECK(worst < 5e-4); // rounding of the colors: 8e-6 of 1e-2
        }
    }

    TEST_CASE("texture coordinates reach the vertex function") {
        Scene scene;
        Mesh mesh;
        mesh.positions = {Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(1, 1, 0), Vec3(-1, 1, 0)};
        mesh.uvs = {Vec2(0, 0), Vec2(3, 0), Vec2(3, 2), Vec2(0, 2)};
        mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
        add(scene, mesh);
        finish_scene(scene);
        const View view{look({0.3, 0.2, 2.5}, {0, 0, 0}, 40), 64, 48};
        const Rendering shown_image = show(scene, view, Asked::kUv);
        for (int y = 0; y < view.height; ++y)
            for (int x = 0; x < view.width; ++x) {
                if (!shown_image.hit(x, y).valid()) continue;
                const Vec2 uv = surface_at(scene, view, {x + 0.5, y + 0.5}, shown_image.hit(x, y)).uv;
                REQUIRE(static_cast<double>(length(shown(shown_image, x, y) - Vec3(uv.x, uv.y, 0))) < 5e-5);
            }
    }

    TEST_CASE("a shader of one's own, its base colors of a texture, too") {
        Scene scene = varied_scene(60);
        scene.textures.textures.push_back(CheckerTexture{Rgb(0.9f, 0.1f, 0.2f), Rgb(0.1f, 0.8f, 0.3f), 3, true});
        std::get<Diffuse>(scene.materials[0]).albedo.texture = 0;
        std::get<Diffuse>(scene.materials[0]).albedo.value = Rgb(1.0f);
        finish_scene(scene);
        Control control;
        raster::RasterSettings settings = with_hits();
        settings.aovs.albedo = true;
        const View view = perspective();
        const Rendering shown_image =
            raster::draw(raster::prepare(scene, settings), view, settings, Stripes{}, control);
        int wrong = 0, above = 0, below = 0;
        for (int y = 0; y < view.height; ++y)
            for (int x = 0; x < view.width; ++x) {
                const Hit& hit = shown_image.hit(x, y);
                if (!hit.valid()) continue;
                const float height = surface_at(scene, view, {x + 0.5, y + 0.5}, hit).p.y;
                if (std::abs(height - 0.5f) < 1e-5f) continue;
                (height > 0.5f ? above : below) += 1;
                const Rgb wanted = height > 0.5f ? shown_image.albedo(x, y) : Rgb(1.0f);
                wrong += max_component(shown_image.radiance(x, y) - wanted) > 1e-6f ||
                         max_component(wanted - shown_image.radiance(x, y)) > 1e-6f;
            }
        CHECK(above > 3000);
        CHECK(below > 3000);
        CHECK(wrong <= 3); // samples at a texture's border, due to different rounding
    }

    TEST_CASE(
        "every built-in shading colors a packet of samples as it colors each alone, whatever else is in the packet") {
        for (const bool only_suns : {false, true}) {
            Scene scene = varied_scene(60);
            if (only_suns) scene.lights[1] = SunLight{normalize(Vec3(-1, -0.5f, 0.2f)), Rgb(0.3f, 0.5f, 1)};
            for (const View& view : {perspective(), orthographic()})
                for (const raster::Shading shading :
                     {raster::Shading::kPhong, raster::Shading::kGouraud, raster::Shading::kFlat,
                      raster::Shading::kToon, raster::Shading::kWireframe, raster::Shading::kNormal,
                      raster::Shading::kAlbedo, raster::Shading::kDepth}) {
                    if (only_suns && shading >= raster::Shading::kWireframe) break; // these ignore the lights
                    const Compared found = packets_against_single(scene, view, shading);
                    CAPTURE(static_cast<int>(shading));
                    CHECK(found.samples > 30'000);
                    CHECK(found.of_quads > 10'000);
                    CHECK(found.of_several > 200);
                    CHECK(found.of_spheres > 500);
                    CHECK(found.by_company == 0);
                    // Toon's bands and the wireframe change within a pixel, where the rounding of a derivative is
                    // visible.
                    CHECK(found.apart <= found.samples / 2000);
                }
        }
    }

    TEST_CASE("packets of meshes of any size are shaded as each of their samples alone") {
        for (const float size : {1e-8f, 1e-3f, 1e6f}) {
            Scene scene;
            Mesh mesh = torus(60, 30); // only face normals, whose lengths depend on the triangles' areas
            for (Vec3& p : mesh.positions) p *= size;
            const Mat4 to_world(scaling(Vec3(1 / size, 1 / size, 1 / size)));
            add(scene, mesh, to_world, Diffuse{{Rgb(0.8f, 0.5f, 0.3f)}});
            // The mesh is instanced twice, so it is not baked.
            add_instance(scene, 0, Mat4(translation(Vec3(0.6f, 1.1f, -0.8f))) * to_world);
            scene.lights = {SunLight{normalize(Vec3(0.4f, -1, -0.5f)), Rgb(2, 1.9f, 1.7f)}};
            finish_scene(scene);
            for (const raster::Shading shading :
                 {raster::Shading::kPhong, raster::Shading::kGouraud, raster::Shading::kFlat, raster::Shading::kToon,
                  raster::Shading::kNormal}) {
                const Compared found = packets_against_single(scene, perspective(), shading);
                CAPTURE(size);
                CAPTURE(static_cast<int>(shading));
                CHECK(found.samples > 8'000);
                CHECK(found.mean > 0.15);
                CHECK(found.apart <= found.samples / 2000);
            }
        }
    }

    TEST_CASE("a sphere's vertices have its own unit normals, however it is stretched, in packets and alone") {
        Scene scene;
        add(scene, Sphere{Vec3(0.3f, 0.1f, 0), 0.8f}, Mat4(scaling(Vec3(1.5f, 0.6f, 3))), Diffuse{{Rgb(0.5f)}});
        finish_scene(scene);
        const raster::ShaderProgramOf<Probe> program(Probe{Asked::kVertexNormal});
        const Compared found = packets_against_single(scene, perspective(), program);
        CHECK(found.of_spheres > 5'000);
        CHECK(found.apart == 0); // (colors are at least kLift, and the tolerance is 2e-4 of that)
        const Rendering seen = show(scene, perspective(), Asked::kVertexNormal);
        double worst = 0;
        for (int y = 0; y < seen.hit.height(); ++y)
            for (int x = 0; x < seen.hit.width(); ++x)
                if (seen.hit(x, y).valid())
                    worst = std::max(worst, std::abs(static_cast<double>(length(shown(seen, x, y))) - 1));
        CHECK(worst < 2e-5); // for values of about kLift
    }
}
