// This header declares the G-buffer, with depth and normal at each pixel, that screen-space effects sample.
#pragma once

#include "common/camera/camera.h"
#include "common/image/image.h"
#include "raster/geometry/samples.h"
#include "raster/lanes.h"
#include "raster/screen/radiance_pyramid.h"
#include "raster/visibility/nearest_pyramid.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

namespace duet::raster {

class OcclusionImage; // raster/screen/occlusion_image.h

/// A screen is the G-buffer of one view with one sample per pixel. Positions are relative to the camera's eye.
class Screen {
public:
    Screen(const Screen&) = delete; // its occlusion refers to it
    Screen& operator=(const Screen&) = delete;
    /// `nearness` is the reversed depth, near / depth, of each pixel's sample; 0 for the background.
    Screen(const Pinhole& view, SampleOffset offset, ImageFloat nearness);

    int width() const { return nearness_.width(); }
    int height() const { return nearness_.height(); }
    Vec3 relative(Vec3 p) const { return Vec3(Vec3d(p) - eye_); }
    Vec3 absolute(Vec3 relative) const { return Vec3(Vec3d(relative) + eye_); }

    /// Projects a point: x and y in pixels, and depth. Behind the eye depth is 0 or less, and x and y are
    /// meaningless.
    Vec3 project(Vec3 p) const {
        const auto [x, y, depth, w] = homogeneous(p);
        return {x / w, y / w, depth};
    }
    /// Returns the pixel that contains a projected point, or the nearest pixel.
    std::pair<int, int> pixel_at(Vec3 place) const {
        const auto within = [](float at, int size) {
            return static_cast<int>(clamp(at, 0.0f, static_cast<float>(size - 1)));
        };
        return {within(place.x, width()), within(place.y, height())};
    }
    /// Returns the visible point at a pixel; empty outside the image and for the background.
    std::optional<Vec3> seen(int x, int y) const;
    /// Returns the depth at a pixel inside the image; infinity for the background.
    float depth(int x, int y) const { return near_ / nearness_(x, y); }
    bool perspective() const { return perspective_; }
    bool contains(float x, float y) const {
        return x >= 0 && y >= 0 && x < static_cast<float>(width()) && y < static_cast<float>(height());
    }

    // The following functions accept one point or a SIMD batch.

    /// Returns x·w, y·w, depth and w of a point. The second function returns their change over the displacement
    /// `way`.
    template <typename T> std::array<T, 4> homogeneous(Vec3T<T> p) const {
        std::array<T, 4> h = homogeneous_change(p);
        for (std::size_t row = 0; row < 4; ++row) h[row] += T(to_pixel_[row].w);
        return h;
    }
    template <typename T> std::array<T, 4> homogeneous_change(Vec3T<T> way) const {
        const auto row = [&](std::size_t r) {
            const Vec4& m = to_pixel_[r];
            return T(m.x) * way.x + T(m.y) * way.y + T(m.z) * way.z;
        };
        return {row(0), row(1), row(2), row(3)};
    }
    /// Returns the visible point of the pixel in column x and row y, both integers, at the reversed depth `nearness`.
    template <typename T> Vec3T<T> at(T x, T y, T nearness) const {
        const T depth = T(near_) / nearness;
        const auto axis = [&](float Vec3::*c) {
            return T(origin_.*c) + T(origin_dx_.*c) * x + T(origin_dy_.*c) * y +
                   (T(direction_.*c) + T(direction_dx_.*c) * x + T(direction_dy_.*c) * y) * depth;
        };
        return {axis(&Vec3::x), axis(&Vec3::y), axis(&Vec3::z)};
    }
    /// Returns the unit direction from a visible point to the viewer.
    template <typename T> Vec3T<T> to_viewer(Vec3T<T> p) const {
        const Vec3T<T> way = perspective_ ? p : Vec3T<T>{T(direction_.x), T(direction_.y), T(direction_.z)};
        return way * -inverse_sqrt(dot(way, way));
    }
    /// Returns the width of a pixel at a depth, in meters.
    template <typename T> T pixel_size(T depth) const {
        return perspective_ ? T(length(direction_dx_)) * depth : T(length(origin_dx_));
    }
    float near() const { return near_; }
    const ImageFloat& nearness() const { return nearness_; }
    /// Returns the greatest reversed depth in the pixel's block of 2^level × 2^level, or in a larger one.
    float greatest_nearness(int x, int y, int level) const { return nearest_.of_block(x, y, level); }

