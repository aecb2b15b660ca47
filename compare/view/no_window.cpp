// This file implements `compare view` in a build without the libraries of the window, where it throws Error.
#include "common/system/error.h"
#include "compare/view/view.h"

namespace duet::compare {

int view(const ViewOptions&) {
    throw Error("view: this program was built without a window. Install the packages libglfw3-dev, libimgui-dev and "
                "libgl-dev, configure anew (cmake --preset release) and build");
}

} // namespace duet::compare
