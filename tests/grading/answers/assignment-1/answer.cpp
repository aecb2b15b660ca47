// A rasterizer: an OBJ file, a camera, clipping, coverage, depth and texture.
#include "compare/lessons/assignments/1-rasterizer/lab.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <sstream>

namespace duet::lab {

Mesh parse_obj(const std::string& text) {
    Mesh mesh;
    std::istringstream lines(text);
    std::string line;
    while (std::getline(lines, line)) {
        std::istringstream words(line);
        std::string key;
        words >> key;
        if (key == "v") {
            Vec3 p;
            words >> p.x >> p.y >> p.z;
            mesh.points.push_back(p);
        } else if (key == "vt") {
            Vec2 uv;
            words >> uv.x >> uv.y;
            mesh.uvs.push_back(uv);
        } else if (key == "f") {
            std::vector<Corner> face;
            std::string word;
            while (words >> word) {
                const std::size_t slash = word.find('/');
                const int point = std::stoi(word);
                const int uv = std::stoi(word.substr(slash + 1));
                face.push_back({point - 1, uv - 1});
            }
            for (std::size_t i = 1; i + 1 < face.size(); ++i) {
                mesh.corners.push_back(face[0]);
                mesh.corners.push_back(face[i]);
                mesh.corners.push_back(face[i + 1]);
            }
        }
    }
    return mesh;
}

Vec4 to_clip(Vec3 p, const Camera& camera, float aspect) {
    const Vec3 back = normalize(camera.eye - camera.target);
    const Vec3 right = normalize(cross(camera.up, back));
    const Vec3 top = cross(back, right);
    const Vec3 q = p - camera.eye;
    const float f = 1 / std::tan(camera.fov / 2);
    const float w = -dot(back, q);
    return {f / aspect * dot(right, q), f * dot(top, q), w - camera.near, w};
}

Vertex crossing(const Vertex& front, const Vertex& behind) {
    const float t = front.clip.z / (front.clip.z - behind.clip.z);
    return {front.clip * (1 - t) + behind.clip * t, front.uv * (1 - t) + behind.uv * t};
}

std::vector<Triangle> clip_near(const Triangle& triangle) {
    std::vector<Vertex> outline;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vertex& a = triangle[i];
        const Vertex& b = triangle[(i + 1) % 3];
        const bool a_in = a.clip.z >= 0, b_in = b.clip.z >= 0;
        if (a_in) outline.push_back(a);
        if (a_in && !b_in) outline.push_back(crossing(a, b));
        if (!a_in && b_in) outline.push_back(crossing(b, a));
    }
    std::vector<Triangle> parts;
    for (std::size_t i = 2; i < outline.size(); ++i) parts.push_back({outline[0], outline[i - 1], outline[i]});
    return parts;
}

struct Grid {
    std::int64_t x, y;
};
std::int64_t edge(Grid a, Grid b, Grid p) { return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x); }
bool inside(std::int64_t w, Grid a, Grid b) {
    const bool top_left = b.y < a.y || (b.y == a.y && b.x > a.x);
    return w > 0 || (w == 0 && top_left);
}

std::vector<Fragment> rasterize(Vec2 a_pixels, Vec2 b_pixels, Vec2 c_pixels, int width, int height) {
    const auto snap = [](Vec2 p) { return Grid{std::llround(p.x * 256), std::llround(p.y * 256)}; };
    Grid a = snap(a_pixels), b = snap(b_pixels), c = snap(c_pixels);
    bool turned = false;
    if (edge(a, b, c) < 0) {
        std::swap(b, c);
        turned = true;
    }
    const float area = static_cast<float>(edge(a, b, c));
    if (area == 0) return {};
    const auto pixel = [](std::int64_t x) { return static_cast<int>(x >> 8); };
    const int left = std::max(0, pixel(std::min({a.x, b.x, c.x})));
    const int right = std::min(width - 1, pixel(std::max({a.x, b.x, c.x})));
    const int top = std::max(0, pixel(std::min({a.y, b.y, c.y})));
    const int bottom = std::min(height - 1, pixel(std::max({a.y, b.y, c.y})));
    std::vector<Fragment> fragments;
    for (int y = top; y <= bottom; ++y)
        for (int x = left; x <= right; ++x) {
            const Grid p{256 * x + 128, 256 * y + 128};
            const std::int64_t wa = edge(b, c, p), wb = edge(c, a, p), wc = edge(a, b, p);
            if (!inside(wa, b, c) || !inside(wb, c, a) || !inside(wc, a, b)) continue;
            Vec3 weights{static_cast<float>(wa) / area, static_cast<float>(wb) / area, static_cast<float>(wc) / area};
            if (turned) std::swap(weights.y, weights.z);
            fragments.push_back({x, y, weights});
        }
    return fragments;
}

Vec3 perspective_weights(Vec3 weights, Vec3 w) {
    const Vec3 over{weights.x / w.x, weights.y / w.y, weights.z / w.z};
    return over / (over.x + over.y + over.z);
}

Rgb texel(const ImageRgb& texture, int x, int y) {
    const int w = texture.width(), h = texture.height();
    x = ((x % w) + w) % w;
    y = ((y % h) + h) % h;
    return texture(x, h - 1 - y);
}

Rgb sample(const ImageRgb& texture, Vec2 uv) {
    const float x = uv.x * static_cast<float>(texture.width()) - 0.5f;
    const float y = uv.y * static_cast<float>(texture.height()) - 0.5f;
    const int i = static_cast<int>(std::floor(x));
    const int j = static_cast<int>(std::floor(y));
    const float s = x - std::floor(x), t = y - std::floor(y);
    const Rgb low = texel(texture, i, j) * (1 - s) + texel(texture, i + 1, j) * s;
    const Rgb high = texel(texture, i, j + 1) * (1 - s) + texel(texture, i + 1, j + 1) * s;
    return low * (1 - t) + high * t;
}

ImageRgb draw(const Mesh& mesh, const Camera& camera, const ImageRgb& texture, int width, int height, Rgb background) {
    ImageRgb image(width, height, background);
    Image<float> depth(width, height, kInfinity);
    const float aspect = static_cast<float>(width) / static_cast<float>(height);
    for (std::size_t i = 0; i + 2 < mesh.corners.size(); i += 3) {
        Triangle triangle;
        for (std::size_t k = 0; k < 3; ++k) {
            const Corner corner = mesh.corners[i + k];
            const Vec3 p = mesh.points[static_cast<std::size_t>(corner.point)];
            triangle[k].clip = to_clip(p, camera, aspect);
            triangle[k].uv = mesh.uvs[static_cast<std::size_t>(corner.uv)];
        }
        for (const Triangle& part : clip_near(triangle)) {
            std::array<Vec2, 3> at;
            Vec3 z, w;
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec4 clip = part[k].clip;
                at[k].x = (1 + clip.x / clip.w) / 2 * static_cast<float>(width);
                at[k].y = (1 - clip.y / clip.w) / 2 * static_cast<float>(height);
                z[k] = clip.z / clip.w;
                w[k] = clip.w;
            }
            for (const Fragment& f : rasterize(at[0], at[1], at[2], width, height)) {
                const float here = dot(f.weights, z);
                if (here >= depth(f.x, f.y)) continue;
                depth(f.x, f.y) = here;
                const Vec3 b = perspective_weights(f.weights, w);
                const Vec2 uv = part[0].uv * b.x + part[1].uv * b.y + part[2].uv * b.z;
                image(f.x, f.y) = sample(texture, uv);
            }
        }
    }
    return image;
}

} // namespace duet::lab
