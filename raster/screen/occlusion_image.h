// How much of the environment each pixel of a picture sees.
#pragma once

#include "raster/screen/ambient_occlusion.h"

namespace duet::raster {

/// The occlusion of what a Screen shows, once a pixel however many samples it has. Each pixel looks in a few directions;
/// what it finds is averaged with those of its neighbours, 8 × 8 of which look everywhere (of 4 × 4, nearly, in small
/// pictures, where so many pixels are wide), that lie on the same surface:
/// within a pixel's width or two of its plane, facing nearly its way. Along rows, then along columns: on a plane that is
/// the mean of all 64, and elsewhere near enough (Pham and van Vliet 2005, «Separable Bilateral Filtering for Fast Video
/// Preprocessing»).
class OcclusionImage {
public:
    /// The screen must outlive it. The same for any number of threads.
    OcclusionImage(const Screen& screen, AmbientOcclusion kind, float radius, int threads);

    /// At a point (relative to the eye) in pixel (x, y), with its unit shading normal: what the pixel's sample, or one
    /// of its neighbours', has found if they lie on the same surface; else looked up anew.
    SkySeen at(int x, int y, Vec3 p, Vec3 n) const;
    /// At any point in view.
    SkySeen look(Vec3 p, Vec3 n) const;
    std::size_t memory_bytes() const { return found_.front().size() * found_.size() * sizeof(float); }

    static constexpr int kLines = 3, kSteps = 24;

private:
    /// The part visible, and the three coordinates of what is hidden.
    using Planes = std::array<ImageFloat, 4>;

    SkySeenT<Floats> look(const OcclusionPoints& points, const OcclusionPattern& pattern) const;
    void look_row(int y);
    /// Means along rows, or down columns, of the pixels of a row.
    void smooth_row(int y, bool down, const Planes& from, Planes& to) const;
    float likeness(int x, int y, Vec3 p, Vec3 n, float tolerance) const;

    const Screen& screen_;
    AmbientOcclusion kind_;
    float radius_;
    std::array<float, 7> kernel_; ///< weights of the mean, by the distance from the middle
    Planes found_;
};

} // namespace duet::raster
