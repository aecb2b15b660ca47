// This file draws the handles of the selected element: arrows move it along axes, rings turn it about them, and the
// square in the middle scales it. Markers show lights and media, which cannot be seen themselves.
#include "compare/view/camera_control.h"
#include "compare/view/edits.h"
#include "compare/view/window/app.h"

#include <cmath>

namespace duet::compare {

namespace {

constexpr double kLengthOfHeight = 0.15; // length of an arrow, as a fraction of the height of the visible region
constexpr double kRingOfLength = 0.75;   // radius of a ring, as a fraction of the length of an arrow
constexpr float kGrabPixels = 7;         // distance from which a handle is grabbed
constexpr double kScalePerPixel = 0.01;  // logarithm of the scale factor per pixel of the drag
constexpr double kSnapDegrees = 15, kSnapFactor = 0.1;
constexpr int kRingPoints = 48;
constexpr float kMarkerPixels = 6; // radius of a marker
constexpr std::array<ImU32, 3> kColors{IM_COL32(235, 90, 70, 255), IM_COL32(120, 200, 80, 255),
                                       IM_COL32(80, 140, 240, 255)};

/// Returns the distance of a point from the line between two others.
float distance_to_line(ImVec2 p, ImVec2 a, ImVec2 b) {
    const float x = b.x - a.x, y = b.y - a.y, square = x * x + y * y;
    if (!(square > 0)) return std::hypot(p.x - a.x, p.y - a.y);
    const float along = std::clamp(((p.x - a.x) * x + (p.y - a.y) * y) / square, 0.0f, 1.0f);
    return std::hypot(p.x - a.x - along * x, p.y - a.y - along * y);
}

/// Returns how far the mouse has moved along the line from `from` to `to`, as a fraction of its length, or 0 for a line
/// shorter than `least` pixels, which points at the viewer.
double along(ImVec2 mouse, ImVec2 from, ImVec2 to, float least) {
    const float x = to.x - from.x, y = to.y - from.y, square = x * x + y * y;
    return square > least * least ? static_cast<double>((mouse.x * x + mouse.y * y) / square) : 0;
}

Vec3d ring_point(const std::array<Vec3d, 3>& axes, std::size_t axis, double angle) {
    return std::cos(angle) * axes[(axis + 1) % 3] + std::sin(angle) * axes[(axis + 2) % 3];
}

double snapped(double value, double step) { return std::round(value / step) * step; }

/// Returns the power of ten that is a hundredth to a tenth of a length.
double snap_length(double length) { return std::pow(10, std::floor(std::log10(length)) - 1); }

} // namespace

std::optional<ImVec2> App::on_screen(Vec3d point) const {
    const Vec3d projected = CameraModel(wish_.view).pinhole().project(point);
    const bool perspective = wish_.view.camera.projection == Camera::Projection::kPerspective;
    if (perspective && !(projected.z > wish_.view.camera.near_distance())) return std::nullopt;
    return ImVec2{area_.low.x + static_cast<float>(projected.x / wish_.view.width) * area_.size.x,
                  area_.low.y + static_cast<float>(projected.y / wish_.view.height) * area_.size.y};
}

void App::place_gizmo(const Box3& box) {
    const Camera& camera = wish_.view.camera;
    gizmo_.axes = selected_axes();
    gizmo_.center = (Vec3d(box.low) + Vec3d(box.high)) / 2.0;
    gizmo_.length = kLengthOfHeight * shown_height(camera, length(gizmo_.center - camera.eye));
}

void App::draw_gizmo() {
    drop_lost_selection();
    const Box3 box = selected_bounds();
    const bool current = drag_ == Drag::kObject || live_.loaded().load == requested_load_;
    if (drag_ != Drag::kObject) gizmo_.handle = Handle::kNone;
    if (!selected_.any() || box.empty() || !document_.editable() || !current) return;
    if (drag_ != Drag::kObject) place_gizmo(box); // while a handle is dragged, the scene that is loaded lags behind
    const Handles possible = handles(document_.json(), selected_.path());
    const bool moves = drag_ == Drag::kObject && gizmo_.handle == Handle::kMove;
    const Vec3d center = moves ? gizmo_.center + gizmo_.dragged * gizmo_.axes[gizmo_.axis] : gizmo_.center;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (possible.move) draw_handle(Handle::kMove, axis, {center, center + gizmo_.length * gizmo_.axes[axis]});
        if (!possible.turn) continue;
        std::vector<Vec3d> ring;
        for (int i = 0; i <= kRingPoints; ++i)
            ring.push_back(center + kRingOfLength * gizmo_.length *
                                        ring_point(gizmo_.axes, axis, 2 * kPiDouble * i / kRingPoints));
        draw_handle(Handle::kTurn, axis, ring);
    }
    if (possible.scale) draw_handle(Handle::kScale, 0, {center, center});
}

