// Declares MediumStack, which tracks the dielectrics that a path is inside of, their absorption, and which of them
// fills a point where several overlap.
#pragma once

#include "raytrace/render_plan.h"

#include <array>

namespace duet::raytrace {

/// Tracks nested dielectrics. Dielectrics with a priority may overlap, as water does with the glass that holds it. In
/// the overlap, only the one with the highest priority is present, and boundaries of the others are ignored (Schmidt
/// and Budge 2002, "Simple Nested Dielectrics in Ray Traced Images"). Dielectrics without a priority refract as if the
/// outside surrounded them. The dielectric that fills a point absorbs the light there. Paths start outside of all
/// dielectrics.
class MediumStack {
public:
    explicit MediumStack(const RenderPlan& plan) : plan_(&plan) {}

    /// Follows a ray from its hit to the first boundary that is not ignored, and returns the hit there. `ray`
    /// becomes the last segment, which ends there. `throughput` is multiplied by the transmittance on the way.
    /// `ignored` is set to the number of ignored boundaries.
    Hit skip_ignored_boundaries(Ray& ray, Hit hit, Rgb& throughput, int& ignored);
    /// Returns the relative index of refraction, inside over outside, of the boundary at which
    /// skip_ignored_boundaries() ended, as seen from its front. It is 0 if the material's own index applies.
    float relative_index() const { return relative_; }
    /// Returns whether a dielectric fills the current point.
    bool in_dielectric() const { return current_medium() != nullptr; }
    /// Returns the transmittance over a distance through the dielectric that fills the current point. At an infinite
    /// distance it is 0 in the channels that are absorbed.
    Rgb transmittance(float distance) const;
    /// Updates the stack when the path crosses the boundary of a dielectric, inwards or outwards.
    void cross(std::uint32_t material, bool inwards);

private:
    const Dielectric& dielectric(std::uint32_t material) const;
    /// Returns the dielectric that fills the current point, or null if there is none. One stack entry of the
    /// material `without` is ignored.
    const Dielectric* current_medium(std::int64_t without = -1) const;

    /// skip_ignored_boundaries() ignores at most this many boundaries in a row. The limit ends paths that make no
    /// progress for lack of precision.
    static constexpr int kMaxIgnored = 1000;

    const RenderPlan* plan_;
    std::array<std::uint32_t, 8> materials_{}; ///< in the order of entry
    std::size_t count_ = 0;
    int overflow_ = 0; ///< number of dielectrics entered while the array was full; they are ignored
    float relative_ = 0;
};

} // namespace duet::raytrace
