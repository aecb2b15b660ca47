// The library's camera, which maps both ways (common/camera/camera.h), and its errors of images (compare/metrics/). The
// library has no function with the contracts of the other two; theirs are plain.
#include "common/camera/camera.h"
#include "compare/lessons/12-both-ways/lab.h"
#include "compare/metrics/image_metrics.h"

namespace duet::lab {

namespace {

Pinhole pinhole(const Camera& c, int width, int height) {
    duet::Camera camera;
    camera.eye = Vec3d(c.eye), camera.look_at = Vec3d(c.target), camera.up = Vec3d(c.up),
    camera.fov_degrees = c.fov_degrees;
    return CameraModel({camera, width, height}).pinhole();
}

} // namespace

Ray pixel_ray(const Camera& camera, int width, int height, int x, int y) {
    const Rayd ray = pinhole(camera, width, height).ray({x + 0.5, y + 0.5});
    return {Vec3(ray.origin), Vec3(ray.direction)}; // the library's t_min is at its near plane
}

std::optional<Vec2> project(const Camera& camera, int width, int height, Vec3 p) {
    const Vec3d place = pinhole(camera, width, height).project(Vec3d(p));
    return place.z > 0 ? std::optional(Vec2(Vec2d{place.x, place.y})) : std::nullopt;
}

Errors errors(const ImageRgb& encoded_image, const ImageRgb& encoded_reference) {
    const compare::ErrorMetrics e =
        compare::error_metrics(compare::decoded(encoded_image), compare::decoded(encoded_reference));
    return {average(e.mean_signed_error), e.mse, e.relmse};
}

Cause classify_pixel(const PixelResult& first, const PixelResult& second, float tolerance) {
    const Rgb d = first.color - second.color;
    if (max_component(Rgb(std::abs(d.r), std::abs(d.g), std::abs(d.b))) <= tolerance) return Cause::kSame;
    if (first.triangle != second.triangle) return Cause::kEdge;
    return std::abs(first.sun - second.sun) > tolerance ? Cause::kShadow : Cause::kLight;
}

ErrorComponents split_error(const std::vector<ImageRgb>& images, const ImageRgb& reference) {
    // The mean squared error of single images is noise + bias²; of their mean it is noise / n + bias².
    const double n = static_cast<double>(images.size());
    ImageRgb mean(reference.width(), reference.height());
    double single = 0;
    for (const ImageRgb& image : images) {
        for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += image[i] * static_cast<float>(1 / n);
        single += compare::error_metrics(image, reference).mse / n;
    }
    const double of_mean = compare::error_metrics(mean, reference).mse;
    const double noise = (single - of_mean) / (1 - 1 / n);
    return {noise, of_mean - noise / n};
}

} // namespace duet::lab
