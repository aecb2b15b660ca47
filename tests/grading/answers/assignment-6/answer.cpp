// Both pipelines and the report, in the plainest way.
#include "compare/lessons/assignments/6-comparison/lab.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace duet::lab {

namespace {

/// These are the camera's axes and the size of its image.
struct View {
    Vec3 eye, right, up, forward;
    float focal; // the distance of the image in pixels
    float center_x, center_y, near;
};

View make_view(const Camera& camera, int width, int height) {
    View view;
    view.eye = camera.eye;
    view.forward = normalize(camera.target - camera.eye);
    view.right = normalize(cross(view.forward, camera.up));
    view.up = cross(view.right, view.forward);
    const float half_angle = camera.fov_degrees * kPi / 360;
    view.focal = static_cast<float>(height) / 2 / std::tan(half_angle);
    view.center_x = static_cast<float>(width) / 2;
    view.center_y = static_cast<float>(height) / 2;
    view.near = camera.near;
    return view;
}

Vec3 ray_direction(const View& view, float x, float y) {
    const Vec3 to_pixel = view.right * (x - view.center_x) + view.up * (view.center_y - y) + view.forward * view.focal;
    return normalize(to_pixel);
}

Vec3 normal_of(const Triangle& t) { return normalize(cross(t.b - t.a, t.c - t.a)); }

Rgb shade(const Scene& scene, const Triangle& t, Vec3 toward_eye, bool lit) {
    Vec3 n = normal_of(t);
    if (dot(n, toward_eye) < 0) n = -n;
    const float cosine = std::max(0.0f, dot(n, scene.to_sun));
    Rgb light = scene.sky;
    if (lit) light = light + scene.sun * cosine;
    return t.albedo * light;
}

struct Found {
    int triangle = -1;
    float t = kInfinity;
};

Found nearest(const Scene& scene, Vec3 origin, Vec3 direction, float t_min) {
    Found found;
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
        const Triangle& tri = scene.triangles[i];
        const Vec3d ab(tri.b - tri.a), ac(tri.c - tri.a), d(direction), o = Vec3d(origin) - Vec3d(tri.a);
        const Vec3d p = cross(d, ac);
        const double det = dot(ab, p);
        if (det == 0) continue;
        const double u = dot(o, p) / det;
        const Vec3d q = cross(o, ab);
        const double v = dot(d, q) / det;
        if (u < 0 || v < 0 || u + v > 1) continue;
        const float t = static_cast<float>(dot(ac, q) / det);
        if (t > t_min && t < found.t) found = {static_cast<int>(i), t};
    }
    return found;
}

float start_of_ray(const View& view, Vec3 direction) { return view.near / dot(direction, view.forward); }

Rendering empty_rendering(int width, int height) {
    return {ImageRgb(width, height), Image<int>(width, height, -1), ImageFloat(width, height, kInfinity)};
}

struct Corner {
    float x, y, z; // right, up and forward of the eye
};

Corner to_camera(const View& view, Vec3 p) {
    const Vec3 from_eye = p - view.eye;
    return {dot(from_eye, view.right), dot(from_eye, view.up), dot(from_eye, view.forward)};
}

std::vector<Corner> clip(const std::array<Corner, 3>& corners, float near) {
    std::vector<Corner> result;
    for (std::size_t i = 0; i < 3; ++i) {
        const Corner a = corners[i], b = corners[(i + 1) % 3];
        if (a.z >= near) result.push_back(a);
        if ((a.z >= near) != (b.z >= near)) {
            const float s = (near - a.z) / (b.z - a.z);
            result.push_back({a.x + (b.x - a.x) * s, a.y + (b.y - a.y) * s, near});
        }
    }
    return result;
}

struct Point {
    double x, y, w; // pixels, and 1 / z
};

double edge(Point a, Point b, Point p) { return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x); }

bool top_left(Point a, Point b) { return b.y < a.y || (b.y == a.y && b.x > a.x); }

void draw(Rendering& out, const Scene& scene, const View& view, int index, Point a, Point b, Point c) {
    if (edge(a, b, c) < 0) std::swap(b, c);
    const double area = edge(a, b, c);
    if (area == 0) return;
    const int width = out.color.width(), height = out.color.height();
    const auto bound = [](double x, int size) {
        return static_cast<int>(std::clamp(x, 0.0, static_cast<double>(size)));
    };
    const int left = bound(std::floor(std::min({a.x, b.x, c.x})), width),
              right = bound(std::ceil(std::max({a.x, b.x, c.x})), width);
    const int top = bound(std::floor(std::min({a.y, b.y, c.y})), height),
              bottom = bound(std::ceil(std::max({a.y, b.y, c.y})), height);
    for (int y = top; y < bottom; ++y) {
        for (int x = left; x < right; ++x) {
            const Point p{x + 0.5, y + 0.5, 0};
            const double wa = edge(b, c, p), wb = edge(c, a, p), wc = edge(a, b, p);
            const bool in_a = wa > 0 || (wa == 0 && top_left(b, c));
            const bool in_b = wb > 0 || (wb == 0 && top_left(c, a));
            const bool in_c = wc > 0 || (wc == 0 && top_left(a, b));
            if (!in_a || !in_b || !in_c) continue;
            const double z = area / (wa * a.w + wb * b.w + wc * c.w);
            const Vec3 direction = ray_direction(view, static_cast<float>(p.x), static_cast<float>(p.y));
            const float distance = static_cast<float>(z / dot(direction, view.forward));
            if (distance >= out.distance(x, y)) continue;
            out.distance(x, y) = distance;
            out.triangle(x, y) = index;
            out.color(x, y) = shade(scene, scene.triangles[static_cast<std::size_t>(index)], -direction, true);
        }
    }
}

} // namespace

