// This file lists the mutations for mutation testing. A test build can disable one numerical safeguard at a time, to
// prove that `compare stress` detects the fault. In every other build, sabotaged() is the constant false.
#pragma once

namespace duet {

/// Each enumerator names a safeguard that a mutation disables. The call of sabotaged() with this enumerator shows the
/// faulty code; compare/stress/sabotage.cpp names the test that must detect it.
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
    kNone ///< no mutation; must be the last enumerator
};

#if defined(DUET_SABOTAGE)
/// The program sets the active mutation once, before it starts any thread.
inline Guard removed_guard = Guard::kNone;
/// Returns whether the calling code must run without the given safeguard.
inline bool sabotaged(Guard guard) { return guard == removed_guard; }
inline constexpr bool kSabotageBuild = true;
#else
constexpr bool sabotaged(Guard) { return false; }
inline constexpr bool kSabotageBuild = false;
#endif

} // namespace duet
