// What a picture knows of the scene: the depth at each pixel. Effects in screen space look around in it.
#pragma once

#include "common/camera/camera.h"
#include "common/image/image.h"
#include "raster/samples.h"

#include <array>
#include <cstdint>
#include <optional>

namespace duet::raster {

/// The depths of one view, one sample a pixel. Positions are relative to the camera's eye.
class Screen {
public:
    /// `nearness`: near / depth of each pixel's sample, 0 where nothing is seen.
    Screen(const Pinhole& view, SampleOffset offset, ImageFloat nearness);

    int width() const { return nearness_.width(); }
    int height() const { return nearness_.height(); }
    Vec3 relative(Vec3 p) const { return Vec3(Vec3d(p) - eye_); }

    /// Where a point is seen: x and y in pixels, depth. Depth is 0 or less, and x and y mean nothing, behind the eye.
    Vec3 project(Vec3 p) const;
    /// What is seen at a pixel; nothing outside the picture, or where nothing is.
    std::optional<Vec3> seen(int x, int y) const;
    /// Depth at a pixel; infinity where nothing is seen. The pixel must be one.
    float depth(int x, int y) const { return near_ / nearness_(x, y); }
    bool perspective() const { return perspective_; }
    /// A picture of what is seen, once it is there; `lamps`: 1 where that is one of Scene::lights.
    void set_radiance(ImageRgb radiance, Image<std::uint8_t> lamps) {
        radiance_ = std::move(radiance);
        lamps_ = std::move(lamps);
    }
    bool is_lamp(int x, int y) const { return lamps_(x, y) != 0; }
    const ImageRgb& radiance() const { return radiance_; }
    bool contains(float x, float y) const {
        return x >= 0 && y >= 0 && x < static_cast<float>(width()) && y < static_cast<float>(height());
    }

private:
    Vec3d eye_;
    Vec3 origin_, origin_dx_, origin_dy_, direction_, direction_dx_, direction_dy_; ///< as Pinhole's, from pixel (0, 0)
    std::array<Vec4, 4> to_pixel_;
    float near_;
    bool perspective_;
    ImageFloat nearness_;
    ImageRgb radiance_;
    Image<std::uint8_t> lamps_;
};

} // namespace duet::raster
