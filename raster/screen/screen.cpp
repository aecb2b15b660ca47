#include "raster/screen/screen.h"

#include "raster/screen/occlusion_image.h"

namespace duet::raster {

Screen::Screen(const Pinhole& view, SampleOffset offset, ImageFloat nearness)
    : eye_(view.origin), near_(static_cast<float>(view.near)),
      perspective_(view.world_to_pixel[3] == view.world_to_pixel[2]), nearness_(std::move(nearness)),
      nearest_(nearness_) {
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

void Screen::set_normals(const ImageRgb& colors) {
    for (ImageFloat& plane : normals_) plane = ImageFloat(width(), height());
    for (std::size_t i = 0; i < colors.size(); ++i) {
        const Vec3 n(2 * colors[i].r - 1, 2 * colors[i].g - 1, 2 * colors[i].b - 1);
        const Vec3 unit = n / max(length(n), 1e-6f);
        normals_[0][i] = unit.x, normals_[1][i] = unit.y, normals_[2][i] = unit.z;
    }
}

std::optional<Vec3> Screen::seen(int x, int y) const {
    if (x < 0 || y < 0 || x >= width() || y >= height()) return std::nullopt;
    const float nearness = nearness_(x, y);
    if (!(nearness > 0)) return std::nullopt;
    return at(static_cast<float>(x), static_cast<float>(y), nearness);
}

std::size_t Screen::memory_bytes() const {
    const auto bytes_of = [](const auto& image) { return image.size() * sizeof(image[0]); };
    const FirstLook& look = first_look_;
    std::size_t sum = bytes_of(nearness_) + static_cast<std::size_t>(nearest_.memory_bytes()) + bytes_of(turns_) +
        bytes_of(thickness_) +
                      bytes_of(look.keys) + bytes_of(look.objects) + bytes_of(look.lamps) +
                          look.radiance.memory_bytes() +
                      look.without_lamps.memory_bytes() + flat_look_.memory_bytes();
    for (const ImageFloat& plane : normals_) sum += bytes_of(plane);
    if (occlusion_) sum += occlusion_->memory_bytes();
    for (const auto& other : {behind_, backs_})
        if (other) sum += other->memory_bytes();
    return sum;
}

} // namespace duet::raster
