#include "compare/view/inspect.h"

#include "common/scene/motion_bounds.h"
#include "common/system/error.h"
#include "compare/report/text.h"

namespace duet::compare {

std::string number_text(double value) { return significant(value, 4); }

std::string color_text(Rgb color) {
    const auto part = [](float x) { return number_text(static_cast<double>(x)); };
    return message(part(color.r), " ", part(color.g), " ", part(color.b));
}

std::string hit_text(const Scene& scene, const Hit& hit) {
    if (!hit.valid()) return "nothing";
    return message(scene.objects[hit.object].name, ", primitive ", hit.primitive, ", ",
                   number_text(static_cast<double>(hit.t)), " m");
}

Box3 entry_bounds(const Scene& scene, std::size_t entry) {
    Box3 box;
    for (const Object& object : scene.objects)
        if (object.entry == entry) box.extend(motion_bounds(object, scene.shapes[object.shape]));
    return box;
}

std::string material_text(const Scene& scene, const Hit& hit) {
    return scene.material_names[material_index(scene, hit.object, hit.primitive)];
}

} // namespace duet::compare
