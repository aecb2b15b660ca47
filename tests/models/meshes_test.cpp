// These tests check the meshes of models/: closed, manifold, with correct normals, and of the required size.
#include "tests/models/obj_text.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace duet;
using namespace duet::test;

namespace {

Vec3d face(const ObjText& obj, const std::array<ObjText::Corner, 3>& t) {
    const Vec3d a = obj.positions[t[0].position];
    return cross(obj.positions[t[1].position] - a, obj.positions[t[2].position] - a);
}

/// Returns the number of directed edges (pairs of positions) without exactly one opposite edge. It is 0 for a closed
/// manifold surface.
std::size_t unmatched_edges(const ObjText& obj) {
    std::vector<std::pair<std::size_t, std::size_t>> there, back;
    for (const auto& t : obj.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            there.emplace_back(t[k].position, t[(k + 1) % 3].position);
            back.emplace_back(t[(k + 1) % 3].position, t[k].position);
        }
    }
    std::ranges::sort(there);
    std::ranges::sort(back);
    std::size_t unmatched = 0;
    for (std::size_t i = 0; i < there.size(); ++i)
        unmatched += there[i] != back[i] || (i > 0 && there[i] == there[i - 1]);
    return unmatched;
}

std::size_t coinciding_positions(const ObjText& obj) {
    std::vector<std::array<double, 3>> sorted;
    for (const Vec3d& p : obj.positions) sorted.push_back({p.x, p.y, p.z});
    std::ranges::sort(sorted);
    return static_cast<std::size_t>(sorted.end() - std::unique(sorted.begin(), sorted.end()));
}

void check_mesh(const std::string& file, std::size_t fewest, std::size_t most, bool has_uvs) {
    CAPTURE(file);
    const ObjText obj = read_obj_text(std::filesystem::path(DUET_SOURCE_DIR) / "models" / file);
    CHECK(obj.triangles.size() >= fewest);
    CHECK(obj.triangles.size() <= most);
    CHECK(coinciding_positions(obj) == 0);
    CHECK(unmatched_edges(obj) == 0);

    std::size_t not_finite = 0, flat = 0, against = 0, not_unit = 0, outside = 0;
    double volume = 0;
    for (const Vec3d& p : obj.positions) not_finite += !is_finite(p);
    for (const Vec3d& n : obj.normals) not_unit += std::abs(length(n) - 1) > 2e-5; // written with 5 decimals
    for (const Vec2d& uv : obj.uvs) outside += !(uv.x >= 0 && uv.x <= 1 && uv.y >= 0 && uv.y <= 1);
    for (const auto& t : obj.triangles) {
        const Vec3d normal = face(obj, t);
        volume += dot(obj.positions[t[0].position], normal) / 6;
        flat += length_squared(normal) == 0;
        Vec3d shading;
        for (const auto& corner : t) shading += obj.normals[corner.normal];
        against += dot(shading, normal) <= 0;
    }
    CHECK(not_finite == 0);
    CHECK(not_unit == 0);
    CHECK(outside == 0);
    CHECK(obj.uvs.empty() != has_uvs);
    CHECK(flat == 0);
    CHECK(against == 0); // triangles whose vertex normals disagree with their winding
    CHECK(volume > 0);   // outward-facing
}

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("the textured mesh with smooth normals has some 5,000 triangles") {
        check_mesh("meshes/amphora.obj", 4500, 5500, true);
    }

    TEST_CASE("the octopus has at least 100,000 triangles") {
        check_mesh("generated/octopus.obj", 100'000, 400'000, false);
    }

    TEST_CASE("the still life's meshes") {
        check_mesh("meshes/bowl.obj", 1000, 4000, true);
        check_mesh("meshes/pear.obj", 1000, 4000, true);
        check_mesh("meshes/plinth.obj", 500, 2000, true);
        check_mesh("meshes/ring.obj", 500, 2000, true);
    }
}