Rendering rasterize(const Scene& scene, const Camera& camera, int width, int height) {
    const View view = make_view(camera, width, height);
    Rendering out = empty_rendering(width, height);
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
        const Triangle& t = scene.triangles[i];
        const std::vector<Corner> polygon =
            clip({to_camera(view, t.a), to_camera(view, t.b), to_camera(view, t.c)}, view.near);
        std::vector<Point> points;
        for (const Corner& corner : polygon) {
            const double w = 1.0 / static_cast<double>(corner.z);
            points.push_back({view.center_x + view.focal * corner.x * w, view.center_y - view.focal * corner.y * w, w});
        }
        for (std::size_t k = 2; k < points.size(); ++k)
            draw(out, scene, view, static_cast<int>(i), points[0], points[k - 1], points[k]);
    }
    return out;
}

Rendering ray_trace(const Scene& scene, const Camera& camera, int width, int height, bool shadows) {
    const View view = make_view(camera, width, height);
    Rendering out = empty_rendering(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const Vec3 direction = ray_direction(view, static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
            const Found found = nearest(scene, view.eye, direction, start_of_ray(view, direction));
            if (found.triangle < 0) continue;
            const Triangle& t = scene.triangles[static_cast<std::size_t>(found.triangle)];
            bool lit = true;
            if (shadows) {
                Vec3 n = normal_of(t);
                if (dot(n, direction) > 0) n = -n;
                const Vec3 p = view.eye + direction * found.t + n * (1e-4f * found.t);
                lit = nearest(scene, p, scene.to_sun, 0).triangle < 0;
            }
            out.triangle(x, y) = found.triangle;
            out.distance(x, y) = found.t;
            out.color(x, y) = shade(scene, t, -direction, lit);
        }
    }
    return out;
}

int triangle_at(const Scene& scene, const Camera& camera, int width, int height, float x, float y) {
    const View view = make_view(camera, width, height);
    const Vec3 direction = ray_direction(view, x, y);
    return nearest(scene, view.eye, direction, start_of_ray(view, direction)).triangle;
}

Errors errors(const ImageRgb& image, const ImageRgb& reference) {
    Errors result;
    for (std::size_t i = 0; i < image.size(); ++i) {
        for (int channel = 0; channel < 3; ++channel) {
            const double a = image[i][static_cast<std::size_t>(channel)],
                         b = reference[i][static_cast<std::size_t>(channel)];
            result.mse += (a - b) * (a - b);
            result.relmse += (a - b) * (a - b) / (b * b + 0.01);
            result.mean_signed_error += a - b;
        }
    }
    const double count = 3.0 * static_cast<double>(image.size());
    result.mse /= count;
    result.relmse /= count;
    result.mean_signed_error /= count;
    result.rmse = std::sqrt(result.mse);
    return result;
}

HitCounts compare_hits(const Scene& scene, const Camera& camera, const Rendering& raster, const Rendering& traced) {
    HitCounts counts;
    const int width = raster.triangle.width(), height = raster.triangle.height();
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const int wanted = raster.triangle(x, y);
            if (wanted == traced.triangle(x, y)) {
                ++counts.same;
                continue;
            }
            bool near_edge = false;
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx)
                    if (triangle_at(scene, camera, width, height,
                                    static_cast<float>(x) + 0.5f + static_cast<float>(dx) / 128,
                                    static_cast<float>(y) + 0.5f + static_cast<float>(dy) / 128) == wanted)
                        near_edge = true;
            const float a = raster.distance(x, y), b = traced.distance(x, y);
            if (near_edge)
                ++counts.edge;
            else if (std::max(a, b) < kInfinity && std::abs(a - b) <= 1e-5f * std::max(a, b))
                ++counts.tie;
            else
                ++counts.unexplained;
        }
    }
    return counts;
}

ImageRgb difference_image(const ImageRgb& image, const ImageRgb& reference, float range) {
    ImageRgb result(image.width(), image.height());
    for (std::size_t i = 0; i < image.size(); ++i) {
        const float d = std::clamp((luminance(image[i]) - luminance(reference[i])) / range, -1.0f, 1.0f);
        if (d > 0) result[i] = Rgb(d, 0, 0);
        if (d < 0) result[i] = Rgb(0, 0, -d);
    }
    return result;
}

} // namespace duet::lab
