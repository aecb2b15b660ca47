// The examiner's own renderer for assignment 1. It computes in double; only coverage comes from lesson raster-02. It
// can make each of the typical mistakes, so that a wrong image is recognized by its likeness.
#pragma once

#include "common/image/image_file.h"
#include "compare/lessons/assignments/1-rasterizer/lab.h"
#include "raster/lessons/02-triangles/triangle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <sstream>

namespace duet::grading {

using lab::Camera, lab::Corner, lab::Mesh;

/// What the examiner's renderer can do wrong.
struct RendererMistakes {
    bool depth_unused = false, farthest_wins = false, affine = false, v_flipped = false, unclipped = false,
         dropped = false, pixel_corners = false, upside_down = false, mirrored = false, aspect_ignored = false,
         one_side_only = false, nearest_texel = false;
};

inline double d(float x) { return static_cast<double>(x); }

inline Vec4d clip_point(Vec3 point, const Camera& camera, double aspect) {
    const Vec3d eye(camera.eye), back = normalize(eye - Vec3d(camera.target)),
                                 right = normalize(cross(Vec3d(camera.up), back)), top = cross(back, right);
    const Vec3d q = Vec3d(point) - eye;
    const double w = -dot(back, q), f = 1 / std::tan(d(camera.fov) / 2);
    return {f * dot(right, q) / aspect, f * dot(top, q), w - d(camera.near), w};
}

inline Rgb texel(const ImageRgb& texture, int x, int y) {
    const int width = texture.width(), height = texture.height();
    return texture(((x % width) + width) % width, height - 1 - ((y % height) + height) % height);
}
inline Rgb sample_texture(const ImageRgb& texture, Vec2d uv, bool nearest = false) {
    const double x = uv.x * texture.width() - 0.5, y = uv.y * texture.height() - 0.5;
    if (nearest) return texel(texture, static_cast<int>(std::lround(x)), static_cast<int>(std::lround(y)));
    const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
    const auto s = static_cast<float>(x - i), t = static_cast<float>(y - j);
    return (texel(texture, i, j) * (1 - s) + texel(texture, i + 1, j) * s) * (1 - t) +
           (texel(texture, i, j + 1) * (1 - s) + texel(texture, i + 1, j + 1) * s) * t;
}

struct Point {
    Vec4d clip;
    Vec2d uv;
};
inline std::vector<std::array<Point, 3>> clipped(const std::array<Point, 3>& t, const RendererMistakes& wrong) {
    if (wrong.unclipped) return {t};
    std::vector<Point> outline;
    for (std::size_t i = 0; i < 3; ++i) {
        const Point &a = t[i], &b = t[(i + 1) % 3];
        if (a.clip.z >= 0) outline.push_back(a);
        if ((a.clip.z >= 0) == (b.clip.z >= 0)) continue;
        if (wrong.dropped) return {};
        const Point &in = a.clip.z >= 0 ? a : b, &out = a.clip.z >= 0 ? b : a;
        const double s = in.clip.z / (in.clip.z - out.clip.z);
        outline.push_back({in.clip * (1 - s) + out.clip * s, in.uv * (1 - s) + out.uv * s});
    }
    std::vector<std::array<Point, 3>> parts;
    for (std::size_t i = 2; i < outline.size(); ++i) parts.push_back({outline[0], outline[i - 1], outline[i]});
    return parts;
}

inline ImageRgb render(const Mesh& mesh, const Camera& camera, const ImageRgb& texture, int width, int height,
                       Rgb background, const RendererMistakes& wrong = {}) {
    ImageRgb image(width, height, background);
    Image<double> depth(width, height, wrong.farthest_wins ? -1e30 : 1e30);
    const double aspect = wrong.aspect_ignored ? 1 : static_cast<double>(width) / height;
    for (std::size_t i = 0; i + 2 < mesh.corners.size(); i += 3) {
        std::array<Point, 3> triangle;
        for (std::size_t k = 0; k < 3; ++k) {
            const Corner corner = mesh.corners[i + k];
            triangle[k] = {clip_point(mesh.points[static_cast<std::size_t>(corner.point)], camera, aspect),
                           Vec2d(mesh.uvs[static_cast<std::size_t>(corner.uv)])};
        }
        for (const auto& part : clipped(triangle, wrong)) {
            std::array<Vec2, 3> p;
            bool out_of_range = false;
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec4d& c = part[k].clip;
                const Vec2d at((1 + (wrong.mirrored ? -c.x : c.x) / c.w) / 2 * width,
                               (1 - (wrong.upside_down ? -c.y : c.y) / c.w) / 2 * height);
                p[k] = Vec2(at) + Vec2{1, 1} * (wrong.pixel_corners ? 0.5f : 0.0f);
                out_of_range = out_of_range || !(std::abs(at.x) < 4e6 && std::abs(at.y) < 4e6);
            }
            if (out_of_range) continue;
            if (wrong.one_side_only &&
                lesson::edge_function(lesson::snap(p[0]), lesson::snap(p[1]), lesson::snap(p[2])) > 0)
                continue;
            lesson::for_each_pixel(p[0], p[1], p[2], width, height, [&](int x, int y, Vec3 weights) {
                Vec3d b(weights);
                const double z = b.x * part[0].clip.z / part[0].clip.w + b.y * part[1].clip.z / part[1].clip.w +
                                 b.z * part[2].clip.z / part[2].clip.w;
                if (!wrong.depth_unused && !(wrong.farthest_wins ? z > depth(x, y) : z < depth(x, y))) return;
                depth(x, y) = z;
                if (!wrong.affine) {
                    b = {b.x / part[0].clip.w, b.y / part[1].clip.w, b.z / part[2].clip.w};
                    b = b / (b.x + b.y + b.z);
                }
                Vec2d uv = part[0].uv * b.x + part[1].uv * b.y + part[2].uv * b.z;
                if (wrong.v_flipped) uv.y = 1 - uv.y;
                image(x, y) = sample_texture(texture, uv, wrong.nearest_texel);
            });
        }
    }
    return image;
}

