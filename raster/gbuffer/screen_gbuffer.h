// This header declares the G-buffer, with depth and normal at each pixel, that screen-space effects sample.
#pragma once

#include "common/camera/camera.h"
#include "common/image/image.h"
#include "raster/gbuffer/radiance_pyramid.h"
#include "raster/geometry/packet.h"
#include "raster/geometry/sample_positions.h"
#include "raster/visibility/hi_z_pyramid.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

namespace duet::raster {

class OcclusionImage; // raster/screen_space/occlusion_image.h

/// This is the G-buffer of one view with one sample per pixel. Positions are relative to the camera's eye.
class ScreenGBuffer {
public:
    ScreenGBuffer(const ScreenGBuffer&) = delete; // its occlusion refers to it
    ScreenGBuffer& operator=(const ScreenGBuffer&) = delete;
    /// `reversed_depth` is the reversed depth, near / depth, of each pixel's sample; 0 for the background.
    ScreenGBuffer(const Pinhole& view, SampleOffset offset, ImageFloat reversed_depth);

    int width() const { return reversed_depth_.width(); }
    int height() const { return reversed_depth_.height(); }
    Vec3 to_eye_relative(Vec3 p) const { return Vec3(Vec3d(p) - eye_); }
    Vec3 to_world_position(Vec3 relative) const { return Vec3(Vec3d(relative) + eye_); }

    /// Projects a point: x and y in pixels, and depth. Behind the eye depth is 0 or less, and x and y are
    /// meaningless.
    Vec3 project(Vec3 p) const {
        const auto [x, y, depth, w] = homogeneous(p);
        return {x / w, y / w, depth};
    }
    /// Returns the pixel that contains a projected point, or the nearest pixel.
    std::pair<int, int> pixel_at(Vec3 projected) const {
        const auto within = [](float at, int size) {
            return static_cast<int>(clamp(at, 0.0f, static_cast<float>(size - 1)));
        };
        return {within(projected.x, width()), within(projected.y, height())};
    }
    /// Returns the visible point at a pixel; empty outside the image and for the background.
    std::optional<Vec3> visible_point(int x, int y) const;
    /// Returns the depth at a pixel inside the image; infinity for the background.
    float depth(int x, int y) const { return near_ / reversed_depth_(x, y); }
    bool perspective() const { return perspective_; }
    bool contains(float x, float y) const {
        return x >= 0 && y >= 0 && x < static_cast<float>(width()) && y < static_cast<float>(height());
    }

    // The following functions accept one point or a SIMD batch.

    /// Returns x·w, y·w, depth and w of a point. The second function returns their change over the displacement
    /// `direction`.
    template <typename T> std::array<T, 4> homogeneous(Vec3T<T> p) const {
        std::array<T, 4> h = homogeneous_change(p);
        for (std::size_t row = 0; row < 4; ++row) h[row] += T(to_pixel_[row].w);
        return h;
    }
    template <typename T> std::array<T, 4> homogeneous_change(Vec3T<T> direction) const {
        const auto row = [&](std::size_t r) {
            const Vec4& m = to_pixel_[r];
            return T(m.x) * direction.x + T(m.y) * direction.y + T(m.z) * direction.z;
        };
        return {row(0), row(1), row(2), row(3)};
    }
    /// Returns the visible point of the pixel in column x and row y, both integers, at the reversed depth
    /// `reversed_depth`.
    template <typename T> Vec3T<T> at(T x, T y, T reversed_depth) const {
        const T depth = T(near_) / reversed_depth;
        const auto axis = [&](float Vec3::*c) {
            return T(origin_.*c) + T(origin_dx_.*c) * x + T(origin_dy_.*c) * y +
                   (T(direction_.*c) + T(direction_dx_.*c) * x + T(direction_dy_.*c) * y) * depth;
        };
        return {axis(&Vec3::x), axis(&Vec3::y), axis(&Vec3::z)};
    }
    /// Returns the unit direction from a visible point to the viewer.
    template <typename T> Vec3T<T> to_viewer(Vec3T<T> p) const {
        const Vec3T<T> direction = perspective_ ? p : Vec3T<T>{T(direction_.x), T(direction_.y), T(direction_.z)};
        return direction * -inverse_sqrt(dot(direction, direction));
    }
    /// Returns the width of a pixel at a depth, in meters.
    template <typename T> T pixel_size(T depth) const {
        return perspective_ ? T(length(direction_dx_)) * depth : T(length(origin_dx_));
    }
    float near() const { return near_; }
    const ImageFloat& reversed_depth() const { return reversed_depth_; }
    /// Returns the greatest reversed depth in the pixel's block of 2^level × 2^level, or in a larger one.
    float max_reversed_depth(int x, int y, int level) const { return nearest_.block_max(x, y, level); }

