// This file draws the part of the panel that edits the scene: the selected element, materials, environment and camera.
#include "compare/view/edits.h"
#include "compare/view/window/app.h"

#include <imgui_stdlib.h>

#include <cmath>

namespace duet::compare {

using nlohmann::ordered_json;

namespace {

/// Edits a value of a scene file in place: numbers, colors and words, and objects and arrays of these.
class JsonEditor {
public:
    /// The names of the scene's materials are offered for a member "material".
    explicit JsonEditor(const ordered_json& scene)
        : materials_(scene.contains("materials") ? scene.at("materials") : ordered_json::object()) {}

    /// Draws the value, and returns whether it has changed.
    bool edit(const std::string& key, ordered_json& value) const {
        ImGui::PushID(key.c_str());
        const bool changed = edit_value(key, value);
        ImGui::PopID();
        return changed;
    }

private:
    bool edit_value(const std::string& key, ordered_json& value) const {
        const char* label = key.c_str();
        if (value.is_boolean()) return edit_boolean(label, value);
        if (key == "priority" || key == "octaves" || key == "resolution") return edit_whole_numbers(label, value);
        if (value.is_number()) return edit_numbers(label, value);
        if (value.is_string()) return key == "material" ? edit_material(value) : edit_text(label, value);
        const bool numbers = value.is_array() && !value.empty() && value.size() <= 4 &&
                             std::all_of(value.begin(), value.end(), [](const auto& x) { return x.is_number(); });
        if (numbers) return is_color(key, value) ? edit_color(label, value) : edit_numbers(label, value);
        if (!value.is_structured() || !ImGui::TreeNode(label)) return false;
        bool changed = false;
        for (const auto& [name, child] : value.items()) changed |= edit(name, child);
        ImGui::TreePop();
        return changed;
    }

    static bool is_color(const std::string& key, const ordered_json& value) {
        return value.size() == 3 && (key == "albedo" || key == "base_color" || key == "tint" || key == "reflectance");
    }

    static bool edit_boolean(const char* label, ordered_json& value) {
        bool on = value.get<bool>();
        if (!ImGui::Checkbox(label, &on)) return false;
        value = on;
        return true;
    }

    static bool edit_numbers(const char* label, ordered_json& value) {
        const bool one = value.is_number();
        std::vector<double> numbers = one ? std::vector{value.get<double>()} : value.get<std::vector<double>>();
        double largest = 0;
        for (const double x : numbers) largest = std::max(largest, std::abs(x));
        const auto speed = static_cast<float>(std::max(largest, 0.1) * 0.005);
        if (!ImGui::DragScalarN(label, ImGuiDataType_Double, numbers.data(), static_cast<int>(numbers.size()), speed,
                                nullptr, nullptr, "%.7g"))
            return false;
        for (double& x : numbers) x = typed_number(x);
        value = one ? ordered_json(numbers.front()) : ordered_json(numbers);
        return true;
    }

    static bool edit_whole_numbers(const char* label, ordered_json& value) {
        if (!value.is_array()) {
            int number = value.get<int>();
            return ImGui::InputInt(label, &number) && (value = number, true);
        }
        std::vector<int> numbers = value.get<std::vector<int>>();
        const int count = static_cast<int>(numbers.size());
        return ImGui::InputScalarN(label, ImGuiDataType_S32, numbers.data(), count) && (value = numbers, true);
    }

    static bool edit_color(const char* label, ordered_json& value) {
        std::array<float, 3> channels{};
        for (std::size_t i = 0; i < 3; ++i) channels[i] = value.at(i).get<float>();
        const std::array<float, 3> before = channels;
        if (!ImGui::ColorEdit3(label, channels.data(), ImGuiColorEditFlags_Float)) return false;
        for (std::size_t i = 0; i < 3; ++i)
            if (channels[i] != before[i]) value.at(i) = std::round(static_cast<double>(channels[i]) * 1000) / 1000;
        return true;
    }

    static bool edit_text(const char* label, ordered_json& value) {
        std::string text = value.get<std::string>();
        if (!ImGui::InputText(label, &text, ImGuiInputTextFlags_EnterReturnsTrue)) return false;
        value = text;
        return true;
    }

    bool edit_material(ordered_json& value) const {
        const std::string now = value.get<std::string>();
        bool changed = false;
        if (!ImGui::BeginCombo("material", now.c_str())) return false;
        for (const auto& [name, material] : materials_.items())
            if (ImGui::Selectable(name.c_str(), name == now) && name != now) value = name, changed = true;
        ImGui::EndCombo();
        return changed;
    }

