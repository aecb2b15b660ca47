#include "raster/gbuffer/screen_gbuffer.h"

#include "raster/screen_space/occlusion_image.h"

namespace duet::raster {

ScreenGBuffer::ScreenGBuffer(const Pinhole& view, SampleOffset offset, ImageFloat reversed_depth)
    : eye_(view.origin), near_(static_cast<float>(view.near)),
      perspective_(view.world_to_pixel[3] == view.world_to_pixel[2]), reversed_depth_(std::move(reversed_depth)),
      nearest_(reversed_depth_) {
    const Vec2d first = offset.position(0, 0);
    origin_ = Vec3(view.origin_dx * first.x + view.origin_dy * first.y);
    origin_dx_ = Vec3(view.origin_dx), origin_dy_ = Vec3(view.origin_dy);
    direction_ = Vec3(view.direction + view.direction_dx * first.x + view.direction_dy * first.y);
    direction_dx_ = Vec3(view.direction_dx), direction_dy_ = Vec3(view.direction_dy);
    for (std::size_t row = 0; row < 4; ++row) {
        const auto& m = view.world_to_pixel[row];
        const double shifted = m[0] * eye_.x + m[1] * eye_.y + m[2] * eye_.z + m[3];
        to_pixel_[row] = {static_cast<float>(m[0]), static_cast<float>(m[1]), static_cast<float>(m[2]),
                          static_cast<float>(shifted)};
    }
}

void ScreenGBuffer::set_normals(const ImageRgb& colors) {
    for (ImageFloat& plane : normals_) plane = ImageFloat(width(), height());
    for (std::size_t i = 0; i < colors.size(); ++i) {
        const Vec3 n(2 * colors[i].r - 1, 2 * colors[i].g - 1, 2 * colors[i].b - 1);
        const Vec3 unit = n / max(length(n), 1e-6f);
        normals_[0][i] = unit.x, normals_[1][i] = unit.y, normals_[2][i] = unit.z;
    }
}

std::optional<Vec3> ScreenGBuffer::visible_point(int x, int y) const {
    if (x < 0 || y < 0 || x >= width() || y >= height()) return std::nullopt;
    const float reversed_depth = reversed_depth_(x, y);
    if (!(reversed_depth > 0)) return std::nullopt;
    return at(static_cast<float>(x), static_cast<float>(y), reversed_depth);
}

std::size_t ScreenGBuffer::memory_bytes() const {
    const auto bytes_of = [](const auto& image) { return image.size() * sizeof(image[0]); };
    const ColorPrepass& prepass = color_prepass_;
    std::size_t sum = bytes_of(reversed_depth_) + static_cast<std::size_t>(nearest_.memory_bytes()) +
                      bytes_of(normal_angles_) + bytes_of(thickness_) + bytes_of(prepass.keys) +
                      bytes_of(prepass.objects) + bytes_of(prepass.light_mask) + prepass.radiance.memory_bytes() +
                      prepass.radiance_without_lights.memory_bytes() + flat_radiance_.memory_bytes();
    for (const ImageFloat& plane : normals_) sum += bytes_of(plane);
    if (occlusion_) sum += occlusion_->memory_bytes();
    for (const auto& other : {behind_, back_faces_})
        if (other) sum += other->memory_bytes();
    return sum;
}

} // namespace duet::raster
