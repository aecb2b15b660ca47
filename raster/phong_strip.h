// Phong's model over strips of samples: the fast way of Shading::kPhong.
#pragma once

#include "raster/encode_strip.h"
#include "raster/prepare.h"
#include "raster/solve.h"

#include <optional>

namespace duet::raster {

/// Shades what a StripSolver has solved. It takes samples of one mesh with normals, in one colour, under suns and point
/// lights; all else goes the way of shade().
class PhongStrips {
public:
    PhongStrips(const PreparedData& data, const PassView& view);

    /// Whether it takes the scene's lights at all.
    bool usable() const { return usable_; }
    /// Radiance of sixteen samples from pixel (x, y) on; those that see nothing have any. False where the strip is not
    /// one that it takes.
    bool shade(const StripSolver& solver, int x, int y, SampleOffset offset, StripColors& colors);

private:
    const PreparedData& data_;
    const PassView& view_;
    bool usable_ = true;
};

} // namespace duet::raster