inline std::string amphora_text() {
    std::ifstream file(DUET_MODELS "meshes/amphora.obj");
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}
/// The amphora, read by the examiner (all its faces are triangles "p/t/n").
inline const Mesh& amphora() {
    static const Mesh mesh = [] {
        Mesh m;
        std::istringstream text(amphora_text());
        for (std::string key; text >> key;) {
            float x = 0, y = 0, z = 0;
            if (key == "v" && text >> x >> y >> z) m.points.push_back({x, y, z});
            if (key == "vt" && text >> x >> y) m.uvs.push_back({x, y});
            char slash = 0;
            int normal = 0;
            Corner c;
            for (int k = 0; key == "f" && k < 3 && text >> c.point >> slash >> c.uv >> slash >> normal; ++k)
                m.corners.push_back({c.point - 1, c.uv - 1});
            if (key[0] == '#' || key == "vn") text.ignore(1000, '\n');
        }
        return m;
    }();
    return mesh;
}
/// Its texture, 256 × 256 texels.
inline const ImageRgb& amphora_texture() {
    static const ImageRgb texture = [] {
        const ImageRgb large = read_image(DUET_MODELS "textures/amphora.png");
        const int n = large.width() / 256;
        ImageRgb small(256, 256);
        for (int y = 0; y < 256 * n; ++y)
            for (int x = 0; x < 256 * n; ++x) small(x / n, y / n) += large(x, y) / static_cast<float>(n * n);
        return small;
    }();
    return texture;
}

/// A checkerboard whose corners have colors of their own, so that a turned or flipped one is seen.
inline ImageRgb checkerboard(int squares, int size) {
    ImageRgb image(squares * size, squares * size);
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            const float u = static_cast<float>(x) / static_cast<float>(image.width()),
                        v = static_cast<float>(y) / static_cast<float>(image.height());
            image(x, y) = Rgb(0.2f + 0.7f * u, 0.3f, 0.2f + 0.7f * v) * ((x / size + y / size) % 2 ? 1.0f : 0.35f);
        }
    return image;
}

/// Two triangles a quad, corners counter-clockwise from the lower left of the texture.
inline void add_quad(Mesh& mesh, const std::array<Vec3, 4>& corners) {
    const int p = static_cast<int>(mesh.points.size()), t = static_cast<int>(mesh.uvs.size());
    mesh.points.insert(mesh.points.end(), corners.begin(), corners.end());
    for (const Vec2 uv : {Vec2{0, 0}, Vec2{1, 0}, Vec2{1, 1}, Vec2{0, 1}}) mesh.uvs.push_back(uv);
    for (const int k : {0, 1, 2, 0, 2, 3}) mesh.corners.push_back({p + k, t + k});
}

/// How often the triangles hub, rim[i], rim[i + 1] cover each pixel by another rule than the top-left one: inside(w, a,
/// b) for a center with the value w at the edge from a to b.
template <typename Inside>
inline Image<int> count_fan_coverage(Vec2 hub, const std::vector<Vec2>& rim, int width, int height,
                                     const Inside& inside) {
    Image<int> image(width, height, 0);
    for (std::size_t i = 0; i < rim.size(); ++i) {
        const std::array p{lesson::snap(hub), lesson::snap(rim[i]), lesson::snap(rim[(i + 1) % rim.size()])};
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                bool covered = true;
                for (std::size_t k = 0; k < 3; ++k) {
                    const auto a = p[k], b = p[(k + 1) % 3];
                    covered = covered && inside(lesson::edge_function(a, b, lesson::pixel_center(x, y)), a, b);
                }
                image(x, y) += covered;
            }
    }
    return image;
}

/// The pixels that a triangle covers if 32 bits hold its edge functions.
inline Image<int> coverage_with_overflow(Vec2 pa, Vec2 pb, Vec2 pc, int width, int height) {
    lesson::FixedPoint a = lesson::snap(pa), b = lesson::snap(pb), c = lesson::snap(pc);
    const auto edge = [](auto p, auto q, auto r) { return static_cast<std::int32_t>(lesson::edge_function(p, q, r)); };
    if (edge(a, b, c) < 0) std::swap(b, c);
    Image<int> image(width, height, 0);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const lesson::FixedPoint p = lesson::pixel_center(x, y);
            image(x, y) = lesson::is_inside(edge(a, b, p), a, b) && lesson::is_inside(edge(b, c, p), b, c) &&
                          lesson::is_inside(edge(c, a, p), c, a);
        }
    return image;
}

} // namespace duet::grading
