#include "raster/gbuffer/gbuffer_pass.h"

#include "raster/gbuffer/surface_lobes.h"
#include "raster/shader/shader_program.h"
#include "raster/shader/single_hit.h"
#include "raster/visibility/hit_lists.h"
#include "raster/visibility/hit_tile.h"
#include "raster/visibility/packet_primitives.h"
#include "raster/visibility/rasterize_tile.h"

#include "common/system/control.h"
#include "common/system/parallel.h"

#include <bit>
#include <optional>

namespace duet::raster {
namespace {

/// Computes the attributes that vary over a surface.
struct AttributeShader {
    static constexpr bool kTextureCoordinates = false;
    template <typename T> struct Varyings {
        Vec3T<T> n;
        T plane; ///< distance of the tangent plane from the eye, times the length of its normal
    };
    template <typename T> Varyings<T> vertex(const VertexInput<T>& v) const {
        return {v.n, dot(v.object.normal(v.n), v.world_p() - broadcast<T>(v.object.eye))};
    }
    template <typename T, typename F> SurfaceAttributes<T> fragment(const F& f) const {
        const Vec3T<T> normal = f.normal(f.at.n).unit();
        return {normal, bulge<T>(f, normal), f.base_color()};
    }

private:
    /// Returns GBuffer::bulge. Phong tessellation moves the point p along the normals nᵢ of the vertices vᵢ, with
    /// barycentric weights wᵢ, by Σ wᵢ nᵢ·(vᵢ − p) (common/geometry/shading_terminator.h). This equals Σ wᵢ nᵢ·vᵢ − p·Σ
    /// wᵢ nᵢ, whose two sums are interpolated attributes.
    template <typename T, typename F> static T bulge(const F& f, const Vec3T<T>& normal) {
        const Vec3T<T> n = f.object.normal(f.at.n);
        const Vec3T<T> p = (f.origin - broadcast<T>(f.object.eye)) + f.direction * f.depth; // relative to the eye
        const T height = f.at.plane - dot(n, p), zero(0.0f);
        const T outward = select(dot(n, normal) < zero, -height, height);
        return max(outward, zero) * inverse_sqrt(max(dot(n, n), T(std::numeric_limits<float>::min())));
    }
};

/// Stores a packet's values, two rows of eight pixels, in a plane. The row below the image is left out.
template <typename T> void store_packet(const PacketOf<T>& packet, int x, int y, Plane<T>& plane) {
    std::copy_n(packet.at(0), kPacketWidth, plane.row(y) + x);
    if (y + 1 < plane.height()) std::copy_n(packet.at(kPacketWidth), kPacketWidth, plane.row(y + 1) + x);
}

void store_packets(const PacketOf<float>& a, const PacketOf<float>& b, const PacketOf<float>& c, int x, int y,
                   Planes3& planes) {
    store_packet(a, x, y, planes.x), store_packet(b, x, y, planes.y), store_packet(c, x, y, planes.z);
}

void set_sample(ColorPacket& colors, std::size_t i, Rgb c) { colors.r[i] = c.r, colors.g[i] = c.g, colors.b[i] = c.b; }

/// Holds the SurfaceLobes of a packet's samples.
struct LobesPacket {
    ColorPacket diffuse, specular;
    PacketOf<float> alpha, coat, coat_alpha;
    ColorPacket tint;
};

void store_lobes(const SurfaceLobes& lobes, int x, int y, GBuffer& gbuffer) {
    gbuffer.diffuse.set_at(x, y, lobes.diffuse);
    gbuffer.specular.set_at(x, y, lobes.specular);
    gbuffer.alpha(x, y) = lobes.alpha;
    if (!gbuffer.coat.empty()) gbuffer.coat(x, y) = lobes.coat, gbuffer.coat_alpha(x, y) = lobes.coat_alpha;
    if (!gbuffer.tint.empty()) gbuffer.tint.set_at(x, y, lobes.tint);
}

/// Holds the state that all tiles share.
struct Frame {
    const RasterSceneData& data;
    const Geometry& geometry;
    const PassView& view;
    bool emission; ///< whether emission is requested
    AttributeShader shader{};
};

/// Fills the G-buffer of one tile, packet by packet.
class TileFiller {
public:
    TileFiller(const Frame& frame, const PixelRect& rect, GBuffer& gbuffer, Planes3& emission)
        : data_(frame.data), scene_(data_.scene), geometry_(frame.geometry), view_(frame.view), rect_(rect),
          with_emission_(frame.emission), gbuffer_(gbuffer), emission_(emission), reader_(geometry_.triangles),
          shader_(data_, geometry_, view_, rect, frame.shader) {}

