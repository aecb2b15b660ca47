// This file runs the event loop of the window of `compare view`.
#include "common/program/program.h"
#include "compare/view/window/measure.h"

namespace duet::compare {

int view(const ViewOptions& options) {
    Window window(window_title(options.scene), options.window);
    App app(options, window);
    if (options.measure > 0) {
        measure(app, window, options);
        return kExitOk;
    }
    const InterruptFlag interrupt;
    bool moves = true;
    do {
        window.begin_frame(moves ? 0 : 0.25);
        moves = app.draw();
        const ImageRgb pixels = window.end_frame(app.wants_screenshot());
        if (!pixels.empty()) app.write_screenshot(pixels);
    } while (!interrupt.raised() && !(window.closing() && app.may_close()));
    return interrupt.raised() ? kExitInterrupted : kExitOk;
}

} // namespace duet::compare
