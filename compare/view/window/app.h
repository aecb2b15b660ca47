// This file declares the state of the window of `compare view`, and the functions that draw it.
#pragma once

#include "compare/view/document.h"
#include "compare/view/live_view.h"
#include "compare/view/quantities.h"
#include "compare/view/scene_text.h"
#include "compare/view/view.h"
#include "compare/view/window/window.h"

#include <imgui.h>

#include <array>
#include <optional>

namespace duet::compare {

/// Selects what the image area shows.
enum class Show { kSplit, kRaster, kTraced, kDifference, kFlip };
inline constexpr std::array<const char*, 5> kShowNames{"split", "raster", "path tracer", "difference", "FLIP"};

/// Holds the rectangle in which the window shows an image of the requested size, in pixels of the window.
struct ImageArea {
    ImVec2 low, size;
    bool hovered = false; ///< whether the pointer is on the image
    Vec2d pixel;          ///< position of the pointer in pixels of the image
};

/// Holds the difference of both images, as bytes for a texture.
struct Comparison {
    std::shared_ptr<const RasterFrame> raster{};
    std::shared_ptr<const TracerFrame> traced{};
    Show show = Show::kDifference;
    ViewTransform view_transform{};
    std::vector<std::uint8_t> bytes{};
    int width = 0, height = 0;
    double figure = 0; ///< luminance shown as full orange or blue; for FLIP the mean
};

/// Returns the title of the window that shows a scene.
inline std::string window_title(const std::filesystem::path& scene) { return "Duet: " + scene.filename().string(); }

/// A Selection is the selected element of the scene file.
struct Selection {
    std::string list = "objects"; ///< or "lights" or "media"
    int index = -1;               ///< in the list; −1: nothing is selected

    bool any() const { return index >= 0; }
    JsonPath path() const { return {list, std::to_string(index)}; }
    friend bool operator==(const Selection&, const Selection&) = default;
};
/// These are the lists of a scene file whose elements can be selected.
inline constexpr std::array<const char*, 3> kSelectableLists{"objects", "lights", "media"};

/// Holds the window's state. For each frame, draw() draws everything and passes the requested images on to the live
/// view.
class App {
public:
    App(const ViewOptions& options, Window& window);
    /// Draws a frame. Returns whether the next frame must follow at once, because something moves.
    bool draw();
    /// Orbits the camera around the look-at point by an angle in radians.
    void turn(double angle);
    /// Moves the first object of the scene file by a vector, in meters, if it can be edited. Returns whether it can.
    bool move_first_object(Vec3d by);
    /// Returns whether the window may close. With unsaved changes, the first request only warns.
    bool may_close() { return may_lose_changes("closes the window"); }
    LiveView& live() { return live_; }
    const Wish& wish() const { return wish_; }
    /// Returns whether a screenshot of this frame is requested.
    bool wants_screenshot() const { return wants_screenshot_; }
    /// Writes the requested screenshot.
    void write_screenshot(const ImageRgb& pixels);

private:
    // These functions are in image_area.cpp.
    void draw_images();
    void fit_images(ImVec2 low, ImVec2 size);
    Vec2d pixel_at(ImVec2 position) const;
    void update_textures();
    void compare_frames();
    void draw_textures();
    void navigate();
    void drag();
    bool fly_by_keys();
    void select_at(Vec2d pixel);
    void draw_markers();
    std::optional<Selection> marker_at(ImVec2 position) const;
    template <typename Visit> void for_each_marker(const Visit& visit) const;
    // These types and functions are in gizmo.cpp.
    enum class Handle { kNone, kMove, kTurn, kScale };
    void place_gizmo(const Box3& box);
    void draw_gizmo();
    void draw_handle(Handle handle, std::size_t axis, const std::vector<Vec3d>& points);
    void drag_object();
    std::optional<ImVec2> on_screen(Vec3d point) const;
    // These functions are in side_panel.cpp.
    void draw_panel();
    void draw_display();
    void draw_renderers();
    void draw_inspector();
    void draw_timings();
    void draw_curve();
    void draw_help();
    // These functions are in scene_panel.cpp.
    void draw_scene();
    void draw_camera();
    void draw_members(const char* list);
    void apply(const JsonPath& path, const nlohmann::ordered_json& changed);
    void draw_selected();
    void draw_choice();
    void drop_lost_selection();
    void draw_turns();
    void draw_additions();
    void draw_mesh_field();
    void duplicate_selected();
    void delete_selected();
    void frame_selected();
    Box3 selected_bounds();
    std::array<Vec3d, 3> selected_axes() const;

    void handle_keys();
    void open(const std::filesystem::path& path);
    void reload();
    void reload_if_changed();
    void load(bool edited = false);
    void changed_camera(const Camera& camera);
    void follow_document(); // shows the document's camera
    void edit(std::string text);
    void undo(bool back);
    void save();
    void write_images();
    // Returns whether the document may be replaced: it has no unsaved changes, or this is the second request in a row.
    bool may_lose_changes(const std::string& what);
    void attempt(const std::function<void()>& action); // shows the message of an Error
    void use_settings();
    void set_quantity(const RungRenderers& quantity);
    std::vector<RungRenderers> quantities() const;

    ViewOptions options_;
    Window& window_;
    SceneDocument document_;
    LiveView live_;
    Wish wish_;
    ViewTransform view_transform_;
    Show show_ = Show::kSplit;
    float split_ = 0.5f;
    enum class Drag { kNone, kCamera, kSplit, kObject } drag_ = Drag::kNone;
    bool help_ = false, flying_ = false, double_click_ = false, wants_screenshot_ = false;
    std::string quantity_ = kWholeImage;
    struct Settings {
        raster::RasterSettings raster;
        raytrace::PathTracerSettings raytrace;
    } settings_;        // settings of the whole image
    Selection selected_;
    bool local_axes_ = false; // handles and buttons turn and move along the object's own axes
    struct {
        std::shared_ptr<const Scene> scene;
        Selection selected;
        Box3 box;
    } bounds_; // bounds of the selected object, as last computed
    struct Gizmo {
        Handle handle = Handle::kNone; // handle under the pointer, or dragged
        std::size_t axis = 0;
        double angle = 0; // angle of the grabbed point of a ring
        std::array<Vec3d, 3> axes{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}};
        Vec3d center;
        double length = 0;  // length of the arrows, in meters
        double dragged = 0; // in meters, in radians, or the logarithm of a factor
        std::string text;   // text before the drag
    } gizmo_;
    unsigned requested_load_ = 0; // LoadedScene::load of the document's text; 0 before the first
    double turn_degrees_ = 15, scale_factor_ = 1.1;
    std::string mesh_file_;          // name that is being typed
    std::string message_, path_log_; // message of the last action; log of the path under the last click
    ImageArea area_;
    std::filesystem::file_time_type file_time_;
    double file_checked_ = 0;

    // These members hold what the textures show.
    std::shared_ptr<const RasterFrame> shown_raster_;
    std::shared_ptr<const TracerFrame> shown_traced_;
    ViewTransform shown_transform_;
    Texture raster_texture_, traced_texture_, comparison_texture_;
    std::mutex comparison_mutex_;                                                // guards comparison_
    std::shared_ptr<const Comparison> comparison_, shown_comparison_, compared_; // compared_: last one started
    LatestJob comparer_;
};

} // namespace duet::compare