    void run(const DepthTile& tile) {
        for (int y = rect_.y0; y < rect_.y1; y += DepthTile::kPacketRows)
            for (int x = rect_.x0; x < rect_.x1; x += static_cast<int>(kPacketWidth))
                fill_packet(sample_packet(tile, x, y), x, y);
    }

private:
    void fill_packet(const SamplePacket& packet, int x, int y) {
        reader_.read(packet.ids, samples_);
        if (samples_.visible == 0) return clear_packet(x, y);
        shader_.shade(packet, shaded_);
        find_materials();
        store_packet(object_, x, y, gbuffer_.object);
        store_packet(material_, x, y, gbuffer_.material);
        store_depths_and_normals(packet);
        emitted_ = {};
        for_each_material([&](std::uint32_t material, std::uint32_t lanes) {
            if (const std::optional<LobesOfColor>& lobes = data_.lobes_of_color[material])
                find_lobes(packet, lanes, *lobes);
            else
                for_each_pixel(packet, lanes, [&](std::size_t i) { find_lobes(packet, i); });
            if (with_emission_ && emitter(scene_.materials[material]) != nullptr)
                for_each_pixel(packet, lanes, [&](std::size_t i) { find_emission(packet, i); });
        });
        store_lobes(x, y);
        store_packets(emitted_.r, emitted_.g, emitted_.b, x, y, emission_);
    }

    /// Marks a packet as background; its other attributes are not read.
    void clear_packet(int x, int y) {
        static const PacketOf<float> kZero{};
        PacketOf<std::int32_t> none;
        none.fill(-1);
        store_packet(kZero, x, y, gbuffer_.reversed_depth);
        store_packet(none, x, y, gbuffer_.object);
        store_packet(none, x, y, gbuffer_.material);
        store_packets(kZero, kZero, kZero, x, y, emission_);
    }

    /// Calls visit(material, lanes) for each material that the packet sees.
    template <typename Visit> void for_each_material(const Visit& visit) const {
        for (std::uint32_t left = samples_.visible; left != 0;) {
            const std::int32_t material = material_[static_cast<std::size_t>(std::countr_zero(left))];
            const std::uint32_t lanes = lanes_equal(material_, material) & left;
            left &= ~lanes;
            visit(static_cast<std::uint32_t>(material), lanes);
        }
    }
    /// Calls visit(i) for those samples of the packet that lie in the tile.
    template <typename Visit>
    void for_each_pixel(const SamplePacket& packet, std::uint32_t lanes, const Visit& visit) const {
        for (const std::size_t i : SetBits(lanes)) {
            const int x = packet.x + static_cast<int>(i % kPacketWidth),
                      y = packet.y + static_cast<int>(i / kPacketWidth);
            if (x < rect_.x1 && y < rect_.y1) visit(i);
        }
    }

    /// Finds each sample's object and material. Most packets see one object with one material.
    void find_materials() {
        if (samples_.object != nullptr) {
            const std::uint32_t object = samples_.object->object;
            if (const auto& materials = scene_.objects[object].materials; materials.size() == 1) {
                object_.fill(static_cast<std::int32_t>(object));
                material_.fill(static_cast<std::int32_t>(materials.front()));
                return;
            }
        }
        object_.fill(-1), material_.fill(-1);
        for (const std::size_t i : SetBits(samples_.visible)) {
            const auto [object, primitive] = geometry_.primitive(reader_.run_of(samples_.id(i)), samples_.id(i));
            object_[i] = static_cast<std::int32_t>(object);
            material_[i] = static_cast<std::int32_t>(material_index(scene_, object, primitive));
        }
    }

    void store_depths_and_normals(const SamplePacket& packet) {
        PacketOf<float> depth;
        for (std::size_t i = 0; i < kPacketSize; i += Floats::size)
            store(depth, i,
                  xsimd::select(lanes_from<float>(samples_.visible >> i),
                                Floats::load_aligned(packet.reversed_depth + i), Floats(0.0f)));
        store_packet(depth, packet.x, packet.y, gbuffer_.reversed_depth);
        replace_zero_normals(packet);
        const auto& [nx, ny, nz] = shaded_.normal;
        store_packets(nx, ny, nz, packet.x, packet.y, gbuffer_.normal);
        store_packet(shaded_.bulge, packet.x, packet.y, gbuffer_.bulge);
    }

