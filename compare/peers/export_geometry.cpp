#include "compare/peers/export_geometry.h"

#include "common/geometry/sphere.h"
#include "common/vec/frame.h"

#include <cmath>

namespace duet::compare {

namespace {

/// Builds a triangle soup in world space from triangles in object space.
class SoupBuilder {
public:
    explicit SoupBuilder(const Mat4& to_world)
        : to_world_(to_world), inverse_(inverse_affine(to_world_)), mirrors_(determinant3(to_world_) < 0) {}

    struct Corner {
        std::int32_t vertex = 0;
        Vec3 p, n;
        Vec2 uv;
    };

    std::int32_t add_vertex(Vec3 p) {
        soup_.positions.push_back(Vec3(transform_point(to_world_, Vec3d(p))));
        return static_cast<std::int32_t>(soup_.positions.size() - 1);
    }
    void add_triangle(Corner a, Corner b, Corner c, std::uint16_t slot, bool smooth) {
        if (mirrors_) std::swap(b, c); // keeps front faces in front
        for (const Corner& corner : {a, b, c}) {
            soup_.triangles.push_back(corner.vertex);
            soup_.uvs.push_back(corner.uv);
            soup_.object_positions.push_back(corner.p);
            if (smooth) soup_.normals.push_back(Vec3(normalize(transform_normal(inverse_, Vec3d(corner.n)))));
        }
        soup_.slots.push_back(slot);
    }
    /// Adds a closed surface of rings × sectors cells. corner_at(i, j) returns corner i of ring j, for i from 0 to
    /// `sectors` and j from 0 to `rings`. All corners of the first ring must coincide (a pole), and so must those of
    /// the last ring. In every ring, the first and the last corner must coincide.
    template <typename CornerAt> void add_rings(int rings, int sectors, const CornerAt& corner_at) {
        std::vector<Corner> grid;
        for (int j = 0; j <= rings; ++j)
            for (int i = 0; i <= sectors; ++i) grid.push_back(corner_at(i, j));
        const auto corner = [&](int i, int j) { return grid[static_cast<std::size_t>(j * (sectors + 1) + i)]; };
        for (int j = 0; j < rings; ++j)
            for (int i = 0; i < sectors; ++i) {
                // At a pole, one edge of the cell degenerates to a point, so one of its two triangles is omitted.
                // Seen from outside, the next sector and the next ring lie right and above, or left and below.
                if (j > 0) add_triangle(corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), 0, true);
                if (j + 1 < rings) add_triangle(corner(i, j), corner(i + 1, j + 1), corner(i, j + 1), 0, true);
            }
    }
    TriangleSoup finish() { return std::move(soup_); }

private:
    Mat4d to_world_, inverse_;
    bool mirrors_;
    TriangleSoup soup_;
};

TriangleSoup mesh_triangles(const Mesh& mesh, const Mat4& to_world) {
    SoupBuilder builder(to_world);
    for (const Vec3 p : mesh.positions) builder.add_vertex(p);
    constexpr Vec2 kDefaultUvs[] = {{0, 0}, {1, 0}, {0, 1}}; // texture coordinates of a mesh without any
    const bool smooth = !mesh.normals.empty();
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        std::array<SoupBuilder::Corner, 3> corners;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t v = mesh.triangles[t][k];
            corners[k] = {static_cast<std::int32_t>(v), mesh.positions[v], smooth ? mesh.normals[v] : Vec3(),
                          mesh.uvs.empty() ? kDefaultUvs[k] : mesh.uvs[v]};
        }
        const std::uint16_t slot = mesh.material_slots.empty() ? std::uint16_t{0} : mesh.material_slots[t];
        builder.add_triangle(corners[0], corners[1], corners[2], slot, smooth);
    }
    return builder.finish();
}

TriangleSoup quad_triangles(const QuadList& list, const Mat4& to_world) {
    SoupBuilder builder(to_world);
    constexpr Vec2 kUv[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (const Quad& quad : list.quads) {
        std::array<SoupBuilder::Corner, 4> c;
        const std::array<Vec3, 4> p = corners(quad);
        for (std::size_t k = 0; k < 4; ++k) c[k] = {builder.add_vertex(p[k]), p[k], Vec3(), kUv[k]};
        builder.add_triangle(c[0], c[1], c[2], 0, false);
        builder.add_triangle(c[0], c[2], c[3], 0, false);
    }
    return builder.finish();
}

} // namespace

TriangleSoup world_triangles(const Shape& shape, const Mat4& to_world) {
    DUET_CHECK(!std::holds_alternative<Sphere>(shape));
    if (const auto* mesh = std::get_if<Mesh>(&shape)) return mesh_triangles(*mesh, to_world);
    return quad_triangles(std::get<QuadList>(shape), to_world);
}

TriangleSoup sphere_triangles(int rings) {
    SoupBuilder builder{Mat4()};
    const int sectors = 2 * rings;
    builder.add_rings(rings, sectors, [&](int i, int j) -> SoupBuilder::Corner {
        const Vec2 uv(static_cast<float>(i) / static_cast<float>(sectors),
                      static_cast<float>(j) / static_cast<float>(rings));
        const Vec3 p = sphere_direction({i == sectors ? 0.0f : uv.x, uv.y});
        return {builder.add_vertex(p), p, p, uv};
    });
    return builder.finish();
}

TriangleSoup sphere_triangles_near(Vec3d pole, double height) {
    constexpr double kStep = 0.028; // √(8e-4): a chord of that many radians is 1e-4 of the radius below its arc
    constexpr int kSectors = 224; // rounded 2π / kStep
    constexpr double kLeastHeight = 1e-6; // smaller facets would be lost in the rounding of their corners
    std::vector<double> angles{0}; // of the rings, from the pole
    while (angles.back() < kPiDouble) {
        const double step = kStep * std::sqrt(max(max(height, kLeastHeight), angles.back()));
        angles.push_back(min(angles.back() + step, kPiDouble));
    }
    SoupBuilder builder{Mat4()};
    const FrameT<double> frame = frame_from_normal(pole);
    builder.add_rings(static_cast<int>(angles.size()) - 1, kSectors, [&](int i, int j) -> SoupBuilder::Corner {
        const double angle = angles[static_cast<std::size_t>(j)], turn = -2 * kPiDouble * (i % kSectors) / kSectors;
        const Vec3 p(frame.to_world({std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn),
                                     std::cos(angle)}));
        return {builder.add_vertex(p), p, p, sphere_uv(p)};
    });
    return builder.finish();
}

double area(const TriangleSoup& soup) {
    double sum = 0;
    for (std::size_t i = 0; i < soup.triangles.size(); i += 3) {
        const auto p = [&](std::size_t k) {
            return Vec3d(soup.positions[static_cast<std::size_t>(soup.triangles[i + k])]);
        };
        sum += length(cross(p(1) - p(0), p(2) - p(0))) / 2;
    }
    return sum;
}

} // namespace duet::compare
