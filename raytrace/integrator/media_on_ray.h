// Declares the media of a scene along one ray. Scattering of the path and scattering of light toward it both depend on
// the columns of the media, so the ray is followed only once.
#pragma once

#include "common/medium/density_grid.h"
#include "common/medium/medium.h"

#include <optional>
#include <span>
#include <vector>

namespace duet::raytrace {

/// Represents a medium on the part of a ray that lies inside its box.
class MediumOnRay {
public:
    /// Keeps a reference to the medium. The part of the ray ends at t_end, which may be infinite.
    MediumOnRay(const Medium& medium, const Ray& ray, float t_end);

    const Medium& medium() const { return *medium_; }
    Interval inside() const { return inside_; } ///< may be empty
    /// Follows the ray from a distance in the interval until it has passed `column`, which is positive or infinite.
    PassedColumn follow(float from, float column);
    /// Returns an upper bound of the distance at which the ray has passed the column. It exceeds the exact distance by
    /// at most one cell of the density grid.
    float passed_by(float from, float column);
    /// Returns the column between two distances, in meters: that of the part that is inside of the box.
    float column(float from, float to);
    /// Returns the column up to a distance, in meters.
    float column(float t) { return column(inside_.begin, t); }

private:
    const Medium* medium_;
    Interval inside_;
    std::optional<DensityOnRay> density_; ///< only for a medium whose density varies
};

/// Holds all media of a scene along [0, t_end] of a ray.
class MediaOnRay {
public:
    /// Keeps references to the media.
    MediaOnRay(std::span<const Medium> media, const Ray& ray, float t_end);

    const Ray& ray() const { return ray_; }
    float t_end() const { return t_end_; }
    std::size_t size() const { return media_.size(); }
    MediumOnRay& operator[](std::size_t i) { return media_[i]; }
    std::vector<MediumOnRay>::iterator begin() { return media_.begin(); }
    std::vector<MediumOnRay>::iterator end() { return media_.end(); }

private:
    Ray ray_;
    float t_end_;
    std::vector<MediumOnRay> media_;
};

} // namespace duet::raytrace
