// The handles of the selected object: three arrows along the world's axes, which move it.
#include "compare/view/edits.h"
#include "compare/view/window/app.h"

#include <cmath>

namespace duet::compare {

namespace {

constexpr double kArrowOfHeight = 0.15; // length of an arrow, as a fraction of what the image shows at the object
constexpr float kGrabPixels = 8;        // distance from which an arrow is grabbed
constexpr std::array<Vec3d, 3> kAxes{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}};
constexpr std::array<ImU32, 3> kColors{IM_COL32(235, 90, 70, 255), IM_COL32(120, 200, 80, 255),
                                       IM_COL32(80, 140, 240, 255)};

/// Returns the distance of a point from the line between two others.
float distance_to_line(ImVec2 p, ImVec2 a, ImVec2 b) {
    const float x = b.x - a.x, y = b.y - a.y, square = x * x + y * y;
    if (!(square > 0)) return std::hypot(p.x - a.x, p.y - a.y);
    const float along = std::clamp(((p.x - a.x) * x + (p.y - a.y) * y) / square, 0.0f, 1.0f);
    return std::hypot(p.x - a.x - along * x, p.y - a.y - along * y);
}

} // namespace

std::optional<ImVec2> App::on_screen(Vec3d point) const {
    const Vec3d projected = CameraModel(wish_.view).pinhole().project(point);
    const bool perspective = wish_.view.camera.projection == Camera::Projection::kPerspective;
    if (perspective && !(projected.z > wish_.view.camera.near_distance())) return std::nullopt;
    return ImVec2{area_.low.x + static_cast<float>(projected.x / wish_.view.width) * area_.size.x,
                  area_.low.y + static_cast<float>(projected.y / wish_.view.height) * area_.size.y};
}

void App::draw_gizmo() {
    if (drag_ != Drag::kObject) gizmo_.axis = -1;
    const Box3 box = selected_bounds();
    if (selected_ < 0 || box.empty() || !document_.editable()) return;
    if (drag_ != Drag::kObject) { // while an arrow is dragged, the scene that is loaded lags behind
        gizmo_.center = (Vec3d(box.low) + Vec3d(box.high)) / 2.0;
        const Camera& camera = wish_.view.camera;
        gizmo_.length =
            kArrowOfHeight * (camera.projection == Camera::Projection::kOrthographic
                                  ? camera.height
                                  : 2 * length(gizmo_.center - camera.eye) * std::tan(radians(camera.fov_degrees) / 2));
    }
    Vec3d center = gizmo_.center;
    if (drag_ == Drag::kObject) center = center + gizmo_.dragged * kAxes[static_cast<std::size_t>(gizmo_.axis)];
    const std::optional<ImVec2> from = on_screen(center);
    if (!from) return;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    for (std::size_t i = 0; i < 3; ++i) {
        const std::optional<ImVec2> to = on_screen(center + gizmo_.length * kAxes[i]);
        if (!to) continue;
        if (drag_ == Drag::kNone && area_.hovered && gizmo_.axis < 0 &&
            distance_to_line(ImGui::GetIO().MousePos, *from, *to) < kGrabPixels)
            gizmo_.axis = static_cast<int>(i);
        const bool active = gizmo_.axis == static_cast<int>(i);
        list.AddLine(*from, *to, active ? IM_COL32_WHITE : kColors[i], active ? 4.0f : 3.0f);
        list.AddCircleFilled(*to, active ? 7.0f : 5.0f, active ? IM_COL32_WHITE : kColors[i]);
    }
}

void App::drag_object() {
    const Vec3d axis = kAxes[static_cast<std::size_t>(gizmo_.axis)];
    const std::optional<ImVec2> from = on_screen(gizmo_.center), to = on_screen(gizmo_.center + gizmo_.length * axis);
    if (!from || !to) return;
    const ImVec2 mouse = ImGui::GetIO().MouseDelta;
    const float x = to->x - from->x, y = to->y - from->y;
    if (!(x * x + y * y > 1)) return; // the axis points at the viewer
    gizmo_.dragged += gizmo_.length * static_cast<double>((mouse.x * x + mouse.y * y) / (x * x + y * y));
    attempt([&] { edit(moved(gizmo_.text, selected_path(), typed_number(gizmo_.dragged) * axis)); });
}

} // namespace duet::compare
