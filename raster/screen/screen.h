// What a picture knows of the scene: depth and normal at each pixel. Effects in screen space look around in it.
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

/// The depths of one view, one sample a pixel. Positions are relative to the camera's eye.
class Screen {
public:
    Screen(const Screen&) = delete; // its occlusion refers to it
    Screen& operator=(const Screen&) = delete;
    /// `nearness`: near / depth of each pixel's sample, 0 where nothing is seen.
    Screen(const Pinhole& view, SampleOffset offset, ImageFloat nearness);

    int width() const { return nearness_.width(); }
    int height() const { return nearness_.height(); }
    Vec3 relative(Vec3 p) const { return Vec3(Vec3d(p) - eye_); }
    Vec3 absolute(Vec3 relative) const { return Vec3(Vec3d(relative) + eye_); }

    /// Where a point is seen: x and y in pixels, depth. Depth is 0 or less, and x and y mean nothing, behind the eye.
    Vec3 project(Vec3 p) const {
        const auto [x, y, depth, w] = homogeneous(p);
        return {x / w, y / w, depth};
    }
    /// The pixel of such a place, or the nearest one.
    std::pair<int, int> pixel_at(Vec3 place) const {
        const auto within = [](float at, int size) { return static_cast<int>(clamp(at, 0.0f, static_cast<float>(size - 1))); };
        return {within(place.x, width()), within(place.y, height())};
    }
    /// What is seen at a pixel; nothing outside the picture, or where nothing is.
    std::optional<Vec3> seen(int x, int y) const;
    /// Depth at a pixel; infinity where nothing is seen. The pixel must be one.
    float depth(int x, int y) const { return near_ / nearness_(x, y); }
    bool perspective() const { return perspective_; }
    bool contains(float x, float y) const {
        return x >= 0 && y >= 0 && x < static_cast<float>(width()) && y < static_cast<float>(height());
    }

    // The same for one point or a batch of them.

    /// x·w, y·w, depth and w of a point, and their change from a point to the next that is `way` away.
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
    /// What the pixel in column x and row y, both whole numbers, sees at near / depth.
    template <typename T> Vec3T<T> at(T x, T y, T nearness) const {
        const T depth = T(near_) / nearness;
        const auto axis = [&](float Vec3::*c) {
            return T(origin_.*c) + T(origin_dx_.*c) * x + T(origin_dy_.*c) * y +
                   (T(direction_.*c) + T(direction_dx_.*c) * x + T(direction_dy_.*c) * y) * depth;
        };
        return {axis(&Vec3::x), axis(&Vec3::y), axis(&Vec3::z)};
    }
    /// Unit, from what a pixel sees to the viewer.
    template <typename T> Vec3T<T> to_viewer(Vec3T<T> p) const {
        const Vec3T<T> way = perspective_ ? p : Vec3T<T>{T(direction_.x), T(direction_.y), T(direction_.z)};
        return way * -inverse_sqrt(dot(way, way));
    }
    /// The width of a pixel at a depth, metres.
    template <typename T> T pixel_size(T depth) const { return perspective_ ? T(length(direction_dx_)) * depth : T(length(origin_dx_)); }
    float near() const { return near_; }
    const ImageFloat& nearness() const { return nearness_; }
    /// The greatest nearness in the pixel's block of 2^level × 2^level, or in a larger one.
    float greatest_nearness(int x, int y, int level) const { return nearest_.of_block(x, y, level); }

    /// Shading normals on the viewer's side, unit, once they are there; any where nothing is seen.
    /// Given as colours, as Shading::kNormal shows them.
    void set_normals(const ImageRgb& colors);
    const std::array<ImageFloat, 3>& normals() const { return normals_; }
    Vec3 normal(int x, int y) const { return {normals_[0](x, y), normals_[1](x, y), normals_[2](x, y)}; }

    /// By how much the normal turns from each pixel to the next (normal_turn), once that is known.
    void set_turns(ImageFloat turns) { turns_ = std::move(turns); }
    float turn(int x, int y) const { return turns_(x, y); }
    /// Metres of depth from what each pixel sees to the nearest back face behind it, where that is of a closed object, once
    /// they are there; else 0.
    void set_thickness(ImageFloat thickness) { thickness_ = std::move(thickness); }
    float thickness(int x, int y) const { return thickness_.empty() ? 0.0f : thickness_(x, y); }

    /// How much of the environment each pixel sees, once it is there; else null.
    void set_occlusion(std::shared_ptr<const OcclusionImage> occlusion) { occlusion_ = std::move(occlusion); }
    const OcclusionImage* occlusion() const { return occlusion_.get(); }

    /// A picture of what is seen, once it is there: how each pixel was shaded at its centre, by a key of what that saw
    /// (FirstLookPicture::key), or 0 where it would not be the same again; which object that is; whether it is a lamp that
    /// rays look for (PreparedData::lamps); and the same at all sizes, with those lamps and without them.
    struct FirstLook {
        Image<std::uint32_t> keys, objects;
        Image<std::uint8_t> lamps;
        RadiancePyramid radiance, without_lamps;
    };
    void set_first_look(FirstLook look) { first_look_ = std::move(look); }
    const FirstLook& first_look() const { return first_look_; }
    /// The same of flat surfaces alone, which go on behind what stands before them, and of what is behind all (flat_look in
    /// raster/screen/flat_look.h), once it is there; else, and where there is neither, empty.
    void set_flat_look(RadiancePyramid look) { flat_look_ = std::move(look); }
    const RadiancePyramid& flat_look() const { return flat_look_; }

    /// The same view where each pixel sees the next object behind its glass, with a first look, in turn with what is behind
    /// that; and the nearest back faces of glass. Else null.
    void set_glass(std::shared_ptr<const Screen> behind, std::shared_ptr<const Screen> backs) {
        behind_ = std::move(behind), backs_ = std::move(backs);
    }
    const Screen* behind() const { return behind_.get(); }
    const Screen* backs() const { return backs_.get(); }
    /// What the view sees at once, where this is behind that; else this.
    void set_front(const Screen& front) { front_ = &front; }
    const Screen& front() const { return front_ != nullptr ? *front_ : *this; }

    /// Of this, the nearest back faces, and what is behind.
    std::size_t memory_bytes() const;

private:
    Vec3d eye_;
    Vec3 origin_, origin_dx_, origin_dy_, direction_, direction_dx_, direction_dy_; ///< as Pinhole's, from pixel (0, 0)
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
