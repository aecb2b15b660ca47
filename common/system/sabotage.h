// The guards of the numerics that a test build can take away, one at a time, to prove that `compare stress` would
// notice: a test that cannot fail is worth nothing. In every other build all this is a constant.
#pragma once

namespace duet {

/// What each is stands where it is asked for; which test notices, in compare/stress/sabotage.cpp.
enum class Guard {
    kDifferenceOfProducts,
    kFrameSign,
    kFilmDoubles,
    kFilmFilter,
    kEnlargedBoxes,
    kUnfusedEdges,
    kNeedles,
    kTieOrder,
    kSphereRoots,
    kOffsetOrigin,
    kPlaneDistance,
    kInstanceError,
    kCriticalAngle,
    kVisibleNormals,
    kTopLeftRule,
    kWideEdges,
    kNearClip,
    kGuardClip,
    kPerspective,
    kInsideTriangle,
    kNearestOutline,
    kReversedDepth,
    kDrawOrder,
    kQuadDiagonal,
    kEyeOutside,
    kPlaceDifference,
    kNone ///< the last
};

#if defined(DUET_SABOTAGE)
/// Set once, before any thread starts.
inline Guard removed_guard = Guard::kNone;
/// Whether the code at hand is to do without this guard.
inline bool sabotaged(Guard guard) { return guard == removed_guard; }
inline constexpr bool kSabotageBuild = true;
#else
constexpr bool sabotaged(Guard) { return false; }
inline constexpr bool kSabotageBuild = false;
#endif

} // namespace duet
