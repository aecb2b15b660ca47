// One mesh drawn both ways, and what differs between two images.
#pragma once

#include "raster/lessons/09-shadow-maps/shadow.h"
#include "raytrace/lessons/05-diffuse/diffuse.h"
#include "raytrace/lessons/07-camera/camera.h"
#include "raytrace/lessons/08-bvh/bvh.h"

namespace duet::lesson {

/// Way 1: for each triangle, the pixels that it covers. shade(hit) is the color of a point that is seen.
inline ImageRgb rasterize(const Mesh& world, const View& view, int width, int height, const auto& shade) {
    Framebuffer target(width, height, Rgb(0));
    const Mat4 projection = perspective(float(radians(view.fov_degrees)), float(width) / float(height), 0.1f, 30);
    const auto triangles = in_clip_space(world, projection * look_at(view.eye, view.look_at, view.up));
    draw_triangles(target, triangles, [&](const Fragment& f) {
        const auto& [a, b, c] = f.triangle;
        const Vec3 outward = normalize(cross(b.p - a.p, c.p - a.p));
        return shade(make_hit({view.eye, f.p - view.eye}, 1, outward, std::size_t(&f.triangle - &triangles[0])));
    });
    return target.color;
}

/// Way 2: for each pixel, the triangle that its ray meets. Only the mistakes need another scale and another half.
inline ImageRgb trace(const Bvh& tree, const View& view, int width, int height, const auto& shade,
                      Vec3 scale = {1, 1, 1}, float half = 0.5f) {
    const Camera camera(view, width, height);
    const Vec3 middle{float(width) / 2, float(height) / 2, 0};
    ImageRgb image(width, height);
    for (int i = 0; i < width * height; ++i) {
        const Vec3 p = middle + (Vec3{float(i % width) + half, float(i / width) + half, 0} - middle) * scale;
        if (const auto hit = closest_hit(tree, camera.ray(p.x, p.y, Vec2(0, 0)))) image[std::size_t(i)] = shade(*hit);
    }
    return image;
}

/// The means of d = image - b, of d² (MSE), and of d² / (b² + 0.01) (relMSE), where b is the reference.
inline Vec3d errors(const ImageRgb& image, const ImageRgb& reference) {
    Vec3d sum;
    for (std::size_t i = 0; i < 3 * image.size(); ++i) {
        const double b = reference[i / 3][i % 3], d = image[i / 3][i % 3] - b;
        sum += Vec3d{d, d * d, d * d / (b * b + 0.01)};
    }
    return sum / (3 * double(image.size()));
}

/// White where both are equally bright, orange where the image is brighter, blue where it is darker, full at `range`.
inline ImageRgb signed_difference(ImageRgb image, const ImageRgb& reference, float range) {
    for (std::size_t i = 0; i < image.size(); ++i) {
        const float d = (luminance(image[i]) - luminance(reference[i])) / range;
        image[i] = lerp(Rgb(0.9f), d > 0 ? Rgb(0.85f, 0.2f, 0) : Rgb(0, 0.1f, 0.6f), min(std::abs(d), 1.0f));
    }
    return image;
}

} // namespace duet::lesson
