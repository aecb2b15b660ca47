#include "compare/kernels/kernel_scene.h"

#include "common/geometry/quad.h"
#include "common/system/error.h"
#include "compare/hits/reference_tracer.h"
#include "compare/stress/accelerated_scene.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::compare;

namespace {

const std::filesystem::path kModels = std::filesystem::path(DUET_SOURCE_DIR) / "models";

double signed_volume(const Mesh& mesh) {
    double sum = 0;
    for (const auto& [a, b, c] : mesh.triangles)
        sum += dot(Vec3d(mesh.positions[a]), cross(Vec3d(mesh.positions[b]), Vec3d(mesh.positions[c]))) / 6;
    return sum;
}

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("a room is a box of twelve triangles that face inwards") {
        const Mesh room = enclosed({}, Vec3(), 2);
        CHECK(room.triangles.size() == 12);
        CHECK(signed_volume(room) == doctest::Approx(-64));
    }

    TEST_CASE("clutter is 27 copies of the mesh, whatever its size and place, that stay within their box") {
        const Mesh one = scaled_and_moved(icosphere(1), 1e-3f, Vec3(5, 6, 7));
        const Mesh all = cluttered(one);
        CHECK(all.triangles.size() == 27 * one.triangles.size());
        CHECK(all.positions.size() == 27 * one.positions.size());
        for (const Vec3& p : all.positions) REQUIRE(max_component(abs(p)) < 2.5f);
        // The scene has 27 spheres with diameter 2 × 0.7. The mesh's box is slightly narrower than 2, because the
        // sphere is a polyhedron.
        const double scale = 2.0 * 0.7 / 2.0;
        CHECK(signed_volume(all) ==
              doctest::Approx(27 * signed_volume(icosphere(1)) * scale * scale * scale).epsilon(0.2));
    }

    TEST_CASE("the rooms of a bare mesh hold its camera and are closed; alone it has no ground") {
        const std::filesystem::path bowl = kModels / "meshes/bowl.obj";
        const std::size_t triangles = load_kernel_scene(bowl, Arrangement::kAlone).triangles().triangles.size();
        for (const Arrangement arrangement : {Arrangement::kRoom, Arrangement::kClutter, Arrangement::kInstances}) {
            const KernelScene scene = load_kernel_scene(bowl, arrangement);
            CAPTURE(name_of(arrangement));
            CHECK(scene.enclosed);
            CHECK(Box3d{Vec3d(scene.scene->bounds.low), Vec3d(scene.scene->bounds.high)}.contains(scene.camera.eye));
            const std::size_t copies = arrangement == Arrangement::kRoom ? 1 : 27;
            CHECK(scene.triangle_count() == copies * triangles + 12 + 2); // the room and the light in it
            CHECK(scene.closed());
        }
        const auto is_quad = [](const Shape& shape) { return std::holds_alternative<QuadList>(shape); };
        const Scene loaded = load_scene(bowl);
        REQUIRE(is_quad(loaded.shapes[loaded.shapes.size() - 1]));
        CHECK(primitive_count(loaded.shapes.front()) == triangles);
    }

    TEST_CASE("a scene file becomes the triangles that its own primitives are, in their places") {
        const std::filesystem::path file = kModels / "cornell.json";
        const KernelScene flat = load_kernel_scene(file, Arrangement::kAlone);
        const Scene scene = load_scene(file);
        CHECK(flat.camera.eye == scene.camera.eye);
        CHECK(flat.lights.size() == scene.lights.size());
        const ReferenceTracer theirs(scene, 0), ours(*flat.scene, 0);
        const Pinhole pinhole = CameraModel({scene.camera, 40, 40}).pinhole();
        for (int y = 0; y < 40; ++y)
            for (int x = 0; x < 40; ++x) {
                const Rayd ray = pinhole.ray({x + 0.37, y + 0.41});
                const ReferenceHit a = theirs.nearest(ray), b = ours.nearest(ray);
                REQUIRE(a.valid() == b.valid());
                if (a.valid()) REQUIRE(a.t == doctest::Approx(b.t).epsilon(1e-6));
            }
    }

    TEST_CASE("instances stand where the flattened copies do, and are one mesh") {
        const std::filesystem::path bowl = kModels / "meshes/bowl.obj";
        const KernelScene flat = load_kernel_scene(bowl, Arrangement::kClutter);
        const KernelScene instanced = load_kernel_scene(bowl, Arrangement::kInstances);
        CHECK(instanced.scene->objects.size() == 28);
        CHECK(instanced.scene->shapes.size() == 2);
        const ReferenceTracer a(*flat.scene, 0), b(*instanced.scene, 0);
        const auto copy = static_cast<std::uint32_t>(instanced.triangles().triangles.size());
        for (std::uint32_t i = 0; i < flat.triangle_count(); i += 97) {
            const auto p = a.corners(0, i), q = b.corners(min(i / copy, 27u), i - min(i / copy, 27u) * copy);
            for (std::size_t k = 0; k < 3; ++k) REQUIRE(length(p[k] - q[k]) < 2e-6);
        }
    }

    TEST_CASE("a scene file's lights are triangles of the flattened mesh") {
        const KernelScene flat = load_kernel_scene(kModels / "cornell.json", Arrangement::kAlone);
        const ReferenceTracer exact(*flat.scene, 0);
        int area_lights = 0;
        for (const Light& light : flat.lights) {
            const auto* surface = std::get_if<SurfaceLight>(&light);
            if (surface == nullptr || surface->object == kNoObject) continue;
            ++area_lights;
            const auto p = exact.corners(surface->object, surface->primitive);
            const auto expected = corners(std::get<Quad>(surface->shape));
            for (std::size_t k = 0; k < 3; ++k) CHECK(length(p[k] - Vec3d(expected[k])) < 1e-6);
        }
        CHECK(area_lights > 0);
    }

    TEST_CASE("spheres are counted as left out; a scene of nothing else is refused, and so is its clutter") {
        CHECK(load_kernel_scene(kModels / "everything.json", Arrangement::kAlone).omitted_spheres > 0);
        CHECK_THROWS_AS(load_kernel_scene(kModels / "cornell.json", Arrangement::kClutter), Error);
        CHECK_THROWS_AS(parse_arrangement("attic"), Error);
    }
}