    /// Replaces normals of length zero, which interpolation between opposite normals yields, by the directions to the
    /// viewer.
    void replace_zero_normals(const SamplePacket& packet) {
        Vec3T<PacketOf<float>>& n = shaded_.normal;
        for (std::size_t i = 0; i < kPacketSize; i += Floats::size) {
            const Vec3T<Floats> normal{load(n.x, i), load(n.y, i), load(n.z, i)};
            const auto valid = dot(normal, normal) > Floats(0.5f);
            if (xsimd::all(valid)) continue;
            const Vec3T<Floats> v = to_viewer(packet, i);
            store(n.x, i, xsimd::select(valid, normal.x, v.x)), store(n.y, i, xsimd::select(valid, normal.y, v.y));
            store(n.z, i, xsimd::select(valid, normal.z, v.z));
        }
    }

    /// Finds the lobes of samples of one material with SIMD.
    void find_lobes(const SamplePacket& packet, std::uint32_t lanes, const LobesOfColor& lobes) {
        LobesPacket found;
        for (std::size_t i = 0; i < kPacketSize; i += Floats::size) {
            const ColorPacket& base = shaded_.color;
            const RgbT<Floats> color{load(base.r, i), load(base.g, i), load(base.b, i)};
            store(found.diffuse, i, lobes.diffuse(color, cosines(packet, i)));
            store(found.specular, i, lobes.specular(color));
        }
        found.alpha.fill(lobes.alpha), found.coat.fill(lobes.coat), found.coat_alpha.fill(lobes.coat_alpha);
        copy_lanes(lanes, found.diffuse, lobes_.diffuse), copy_lanes(lanes, found.specular, lobes_.specular);
        copy_lanes(lanes, found.alpha, lobes_.alpha);
        copy_lanes(lanes, found.coat, lobes_.coat), copy_lanes(lanes, found.coat_alpha, lobes_.coat_alpha);
        copy_lanes(lanes, shaded_.color, lobes_.tint); // that of glass is its base color
    }

    /// Finds the lobes of one sample, whose material has parameters that vary over the surface.
    void find_lobes(const SamplePacket& packet, std::size_t i) {
        const Vec2d pixel = packet.position(i);
        const Ray ray = rounded(view_.pinhole.ray(pixel), view_.time);
        const Hit hit = find_hit(geometry_, view_, samples_.id(i), pixel);
        const SurfacePoint point = filtered_point(scene_, view_, ray, hit, samples_per_pixel(packet, view_));
        const Vec3T<PacketOf<float>>& n = shaded_.normal;
        const float cosine = clamp(-dot(Vec3(n.x[i], n.y[i], n.z[i]), ray.direction), 1e-4f, 1.0f);
        const SurfaceLobes lobes =
            surface_lobes(bsdf_at(scene_.materials[point.material], scene_.textures, point), cosine);
        set_sample(lobes_.diffuse, i, lobes.diffuse), set_sample(lobes_.specular, i, lobes.specular);
        lobes_.alpha[i] = lobes.alpha, lobes_.coat[i] = lobes.coat, lobes_.coat_alpha[i] = lobes.coat_alpha;
        set_sample(lobes_.tint, i, lobes.tint);
    }

    void store_lobes(int x, int y) {
        const auto& [diffuse, specular, alpha, coat, coat_alpha, tint] = lobes_;
        store_packets(diffuse.r, diffuse.g, diffuse.b, x, y, gbuffer_.diffuse);
        store_packets(specular.r, specular.g, specular.b, x, y, gbuffer_.specular);
        store_packet(alpha, x, y, gbuffer_.alpha);
        if (!gbuffer_.tint.empty()) store_packets(tint.r, tint.g, tint.b, x, y, gbuffer_.tint);
        if (gbuffer_.coat.empty()) return;
        store_packet(coat, x, y, gbuffer_.coat), store_packet(coat_alpha, x, y, gbuffer_.coat_alpha);
    }

    /// Returns the directions to the viewer, which do not depend on the depth.
    Vec3T<Floats> to_viewer(const SamplePacket& packet, std::size_t i) const {
        const auto at = [&](const PacketOf<float>& offsets, int start) {
            return load(offsets, i) + Floats(static_cast<float>(start));
        };
        return gbuffer_.projection.to_viewer(gbuffer_.projection.point(
            at(kColumns<float>, packet.x), at(kRows<float>, packet.y), Floats(gbuffer_.projection.near())));
    }
    /// Returns the cosines between the shading normals and the directions to the viewer.
    Floats cosines(const SamplePacket& packet, std::size_t i) const {
        const Vec3T<PacketOf<float>>& n = shaded_.normal;
        return dot(Vec3T<Floats>{load(n.x, i), load(n.y, i), load(n.z, i)}, to_viewer(packet, i));
    }

