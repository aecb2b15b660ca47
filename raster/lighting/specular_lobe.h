// Samples tables of the GGX lobe for a batch of pixels: its linearly transformed cosine and its directional albedo.
#pragma once

#include "common/image/rgb.h"
#include "raster/geometry/lane_math.h"

namespace duet::raster {

/// Maps directions of a lobe to those of a clamped cosine, up to a common factor. The frame is that of the normal, +z,
/// with the viewer in the plane y = 0 (Heitz et al. 2016, §3). The matrix is [xx 0 xz; 0 yy 0; zx 0 zz].
template <typename T> struct CosineSpaceT {
    T xx, xz, yy, zx, zz;
    T determinant, gram_xx, gram_xz, gram_yy, gram_zz; ///< elements of M Mᵀ; the others are 0

    /// The arguments are the elements of LobeMatrix (raster/lighting/lobe_matrix.h). This matrix is its inverse times
    /// its determinant.
    static CosineSpaceT of(T m11, T m13, T m22, T m31, T m33) {
        const T flat = m11 * m33 - m13 * m31;
        CosineSpaceT s{m33, -m13, flat / m22, -m31, m11, {}, {}, {}, {}, {}};
        s.determinant = flat * s.yy;
        s.gram_xx = s.xx * s.xx + s.xz * s.xz, s.gram_zz = s.zx * s.zx + s.zz * s.zz;
        s.gram_xz = s.xx * s.zx + s.xz * s.zz, s.gram_yy = s.yy * s.yy;
        return s;
    }
    Vec3T<T> operator()(const Vec3T<T>& w) const {
        return {multiply_add(xx, w.x, T(xz * w.z)), yy * w.y, multiply_add(zx, w.x, T(zz * w.z))};
    }
};

/// Holds the table values of a lobe with reflectance 1, for a batch of pixels.
struct LobeTables {
    Floats m11, m13, m22, m31, m33;
    Floats energy, share;  ///< GgxAlbedo
    Floats mean_lost;      ///< GgxAverageAlbedo::lost
};

/// Returns the cosine between the unit vectors to the viewer and along the normal, clamped to [1e-4, 1]. The clamp is
/// necessary because rounding can make the product exceed 1, and a bent normal may face away from the viewer.
inline Floats viewer_cosine(const Vec3T<Floats>& normal, const Vec3T<Floats>& to_viewer) {
    return clamp(dot(normal, to_viewer), Floats(1e-4f), Floats(1.0f));
}

/// Returns the fraction of uniform light that a lobe reflects to the viewer, including multiple scattering. For a
/// mirror it is Schlick's Fresnel term.
RgbT<Floats> specular_albedo(const LobeTables& tables, const RgbT<Floats>& normal, const Floats& alpha,
                             const Floats& cosine);

/// Samples the tables by roughness and angle. The rows of a roughness are interpolated once and reused while the
/// roughness stays the same. The lookup by angle then runs in registers. (Gathers would take 28 of 16 lanes each.)
class LobeLookup {
public:
    /// Returns the tables' values. alpha is in [0, 1], `cosine` between normal and viewer in (0, 1]. Lanes outside
    /// `lanes` are unspecified.
    LobeTables operator()(const Floats& alpha, const Floats& cosine, const xsimd::batch_bool<float>& lanes);
    /// Returns the fraction of light from directions at these cosines that single scattering does not reflect.
    Floats lost(const Floats& alpha, const Floats& cosine, const xsimd::batch_bool<float>& lanes);

private:
    void set_rows(float alpha);

    float alpha_ = -1;
    std::array<PacketOf<float>, 5> matrix_;
    std::array<PacketOf<float>, 2> lost_, share_; ///< each has 32 columns
    float mean_lost_ = 0;
};

} // namespace duet::raster
