#include "raster/shader/packet_surface.h"

#include "raster/shader/single_hit.h"

#include "common/vec/robust.h"

namespace duet::raster {
namespace {

/// Interpolates texture coordinates over a triangle, for one sample or a batch. They match surface_point(), but in
/// float, like the barycentrics.
template <typename T> struct TriangleUv {
    Vec2T<T> first{T(0), T(0)}, along_u{T(1), T(0)}, along_v{T(0), T(1)};

    Vec2T<T> at(const T& u, const T& v) const {
        return {multiply_add(along_u.x, u, multiply_add(along_v.x, v, first.x)),
                multiply_add(along_u.y, u, multiply_add(along_v.y, v, first.y))};
    }
    /// Returns the change of the texture coordinates for a change of the barycentrics.
    Vec2T<T> step(const T& du, const T& dv) const {
        return {multiply_add(along_u.x, du, T(along_v.x * dv)), multiply_add(along_u.y, du, T(along_v.y * dv))};
    }
};

struct UvTriangle : TriangleUv<float> {
    bool has_area = true; ///< whether the triangle has an area in texture space

    UvTriangle(const PackedShape& shape, std::size_t triangle) {
        if (!shape.has_uvs) return;
        const auto uv = [&](std::size_t k) {
            const PackedVertex& corner = shape.vertices[shape.triangles[triangle][k]];
            return Vec2(corner.u, corner.v);
        };
        const Vec2 a = uv(0), b = uv(1), c = uv(2);
        first = a, along_u = b - a, along_v = c - a;
        has_area = difference_of_products(along_u.x, along_v.y, along_u.y, along_v.x) != 0;
    }
};

/// Holds the texture coordinates of one triangle per lane, and one bit per lane whose triangle has an area in texture
/// space.
struct UvTriangles : TriangleUv<Floats> {
    std::uint32_t with_area = 0;

    void set(std::uint32_t lanes, const UvTriangle& triangle) {
        const auto here = lanes_from<float>(lanes);
        const auto put = [&](Vec2T<Floats>& to, Vec2 from) {
            to = {xsimd::select(here, Floats(from.x), to.x), xsimd::select(here, Floats(from.y), to.y)};
        };
        put(first, triangle.first), put(along_u, triangle.along_u), put(along_v, triangle.along_v);
        if (triangle.has_area) with_area |= lanes;
    }
};

} // namespace

/// Returns the factor that scales footprints by the sampling rate, like PixelFootprint.
float PacketSurface::step_scale() const {
    return static_cast<float>(1 / std::sqrt(samples_per_pixel(*packet_, view_)));
}

Vec3 PacketSurface::mapped_normal(std::size_t sample) const {
    if (!(samples_->visible >> sample & 1)) return {0, 0, 1};
    const Vec2d pixel = packet_->position(sample);
    return hit_normal(data_.scene, view_, find_hit(geometry_, view_, samples_->id(sample), pixel), pixel,
                      samples_per_pixel(*packet_, view_));
}

Rgb PacketSurface::emitted(std::size_t sample) const {
    if (!(samples_->visible >> sample & 1)) return {};
    const Vec2d pixel = packet_->position(sample);
    return hit_emission(data_.scene, view_, find_hit(geometry_, view_, samples_->id(sample), pixel), pixel,
                        samples_per_pixel(*packet_, view_));
}

/// Returns the same color as surface_point(), set_footprint() and base_color() together, but computes only what base
/// colors depend on. (The derivatives of the texture coordinates follow from those of the barycentrics, which are
/// already computed with SIMD.)
Rgb PacketSurface::base_color(std::size_t sample) const {
    if (!(samples_->visible >> sample & 1)) return {};
    if (samples_->shape == nullptr) {
        const Vec2d pixel = packet_->position(sample);
        return hit_color(data_.scene, view_, rounded(view_.pinhole.ray(pixel), view_.time),
                         find_hit(geometry_, view_, samples_->id(sample), pixel), samples_per_pixel(*packet_, view_));
    }
    const PackedShape& shape = *samples_->shape;
    const std::size_t triangle = samples_->index(sample);
    const float u = (*at_.b1)[sample], v = (*at_.b2)[sample];
    SurfacePoint point;
    point.object = samples_->object->object;
    point.primitive = static_cast<std::uint32_t>(shape.primitive(triangle));
    point.material = material_index(data_.scene, point.object, point.primitive);
    point.time = view_.time;
    const auto corner = [&](std::size_t k) { return Vec3d(shape.vertices[shape.triangles[triangle][k]].p); };
    const Vec3d a = corner(0), b = corner(1), c = corner(2);
    point.p_object = Vec3(a + (b - a) * static_cast<double>(u) + (c - a) * static_cast<double>(v));
    const UvTriangle uv(shape, triangle);
    point.uv = uv.at(u, v);
    if (data_.scene.needs.footprints && uv.has_area) {
        const auto step = [&](std::size_t axis) {
            return uv.step((*at_.b1_steps)[axis][sample], (*at_.b2_steps)[axis][sample]) * step_scale();
        };
        point.duv_dx = step(0);
        point.duv_dy = step(1);
    }
    return duet::base_color(data_.scene.materials[point.material], data_.scene.textures, point);
}

/// Returns the base colors of one batch of samples, with SIMD if a single texture determines the object's color.
RgbT<Floats> PacketSurface::base_colors(std::size_t first) const {
    if (samples_->shape == nullptr) return ColorSource::base_colors(first);
    const std::optional<RgbSlot>& slot = data_.objects[samples_->object->object].uniform_texture;
    if (!slot) return ColorSource::base_colors(first);
    const auto& texture =
        std::get<ImageTexture>(data_.scene.textures.textures[static_cast<std::size_t>(slot->texture)]);
    const RgbT<Floats> c = broadcast<Floats>(slot->value) *
                           data_.texture_samplers[texture.image].sample(texture, texture_coordinates(first));
    const Floats zero(0.0f), one(1.0f); // the limits are those of evaluate_reflectance()
    return {clamp(c.r, zero, one), clamp(c.g, zero, one), clamp(c.b, zero, one)};
}

/// Computes the coordinates triangle by triangle, because adjacent samples mostly see the same triangle.
TextureCoordinates PacketSurface::texture_coordinates(std::size_t first) const {
    constexpr std::uint32_t kAll = (1u << Floats::size) - 1;
    TextureCoordinates coordinates;
    coordinates.lanes = samples_->visible >> first & kAll;
    UvTriangles uv;
    for (std::uint32_t left = coordinates.lanes; left != 0;) {
        const std::size_t sample = first + static_cast<std::size_t>(std::countr_zero(left));
        const std::uint32_t lanes = lanes_equal(samples_->ids, samples_->ids[sample]) >> first & kAll;
        uv.set(lanes, UvTriangle(*samples_->shape, samples_->index(sample)));
        left &= ~lanes;
    }
    coordinates.uv = uv.at(load(*at_.b1, first), load(*at_.b2, first));
    const auto has_area = lanes_from<float>(uv.with_area);
    const Floats zero(0.0f), scale(step_scale());
    const auto step = [&](std::size_t axis) {
        const Vec2T<Floats> whole =
            uv.step(load((*at_.b1_steps)[axis], first), load((*at_.b2_steps)[axis], first)) * scale;
        return Vec2T<Floats>(xsimd::select(has_area, whole.x, zero), xsimd::select(has_area, whole.y, zero));
    };
    coordinates.duv_dx = step(0);
    coordinates.duv_dy = step(1);
    return coordinates;
}

} // namespace duet::raster