    const ordered_json materials_;
};

/// Writes the parts of a value that differ, so that the rest stays as it was typed.
std::string with_changes(std::string text, const JsonPath& path, const ordered_json& old, const ordered_json& changed) {
    if (old == changed) return text;
    if (!changed.is_structured() || changed.size() != old.size()) return with_value(text, path, changed);
    for (const auto& [key, value] : changed.items()) {
        JsonPath part = path;
        part.push_back(key);
        text = with_changes(std::move(text), part, changed.is_object() ? old.at(key) : old.at(std::stoul(key)), value);
    }
    return text;
}

std::string name_of(const ordered_json& element, int index) {
    if (element.contains("name")) return element.at("name").get<std::string>();
    return element.value("type", "element") + " " + std::to_string(index);
}

} // namespace

void App::draw_scene() {
    draw_camera();
    if (!document_.editable()) return ImGui::TextDisabled("A bare mesh: write a scene file to edit more.");
    draw_additions();
    draw_mesh_field();
    draw_selected();
    draw_members("materials");
    draw_members("environment");
    ImGui::Separator();
    ImGui::BeginDisabled(!document_.changed());
    if (ImGui::Button("save (Ctrl+S)")) save();
    ImGui::EndDisabled();
    ImGui::SameLine();
    if (ImGui::Button("undo")) undo(true);
    ImGui::SameLine();
    if (ImGui::Button("redo")) undo(false);
}

void App::draw_camera() {
    if (!ImGui::TreeNode("camera")) return;
    Camera camera = document_.camera();
    const auto drag = [](const char* name, double& value, float speed, double low, double high) {
        return ImGui::DragScalar(name, ImGuiDataType_Double, &value, speed, &low, &high, "%.5g");
    };
    const double distance = length(camera.look_at - camera.eye);
    const auto step = static_cast<float>(0.002 * distance);
    bool changed = false;
    if (camera.projection == Camera::Projection::kOrthographic) {
        changed |= drag("height", camera.height, static_cast<float>(0.005 * camera.height), 1e-6, 1e6);
    } else {
        changed |= drag("field of view", camera.fov_degrees, 0.1f, 1, 170);
        changed |= drag("lens radius", camera.aperture_radius, 0.1f * step, 0, distance);
        double focus = camera.focus_distance > 0 ? camera.focus_distance : distance;
        if (drag("focus distance", focus, step, 1e-3 * distance, 1e3 * distance))
            camera.focus_distance = focus, changed = true;
    }
    for (double* number : {&camera.fov_degrees, &camera.height, &camera.aperture_radius, &camera.focus_distance})
        *number = typed_number(*number);
    if (changed) changed_camera(camera);
    ImGui::TreePop();
}

void App::draw_members(const char* list) {
    const ordered_json& scene = document_.json();
    if (!scene.contains(list) || !ImGui::TreeNode(list)) return;
    const JsonEditor editor(scene);
    const ordered_json value = scene.at(list); // the document changes below
    for (const auto& [key, child] : value.items()) {
        ordered_json changed = child;
        if (editor.edit(key, changed)) apply({list, key}, changed);
    }
    ImGui::TreePop();
}

void App::apply(const JsonPath& path, const ordered_json& changed) {
    attempt([&] {
        const ordered_json old = ordered_json::parse(value_text(document_.text(), path));
        edit(with_changes(document_.text(), path, old, changed));
    });
}

// Clears the selection if its list no longer has such an element.
void App::drop_lost_selection() {
    if (!selected_.any()) return;
    const ordered_json& scene = document_.json();
    if (!scene.contains(selected_.list) || selected_.index >= static_cast<int>(scene.at(selected_.list).size()))
        selected_ = {};
}

void App::draw_choice() {
    const ordered_json& scene = document_.json();
    const auto label = [&](const Selection& one) {
        const ordered_json& element = scene.at(one.list).at(static_cast<std::size_t>(one.index));
        return (one.list == "objects" ? "" : one.list + ": ") + name_of(element, one.index);
    };
    if (!ImGui::BeginCombo("selected", selected_.any() ? label(selected_).c_str() : "none")) return;
    for (const char* list : kSelectableLists) {
        if (!scene.contains(list)) continue;
        ImGui::PushID(list);
        ImGuiListClipper visible;
        visible.Begin(static_cast<int>(scene.at(list).size()));
        while (visible.Step())
            for (Selection one{list, visible.DisplayStart}; one.index < visible.DisplayEnd; ++one.index) {
                ImGui::PushID(one.index);
                if (ImGui::Selectable(label(one).c_str(), one == selected_)) selected_ = one;
                ImGui::PopID();
            }
        ImGui::PopID();
    }
    ImGui::EndCombo();
}

void App::draw_selected() {
    drop_lost_selection();
    draw_choice();
    if (!selected_.any()) return;
    const ordered_json& scene = document_.json();
    ordered_json element = scene.at(selected_.list).at(static_cast<std::size_t>(selected_.index));
    const JsonEditor editor(scene);
    bool changed = false;
    ImGui::Indent();
    for (auto& [name, child] : element.items())
        if (name != "type") changed |= editor.edit(name, child);
    if (changed) apply(selected_.path(), element);
    draw_turns();
    if (element.contains("material") && ImGui::Button("a material of its own"))
        attempt([&] { edit(with_own_material(document_.text(), selected_.path())); });
    if (ImGui::Button("duplicate (Ctrl+D)")) duplicate_selected();
    ImGui::SameLine();
    if (ImGui::Button("delete (Del)")) delete_selected();
    ImGui::Unindent();
}

// Draws the controls that turn and scale the selected element about its center.
void App::draw_turns() {
    const Box3 box = selected_bounds();
    const Handles possible = handles(document_.json(), selected_.path());
    if (box.empty()) return;
    const Vec3d center = (Vec3d(box.low) + Vec3d(box.high)) / 2.0;
    const auto apply_map = [&](const Mat4d& map) {
        attempt([&] {
            edit(transformed(document_.text(), selected_.path(), translation(center) * map * translation(-center)));
            document_.commit();
        });
    };
    if (selected_.list == "objects") ImGui::Checkbox("its own axes (L)", &local_axes_);
    if (possible.turn) {
        ImGui::SetNextItemWidth(120);
        ImGui::InputDouble("degrees", &turn_degrees_, 0, 0, "%.4g");
        constexpr std::array<const char*, 3> kTurns{"turn x", "turn y", "turn z"};
        for (std::size_t i = 0; i < 3; ++i) {
            if (i > 0) ImGui::SameLine();
            if (ImGui::Button(kTurns[i])) apply_map(rotation(selected_axes()[i], radians(turn_degrees_)));
        }
    }
    if (!possible.scale) return;
    ImGui::SetNextItemWidth(120);
    ImGui::InputDouble("factor", &scale_factor_, 0, 0, "%.4g");
    ImGui::SameLine();
    if (ImGui::Button("scale")) apply_map(scaling(Vec3d(scale_factor_, scale_factor_, scale_factor_)));
}

void App::draw_additions() {
    if (!ImGui::BeginCombo("add", "...")) return;
    const Camera& camera = document_.camera();
    for (std::size_t i = 0; i < kNewElementNames.size(); ++i) {
        if (!ImGui::Selectable(kNewElementNames[i])) continue;
        attempt([&] {
            const double size = 0.1 * length(camera.look_at - camera.eye);
            const ordered_json before = document_.json();
            edit(with_new_element(document_.text(), static_cast<NewElement>(i), camera.look_at, size));
            document_.commit();
            for (const char* list : kSelectableLists) {
                const auto count = [&](const ordered_json& scene) {
                    return scene.contains(list) ? static_cast<int>(scene.at(list).size()) : 0;
                };
                if (count(document_.json()) > count(before)) selected_ = {list, count(before)};
            }
        });
    }
    ImGui::EndCombo();
}

void App::draw_mesh_field() {
    const bool typed = ImGui::InputText("mesh", &mesh_file_, ImGuiInputTextFlags_EnterReturnsTrue);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("The name of an .obj, relative to the scene file; Enter adds it");
    if (typed) attempt([&] { edit(with_new_mesh(document_.text(), mesh_file_)); });
}

void App::duplicate_selected() {
    if (!selected_.any() || !document_.editable()) return;
    drag_ = Drag::kNone;
    attempt([&] {
        edit(duplicated(document_.text(), selected_.path()));
        document_.commit();
        selected_.index = static_cast<int>(document_.json().at(selected_.list).size()) - 1;
    });
}

void App::delete_selected() {
    if (!selected_.any() || !document_.editable()) return;
    drag_ = Drag::kNone;
    attempt([&] {
        edit(without_value(document_.text(), selected_.path()));
        document_.commit();
        selected_ = {};
    });
}

} // namespace duet::compare
