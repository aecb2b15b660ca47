#include "compare/stress/scenes/reduce_scene.h"

#include "common/system/stopwatch.h"

#include <cstdio>
#include <cstdlib>

namespace duet::compare {

namespace {

double with_two_digits(double x) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2g", x);
    return std::strtod(text, nullptr);
}

class Reducer {
public:
    Reducer(Json scene, double seconds, const std::function<bool(const Json&)>& fails)
        : scene_(std::move(scene)), seconds_(seconds), fails_(fails) {}

    Json run() {
        do {
            changed_ = false;
            reduce(scene_);
        } while (changed_);
        return std::move(scene_);
    }

private:
    /// Calls change() and keeps its effect if the scene still fails. Otherwise restores `node`.
    template <typename Change> bool try_change(Json& node, const Change& change) {
        Json before = node;
        change();
        if (node != before && watch_.seconds() < seconds_ && fails_(scene_)) return changed_ = true;
        node = std::move(before);
        return false;
    }

    void reduce(Json& node) {
        if (node.is_number()) try_change(node, [&] { node = with_two_digits(node.get<double>()); });
        if (!node.is_structured()) return;
        for (auto i = static_cast<std::ptrdiff_t>(node.size()); i-- > 0;)
            if (!try_change(node, [&] { node.erase(std::next(node.begin(), i)); })) reduce(*std::next(node.begin(), i));
    }

    Json scene_;
    double seconds_;
    const std::function<bool(const Json&)>& fails_;
    Stopwatch watch_;
    bool changed_ = false;
};

} // namespace

Json reduce_scene(Json scene, double seconds, const std::function<bool(const Json&)>& fails) {
    return Reducer(std::move(scene), seconds, fails).run();
}

} // namespace duet::compare
