// This file draws the images of `compare view`, and handles the mouse on them.
#include "compare/view/camera_control.h"
#include "compare/view/edits.h"
#include "compare/view/image_comparison.h"
#include "compare/view/inspect.h"
#include "compare/view/window/app.h"
#include "raytrace/pixel_debug.h"

#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>

namespace duet::compare {

namespace {

constexpr float kSplitGrip = 8;      // distance in pixels from which the line is grabbed
constexpr double kOrbitRadians = 4;  // a drag over the height of the image turns by this angle
constexpr double kLookRadians = 1;   // a drag over the height of the image looks around by this angle
constexpr double kWheelFactor = 0.9; // factor of the distance for a step of the wheel
constexpr double kFlyPerSecond = 1;  // distances to the look-at point per second
constexpr float kClickPixels = 4;    // a click moves the pointer by fewer pixels

Comparison compared(const Comparison& begun, int threads) {
    const ImageRgb &a = begun.raster->rendering.radiance, &b = begun.traced->image;
    Comparison result{.width = a.width(), .height = a.height()};
    try {
        ImageComparison images = begun.show == Show::kFlip ? flip_comparison(a, b, begun.view_transform, threads)
                                                           : signed_comparison(a, b, threads);
        result.bytes = std::move(images.bytes);
        result.figure = images.figure;
    } catch (const std::exception&) { // no memory: an image of one pixel
        result = {.bytes = {0, 0, 0}, .width = 1, .height = 1};
    }
    result.show = begun.show;
    return result;
}

} // namespace

void App::fit_images(ImVec2 low, ImVec2 size) {
    const bool fixed = options_.scene_options.size.width > 0;
    const ImageSize image = fixed ? options_.scene_options.size : document_.image_size();
    const auto width = static_cast<float>(image.width), height = static_cast<float>(image.height);
    const float scale = std::min(size.x / width, size.y / height);
    area_.size = {std::max(1.0f, std::floor(width * scale)), std::max(1.0f, std::floor(height * scale))};
    area_.low = {std::floor(low.x + (size.x - area_.size.x) / 2), std::floor(low.y + (size.y - area_.size.y) / 2)};
    View view{document_.camera(), image.width, image.height};
    if (!fixed) view.width = static_cast<int>(area_.size.x), view.height = static_cast<int>(area_.size.y);
    if (view.width != wish_.view.width || view.height != wish_.view.height) {
        wish_.view = view;
        ++wish_.version;
    }
}

Vec2d App::pixel_at(ImVec2 position) const {
    return {static_cast<double>((position.x - area_.low.x) / area_.size.x) * wish_.view.width,
            static_cast<double>((position.y - area_.low.y) / area_.size.y) * wish_.view.height};
}

void App::draw_images() {
    const ImVec2 low = ImGui::GetCursorScreenPos(), size = ImGui::GetContentRegionAvail();
    fit_images(low, size);
    ImGui::InvisibleButton("mouse", size, ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonMiddle);
    area_.pixel = pixel_at(ImGui::GetIO().MousePos);
    area_.hovered = ImGui::IsItemHovered() && area_.pixel.x >= 0 && area_.pixel.y >= 0 &&
                    area_.pixel.x < wish_.view.width && area_.pixel.y < wish_.view.height;
    update_textures();
    draw_textures();
    if (document_.editable()) draw_markers();
    draw_gizmo();
    navigate();
}

void App::update_textures() {
    const auto raster = live_.raster_frame();
    const auto traced = live_.tracer_frame();
    const bool colors = quantity_ == "normals" || quantity_ == "albedo"; // colors without light
    const ViewTransform transform = colors ? ViewTransform{} : view_transform_;
    const bool all = !(transform == shown_transform_);
    const auto set = [&](Texture& texture, const ImageRgb& image) {
        texture.set(display_bytes(image, transform, options_.settings.threads), image.width(), image.height());
    };
    if (raster && raster->error.empty() && (all || raster != shown_raster_))
        set(raster_texture_, raster->rendering.radiance);
    if (traced && traced->error.empty() && (all || traced != shown_traced_)) set(traced_texture_, traced->image);
    shown_raster_ = raster;
    shown_traced_ = traced;
    shown_transform_ = transform;
    if (show_ == Show::kDifference || show_ == Show::kFlip) compare_frames();
}

void App::compare_frames() {
    const std::shared_ptr<const RasterFrame>& raster = shown_raster_;
    const std::shared_ptr<const TracerFrame>& traced = shown_traced_;
    const bool comparable = raster && traced && raster->scale == 1 && !traced->preview &&
                            raster->version == traced->version && raster->load == traced->load &&
                            raster->error.empty() && traced->error.empty();
    if (comparable && !comparer_.busy() &&
        !(compared_ && compared_->raster == raster && compared_->traced == traced && compared_->show == show_ &&
          compared_->view_transform == shown_transform_)) {
        compared_ = std::make_shared<const Comparison>(
            Comparison{.raster = raster, .traced = traced, .show = show_, .view_transform = shown_transform_});
        comparer_.start([this, begun = compared_](const std::atomic<bool>&) {
            const auto result = std::make_shared<const Comparison>(compared(*begun, options_.settings.threads));
            const std::lock_guard lock(comparison_mutex_);
            comparison_ = result;
            Window::wake();
        });
    }
    const std::lock_guard lock(comparison_mutex_);
    if (comparison_ && comparison_ != shown_comparison_) {
        comparison_texture_.set(comparison_->bytes, comparison_->width, comparison_->height);
        shown_comparison_ = comparison_;
    }
}

void App::draw_textures() {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 low = area_.low, high{low.x + area_.size.x, low.y + area_.size.y};
    const auto draw = [&](const Texture& texture, float from, float to) {
        if (texture.empty() || from >= to) return;
        list.AddImage(texture.id(), {low.x + from * area_.size.x, low.y}, {low.x + to * area_.size.x, high.y},
                      {from, 0}, {to, 1});
    };
    const auto label = [&](const char* text, bool right) {
        const ImVec2 size = ImGui::CalcTextSize(text);
        const ImVec2 at{right ? high.x - size.x - 8 : low.x + 8, low.y + 6};
        list.AddRectFilled({at.x - 4, at.y - 2}, {at.x + size.x + 4, at.y + size.y + 2}, IM_COL32(0, 0, 0, 140), 3);
        list.AddText(at, IM_COL32_WHITE, text);
    };
    if (raster_texture_.empty() && traced_texture_.empty()) {
        list.AddText({low.x + 8, low.y + 6}, IM_COL32_WHITE, "Loading and preparing the scene ...");
        return;
    }
    if (show_ == Show::kDifference || show_ == Show::kFlip) {
        if (shown_comparison_ && shown_comparison_->show == show_) draw(comparison_texture_, 0, 1);
        label(show_ == Show::kFlip ? "FLIP" : "raster - path tracer", false);
        return;
    }
    const float split = show_ == Show::kRaster ? 1 : show_ == Show::kTraced ? 0 : split_;
    draw(raster_texture_, 0, split);
    draw(traced_texture_, split, 1);
    if (split > 0) label("raster", false);
    if (split < 1) label(live_.paused() ? "path tracer, paused" : "path tracer", true);
    if (show_ != Show::kSplit) return;
    const float x = low.x + split * area_.size.x;
    list.AddLine({x, low.y}, {x, high.y}, IM_COL32(255, 255, 255, 200), 2);
    list.AddCircleFilled({x, (low.y + high.y) / 2}, 6, IM_COL32_WHITE);
}

void App::navigate() {
    const ImGuiIO& io = ImGui::GetIO();
    const bool pressed = ImGui::IsMouseClicked(0) || ImGui::IsMouseClicked(2);
    if (area_.hovered && pressed) {
        const float line = area_.low.x + split_ * area_.size.x;
        drag_ = show_ == Show::kSplit && std::abs(io.MousePos.x - line) < kSplitGrip ? Drag::kSplit
                : gizmo_.handle != Handle::kNone                                     ? Drag::kObject
                                                                                     : Drag::kCamera;
        double_click_ = ImGui::IsMouseDoubleClicked(0);
        gizmo_.dragged = 0;
        gizmo_.text = document_.text();
    }
    if (drag_ != Drag::kNone && (io.MouseDelta.x != 0 || io.MouseDelta.y != 0)) drag();
    if (drag_ != Drag::kNone && !ImGui::IsMouseDown(0) && !ImGui::IsMouseDown(2)) {
        const bool click = io.MouseDragMaxDistanceSqr[0] < kClickPixels * kClickPixels;
        if (click && drag_ == Drag::kCamera && area_.hovered && ImGui::IsMouseReleased(0)) select_at(area_.pixel);
        drag_ = Drag::kNone;
    }
    if (area_.hovered && io.MouseWheel != 0) {
        changed_camera(dolly(document_.camera(), std::pow(kWheelFactor, static_cast<double>(io.MouseWheel))));
    }
}

void App::drag() {
    const ImGuiIO& io = ImGui::GetIO();
    if (drag_ == Drag::kSplit) {
        split_ = std::clamp((io.MousePos.x - area_.low.x) / area_.size.x, 0.0f, 1.0f);
        return;
    }
    if (drag_ == Drag::kObject) return drag_object();
    if (ImGui::IsMouseDown(0) && io.MouseDragMaxDistanceSqr[0] < kClickPixels * kClickPixels) return; // still a click
    const double right = static_cast<double>(io.MouseDelta.x / area_.size.y);
    const double down = static_cast<double>(io.MouseDelta.y / area_.size.y);
    if (io.KeyShift || ImGui::IsMouseDown(2))
        changed_camera(pan(document_.camera(), -right, down));
    else if (io.KeyCtrl)
        changed_camera(look_around(document_.camera(), -kLookRadians * right, kLookRadians * down));
    else
        changed_camera(orbit(document_.camera(), -kOrbitRadians * right, kOrbitRadians * down));
}

bool App::fly_by_keys() {
    const auto axis = [&](int positive, int negative) {
        return static_cast<int>(window_.held(positive)) - static_cast<int>(window_.held(negative));
    };
    const int forward = axis(GLFW_KEY_W, GLFW_KEY_S), right = axis(GLFW_KEY_D, GLFW_KEY_A),
              up = axis(GLFW_KEY_E, GLFW_KEY_Q);
    const bool flies = forward != 0 || right != 0 || up != 0;
    if (flies) {
        const double step = kFlyPerSecond * std::min(static_cast<double>(ImGui::GetIO().DeltaTime), 0.1);
        changed_camera(fly(document_.camera(), step * forward, step * right, step * up));
    }
    flying_ = flies;
    return flies || drag_ != Drag::kNone;
}

void App::select_at(Vec2d pixel) {
    if (const std::optional<Selection> marked = marker_at(ImGui::GetIO().MousePos)) {
        selected_ = *marked;
        return;
    }
    const LoadedScene loaded = live_.loaded();
    if (!loaded.raytrace || loaded.load != requested_load_) return; // the scene is that of an older text
    const Ray ray = CameraModel(wish_.view).ray({std::floor(pixel.x) + 0.5, std::floor(pixel.y) + 0.5});
    const Hit hit = trace(loaded.raytrace->prepared, ray);
    selected_ = {};
    if (hit.valid()) selected_.index = static_cast<int>(loaded.scene->objects[hit.object].entry);
    path_log_.clear();
    if (raytrace::traces_light_paths(wish_.raytrace.integrator)) return; // only whole images can be explained
    attempt([&] {
        path_log_ = raytrace::debug_pixel(loaded.raytrace->prepared, wish_.view, wish_.raytrace,
                                          {static_cast<int>(pixel.x), static_cast<int>(pixel.y), 0});
    });
    if (hit.valid() && double_click_)
        changed_camera(
            look_at_point(document_.camera(), Vec3d(ray.origin) + static_cast<double>(hit.t) * Vec3d(ray.direction)));
}

Box3 App::selected_bounds() {
    const LoadedScene loaded = live_.loaded();
    if (!selected_.any() || !loaded.scene) return {};
    if (selected_.list != "objects") {
        const Box3 box = place(document_.json(), selected_.path());
        return box.empty() ? loaded.scene->bounds : box; // a sun is everywhere
    }
    if (bounds_.scene != loaded.scene || !(bounds_.selected == selected_))
        bounds_ = {loaded.scene, selected_, entry_bounds(*loaded.scene, static_cast<std::size_t>(selected_.index))};
    return bounds_.box;
}

std::array<Vec3d, 3> App::selected_axes() const {
    try {
        if (local_axes_) return local_axes(document_.json(), selected_.path());
    } catch (const Error&) { // the transform that was typed last cannot be used
    }
    return {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}};
}

void App::frame_selected() {
    const LoadedScene loaded = live_.loaded();
    if (!loaded.scene) return;
    const double aspect = static_cast<double>(wish_.view.width) / wish_.view.height;
    changed_camera(frame_box(document_.camera(), selected_.any() ? selected_bounds() : loaded.scene->bounds, aspect));
    document_.commit();
}

} // namespace duet::compare
