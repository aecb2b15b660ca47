// This file draws the panel of `compare view`: how the images are shown, which quantity is rendered, and what lies
// under the pointer.
#include "compare/view/window/app.h"

#include "common/program/program.h"
#include "common/system/error.h"
#include "compare/view/inspect.h"
#include "raster/shading/built_in_shaders.h"

#include <cmath>

namespace duet::compare {

namespace {

void row(const char* name, const std::string& value) {
    ImGui::TextDisabled("%s", name);
    ImGui::SameLine(110);
    ImGui::TextUnformatted(value.c_str());
}

constexpr std::pair<const char*, const char*> kHelp[] = {
    {"drag", "orbit around the look-at point"},
    {"Shift + drag", "pan; so does the middle button"},
    {"Ctrl + drag", "look around"},
    {"wheel", "move closer or away"},
    {"W A S D Q E", "fly forward, left, back, right, down, up"},
    {"click", "select the object, or the light or medium at a marker; print its path"},
    {"double click", "look there, and focus there"},
    {"drag a handle", "arrow: move, ring: turn, square: scale; Ctrl snaps"},
    {"L", "handles along the world's axes, or the object's own"},
    {"F", "frame the selected object, or everything"},
    {"1 to 5", "split, raster, path tracer, difference, FLIP"},
    {"space", "pause the path tracer"},
    {"Ctrl + Z, Y", "undo, redo"},
    {"Ctrl + D", "duplicate the object"},
    {"Delete", "delete the object"},
    {"Escape", "select nothing"},
    {"Ctrl + S", "save the scene file"},
    {"R", "read the scene file anew"},
    {"P", "write raster.exr and raytrace.exr"},
    {"F12", "write view.png, the whole window"},
    {"drop a file", "open a scene, or add a mesh (.obj) to it"},
    {"Ctrl + Q", "quit"},
};

} // namespace

void App::draw_panel() {
    if (!message_.empty()) ImGui::TextWrapped("%s", message_.c_str());
    const LoadedScene loaded = live_.loaded();
    if (!loaded.error.empty()) {
        ImGui::PushStyleColor(ImGuiCol_Text, IM_COL32(255, 150, 120, 255));
        ImGui::TextWrapped("%s", loaded.error.c_str());
        ImGui::PopStyleColor();
    }
    ImGui::TextDisabled("? shows all keys");
    const auto section = [](const char* name) { return ImGui::CollapsingHeader(name, ImGuiTreeNodeFlags_DefaultOpen); };
    if (section("Display")) draw_display();
    if (section("Renderers")) draw_renderers();
    if (section("Under the pointer")) draw_inspector();
    if (section("Time and error")) draw_timings();
    if (section("Scene")) draw_scene();
}

void App::draw_display() {
    int show = static_cast<int>(show_);
    if (ImGui::Combo("show", &show, kShowNames.data(), kShowNames.size())) show_ = static_cast<Show>(show);
    if (show_ == Show::kDifference && shown_comparison_ && shown_comparison_->show == show_)
        row("full color", "luminance " + number_text(shown_comparison_->figure));
    if (show_ == Show::kFlip && shown_comparison_ && shown_comparison_->show == show_)
        row("mean FLIP", number_text(shown_comparison_->figure));
    ImGui::SliderFloat("exposure", &view_transform_.exposure, -8, 8, "%.2f EV");
    const std::string now(kTones.name(view_transform_.tone));
    if (!ImGui::BeginCombo("tone", now.c_str())) return;
    for (const auto& [name, tone] : kTones.entries)
        if (ImGui::Selectable(std::string(name).c_str())) view_transform_.tone = tone;
    ImGui::EndCombo();
}

void App::draw_renderers() {
    if (ImGui::BeginCombo("quantity", quantity_.c_str())) {
        for (const RungRenderers& quantity : quantities())
            if (ImGui::Selectable(quantity.name.c_str(), quantity.name == quantity_)) set_quantity(quantity);
        ImGui::EndCombo();
    }
    ImGui::BeginDisabled(quantity_ != kWholeImage);
    if (ImGui::BeginCombo("raster", std::string(raster::kShadings.name(settings_.raster.shading)).c_str())) {
        for (const auto& [shading_name, shading] : raster::kShadings.entries) {
            if (!ImGui::Selectable(std::string(shading_name).c_str())) continue;
            settings_.raster.shading = shading;
            use_settings();
        }
        ImGui::EndCombo();
    }
    const std::string name(raytrace::integrator_name(settings_.raytrace.integrator));
    if (ImGui::BeginCombo("path tracer", name.c_str())) {
        for (const auto integrator : kIntegrators) {
            const std::string other(raytrace::integrator_name(integrator));
            if (!ImGui::Selectable(other.c_str(), other == name)) continue;
            settings_.raytrace.integrator = integrator;
            use_settings();
        }
        ImGui::EndCombo();
    }
    ImGui::EndDisabled();
    bool paused = live_.paused();
    if (ImGui::Checkbox("pause the path tracer (space)", &paused)) live_.pause(paused);
    if (ImGui::Button("write images (P)")) write_images();
    ImGui::SameLine();
    if (ImGui::Button("screenshot (F12)")) wants_screenshot_ = true;
}

void App::use_settings() {
    wish_.raster = settings_.raster;
    wish_.raytrace = settings_.raytrace;
    ++wish_.version;
}

void App::set_quantity(const RungRenderers& quantity) {
    quantity_ = quantity.name;
    if (quantity_ == kWholeImage) return use_settings();
    wish_.raster = quantity.raster_settings;
    wish_.raytrace = quantity.raytrace_settings;
    ++wish_.version;
}

std::vector<RungRenderers> App::quantities() const {
    const LoadedScene loaded = live_.loaded();
    if (!loaded.raster) return {};
    return color_quantities(*loaded.scene,
                            {loaded.raster->prepared, settings_.raster, loaded.raytrace->prepared, settings_.raytrace});
}

void App::draw_inspector() {
    const LoadedScene loaded = live_.loaded();
    if (!area_.hovered || !loaded.raytrace) {
        ImGui::TextDisabled("Point at the image.");
        return;
    }
    const int x = static_cast<int>(area_.pixel.x), y = static_cast<int>(area_.pixel.y);
    row("pixel", message(x, ", ", y));
    const auto at_pointer = [&](const auto& image) {
        return image(std::min(x * image.width() / wish_.view.width, image.width() - 1),
                     std::min(y * image.height() / wish_.view.height, image.height() - 1));
    };
    if (shown_raster_ && shown_raster_->error.empty()) {
        row("raster", color_text(at_pointer(shown_raster_->rendering.radiance)));
        if (!shown_raster_->rendering.hit.empty() && shown_raster_->prepared == loaded.raster->id)
            row("its hit", hit_text(*loaded.raster->scene, at_pointer(shown_raster_->rendering.hit)));
    }
    if (shown_traced_ && shown_traced_->error.empty()) row("path tracer", color_text(at_pointer(shown_traced_->image)));
    const Hit hit = trace(loaded.raytrace->prepared, CameraModel(wish_.view).ray({x + 0.5, y + 0.5}));
    row("its hit", hit_text(*loaded.scene, hit));
    if (hit.valid()) row("material", material_text(*loaded.scene, hit));
    if (!path_log_.empty() && ImGui::TreeNode("path of the last click")) {
        ImGui::TextUnformatted(path_log_.c_str());
        ImGui::TreePop();
    }
}

void App::draw_timings() {
    const LoadedScene loaded = live_.loaded();
    if (loaded.scene)
        row("prepared in", message(format_duration(loaded.raster ? loaded.raster->seconds : 0), ", ",
                                   format_duration(loaded.raytrace->seconds)));
    if (shown_raster_ && shown_raster_->error.empty()) {
        row("raster", message(format_duration(shown_raster_->seconds),
                              shown_raster_->scale < 1 ? " (smaller while it moves)" : ""));
        if (ImGui::TreeNode("stages of raster")) {
            for (const auto& [stage, seconds] : shown_raster_->rendering.statistics.seconds)
                row(stage.c_str(), format_duration(seconds));
            ImGui::TreePop();
        }
    } else if (shown_raster_) {
        ImGui::TextWrapped("raster: %s", shown_raster_->error.c_str());
    }
    if (!shown_traced_) return;
    if (!shown_traced_->error.empty()) return ImGui::TextWrapped("path tracer: %s", shown_traced_->error.c_str());
    row("path tracer", message(shown_traced_->preview ? "first look" : message(shown_traced_->samples, " samples"),
                               ", ", format_duration(shown_traced_->seconds), live_.paused() ? ", paused" : ""));
    if (shown_traced_->estimated_relmse < 0) return;
    row("relMSE", number_text(shown_traced_->estimated_relmse) + " (estimated)");
    draw_curve();
}

// Draws the estimated error against time, both logarithmic.
void App::draw_curve() {
    const auto& curve = shown_traced_->curve;
    if (curve.size() < 2) return;
    const ImVec2 low = ImGui::GetCursorScreenPos(), size{ImGui::GetContentRegionAvail().x, 90};
    ImGui::Dummy(size);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRect(low, {low.x + size.x, low.y + size.y}, IM_COL32(90, 90, 95, 255));
    const double first = std::log(curve.front().first), last = std::log(curve.back().first);
    double top = curve.front().second, bottom = top;
    for (const auto& [seconds, error] : curve) top = std::max(top, error), bottom = std::min(bottom, error);
    const double height = std::max(std::log(top / bottom), 1e-6);
    std::vector<ImVec2> points;
    for (const auto& [seconds, error] : curve)
        points.push_back(
            {low.x + size.x * static_cast<float>((std::log(seconds) - first) / std::max(last - first, 1e-6)),
             low.y + size.y * static_cast<float>(std::log(top / error) / height)});
    list.AddPolyline(points.data(), static_cast<int>(points.size()), IM_COL32(255, 190, 90, 255), ImDrawFlags_None, 2);
    list.AddText({low.x + 4, low.y + size.y - 18}, IM_COL32(160, 160, 165, 255),
                 message(number_text(top), " to ", number_text(bottom), ", ", number_text(curve.front().first), " to ",
                         number_text(curve.back().first), " s")
                     .c_str());
}

void App::draw_help() {
    ImGui::SetNextWindowPos({60, 60}, ImGuiCond_FirstUseEver);
    if (ImGui::Begin("Keys and mouse", &help_, ImGuiWindowFlags_AlwaysAutoResize)) {
        for (const auto& [keys, what] : kHelp) row(keys, what);
    }
    ImGui::End();
}

} // namespace duet::compare
