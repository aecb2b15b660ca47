#include "compare/stress/sabotage.h"

#include "common/system/error.h"

#include <algorithm>
#include <iterator>

namespace duet::compare {

namespace {

constexpr Sabotage kSabotages[] = {
    {Guard::kDifferenceOfProducts, "difference-of-products", "arithmetic/difference-of-products"},
    {Guard::kFrameSign, "frame-sign", "arithmetic/frames"},
    {Guard::kFilmDoubles, "film-doubles", "arithmetic/film-equal-samples"},
    {Guard::kFilmFilter, "film-filter", "arithmetic/film-bad-samples"},
    {Guard::kEnlargedBoxes, "enlarged-boxes", "leak/edges"},
    {Guard::kUnfusedEdges, "unfused-edges", "leak/edges"},
    {Guard::kNeedles, "needles", "intersection/slivers"},
    {Guard::kTieOrder, "tie-order", "intersection/duplicates"},
    {Guard::kSphereRoots, "sphere-roots", "intersection/far-spheres"},
    {Guard::kOffsetOrigin, "offset-origin", "departure/self-hits"},
    {Guard::kPlaneDistance, "plane-distance", "departure/huge-ground"},
    {Guard::kInstanceError, "instance-error", "departure/error-bounds"},
    {Guard::kCriticalAngle, "critical-angle", "material/critical-angle"},
    {Guard::kVisibleNormals, "visible-normals", "material/chi-squared"},
    {Guard::kTopLeftRule, "top-left-rule", "coverage/once-fans"},
    {Guard::kWideEdges, "wide-edges", "coverage/exact-integers"},
    {Guard::kNearClip, "near-clip", "projection/near-plane"},
    {Guard::kGuardClip, "guard-clip", "projection/guard-band"},
    {Guard::kPerspective, "perspective", "projection/barycentrics"},
    {Guard::kInsideTriangle, "inside-triangle", "projection/near-plane"},
    {Guard::kNearestOutline, "nearest-outline", "projection/slivers"},
    {Guard::kReversedDepth, "reversed-depth", "projection/depth-order"},
    {Guard::kDrawOrder, "draw-order", "projection/draw-order"},
    {Guard::kQuadDiagonal, "quad-diagonal", "pipeline/hits-quads"},
    {Guard::kEyeOutside, "eye-outside", "pipeline/hits-meshes"},
    {Guard::kPlaceDifference, "place-difference", "pipeline/hits-far"},
};
static_assert(std::size(kSabotages) == static_cast<std::size_t>(Guard::kNone));

} // namespace

std::span<const Sabotage> sabotages() { return kSabotages; }

void remove_guard([[maybe_unused]] const std::string& name) {
#if defined(DUET_SABOTAGE)
    const auto found = std::find_if(std::begin(kSabotages), std::end(kSabotages),
                                    [&](const Sabotage& sabotage) { return sabotage.name == name; });
    if (found != std::end(kSabotages)) {
        removed_guard = found->guard;
        return;
    }
    std::string known;
    for (const Sabotage& sabotage : kSabotages) known += (known.empty() ? "" : ", ") + std::string(sabotage.name);
    throw Error(message("--sabotage: found ", name, ", expected one of: ", known));
#else
    throw Error("--sabotage: this build has its guards built in; the preset sabotage can take them away");
#endif
}

} // namespace duet::compare