    void find_emission(const SamplePacket& packet, std::size_t i) {
        const Vec2d pixel = packet.position(i);
        const Hit hit = find_hit(geometry_, view_, samples_.id(i), pixel);
        set_sample(emitted_, i, hit_emission(scene_, view_, hit, pixel, samples_per_pixel(packet, view_)));
    }

    const RasterSceneData& data_;
    const Scene& scene_;
    const Geometry& geometry_;
    const PassView& view_;
    PixelRect rect_;
    bool with_emission_;
    GBuffer& gbuffer_;
    Planes3& emission_;
    PacketReader reader_;
    TileShader<AttributeShader> shader_;
    // The following members describe the current packet.
    PacketPrimitives samples_;
    PacketAttributes shaded_;
    PacketOf<std::int32_t> object_, material_;
    LobesPacket lobes_{};
    ColorPacket emitted_;
};

} // namespace

OptionalPlanes optional_planes(const Scene& scene) {
    OptionalPlanes planes;
    for (const Material& material : scene.materials) {
        if (const auto* p = std::get_if<Principled>(&material))
            planes.coat = planes.coat || p->clearcoat.value > 0 || !p->clearcoat.constant();
        if (const auto* glass = std::get_if<Dielectric>(&material))
            planes.tint = planes.tint || glass->tint.texture >= 0;
    }
    return planes;
}

void store_surface(const Scene& scene, const VisibleSurface& surface, bool emits, int x, int y, GBuffer& gbuffer,
                   Planes3& emission) {
    const SurfacePoint& point = surface.point;
    const Vec3 n = dot(point.ng, surface.to_viewer) < 0 ? -point.ns : point.ns;
    const float cosine = clamp(dot(n, surface.to_viewer), 1e-4f, 1.0f);
    gbuffer.reversed_depth(x, y) = surface.reversed_depth;
    gbuffer.normal.set_at(x, y, n);
    gbuffer.bulge(x, y) = max(dot(point.terminator_offset, n), 0.0f);
    store_lobes(surface_lobes(surface.bsdf, cosine), x, y, gbuffer);
    gbuffer.object(x, y) = static_cast<std::int32_t>(point.object);
    gbuffer.material(x, y) = static_cast<std::int32_t>(point.material);
    emission.set_at(x, y,
                    emits ? emitted(scene.materials[point.material], scene.textures, point, surface.to_viewer) : Rgb());
}

void clear(GBuffer& gbuffer, Planes3& emission) {
    gbuffer.reversed_depth.fill(0), gbuffer.object.fill(-1), gbuffer.material.fill(-1);
    emission.fill(0);
}

void store_hit(const SampleView& sample, int x, int y, const Hit& hit, float reversed_depth, GBuffer& gbuffer,
               Planes3& emission) {
    const Scene& scene = sample.data.scene;
    const Ray ray = rounded(sample.view.pinhole.ray(sample.offset.position(x, y)), sample.view.time);
    const SurfacePoint point = filtered_point(scene, sample.view, ray, hit, sample.view.samples_per_pixel);
    const Bsdf bsdf = bsdf_at(scene.materials[point.material], scene.textures, point);
    store_surface(scene, {point, bsdf, -ray.direction, reversed_depth}, sample.settings.components.emission, x, y,
                  gbuffer, emission);
}

void fill_gbuffer(const SampleView& sample, GBuffer& gbuffer, Planes3& emission, const VisitLayers& visit_layers) {
    const Frame frame{sample.data, sample.geometry, sample.view, sample.settings.components.emission};
    parallel_for(sample.grid.size(), sample.settings.threads, [&](std::size_t i) {
        if (sample.control.stopped()) return;
        DepthTile depths;
        rasterize_tile(sample.geometry, sample.view, sample.offset, sample.grid.tile(i), i, depths);
        TileFiller(frame, depths.rect(), gbuffer, emission).run(depths);
        if (!visit_layers || sample.layers == nullptr || !sample.layers->overlaps_tile(i)) return;
        HitTile tile(depths, sample.geometry, sample.view);
        HitLists lists(*sample.layers, sample.view, sample.offset, i, tile);
        visit_layers(i, tile, lists);
    });
}

} // namespace duet::raster
