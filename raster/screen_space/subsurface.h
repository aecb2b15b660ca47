// Subsurface scattering in screen space: the diffuse light of solids is blurred over the distance that light comes
// inside, along columns and then along rows (Jimenez et al. 2015, "Separable Subsurface Scattering", with the
// pre-integrated kernel of §5.1). It is exact where the light varies along one of the axes only, on a plane. Light that
// comes through thin parts is missing, because the image does not show its other side.
#pragma once

#include "raster/gbuffer/gbuffer.h"
#include "raster/screen_space/diffusion_profile.h"

namespace duet::raster {

/// Separates the diffuse lobes of solids in a G-buffer from all other lobes, so that the light of both can be computed
/// apart. It changes the G-buffer, and restores it in the end.
class SolidLobes {
public:
    /// Leaves all but the solids' diffuse lobes in the G-buffer.
    SolidLobes(const SolidMaterials& materials, GBuffer& gbuffer, int threads);
    SolidLobes(const SolidLobes&) = delete;
    SolidLobes& operator=(const SolidLobes&) = delete;
    ~SolidLobes();

    /// Leaves only the solids' diffuse lobes in the G-buffer.
    void show_diffuse();

private:
    GBuffer& gbuffer_;
    Planes3 diffuse_, solid_diffuse_, specular_;
    PlaneFloat coat_;
};

/// Blurs the light of solids, which is that of the diffuse lobes of the G-buffer.
void blur_solid_light(const SolidMaterials& materials, const GBuffer& gbuffer, int threads, Planes3& light);

} // namespace duet::raster