    /// Sets the unit shading normals on the viewer's side, encoded as colors like Shading::kNormal. The background's
    /// normals are arbitrary.
    void set_normals(const ImageRgb& colors);
    const std::array<ImageFloat, 3>& normals() const { return normals_; }
    Vec3 normal(int x, int y) const { return {normals_[0](x, y), normals_[1](x, y), normals_[2](x, y)}; }

    /// Sets the angle between each pixel's normal and its neighbors' (normal_turn).
    void set_turns(ImageFloat turns) { turns_ = std::move(turns); }
    float turn(int x, int y) const { return turns_(x, y); }
    /// Sets the depth in meters from each visible surface to the nearest back face behind it, for closed objects; 0
    /// for others. thickness() is 0 before this call.
    void set_thickness(ImageFloat thickness) { thickness_ = std::move(thickness); }
    float thickness(int x, int y) const { return thickness_.empty() ? 0.0f : thickness_(x, y); }

    /// Sets the ambient occlusion; occlusion() is null before this call.
    void set_occlusion(std::shared_ptr<const OcclusionImage> occlusion) { occlusion_ = std::move(occlusion); }
    const OcclusionImage* occlusion() const { return occlusion_.get(); }

    /// Stores the color prepass, shaded at the pixels' centers. `keys` identifies the surface of each pixel
    /// (FirstLookPicture::key) and is 0 where the radiance must not be reused. `objects` has object IDs. `lamps`
    /// marks lights that rays intersect directly (PreparedData::lamps). The pyramids have the radiance with and
    /// without these lights.
    struct FirstLook {
        Image<std::uint32_t> keys, objects;
        Image<std::uint8_t> lamps;
        RadiancePyramid radiance, without_lamps;
    };
    void set_first_look(FirstLook look) { first_look_ = std::move(look); }
    const FirstLook& first_look() const { return first_look_; }
    /// Sets the radiance of flat surfaces, which are assumed to continue behind occluders, and of the background
    /// (flat_look in raster/screen/flat_look.h). It is empty before this call, and if there is neither.
    void set_flat_look(RadiancePyramid look) { flat_look_ = std::move(look); }
    const RadiancePyramid& flat_look() const { return flat_look_; }

    /// Sets the layer behind the glass and the nearest back faces of glass. In the layer each pixel shows the next
    /// object behind its glass; it has a color prepass and may have its own layer behind it. Both are null without
    /// glass.
    void set_glass(std::shared_ptr<const Screen> behind, std::shared_ptr<const Screen> backs) {
        behind_ = std::move(behind), backs_ = std::move(backs);
    }
    const Screen* behind() const { return behind_.get(); }
    const Screen* backs() const { return backs_.get(); }
    /// Sets the front layer of the view; front() is this screen if it is not set.
    void set_front(const Screen& front) { front_ = &front; }
    const Screen& front() const { return front_ != nullptr ? *front_ : *this; }

    /// Returns the memory of this screen, its back faces, and the layers behind it.
    std::size_t memory_bytes() const;

private:
    Vec3d eye_;
    /// These vectors are as in Pinhole, but relative to pixel (0, 0).
    Vec3 origin_, origin_dx_, origin_dy_, direction_, direction_dx_, direction_dy_;
    std::array<Vec4, 4> to_pixel_;
    float near_;
    bool perspective_;
    ImageFloat nearness_;
    NearestPyramid nearest_;
    std::array<ImageFloat, 3> normals_;
    std::shared_ptr<const OcclusionImage> occlusion_;
    FirstLook first_look_;
    RadiancePyramid flat_look_;
    ImageFloat turns_, thickness_;
    std::shared_ptr<const Screen> behind_, backs_;
    const Screen* front_ = nullptr;
};

} // namespace duet::raster
