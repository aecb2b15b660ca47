// This file converts shapes to triangle meshes, for renderers that support no other shapes.
#pragma once

#include "common/scene/scene.h"

#include <cstdint>
#include <vector>

namespace duet::compare {

/// A TriangleSoup is a triangle mesh with attributes per triangle corner. Triangles are counter-clockwise when seen
/// from the front.
struct TriangleSoup {
    std::vector<Vec3> positions;         ///< shared vertices
    std::vector<std::int32_t> triangles; ///< three vertex indices per triangle
    std::vector<std::int32_t> slots;     ///< material slot, one per triangle
    std::vector<Vec3> normals;           ///< one per corner, unit length; empty: flat shading
    std::vector<Vec2> uvs;               ///< one per corner
    std::vector<Vec3> object_positions;  ///< one per corner, in object space
};

/// Converts a mesh or quads to world space. If `to_world` mirrors, two corners are swapped so that front faces
/// stay front faces.
TriangleSoup world_triangles(const Shape& shape, const Mat4& to_world);

/// Returns the unit sphere around the origin, tessellated in rings and sectors, with smooth normals and the
/// texture coordinates of sphere_uv. Its vertices lie on the sphere, at most an angle of π/rings apart. Faces
/// lie at most 1 − cos(π/(2·rings)) below the sphere's surface.
TriangleSoup sphere_triangles(int rings);
/// Returns the unit sphere around the origin with rings about `pole`, a unit vector. The rings are the finer the closer
/// they are to the pole: seen from a point `height` above it, faces lie below the surface by at most 2e-4 of their
/// distance. This suits a scene whose ground is a huge sphere. Textures have a seam, unlike those of sphere_triangles.
TriangleSoup sphere_triangles_near(Vec3d pole, double height);
/// Returns the number of triangles of sphere_triangles(rings).
constexpr std::int64_t sphere_triangle_count(int rings) { return 4 * std::int64_t{rings} * (rings - 1); }

/// Returns the total area of the triangles.
double area(const TriangleSoup& soup);

} // namespace duet::compare
