// This file generates tracery.obj, the stonework of a Gothic window: two lancets with trefoil heads, and between them a
// circle with a quatrefoil. All of their arcs touch, which determines the circle's center and radius.
#include "models/distance_field.h"
#include "models/implicit.h"
#include "models/nave.h"

namespace duet::models {
namespace {

constexpr double kHalf = kWindowHalf, kSpringing = kWindowSpringing;
constexpr double kBar = 0.075, kDepth = 0.15;  // half the width of a bar, half of its depth
constexpr double kNose = 0.022, kArris = 0.05; // half the width of a bar's front, half the depth of its sides
constexpr double kFillet = 0.05;               // distance of lines below which a fillet joins them
constexpr double kCuspDepth = 0.055;           // half the depth of the cusps' plates
// The circle touches both lancets, whose arcs have radius kHalf, and the window's arch, whose radius is twice that.
constexpr double kCircle = kHalf / 2;
const double kCircleHeight = kSpringing + std::sqrt(1.25) * kHalf;

/// Returns the signed distance to the border of a pointed opening of this half width; x is from its middle.
double lancet(double x, double y, double half) {
    x = std::abs(x);
    return y < kSpringing ? x - half : std::hypot(x + half, y - kSpringing) - 2 * half;
}

double circle(double x, double y, double radius) { return std::hypot(x, y) - radius; }

/// Returns the signed distance to the border of the trefoil-headed opening within a lancet.
double trefoil(double x, double y) {
    const double up = y - kSpringing;
    const double foils = min(circle(std::abs(x) - 0.25, up - 0.1, 0.32), circle(x, up - 0.6, 0.38));
    return min(foils, std::max(std::abs(x) - (kHalf / 2 - kBar), up - 0.1));
}

double quatrefoil(double x, double y) {
    x = std::abs(x), y = std::abs(y);
    return circle(std::max(x, y) - 0.27, min(x, y), 0.3);
}

/// Returns the signed distance to a chamfered bar, for a point at distance d from the bar's middle line and z from its
/// middle plane.
double bar(double d, double z) {
    constexpr Vec2d kChamfer(kDepth - kArris, kBar - kNose); // normal of the chamfer, unnormalized
    const double chamfer = ((d - kBar) * kChamfer.x + (z - kArris) * kChamfer.y) / std::hypot(kChamfer.x, kChamfer.y);
    return std::max({d - kBar, z - kDepth, chamfer});
}

/// Returns the signed distance to a plate that fills the region inside of `outer` but not inside of `opening`, and
/// tapers toward the opening.
double plate(double outer, double opening, double z) {
    return std::max({outer, -opening, z - kCuspDepth, (z - 0.035 - opening) * std::sqrt(0.5)});
}

double tracery(Vec3d p) {
    const double left = lancet(p.x + kHalf / 2, p.y, kHalf / 2), right = lancet(p.x - kHalf / 2, p.y, kHalf / 2);
    const double head = p.y - kCircleHeight, oculus = circle(p.x, head, kCircle), z = std::abs(p.z);
    // The rounded minimum fillets the acute corners where arcs touch, which no cell of the mesh could resolve.
    double lines = smooth_min(std::abs(left), std::abs(right), kFillet);
    for (const double line : {lancet(p.x, p.y, kHalf), oculus}) lines = smooth_min(lines, std::abs(line), kFillet);
    const double cusps = min(plate(min(left, right), trefoil(std::abs(p.x) - kHalf / 2, p.y), z),
                             plate(oculus, quatrefoil(p.x, head), z));
    return std::max(min(bar(lines, z), cusps), -0.05 - p.y); // the tracery's foot is in the sill
}

} // namespace

void write_tracery(const std::filesystem::path& folder) {
    const Vec3d high(kHalf + 0.2, kSpringing + std::sqrt(3.0) * kHalf + 0.3, 0.25);
    const Implicit surface{tracery, Vec3d(-high.x, -0.2, -high.z), high, 1.5};
    write_obj(folder / kTraceryFile, polygonize(surface, 0.03), "The tracery of a window, made by models/tracery.cpp.");
}

} // namespace duet::models