    /// Sets the unit shading normals on the viewer's side, encoded as colors like Shading::kNormal. The background's
    /// normals are arbitrary.
    void set_normals(const ImageRgb& colors);
    const std::array<ImageFloat, 3>& normals() const { return normals_; }
    Vec3 normal(int x, int y) const { return {normals_[0](x, y), normals_[1](x, y), normals_[2](x, y)}; }

    /// Sets the angle between each pixel's normal and its neighbors' (max_normal_angle).
    void set_normal_angles(ImageFloat normal_angles) { normal_angles_ = std::move(normal_angles); }
    float normal_angle(int x, int y) const { return normal_angles_(x, y); }
    /// Sets the depth in meters from each visible surface to the nearest back face behind it, for closed objects; 0
    /// for others. thickness() is 0 before this call.
    void set_thickness(ImageFloat thickness) { thickness_ = std::move(thickness); }
    float thickness(int x, int y) const { return thickness_.empty() ? 0.0f : thickness_(x, y); }

    /// Sets the ambient occlusion; occlusion() is null before this call.
    void set_occlusion(std::shared_ptr<const OcclusionImage> occlusion) { occlusion_ = std::move(occlusion); }
    const OcclusionImage* occlusion() const { return occlusion_.get(); }

    /// Stores the color prepass, shaded at the pixels' centers. `keys` identifies the surface of each pixel
    /// (ColorPrepassImage::key) and is 0 where the radiance must not be reused. `objects` has object IDs. `light_mask`
    /// marks lights that rays intersect directly (RasterSceneData::reflected_lights). The pyramids have the radiance
    /// with and without these lights.
    struct ColorPrepass {
        Image<std::uint32_t> keys, objects;
        Image<std::uint8_t> light_mask;
        RadiancePyramid radiance, radiance_without_lights;
    };
    void set_color_prepass(ColorPrepass prepass) { color_prepass_ = std::move(prepass); }
    const ColorPrepass& color_prepass() const { return color_prepass_; }
    /// Sets the radiance of flat surfaces, which are assumed to continue behind occluders, and of the background
    /// (flat_surface_radiance in raster/screen_space/flat_surfaces.h). It is empty before this call, and if there is
    /// neither.
    void set_flat_radiance(RadiancePyramid radiance) { flat_radiance_ = std::move(radiance); }
    const RadiancePyramid& flat_radiance() const { return flat_radiance_; }

    /// Sets the layer behind the glass and the nearest back faces of glass. In the layer each pixel shows the next
    /// object behind its glass; it has a color prepass and may have its own layer behind it. Both are null without
    /// glass.
    void set_glass(std::shared_ptr<const ScreenGBuffer> behind, std::shared_ptr<const ScreenGBuffer> back_faces) {
        behind_ = std::move(behind), back_faces_ = std::move(back_faces);
    }
    const ScreenGBuffer* behind() const { return behind_.get(); }
    const ScreenGBuffer* back_faces() const { return back_faces_.get(); }
    /// Sets the front layer of the view; front() is this G-buffer if it is not set.
    void set_front(const ScreenGBuffer& front) { front_ = &front; }
    const ScreenGBuffer& front() const { return front_ != nullptr ? *front_ : *this; }

    /// Returns the memory of this G-buffer, its back faces, and the layers behind it.
    std::size_t memory_bytes() const;

private:
    Vec3d eye_;
    /// These vectors are as in Pinhole, but relative to pixel (0, 0).
    Vec3 origin_, origin_dx_, origin_dy_, direction_, direction_dx_, direction_dy_;
    std::array<Vec4, 4> to_pixel_;
    float near_;
    bool perspective_;
    ImageFloat reversed_depth_;
    HiZPyramid nearest_;
    std::array<ImageFloat, 3> normals_;
    std::shared_ptr<const OcclusionImage> occlusion_;
    ColorPrepass color_prepass_;
    RadiancePyramid flat_radiance_;
    ImageFloat normal_angles_, thickness_;
    std::shared_ptr<const ScreenGBuffer> behind_, back_faces_;
    const ScreenGBuffer* front_ = nullptr;
};

} // namespace duet::raster
