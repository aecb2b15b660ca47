// Evaluates one light on a batch of pixels of the G-buffer.
#pragma once

#include "raster/gbuffer/gbuffer.h"
#include "raster/lighting/frame_lights.h"
#include "raster/lighting/specular_lobe.h"

namespace duet::raster {

/// Holds the surfaces of a batch of pixels, prepared for any number of lights. Local vectors are in the frame whose z
/// axis is the shading normal, with the viewer in the plane y = 0.
class LitBatch {
public:
    using Lanes = xsimd::batch_bool<float>;
    /// Keeps the tables of a thread from batch to batch.
    struct Tables {
        LobeLookup specular, coat;
    };

    /// Only the given lanes are lit. They must be visible surfaces.
    LitBatch(const GBuffer& gbuffer, int x, int y, const Lanes& lanes, Tables& tables);

    /// Selects the lobes that reflect light.
    enum class Lobes { kAll, kSpecular };
    /// Returns the radiance that the lobes reflect from one light without shadows; 0 in other lanes. Only light from
    /// above the plane of the shading normal counts. An emitter does not light points in its own plane.
    RgbT<Floats> reflected(const FrameLight& light, Lobes lobes = Lobes::kAll) const;
    /// Returns the radiance that all lobes but the specular ones reflect, given the irradiance.
    RgbT<Floats> diffuse(const RgbT<Floats>& irradiance) const;

    const Vec3T<Floats>& p() const { return p_; }
    const Vec3T<Floats>& n() const { return z_; }
    bool specular() const { return lobe_count_ > 0; }

private:
    struct Lobe {
        LobeLookup* lookup;
        CosineSpaceT<Floats> cosine_space;
        Floats alpha;
        RgbT<Floats> normal; ///< reflectance at normal incidence
        Floats weight;       ///< fraction of the lobe's light that reaches the viewer
        RgbT<Floats> albedo; ///< albedo of single scattering, times weight / π
        RgbT<Floats>
            several; ///< BRDF of multiple scattering, without its factor lost(wi)
        Floats mean_lost;
        Lanes lanes; ///< where the lobe exists
    };

    Vec3T<Floats> local(const Vec3T<Floats>& v) const { return {dot(x_, v), dot(y_, v), dot(z_, v)}; }
    const Lobe& add_lobe(LobeLookup& lookup, const RgbT<Floats>& normal, const Floats& alpha, const Floats& weight,
                         const Lanes& lanes);
    template <std::size_t N> RgbT<Floats> from_polygon(const FrameLight& light, const Lanes& diffuse_lanes) const;
    RgbT<Floats> from_sphere(const FrameLight& light, const Lanes& diffuse_lanes) const;
    RgbT<Floats> from_position(const FrameLight& light, const Lanes& diffuse_lanes) const;
    RgbT<Floats> from_direction(const Vec3T<Floats>& wi, const Floats& irradiance, const Lanes& diffuse_lanes,
                                std::size_t lobe_count) const;

    Vec3T<Floats> p_, x_, y_, z_; ///< the point relative to the eye; the axes of the frame
    Vec3T<Floats> wo_;            ///< local unit direction to the viewer
    Floats rounding_;             ///< greatest error of a point's position, m
    Lanes lanes_;
    RgbT<Floats> diffuse_; ///< BRDF of the diffuse lobe
    RgbT<Floats> uniform_; ///< diffuse_ plus multiple scattering, for area lights
    std::array<Lobe, 2> lobes_;
    std::size_t lobe_count_ = 0;
};

} // namespace duet::raster
