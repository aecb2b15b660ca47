#include "raster/gbuffer/screen_projection.h"

namespace duet::raster {

ScreenProjection::ScreenProjection(const Pinhole& view, SampleOffset offset)
    : eye_(view.origin), near_(static_cast<float>(view.near)),
      perspective_(view.world_to_pixel[3] == view.world_to_pixel[2]) {
    const Vec2d first = offset.position(0, 0);
    origin_ = Vec3(view.origin_dx * first.x + view.origin_dy * first.y);
    origin_dx_ = Vec3(view.origin_dx), origin_dy_ = Vec3(view.origin_dy);
    direction_ = Vec3(view.direction + view.direction_dx * first.x + view.direction_dy * first.y);
    direction_dx_ = Vec3(view.direction_dx), direction_dy_ = Vec3(view.direction_dy);
    for (std::size_t row = 0; row < 4; ++row) {
        const auto& m = view.world_to_pixel[row];
        double constant = m[0] * eye_.x + m[1] * eye_.y + m[2] * eye_.z + m[3];
        Vec3d linear(m[0], m[1], m[2]);
        if (row < 2) { // shift x and y so that the sample of pixel (x, y) projects to exactly (x, y)
            const auto& w = view.world_to_pixel[3];
            const double shift = row == 0 ? first.x : first.y;
            linear = linear - Vec3d(w[0], w[1], w[2]) * shift;
            constant -= shift * (w[0] * eye_.x + w[1] * eye_.y + w[2] * eye_.z + w[3]);
        }
        to_pixel_[row] = {static_cast<float>(linear.x), static_cast<float>(linear.y), static_cast<float>(linear.z),
                          static_cast<float>(constant)};
    }
}

} // namespace duet::raster
