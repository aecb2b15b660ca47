// Assignment 1: a rasterizer that draws the amphora.
#pragma once

#include "common/image/image.h"
#include "tests/grading/lab.h"

#include <array>
#include <string>
#include <vector>

namespace duet::lab {

/// A corner of a triangle: indices into the points and the uvs of its mesh, counted from 0.
struct Corner {
    int point = 0, uv = 0;
};
struct Mesh {
    std::vector<Vec3> points;
    std::vector<Vec2> uvs;       ///< texture coordinates; (0, 0) is the lower left corner of the texture
    std::vector<Corner> corners; ///< three a triangle
};

/// The eye looks at target; up says roughly where up is. There is no far plane.
struct Camera {
    Vec3 eye, target, up;
    float fov = 1;     ///< the vertical field of view in radians, in (0, π)
    float near = 0.1f; ///< the distance of the near plane, > 0
};

struct Vertex {
    Vec4 clip; ///< in clip space
    Vec2 uv;
};
using Triangle = std::array<Vertex, 3>;

/// A pixel that a triangle covers, and the weights (barycentric coordinates) of its corners there, which sum to 1.
struct Fragment {
    int x = 0, y = 0;
    Vec3 weights;
};

/// The mesh in the text of an OBJ file. Lines "v x y z" are points, lines "vt u v" are texture coordinates. A line "f"
/// has three or more corners, each of the form point/uv or point/uv/normal, counted from 1. A face of more than three
/// corners 0, 1, 2, 3 … becomes the triangles 0 1 2, 0 2 3 and so on. All other lines are ignored. Numbers are
/// separated by one or more spaces.
Mesh parse_obj(const std::string& text);

/// A point of the world in clip space. w is the distance in front of the eye. After the division by w, what an image
/// with that aspect (width / height) shows has x and y in [-1, 1], y up. z is w - near, so points in front of the near
/// plane have z >= 0, and the depth z / w grows with the distance.
Vec4 to_clip(Vec3 p, const Camera& camera, float aspect);

/// The part of the triangle with z >= 0 as zero, one or two triangles, with the winding of the original.
std::vector<Triangle> clip_near(const Triangle& triangle);

/// The pixels of a width × height image whose centers the triangle covers, each once. Corners are in pixels from the
/// upper left corner (y down), at most 2^15 pixels outside, in either order. They are snapped to 1/256 pixel first. A
/// center on an edge belongs to the triangle if that is a left or top edge. Triangles without area cover nothing.
std::vector<Fragment> rasterize(Vec2 a, Vec2 b, Vec2 c, int width, int height);

/// The weights of the corners on the triangle in space, from those in the image and the w of the three corners (> 0).
/// They sum to 1.
Vec3 perspective_weights(Vec3 weights, Vec3 w);

/// The color of a texture at uv, bilinear: the mean of the four texels whose centers are nearest, each weighted by how
/// near it is. Row 0 of the image is the top row, where v is 1. The texture repeats beyond [0, 1] in both directions.
Rgb sample(const ImageRgb& texture, Vec2 uv);

/// The mesh as the camera sees it, in a width × height image. Each pixel has the color of the texture at the nearest
/// point that covers its center, or the background. Both sides of a triangle are visible.
ImageRgb draw(const Mesh& mesh, const Camera& camera, const ImageRgb& texture, int width, int height, Rgb background);

} // namespace duet::lab

DUET_LAB(parse_obj, to_clip, clip_near, rasterize, perspective_weights, sample, draw)
