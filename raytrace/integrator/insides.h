// The dielectrics that a path is inside of: what they absorb, and which of them fills a place where several overlap.
#pragma once

#include "raytrace/plan.h"

#include <array>

namespace duet::raytrace {

/// Dielectrics with a priority may overlap, as water does the glass it stands in: where they do, the one of the highest
/// priority is there alone, and boundaries of the others inside it are none (Schmidt and Budge 2002, «Simple Nested
/// Dielectrics in Ray Traced Images»). Those without one refract as if they stood in the outside by themselves. Light is
/// absorbed by the one that fills the place. Paths start outside of all.
class Insides {
public:
    explicit Insides(const RenderPlan& plan) : plan_(&plan) {}

    /// Follows a ray from its hit on to the first boundary that is one, which is returned; `ray` then ends there. What is
    /// absorbed on the way is taken from throughput. `passed`: the number of boundaries gone through.
    Hit arrive(Ray& ray, Hit hit, Rgb& throughput, int& passed);
    /// Of the boundary arrived at, as seen from its front: the index inside over outside, or 0: its material's own.
    float relative_index() const { return relative_; }
    /// What is left of light after a distance through what fills the place; black after an infinite one where any is
    /// absorbed.
    Rgb transmittance(float distance) const;
    /// The path goes through the boundary of a dielectric, inwards or outwards.
    void cross(std::uint32_t material, bool inwards);

private:
    const Dielectric& glass(std::uint32_t material) const;
    /// The one that fills the place, or null; one entry of `without` does not count.
    const Dielectric* filling(std::int64_t without = -1) const;

    /// Boundaries passed at once: a path that goes nowhere for want of precision has to end.
    static constexpr int kMostPassed = 1000;

    const RenderPlan* plan_;
    std::array<std::uint32_t, 8> materials_{}; ///< as entered
    std::size_t count_ = 0;
    int deeper_ = 0; ///< those that were entered when the array was full: they fill nothing
    float relative_ = 0;
};

} // namespace duet::raytrace