// Draws a handle, and selects it if it is the first under the pointer.
void App::draw_handle(Handle handle, std::size_t axis, const std::vector<Vec3d>& points) {
    std::vector<ImVec2> line;
    for (const Vec3d& point : points) {
        const std::optional<ImVec2> pixel = on_screen(point);
        if (!pixel) return;
        line.push_back(*pixel);
    }
    if (drag_ == Drag::kNone && area_.hovered && (gizmo_.handle == Handle::kNone || handle == Handle::kScale))
        for (std::size_t i = 0; i + 1 < line.size(); ++i) {
            if (distance_to_line(ImGui::GetIO().MousePos, line[i], line[i + 1]) > kGrabPixels) continue;
            gizmo_.handle = handle;
            gizmo_.axis = axis;
            gizmo_.angle = 2 * kPiDouble * static_cast<double>(i) / kRingPoints;
            break;
        }
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const bool active = gizmo_.handle == handle && gizmo_.axis == axis;
    const ImU32 color = active                     ? IM_COL32_WHITE
                        : handle == Handle::kScale ? IM_COL32(220, 220, 90, 255)
                                                   : kColors[axis];
    list.AddPolyline(line.data(), static_cast<int>(line.size()), color, ImDrawFlags_None,
                     handle == Handle::kTurn ? 1.5f : 3.0f);
    if (handle == Handle::kMove) list.AddCircleFilled(line.back(), active ? 7.0f : 5.0f, color);
    if (handle == Handle::kScale)
        list.AddRectFilled({line[0].x - 5, line[0].y - 5}, {line[0].x + 5, line[0].y + 5}, color);
}

// Calls visit(selection, pixel) for each light and medium that has a position in the image.
template <typename Visit> void App::for_each_marker(const Visit& visit) const {
    const nlohmann::ordered_json& scene = document_.json();
    for (const char* list : {"lights", "media"}) {
        const int count = scene.contains(list) ? static_cast<int>(scene.at(list).size()) : 0;
        for (Selection marked{list, 0}; marked.index < count; ++marked.index) {
            const Box3 box = place(scene, marked.path());
            if (box.empty()) continue;
            const std::optional<ImVec2> pixel = on_screen((Vec3d(box.low) + Vec3d(box.high)) / 2.0);
            if (pixel) visit(marked, *pixel);
        }
    }
}

void App::draw_markers() {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    for_each_marker([&](const Selection& marked, ImVec2 pixel) {
        const ImU32 color = marked == selected_ ? IM_COL32_WHITE : IM_COL32(250, 220, 120, 255);
        list.AddCircle(pixel, kMarkerPixels, IM_COL32(0, 0, 0, 200), 0, 4);
        list.AddCircle(pixel, kMarkerPixels, color, 0, 2);
    });
}

std::optional<Selection> App::marker_at(ImVec2 position) const {
    std::optional<Selection> nearest;
    float least = kMarkerPixels + kGrabPixels / 2;
    for_each_marker([&](const Selection& marked, ImVec2 pixel) {
        const float distance = std::hypot(pixel.x - position.x, pixel.y - position.y);
        if (distance <= least) least = distance, nearest = marked;
    });
    return nearest;
}

void App::drag_object() {
    const ImVec2 mouse = ImGui::GetIO().MouseDelta;
    const Vec3d center = gizmo_.center, axis = gizmo_.axes[gizmo_.axis];
    const bool snaps = ImGui::GetIO().KeyCtrl;
    Mat4d map;
    if (gizmo_.handle == Handle::kMove) {
        const std::optional<ImVec2> from = on_screen(center), to = on_screen(center + gizmo_.length * axis);
        if (from && to) gizmo_.dragged += gizmo_.length * along(mouse, *from, *to, 1);
        const double by = snaps ? snapped(gizmo_.dragged, snap_length(gizmo_.length)) : gizmo_.dragged;
        attempt([&] { edit(moved(gizmo_.text, selected_.path(), typed_number(by) * axis)); });
        return;
    }
    if (gizmo_.handle == Handle::kTurn) {
        constexpr double kStep = 0.01; // step of the angle, to find the tangent
        const auto point = [&](double angle) {
            return on_screen(center + kRingOfLength * gizmo_.length * ring_point(gizmo_.axes, gizmo_.axis, angle));
        };
        const double angle = gizmo_.angle + gizmo_.dragged;
        const std::optional<ImVec2> from = point(angle - kStep / 2), to = point(angle + kStep / 2);
        if (from && to) gizmo_.dragged += along(mouse, *from, *to, 0.05f) * kStep;
        map = rotation(axis, snaps ? snapped(gizmo_.dragged, radians(kSnapDegrees)) : gizmo_.dragged);
    } else {
        gizmo_.dragged += kScalePerPixel * static_cast<double>(mouse.x - mouse.y);
        const double factor = std::exp(gizmo_.dragged);
        const double size = snaps ? std::max(snapped(factor, kSnapFactor), kSnapFactor) : factor;
        map = scaling(Vec3d(size, size, size));
    }
    const Mat4d about_center = translation(center) * map * translation(-center);
    attempt([&] { edit(transformed(gizmo_.text, selected_.path(), about_center)); });
}

} // namespace duet::compare
