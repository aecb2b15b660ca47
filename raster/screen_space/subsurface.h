// Computes subsurface scattering in screen space. The diffuse light of solids is blurred over the distance that light
// travels inside, along columns and then along rows (Jimenez et al. 2015, "Separable Subsurface Scattering", with the
// pre-integrated kernel of §5.1). The result is exact on a plane where the light varies along one of the axes only.
// Light through thin parts is missing, because the image does not show their other side.
#pragma once

#include "raster/gbuffer/gbuffer.h"
#include "raster/screen_space/diffusion_profile.h"

namespace duet::raster {

enum class Lobes { kAll, kSolids, kOthers }; ///< kSolids: the diffuse lobes of solids

/// Separates the diffuse lobes of solids in a G-buffer from all other lobes, so that their light can be computed
/// separately. It changes the G-buffer, and its destructor restores it.
class SolidLobes {
public:
    SolidLobes(const SolidMaterials& materials, GBuffer& gbuffer, int threads);
    SolidLobes(const SolidLobes&) = delete;
    SolidLobes& operator=(const SolidLobes&) = delete;
    ~SolidLobes() { show(Lobes::kAll); }

    /// Leaves some lobes in the G-buffer and removes the others.
    void show(Lobes lobes);

private:
    GBuffer& gbuffer_;
    Planes3 all_, solids_, others_; ///< diffuse lobes
    Planes3 specular_;
    PlaneFloat coat_;
};

/// Blurs `light`, the light of solids, which the diffuse lobes in the G-buffer reflect.
void blur_solid_light(const SolidMaterials& materials, const GBuffer& gbuffer, int threads, Planes3& light);

} // namespace duet::raster
