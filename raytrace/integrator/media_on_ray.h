// The media of a scene along one ray. What they do to a path, and where they scatter light towards it, are questions
// about the same columns, so the ray is followed once for all of them.
#pragma once

#include "common/medium/density_grid.h"
#include "common/medium/medium.h"

#include <optional>
#include <span>
#include <vector>

namespace duet::raytrace {

/// A MediumOnRay is a medium on the part of a ray that is inside of its box.
class MediumOnRay {
public:
    /// Keeps a reference to the medium. The part ends at t_end, which may be infinite.
    MediumOnRay(const Medium& medium, const Ray& ray, float t_end);

    const Medium& medium() const { return *medium_; }
    Interval inside() const { return inside_; } ///< may be empty
    /// Follows the ray from a distance of the interval on until it has passed a column, > 0 or infinite.
    PassedColumn follow(float from, float column);
    /// Returns the distance by which it has passed the column, up to a cell of the density's grid too long.
    float passed_by(float from, float column);
    /// Returns the column up to a distance, in meters; that of the whole interval beyond its end.
    float column(float t);

private:
    const Medium* medium_;
    Interval inside_;
    std::optional<DensityOnRay> density_; ///< of a medium whose density varies
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
