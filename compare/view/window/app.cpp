#include "compare/view/window/app.h"

#include "common/image/image_file.h"
#include "common/system/error.h"
#include "common/system/file.h"
#include "compare/view/camera_control.h"
#include "compare/view/edits.h"

#include <GLFW/glfw3.h>

namespace duet::compare {

namespace {

/// This is the interval, in seconds, between checks of whether another program has changed the scene file.
constexpr double kFileCheckSeconds = 1;

} // namespace

App::App(const ViewOptions& options, Window& window)
    : options_(options), window_(window), document_(options.scene, options.scene_options),
      live_(options.settings.threads, Window::wake) {
    view_transform_ = options.view_transform.applied_to(document_.view_transform());
    settings_ = {raster_settings(options.settings), path_tracer_settings(options.settings)};
    settings_.raster.aovs.hit = true;
    settings_.raytrace.aovs.variance = true; // two replicates, from which the error is estimated
    use_settings();
    file_time_ = write_time(document_.path());
}

bool App::draw() {
    for (const std::filesystem::path& file : window_.dropped()) open(file);
    reload_if_changed();

    const ImVec2 size = ImGui::GetIO().DisplaySize;
    constexpr float kPanelWidth = 380;
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize(size);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
    ImGui::Begin("root", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoBringToFrontOnFocus |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoMove);
    ImGui::BeginChild("images", {std::max(64.0f, size.x - kPanelWidth), 0}, false,
                      ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoScrollWithMouse);
    draw_images();
    ImGui::EndChild();
    ImGui::PopStyleVar();
    ImGui::SameLine(0, 0);
    ImGui::BeginChild("panel", {0, 0}, true);
    draw_panel();
    ImGui::EndChild();
    ImGui::End();
    if (help_) draw_help();
    if (!ImGui::IsAnyItemActive() && !flying_) document_.commit();
    handle_keys(); // after the mouse, so that keys apply to the result of a drag that has just ended

    if (requested_load_ == 0) load(); // the first frame: the size of the images is known now
    if (selected_.any() && document_.editable()) live_.expect_edits(wish_.view, document_.reader());
    live_.show(wish_);
    return fly_by_keys();
}

void App::load(bool edited) { requested_load_ = live_.load(wish_.view, document_.reader(), edited); }

void App::changed_camera(const Camera& camera) {
    document_.set_camera(camera);
    follow_document();
}

void App::turn(double angle) {
    changed_camera(orbit(document_.camera(), angle, 0));
    document_.commit();
}

bool App::move_first_object(Vec3d by) {
    if (!document_.editable() || live_.loaded().scene->objects.empty()) return false;
    edit(moved(document_.text(), {"objects", "0"}, by));
    document_.commit();
    return true;
}

void App::follow_document() {
    wish_.view.camera = document_.camera();
    ++wish_.version;
}

void App::edit(std::string text) {
    document_.set_text(std::move(text));
    load(true);
}

void App::undo(bool back) {
    drag_ = Drag::kNone;
    const std::string before = document_.text();
    if (!(back ? document_.undo() : document_.redo())) {
        message_ = back ? "Nothing to undo." : "Nothing to redo.";
        return;
    }
    follow_document();
    if (document_.text() == before) return;
    selected_ = {}; // the index may now belong to another object
    load(true);
}

bool App::may_lose_changes(const std::string& what) {
    const std::string warning = "There are changes that were not saved. The same once more " + what + ".";
    const bool may = !document_.changed() || message_ == warning;
    message_ = may ? "" : warning;
    return may;
}

void App::attempt(const std::function<void()>& action) {
    try {
        action();
    } catch (const std::exception& error) {
        message_ = error.what();
    }
}

void App::open(const std::filesystem::path& path) {
    attempt([&] {
        if (lower_case_extension(path) == ".obj" && document_.editable()) {
            edit(with_new_mesh(document_.text(), std::filesystem::absolute(path).string()));
            document_.commit();
            return;
        }
        if (!may_lose_changes("opens another scene")) return;
        SceneOptions scene_options = options_.scene_options;
        if (lower_case_extension(path) == ".json") scene_options.up = UpAxis::kGuessed; // --up is for bare meshes
        document_ = SceneDocument(path, scene_options);
        view_transform_ = options_.view_transform.applied_to(document_.view_transform());
        quantity_ = kWholeImage;
        use_settings();
        window_.set_title(window_title(path));
        selected_ = {};
        file_time_ = write_time(path);
        follow_document();
        load();
        message_ = "Opened " + path.string() + ".";
    });
}

void App::reload_if_changed() {
    const double now = glfwGetTime();
    if (now < file_checked_ + kFileCheckSeconds) return;
    file_checked_ = now;
    const auto time = write_time(document_.path());
    if (time == file_time_) return;
    file_time_ = time;
    if (document_.changed()) {
        message_ = "The file has changed on disk, and here, too. R reads it anew.";
        return;
    }
    reload();
}

void App::reload() {
    attempt([&] {
        if (!may_lose_changes("reads the file anew")) return;
        file_time_ = write_time(document_.path()); // a later change is read again
        document_.reload();
        selected_ = {};
        follow_document();
        load();
        message_ = "Read the file anew.";
    });
}

void App::save() {
    attempt([&] {
        document_.commit();
        document_.save();
        file_time_ = write_time(document_.path());
        message_ = "Saved " + document_.path().string() + ".";
    });
}

void App::write_images() {
    attempt([&] {
        const auto raster = live_.raster_frame();
        const auto traced = live_.tracer_frame();
        if (!live_.loaded().raster || !raster || !traced) throw Error("no image has been rendered yet");
        write_image(options_.folder / "raster.exr", raster->rendering.radiance);
        write_image(options_.folder / "raytrace.exr", traced->image);
        message_ = message("Wrote raster.exr and raytrace.exr (", traced->samples, " samples) to ",
                           options_.folder.string(), ".");
    });
}

void App::write_screenshot(const ImageRgb& pixels) {
    wants_screenshot_ = false;
    attempt([&] {
        const std::filesystem::path file = options_.folder / "view.png";
        write_image(file, pixels);
        message_ = "Wrote " + file.string() + ".";
    });
}

void App::handle_keys() {
    for (const KeyPress& press : window_.keys()) {
        if (press.control) {
            if (press.key == GLFW_KEY_Z) undo(!press.shift);
            if (press.key == GLFW_KEY_Y) undo(false);
            if (press.key == GLFW_KEY_S) save();
            if (press.key == GLFW_KEY_Q) window_.close();
            if (press.key == GLFW_KEY_D) duplicate_selected();
            continue;
        }
        if (press.key >= GLFW_KEY_1 && press.key <= GLFW_KEY_5) show_ = static_cast<Show>(press.key - GLFW_KEY_1);
        if (press.key == GLFW_KEY_SPACE) live_.pause(!live_.paused());
        if (press.key == GLFW_KEY_F) frame_selected();
        if (press.key == GLFW_KEY_DELETE) delete_selected();
        if (press.key == GLFW_KEY_ESCAPE) drag_ = Drag::kNone, selected_ = {};
        if (press.key == GLFW_KEY_L) local_axes_ = !local_axes_;
        if (press.key == GLFW_KEY_P) write_images();
        if (press.key == GLFW_KEY_F12) wants_screenshot_ = true;
        if (press.key == GLFW_KEY_R) reload();
        if (press.key == GLFW_KEY_F1) help_ = !help_;
    }
}

} // namespace duet::compare
